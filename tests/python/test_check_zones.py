"""The checker's energies and zones against figures by hand."""

import math

import numpy as np
import pytest
from aisle import goal_t, polygon_t, query_t, waypoint_t
from aisle_tools import vehicle
from aisle_tools.check import ENERGY_TOLERANCE, Obstacles, check_path, energies, float_slack
from aisle_tools.world import Polygon, World
from test_geometry import BOX, DISC, DRAG, good_path, wp


def area(kind, x0, x1, y0=-1.0, y1=1.0, value=0.0, direction=0.0):
    return Polygon(9, np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]]), kind, value, direction)


def faults(*zones, body=DISC, y=0.0):
    world = Obstacles(World("hall", (-6.0, -6.0, 10.0, 6.0), list(zones)))
    return check_path(good_path(y), world, body).faults


@pytest.mark.parametrize(("direction", "ok"), [(0.0, True), (1.57, True), (-1.57, True), (1.58, False), (math.pi, False)])
def test_directed_zones_bar_what_is_against_them(direction, ok):
    assert (faults(area(polygon_t.DIRECTED, 1.0, 2.0, direction=direction)) == []) == ok


def test_the_origin_alone_is_directed():
    assert faults(area(polygon_t.DIRECTED, 1.0, 2.0, direction=3.0), y=1.05) == []
    assert "zone 9: driven against" in faults(area(polygon_t.DIRECTED, 1.0, 2.0, direction=3.0), y=0.95)[0]


@pytest.mark.parametrize("body", [DISC, BOX])
def test_limits_of_zones_count_where_the_body_touches_them(body):
    reach = 0.3 if body.is_disc else 0.5
    assert faults(area(polygon_t.SPEED_LIMIT, 1.5, 2.5, value=1.0), body=body) == []
    assert "1.000 m/s" in faults(area(polygon_t.SPEED_LIMIT, 1.5, 2.5, value=0.9), body=body)[0]
    assert faults(area(polygon_t.SPEED_LIMIT, 4.0 + reach + 0.01, 6.0, value=0.1), body=body) == []
    assert faults(area(polygon_t.SPEED_LIMIT, 1.5, 2.5, 0.31, 1.0, 0.1), body=body) == []  # beside it
    assert faults(area(polygon_t.SPEED_LIMIT, 1.5, 2.5, 0.29, 1.0, 0.1), body=body) != []


def test_penalties_bind_nobody():
    assert faults(area(polygon_t.PENALTY, 1.0, 2.0, value=1.0)) == []


def test_energy_by_piece_and_cause():
    roll = energies(good_path(), DISC)
    assert [e.rolling for e in roll] == pytest.approx([DRAG, 2 * DRAG, DRAG])
    assert [e.acceleration for e in roll] == pytest.approx([312.5, 0.0, 0.0])  # braking gives nothing back
    assert [e.idle for e in roll] == pytest.approx([100.0] * 3)


def test_energy_from_rest_to_rest_leaves_the_dwell_out():
    path = good_path()
    path.waypoints = [wp(0, 0), wp(1, 0, t=3), wp(2, 0, t=13)]
    path.waypoints[1].flags, path.waypoints[1].goal_id = waypoint_t.GOAL, 4
    query = query_t()
    goal = goal_t()
    goal.id, goal.dwell = 4, 7.0
    query.goals, query.num_goals = [goal], 1
    body = vehicle.body(vehicle.make({"radius": 0.3}))
    first, second = energies(path, body, query)  # peak 0.5 m/s in both
    assert first.acceleration == pytest.approx(0.5 * 500 * 0.25 / 0.8) == second.acceleration
    assert second.idle == pytest.approx(500.0)


def many_short(peak=0.2, count=60, begin=1000.0):
    """Triangles from rest to rest late on the clock, with the energy that their exact times tell."""
    body = vehicle.body(vehicle.make({"radius": 0.3}))
    lim = body.limits
    up, down = peak / lim["a_max"], peak / lim["d_max"]
    length, path = 0.5 * peak * (up + down), good_path()
    at = [np.float32(begin + k * (up + down)) for k in range(count + 1)]
    path.waypoints = [wp(k * length, 0, t=float(t)) for k, t in enumerate(at)]
    found = sum(e.total for e in energies(path, body))
    exact = count * 0.5 * lim["mass"] * peak**2 / lim["drive_efficiency"]
    rest = sum(e.rolling + e.idle for e in energies(path, body))
    return path, body, found, exact + rest


def test_energy_may_be_off_by_what_float_times_leave_open():
    path, body, found, exact = many_short()
    slack = float_slack(path, body, None)
    assert abs(found - exact) > ENERGY_TOLERANCE * found  # times as floats tell less than that
    assert abs(found - exact) < slack < 0.1 * found
    for claimed, ok in ((exact, True), (found + slack + 2.0 * ENERGY_TOLERANCE * found, False), (0.8 * found, False)):
        path.energy = claimed
        told = check_path(path, Obstacles(World("hall", (-6.0, -6.0, 30.0, 6.0), [])), body).faults
        assert (not any("energy" in fault for fault in told)) == ok
    assert float_slack(good_path(), body, None) == 0.0  # moving ends tell their speeds
