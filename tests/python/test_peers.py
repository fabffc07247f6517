"""What the peers are given: obstacles grown so that no way of theirs is nearer than the disc's radius."""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path

import pytest
import shapely
from aisle_tools.scenario import read_scenario
from shapely.geometry import Polygon

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tools" / "bench"))
import peers  # noqa: E402

SCENARIOS = ROOT / "tests" / "data" / "scenarios"
SQUARES = [Polygon([(0, 0), (2, 0), (2, 1), (0, 1)]), Polygon([(1.9, 0.5), (3, 0.5), (3, 2), (1.9, 2)])]


def test_grown_obstacles_lie_around_the_exact_ones_and_not_much_beyond():
    exact = shapely.union_all([p.buffer(0.5, quad_segs=400) for p in SQUARES])
    grown = shapely.union_all(peers.grown(SQUARES, 0.5))
    assert exact.difference(grown.buffer(1e-6)).area < 1e-6
    assert grown.difference(exact.buffer(0.005)).area < 1e-9


def test_sides_move_out_by_the_radius_exactly_and_arcs_by_what_the_tangents_need():
    square = [Polygon([(0, 0), (0, 2), (2, 2), (2, 0)])]  # clockwise: either turn is taken
    for quarter in (1, 8, 12):
        (out,) = peers.grown(square, 0.5, quarter)
        assert out.bounds == pytest.approx((-0.5, -0.5, 2.5, 2.5), abs=1e-12)
        away = [square[0].distance(shapely.Point(c)) for c in out.exterior.coords]
        assert max(away) == pytest.approx(0.5 / math.cos(math.pi / (4 * quarter)), abs=1e-12)
        assert len(out.exterior.coords) - 1 == 4 * quarter


def test_a_robot_of_millimetres_gets_one_corner_for_a_corner():
    (out,) = peers.grown(SQUARES[:1], 1e-3)
    assert len(out.exterior.coords) - 1 == 4


def test_overlapping_ones_are_united():
    assert len(peers.grown(SQUARES, 0.1)) == 1
    assert len(peers.grown([SQUARES[0], Polygon([(9, 9), (10, 9), (10, 10)])], 0.1)) == 2


def test_free_space_is_the_part_that_holds_the_start():
    wall = [Polygon([(4, -1), (5, -1), (5, 11), (4, 11)])]
    left = peers.free_space((0, 0, 10, 10), wall, 0.5, (1, 1))
    right = peers.free_space((0, 0, 10, 10), wall, 0.5, (9, 1))
    assert left.bounds[2] == pytest.approx(3.5, abs=0.01) and right.bounds[0] == pytest.approx(5.5, abs=0.01)


@pytest.mark.parametrize("name", ["field_8_disc", "storage_lr", "narrow_03"])
def test_a_scene_keeps_the_radius_and_asks_every_leg(name):
    path = SCENARIOS / f"{name}.json"
    raw, scenario = json.loads(path.read_text()), read_scenario(path, -1.0)
    scene = peers.scene_of(raw, scenario, 7)
    obstacles = shapely.union_all([Polygon(o) for o in raw["obstacles"]])
    corners = [c for ring in [scene["outer"], *scene["holes"]] for c in ring]
    x0, y0, x1, y1 = raw["bounds"]
    inner = [c for c in corners if x0 + 1e-6 < c[0] < x1 - 1e-6 and y0 + 1e-6 < c[1] < y1 - 1e-6]
    assert inner and min(obstacles.distance(shapely.Point(c)) for c in inner) > raw["robot"]["radius"] - 1e-9
    assert scene["repeat"] == 7 and len(scene["pairs"]) == len(scenario.goals)


def test_rounds_are_taken_leg_by_leg_at_the_median():
    rounds = [[{"ms": ms, "p99": 2 * ms, "length": 5.0}] for ms in (3.0, 1.0, 2.0)]
    assert peers.merged(rounds) == [{"ms": 2.0, "p99": 4.0, "length": 5.0}]
    assert math.isclose(peers.middle([1.0, 3.0]), 2.0)
