"""aisle paper 1: its measures by hand, the least exposure and the shortest way where they are known."""

import math
import re
from pathlib import Path

import numpy as np
import pytest
from aisle_tools import cli, paper1, risk
from aisle_tools.check import Obstacles
from aisle_tools.world import Polygon, World

ROOT = Path(__file__).resolve().parent.parent.parent
SCENARIOS = ROOT / "tests" / "data" / "scenarios"


def box(ident, x0, y0, x1, y1):
    return Polygon(ident, np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], dtype=float))


def hall(*boxes):
    return World("hall", (0.0, 0.0, 10.0, 8.0), [box(i + 1, *b) for i, b in enumerate(boxes)], None, 0.0)


def test_avoidance_is_equation_5_averaged_over_the_points():
    world = hall((4.0, 3.0, 5.2, 4.6))  # R = 1.0
    points = np.array([[4.6, 3.8], [4.6, 4.8], [9.0, 7.0]])
    expected = (1.0 + (1.0 - 1.05 * 1.0 / 1.5) + 0.0) / 3.0
    assert paper1.avoidance(world, 0.5, points) == pytest.approx(expected)


def define(header, name):
    found = re.search(rf"^#define {name} (\S+)", (ROOT / "src" / "plan" / header).read_text(), re.MULTILINE)
    return float(found.group(1))


def test_constants_are_those_of_the_planner():
    assert paper1.ALPHA == define("paper_swarm.h", "AISLE_PAPER_ALPHA")
    assert paper1.BETA == define("paper_swarm.h", "AISLE_PAPER_BETA")
    assert paper1.WALL == define("paper_swarm.h", "AISLE_PAPER_WALL")
    assert paper1.WEIGHT == define("objective.h", "AISLE_OBJECTIVE_RISK_WEIGHT")


def test_walls_have_no_circle():
    assert paper1.avoidance(hall((0.0, 7.8, 10.0, 8.0)), 0.5, np.array([[5.0, 7.0]])) == 0.0


def test_exposure_of_a_straight_way_along_a_wall():
    obstacles = Obstacles(hall())
    way = np.array([[2.0, 0.8], [6.0, 0.8]])  # clearance 0.3 of a disc of 0.5
    assert risk.exposure(obstacles, 0.5, 0.5, way) == pytest.approx(4.0 * 0.4, rel=1e-6)
    assert risk.exposure(obstacles, 0.5, 0.5, way + [0.0, 2.0]) == 0.0


def test_least_exposure_keeps_to_the_middle_of_the_only_corridor():
    obstacles = Obstacles(hall((3.0, 0.0, 7.0, 3.2), (3.0, 4.8, 7.0, 8.0)))  # 1.6 m wide: clearance 0.3 at best
    way = risk.least_exposure(obstacles, 0.5, 0.1, 0.5, (1.0, 4.0), (9.0, 4.0))
    x = np.linspace(0.0, 0.6, 601)  # past a corner of the corridor, until the clearance is 0.5
    end = float((2.0 - 2.0 * np.hypot(0.8, 0.5 * (x[1:] + x[:-1]))).sum() * 0.001)
    assert risk.exposure(obstacles, 0.5, 0.5, way) == pytest.approx(4.0 * 0.4 + 2.0 * end, rel=1e-3)
    inside = way[(way[:, 0] > 3.0) & (way[:, 0] < 7.0)]
    assert np.abs(inside[:, 1] - 4.0).max() < 1e-9


def test_least_exposure_is_empty_where_the_margin_cannot_be_kept():
    obstacles = Obstacles(hall((3.0, 0.0, 7.0, 3.45), (3.0, 4.55, 7.0, 8.0)))
    assert len(risk.least_exposure(obstacles, 0.5, 0.1, 0.5, (1.0, 4.0), (9.0, 4.0))) == 0


def test_shortest_way_round_a_corner_is_tangents_and_an_arc():
    obstacles = Obstacles(hall((4.99, 0.0, 5.01, 4.0)))
    length = risk.shortest(obstacles, 0.6, (2.0, 4.0), (8.0, 4.0))
    a = 2.99  # from a start to its corner
    tangent = math.sqrt(a * a - 0.36)
    angle = math.pi / 2.0 - math.acos(0.6 / a)
    exact = 2.0 * (tangent + 0.6 * angle) + 0.02
    assert exact * (1.0 - 1e-3) <= length <= exact + 1e-6


def test_changed_layouts_move_columns_alone():
    made = {c.name: c for c in paper1.cases(SCENARIOS, 0.1)}
    before = made["storage_lr"].scenario.world.polygons
    after = made["changed_lr"].scenario.world.polygons
    moves = [float((b.vertices - a.vertices)[:, 1].mean()) for a, b in zip(before, after)]
    assert moves[:4] == [0.0] * 4  # walls
    assert sorted(set(np.round(moves[4:], 9))) == [0.0, 0.6]
    assert moves[4:].count(0.0) == 8


def test_the_iteration_from_which_one_curve_stays_below_another():
    def runs(values):
        return [np.array([[v, 0.0, 0.0, 0.0] for v in values])]

    assert paper1.below_from(runs([5, 5, 5, 5]), runs([6, 4, 6, 4])) == "4"
    assert paper1.below_from(runs([5, 5]), runs([4, 4])) == "1"
    assert paper1.below_from(runs([5, 5]), runs([4, 6])) == "never"


def test_infeasible_bests_are_left_out_of_the_curves():
    first = np.array([[9.0, 0, 0, 1.0], [5.0, 0, 0, 0.0]])
    second = np.array([[9.0, 0, 0, 1.0], [7.0, 0, 0, 0.0]])
    assert math.isnan(paper1.feasible_median([first, second], 0)[0])
    assert paper1.feasible_median([first, second], 0)[1] == 6.0


def test_a_missing_program_is_told(tmp_path, capsys):
    assert cli.main(["paper", "1", "--programs", str(tmp_path)]) == 2
    assert "not found" in capsys.readouterr().err
