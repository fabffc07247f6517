"""Long bodies and cars in a rack hall: headings, reversals and turning circles, by the daemon, judged independently."""

import json
import math

import pytest
from aisle import path_t, waypoint_t
from aisle_tools import vehicle
from aisle_tools.bus import Recording
from aisle_tools.check import Obstacles, check_path
from aisle_tools.scenario import read_scenario

UP, DOWN = 0.5 * math.pi, -0.5 * math.pi
FORKLIFT = {"footprint": [[-0.5, -0.5], [1.9, -0.5], [1.9, 0.5], [-0.5, 0.5]], "margin": 0.05}
CAR = {"drive": "tricycle", "curvature_max": 0.6666}


def box(x0, y0, x1, y1):
    return [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]


@pytest.fixture()
def hall(tmp_path):
    """Three aisles of 1.3 m between racks, the middle one closed at its upper end; cross aisles of 3.5 m."""
    racks = [box(x, 3.5, x + 1.1, 10.5) for x in (1.3, 3.7, 6.1, 8.5)]
    closed = box(4.8, 9.5, 6.1, 10.5)
    scenario = {"name": "racks", "family": "racks", "bounds": [0, 0, 14, 14], "robot": {"radius": 0.5},
                "start": [0.65, 7.0], "goals": [[5.45, 7.0]], "obstacles": [*racks, closed]}
    path = tmp_path / "racks.json"
    path.write_text(json.dumps(scenario))
    return path


def asked(daemon, hall, tmp_path, drive, start, goal):
    """The one path between two poses, looked at every centimetre."""
    log = tmp_path / "replies.log"
    daemon.aisle("map", hall)
    body = tmp_path / "forklift.json"
    body.write_text(json.dumps({**FORKLIFT, **drive}))
    daemon.aisle("vehicle", "--vehicle", body)
    poses = [",".join(f"{v:.9f}" for v in p) for p in (start, goal)]
    daemon.aisle("query", f"--start={poses[0]}", f"--goal={poses[1]}", "--objective", "shortest", "--save", log, "--vehicle", body)
    recording = Recording(log, daemon.prefix)
    (path,) = recording.replies
    assert path.status == path_t.OK
    obstacles = Obstacles(read_scenario(hall).world)
    report = check_path(path, obstacles, vehicle.body(recording.vehicle), recording.queries[path.query_id])
    assert report.ok, report.faults
    assert report.clearance >= 0.05 - 1e-6
    return path


def backwards(path):
    pairs = zip(path.waypoints, path.waypoints[1:])
    return sum(b.s - a.s for a, b in pairs if b.flags & waypoint_t.REVERSE)


@pytest.mark.parametrize("drive", [{}, CAR])
@pytest.mark.parametrize(("there", "then"), [(UP, UP), (UP, DOWN), (DOWN, UP)])
def test_a_forklift_comes_from_aisle_to_aisle_by_every_heading(daemon, hall, tmp_path, drive, there, then):
    path = asked(daemon, hall, tmp_path, drive, (0.65, 7.0, there), (7.85, 7.0, then))
    turns = sum(1 for w in path.waypoints if w.flags & waypoint_t.TURN_IN_PLACE)
    assert path.length < 1.6 * path.length_bound
    if drive:
        assert turns == 0 and max(abs(w.curvature) for w in path.waypoints) <= 0.6667


@pytest.mark.parametrize("drive", [{}, CAR])
def test_out_of_a_dead_end_it_backs_and_drives_on_forwards(daemon, hall, tmp_path, drive):
    path = asked(daemon, hall, tmp_path, drive, (5.45, 7.0, UP), (12.0, 12.0, 0.0))
    assert 2.0 <= backwards(path) <= 7.5
    assert not path.waypoints[-1].flags & waypoint_t.REVERSE


def test_a_body_too_wide_for_the_aisle_is_told_the_gap(daemon, hall):
    daemon.aisle("map", hall)
    daemon.aisle("vehicle", "--footprint", "2.4x1.3", "--margin", "0.05")
    out = daemon.aisle("query", "--start=12,2,0", "--goal=12,12,0", "--objective", "shortest")
    assert " OK " in out
    out = daemon.aisle("query", "--start=12,2,0", "--goal=5.45,7.0,1.5707963", expect=1)
    assert "GOAL_OCCUPIED" in out
