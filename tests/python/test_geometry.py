"""The curve of waypoints: lines, arcs, turns; then the checker against paths known to be good or bad."""

import math

import numpy as np
import pytest
from aisle import path_t, waypoint_t
from aisle_tools import geometry, vehicle
from aisle_tools.check import Obstacles, boundary_boxes, check_path, placed, turn_time
from aisle_tools.world import Grid, Polygon, World


def wp(x, y, theta=0.0, curvature=0.0, v=0.0, t=0.0, s=0.0, flags=0, clearance=0.0):
    w = waypoint_t()
    w.x, w.y, w.theta, w.curvature, w.v, w.t, w.s, w.flags, w.clearance = x, y, theta, curvature, v, t, s, flags, clearance
    return w


def test_line_goes_straight_and_theta_turns_linearly():
    p = geometry.piece(wp(1, 1, 0.0), wp(4, 5, 1.0))
    assert p.length == pytest.approx(5.0)
    assert p.at(0.5) == pytest.approx((2.5, 3.0, 0.5))


def test_theta_takes_the_short_way_round():
    p = geometry.piece(wp(0, 0, 3.0), wp(1, 0, -3.0))
    assert p.turn == pytest.approx(2.0 * math.pi - 6.0)


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("direction", [0.0, 1.0, 2.5, -3.0])
def test_quarter_arc_turns_to_the_signed_side(sign, direction):
    # Radius 2, a quarter turn: in the frame of motion it ends 2 ahead and 2 to the side.
    c, s = math.cos(direction), math.sin(direction)
    ahead, side = 2.0, 2.0 * sign
    end = wp(ahead * c - side * s, ahead * s + side * c, direction + sign * math.pi / 2, curvature=0.5 * sign)
    p = geometry.piece(wp(0, 0, direction), end)
    assert p.length == pytest.approx(math.pi)
    assert geometry.wrap(p.heading - direction) == pytest.approx(0.0, abs=1e-12)
    centre = (-side * s, side * c)
    for f in np.linspace(0, 1, 9):
        x, y, theta = p.at(f)
        assert math.hypot(x - centre[0], y - centre[1]) == pytest.approx(2.0)
        assert geometry.wrap(p.heading_at(f) - theta) == pytest.approx(0.0, abs=1e-12)
    assert p.at(1.0)[:2] == pytest.approx((end.x, end.y))


def test_half_circle_is_the_widest_arc_even_if_rounded_short():
    p = geometry.piece(wp(0, 0), wp(2, 0, curvature=1.0000001))
    assert p.length == pytest.approx(math.pi, rel=1e-3)
    assert p.at(0.5)[1] == pytest.approx(-1.0, rel=1e-3)  # a left turn bulges to the right of the chord


def test_samples_are_dense_and_hit_every_waypoint():
    points = [wp(0, 0), wp(1, 0), wp(1, 0, 2.0), wp(2, 1, 2.0, curvature=1.0)]
    samples = list(geometry.sample(points, 0.01, 0.01))
    gaps = [math.hypot(b.x - a.x, b.y - a.y) for a, b in zip(samples, samples[1:])]
    assert max(gaps) <= 0.01 + 1e-12
    assert max(abs(b.theta - a.theta) for a, b in zip(samples, samples[1:])) <= 0.01 + 1e-12
    for w in points:
        assert min(math.hypot(s.x - w.x, s.y - w.y) for s in samples) < 1e-9
    assert geometry.length(points) == pytest.approx(1.0 + math.pi / 2)


def test_wrap():
    for angle in np.linspace(-20, 20, 401):
        w = geometry.wrap(angle)
        assert -math.pi < w <= math.pi and math.cos(w - angle) == pytest.approx(1.0)


# ---- the checker
DRAG = 500 * 9.80665 * 0.015 / 0.8  # N at the battery, of the default vehicle


def good_path(y=0.0):
    """4 m along x: to 1 m/s and back to rest, 0.5 m/s2."""
    path = path_t()
    path.waypoints = [wp(0, y), wp(1, y, v=1, t=2, s=1), wp(3, y, v=1, t=4, s=3), wp(4, y, t=6, s=4)]
    path.num_waypoints, path.length, path.duration, path.length_bound = 4, 4.0, 6.0, 4.0
    path.energy = 4 * DRAG + 0.5 * 500 / 0.8 + 50 * 6.0
    return path


def wall(distance):
    """A wall along x whose lower edge is `distance` above y = 0."""
    return Polygon(7, np.array([[-5.0, distance], [9.0, distance], [9.0, distance + 1.0], [-5.0, distance + 1.0]]))


def hall(*polygons, grid=None):
    return Obstacles(World("hall", (-6.0, -6.0, 10.0, 6.0), list(polygons), grid))


DISC = vehicle.body(vehicle.make({"radius": 0.3, "margin": 0.1}))
BOX = vehicle.body(vehicle.make({"footprint": [[-0.5, -0.3], [0.5, -0.3], [0.5, 0.3], [-0.5, 0.3]], "margin": 0.1}))


@pytest.mark.parametrize("body", [DISC, BOX])
def test_good_path_has_no_fault_and_its_clearance_is_exact(body):
    report = check_path(good_path(), hall(wall(1.0)), body)
    assert report.ok, report.faults
    assert report.clearance == pytest.approx(0.7) and report.violation == pytest.approx(-0.6)
    assert report.length == pytest.approx(4.0)


@pytest.mark.parametrize("body", [DISC, BOX])
@pytest.mark.parametrize(("distance", "ok"), [(0.41, True), (0.4001, True), (0.3999, False), (0.2, False), (-0.5, False)])
def test_margin_is_kept_or_missed(body, distance, ok):
    path = good_path()
    for w in path.waypoints:  # slow enough beside a wall
        w.v = min(w.v, 0.25)
        w.t *= 10.0
    path.duration *= 10.0
    report = check_path(path, hall(wall(distance)), body)
    assert ("clearance" in " ".join(report.faults)) == (not ok)


def test_scan_cells_count_as_closed_squares():
    occupied = np.zeros((240, 320), dtype=bool)
    occupied[140:160, :] = True  # y from -6 + 140 * 0.05 = 1.0
    grid = Grid(-6.0, -6.0, 0.05, occupied)
    report = check_path(good_path(), hall(grid=grid), DISC)
    assert report.clearance == pytest.approx(0.7) and report.ok
    occupied[140:, :] = True
    inside = check_path(good_path(y=4.0), hall(grid=grid), DISC)  # 2 m from any free cell, deep in the block
    assert inside.clearance == pytest.approx(-0.3) and not inside.ok


def test_boundary_boxes_are_the_cells_beside_free_ones():
    occupied = np.ones((5, 5), dtype=bool)
    occupied[2, 2] = False
    boxes = boundary_boxes(Grid(0.0, 0.0, 1.0, occupied))
    assert sorted(b.bounds for b in boxes) == [(1, 2, 2, 3), (2, 1, 3, 2), (2, 3, 3, 4), (3, 2, 4, 3)]


def test_bounds_are_walls():
    world = Obstacles(World("hall", (-6.0, -0.35, 10.0, 6.0)))
    assert check_path(good_path(), world, DISC).clearance == pytest.approx(0.05)


def test_footprint_is_placed_by_a_counter_clockwise_turn():
    body = vehicle.body(vehicle.make({"footprint": [[0, 0], [2, 0], [0, 1]]}))
    turned, straight = placed(body, np.array([[10.0, 20.0, math.pi / 2], [10.0, 20.0, 0.0]]))
    assert turned == pytest.approx(np.array([[10.0, 20.0], [10.0, 22.0], [9.0, 20.0]]))
    assert straight == pytest.approx(np.array([[10.0, 20.0], [12.0, 20.0], [10.0, 21.0]]))


def test_rotated_footprint_touches_with_its_corner():
    path = path_t()
    path.waypoints = [wp(0, 0, flags=waypoint_t.TURN_IN_PLACE), wp(0, 0, math.pi / 2, t=10)]
    path.num_waypoints, path.duration = 2, 10.0
    corner = math.hypot(0.5, 0.3)
    path.energy = DRAG * corner * math.pi / 2 + 50 * 10
    report = check_path(path, hall(wall(corner + 0.2)), BOX)
    assert report.clearance == pytest.approx(0.2, abs=1e-5) and report.ok


@pytest.mark.parametrize(
    ("spoil", "needle"),
    [
        (lambda p: setattr(p.waypoints[1], "t", 1.0), "time needed"),
        (lambda p: setattr(p.waypoints[2], "t", 2.0), "does not rise"),
        (lambda p: setattr(p.waypoints[3], "v", 0.5), "not at rest"),
        (lambda p: setattr(p.waypoints[1], "v", 1.6), "speed"),
        (lambda p: setattr(p.waypoints[1], "theta", 0.1), "heading"),
        (lambda p: setattr(p, "length", 4.1), "length 4.1"),
        (lambda p: setattr(p, "duration", 5.0), "duration"),
        (lambda p: setattr(p, "energy", p.energy * 1.002), "energy"),
        (lambda p: setattr(p, "length_bound", 4.1), "length_bound"),
        (lambda p: setattr(p, "clearance_min", 0.9), "clearance_min"),
        (lambda p: setattr(p.waypoints[2], "clearance", 0.9), "waypoint 2: clearance"),
        (lambda p: setattr(p.waypoints[2], "curvature", 1.2), "no arc"),
        (lambda p: setattr(p.waypoints[0], "flags", waypoint_t.TURN_IN_PLACE), "turn on the spot moves"),
        (lambda p: setattr(p, "waypoints", []), "no waypoints"),
    ],
)
def test_each_spoilt_field_is_noticed(spoil, needle):
    path = good_path()
    spoil(path)
    assert needle in "; ".join(check_path(path, hall(wall(1.0)), DISC).faults)


def test_acceleration_lateral_and_creep_limits():
    path = good_path()
    path.waypoints[1].x = path.waypoints[1].s = 0.5  # 1 m/s after half a metre: 1 m/s2
    assert "acceleration" in "; ".join(check_path(path, hall(), DISC).faults)
    assert "creep_speed" in "; ".join(check_path(good_path(), hall(wall(0.75)), DISC).faults)
    path = good_path()  # an arc of radius 1 at 1 m/s: lateral 1 m/s2
    path.waypoints[2] = wp(2, 1, math.pi / 2, curvature=1.0, v=1, t=4)
    assert "lateral" in "; ".join(check_path(path, hall(), DISC).faults)


def test_goals_in_any_order_are_looked_for_in_the_paths():
    from aisle_tools import query

    leg = query.Leg("1", (0.0, 0.0), [(4.0, 0.0), (1.0, 0.0)])  # ids 1 and 2
    path = good_path()
    for at, ident in ((1, 2), (3, 1)):
        path.waypoints[at].flags, path.waypoints[at].goal_id = waypoint_t.GOAL, ident
    asked = query.make_query(leg, 1, 1, path_options(), False, any_order=True)
    assert check_path(path, hall(), DISC, asked).ok
    path.waypoints[1].flags = 0  # goal 2 is passed, but not said to be
    assert "goal 2" in "; ".join(check_path(path, hall(), DISC, asked).faults)
    asked.ordering = 0
    assert "goal 2" in "; ".join(check_path(good_path(), hall(), DISC, asked).faults)


def test_goals_are_looked_for_in_order():
    from aisle_tools import query

    leg = query.Leg("1", (0.0, 0.0), [(1.0, 0.0), (4.0, 0.0)])
    asked = query.make_query(leg, 1, 1, path_options(), False)
    assert check_path(good_path(), hall(), DISC, asked).ok
    asked.goals = asked.goals[::-1]
    assert "is not reached in order" in "; ".join(check_path(good_path(), hall(), DISC, asked).faults)
    asked.start.x = 0.5
    assert "not where asked" in "; ".join(check_path(good_path(), hall(), DISC, asked).faults)


def path_options():
    from aisle import options_t

    return options_t()


def test_turn_time_is_a_trapezoid_or_a_triangle():
    assert turn_time(0.25, 1.0, 1.0) == pytest.approx(1.0)
    assert turn_time(2.0, 1.0, 1.0) == pytest.approx(3.0)
