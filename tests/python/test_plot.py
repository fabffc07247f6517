"""Pictures and logs: written, not empty, readable again."""

import math

import numpy as np
import pytest
from aisle import path_t, status_t, waypoint_t
from aisle_tools import cli
from aisle_tools.bottleneck import ClearanceField, narrowest
from aisle_tools.bus import LogWriter, Recording, read_events
from aisle_tools.check import Obstacles
from aisle_tools.errors import UserError
from aisle_tools.world import Polygon, World
from conftest import DATA
from PIL import Image


def reply(ident, points):
    path = path_t()
    path.query_id, path.num_waypoints = ident, len(points)
    for x, y in points:
        w = waypoint_t()
        w.x, w.y = x, y
        path.waypoints.append(w)
    if not points:
        path.status, path.cause, path.cause_value = path_t.NONE, status_t.TOO_NARROW, 0.61
    return path


@pytest.fixture
def log(tmp_path, data):
    """A log with scenario, vehicle, two queries and a reply of each kind."""
    path = tmp_path / "s.log"
    scenario = str(data / "scenarios" / "barrier_1.json")
    assert cli.main(["map", scenario, "--log", str(path)]) == 0
    assert cli.main(["vehicle", "--scenario", scenario, "--log", str(path)]) == 0
    assert cli.main(["query", "--scenario", scenario, "--log", str(path)]) == 0
    assert cli.main(["query", "--start", "2,2", "--goal", "12,4", "--log", str(path)]) == 0
    writer = LogWriter(path, "AISLE")
    writer.publish("REPLY", reply(1, [(0.0, 1.0), (7.0, 11.5), (8.0, 11.5), (15.0, 9.0)]))
    writer.close()
    return path


@pytest.mark.parametrize("suffix", ["png", "svg"])
def test_plot_draws_what_a_log_holds(tmp_path, log, suffix):
    out = tmp_path / f"p.{suffix}"
    assert cli.main(["plot", "--replies", str(log), "--out", str(out)]) == 0
    assert out.stat().st_size > 10000
    if suffix == "png":
        colours = Image.open(out).convert("RGB").getcolors(1 << 24)
        assert len(colours) > 50


def test_plot_marks_a_refusal_in_red(tmp_path, log):
    writer = LogWriter(log, "AISLE")
    writer.publish("REPLY", reply(1, []))
    writer.publish("REPLY", reply(2, []))
    writer.close()
    times = [e[0] for e in read_events(log)]
    assert times == sorted(set(times))
    out = tmp_path / "p.png"
    assert cli.main(["plot", "--replies", str(log), "--out", str(out)]) == 0
    pixels = np.asarray(Image.open(out).convert("RGB")).reshape(-1, 3)
    assert (np.abs(pixels.astype(int) - [0xD6, 0x27, 0x28]).max(axis=1) < 8).sum() > 200


def test_refusal_with_a_place_is_no_path(tmp_path, capsys):
    from aisle_tools import names

    refused = reply(1, [(7.5, 11.8)])
    refused.status, refused.cause, refused.cause_value, refused.cause_id = path_t.NONE, status_t.TOO_NARROW, 1.2, 2
    assert not names.is_path(refused) and names.place(refused) == (7.5, 11.8)
    assert names.reason(refused) == "TOO_NARROW, the gap is 1.200 m, by polygon 2, at (7.50, 11.80)"
    assert names.is_path(reply(1, [(0.0, 0.0)])) and names.place(reply(1, [(0.0, 0.0)])) is None
    only = tmp_path / "only.log"
    writer = LogWriter(only, "AISLE")
    writer.publish("REPLY", refused)
    writer.close()
    scenario = str(DATA / "scenarios" / "barrier_1.json")
    assert cli.main(["plot", "--scenario", scenario, "--replies", str(only), "--out", str(tmp_path / "p.png")]) == 0
    assert cli.main(["check", str(only), "--scenario", scenario]) == 0
    assert "0 at fault" in capsys.readouterr().out


def test_plot_draws_a_scanned_map(tmp_path, data):
    log = tmp_path / "m.log"
    writer = LogWriter(log, "AISLE")
    writer.publish("REPLY", reply(1, [(0.0, 0.0), (1.0, 1.0)]))
    writer.close()
    yaml = data / "ros_maps" / "aws_small_warehouse.yaml"
    out = tmp_path / "p.png"
    assert cli.main(["plot", "--replies", str(log), "--map", str(yaml), "--out", str(out)]) == 0
    assert out.stat().st_size > 20000


def test_log_is_appended_in_order_and_read_back(log):
    events = read_events(log)
    assert [e[0] for e in events] == sorted({e[0] for e in events})
    assert [e[1] for e in events][:3] == ["AISLE_LAYOUT", "AISLE_VEHICLE", "AISLE_QUERY"]
    recording = Recording(log, "AISLE")
    assert recording.vehicle.footprint_radius == pytest.approx(0.3) and recording.vehicle.margin == -1.0
    assert len(recording.replies) == 1 and len(recording.newest_map()[0]) == 1
    assert not Recording(log, "OTHER").replies


def test_what_is_no_log_is_refused(tmp_path):
    path = tmp_path / "x.log"
    path.write_text("hello")
    with pytest.raises(UserError, match="not an LCM log"):
        read_events(path)
    with pytest.raises(UserError, match="no such file"):
        read_events(tmp_path / "gone.log")


def test_narrowest_place_is_found_in_the_gap():
    walls = [Polygon(i, np.array([[4, a], [5, a], [5, b], [4, b]], float)) for i, (a, b) in enumerate([(0, 6), (6.8, 10)])]
    field = ClearanceField(Obstacles(World("gap", (0.0, 0.0, 10.0, 10.0), walls)), 40000)
    place = narrowest(field, (2.0, 2.0), (8.0, 2.0))
    assert place.clearance == pytest.approx(0.4, abs=0.06)
    assert math.hypot(place.x - 4.5, place.y - 6.4) < 0.6


def test_check_command_finds_the_collision(log, capsys):
    assert cli.main(["check", str(log)]) == 1
    assert "1 at fault" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "needle"),
    [
        (["map", "gone.yaml"], "gone.yaml: No such file"),
        (["map", "picture.pgm"], "give the map's .yaml"),
        (["map", "gone.json", "--tile", "1"], "--tile must be at least 8"),
        (["vehicle", "--log", "x.log"], "which vehicle?"),
        (["vehicle", "--radius", "0", "--log", "x.log"], "--radius must be above 0"),
        (["query", "--log", "x.log"], "what to ask?"),
        (["query", "--start", "1,1", "--goal", "2,2", "--planner", "magic", "--log", "x.log"], "'magic' is none of"),
        (["query", "--start", "1", "--goal", "2,2", "--log", "x.log"], "--start '1' is not X,Y"),
        (["query", "--goals", "gone.csv", "--log", "x.log"], "gone.csv: No such file"),
        (["plot", "--out", "x.png"], "which map?"),
        (["check", "gone.log"], "gone.log: no such file"),
        (["watch", "--lcm-url", "nonsense://", "--timeout", "0.1"], "cannot open the LCM bus 'nonsense://'"),
    ],
)
def test_errors_are_one_line_and_exit_2(tmp_path, monkeypatch, capfd, words, needle):
    monkeypatch.chdir(tmp_path)
    assert cli.main(words) == 2
    lines = [line for line in capfd.readouterr().err.splitlines() if line.startswith(f"aisle {words[0]}: ")]
    assert len(lines) == 1 and needle in lines[0]


def test_no_daemon_is_said_with_bus_and_prefix(capsys):
    assert (
        cli.main(
            ["query", "--start", "1,1", "--goal", "2,2", "--lcm-url", "memq://", "--prefix", "AGV7", "--timeout", "0.2"]
        )
        == 2
    )
    assert "is aisled running on memq:// with prefix AGV7?" in capsys.readouterr().err


def test_negative_coordinates_need_no_equals_sign(tmp_path):
    log = tmp_path / "n.log"
    assert cli.main(["query", "--start", "-1.5,-2", "--goal", "-3,4", "--goal", "-.5,1,-1.5", "--log", str(log)]) == 0
    query = next(iter(Recording(log, "AISLE").queries.values()))
    assert (query.start.x, query.start.y, query.goals[1].x, query.goals[1].theta) == (-1.5, -2.0, -0.5, -1.5)


def refusal(cause, value, waypoints):
    """waypoints: (x, y, flags, goal_id)."""
    path = reply(1, [w[:2] for w in waypoints])
    path.status, path.cause, path.cause_value, path.cause_id = path_t.NONE, cause, value, waypoints[1][3]
    for w, told in zip(path.waypoints, waypoints):
        w.flags, w.goal_id = told[2:]
    return path


REMOVED = waypoint_t.GOAL
HINTED = [
    (
        refusal(status_t.TOO_NARROW, 2.13, [(5, 5, 0, 0), (4, 5, 0, 12), (6.13, 5, 0, -1), (3, 5, REMOVED, 7)]),
        "TOO_NARROW, gap of 2.130 m between polygon 12 and the scanned map, at (5.00, 5.00), "
        "removing polygon 7 would open the way",
    ),
    (
        refusal(status_t.GOAL_OCCUPIED, 0.1201, [(5, 5, 0, 0), (5.1, 5.0664, 0, 0)]),
        "GOAL_OCCUPIED, at (5.00, 5.00), move 0.121 m to (5.100, 5.066)",
    ),
    (
        refusal(status_t.NO_PATH, 0.0, [(5, 5, 0, 0), (4, 5, REMOVED, 12), (3, 5, REMOVED, 7)]),
        "NO_PATH, goal 12, at (5.00, 5.00), removing polygon 12 and polygon 7 would open the way",
    ),
]


@pytest.mark.parametrize(("refused", "text"), HINTED)
def test_a_refusal_says_and_shows_what_would_help(tmp_path, refused, text):
    from aisle_tools import names

    assert names.reason(refused) == text
    log, out = tmp_path / "r.log", tmp_path / "p.png"
    writer = LogWriter(log, "AISLE")
    writer.publish("REPLY", refused)
    writer.close()
    scenario = str(DATA / "scenarios" / "barrier_1.json")
    assert cli.main(["plot", "--scenario", scenario, "--replies", str(log), "--out", str(out)]) == 0
    pixels = np.asarray(Image.open(out).convert("RGB")).reshape(-1, 3)
    assert (np.abs(pixels.astype(int) - [0x7A, 0x3D, 0xB8]).max(axis=1) < 8).sum() > 20
