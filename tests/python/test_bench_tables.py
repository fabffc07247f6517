"""The pure parts of the timing tables: halls, fits and verdicts, without the program."""

import sys
from pathlib import Path

import numpy as np
import pytest
from aisle_tools.scenario import read_scenario

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tools" / "bench"))

import curves  # noqa: E402
import logs  # noqa: E402

HALLS = [((20.0, 20.0), 40, 2.8), (curves.HALL, 10, 1.2), (curves.HALL, 4096, 1.18)]


def corners(hall):
    return [p.vertices for p in hall.world.polygons]


def area(p):
    x, y = p.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


@pytest.mark.parametrize("sides, count, slot", HALLS)
def test_the_same_seed_makes_the_same_hall_and_ends(sides, count, slot):
    first, again, other = (curves.make_hall(seed, sides, count, slot) for seed in (1, 1, 2))
    assert all((a == b).all() for a, b in zip(corners(first), corners(again)))
    assert not all(a.shape == b.shape and (a == b).all() for a, b in zip(corners(first), corners(other)))
    assert curves.make_legs(1, first, 3) == curves.make_legs(1, again, 3)
    assert curves.make_legs(1, first, 3) != curves.make_legs(2, first, 3)


@pytest.mark.parametrize("sides, count, slot", HALLS)
def test_obstacles_are_convex_apart_and_inside(sides, count, slot):
    hall = curves.make_hall(3, sides, count, slot)
    assert len(hall.world.polygons) == count
    assert sum(area(p) for p in corners(hall)) < 0.3 * sides[0] * sides[1]
    for p in corners(hall):
        edge = np.roll(p, -1, axis=0) - p
        after = np.roll(edge, -1, axis=0)
        assert (edge[:, 0] * after[:, 1] - edge[:, 1] * after[:, 0] > 0.0).all()
        assert (p > 0.0).all() and (p < sides).all()
    for i, (centre, size) in enumerate(zip(hall.centres, hall.sizes)):
        gaps = np.hypot(*(hall.centres - centre).T) - hall.sizes - size
        assert np.delete(gaps, i).min() > 0.0


@pytest.mark.parametrize("sides, count, slot", HALLS)
def test_ends_keep_clear_of_obstacles_and_walls(sides, count, slot):
    hall = curves.make_hall(1, sides, count, slot)
    for leg in curves.make_legs(1, hall, 20):
        for x, y in (leg.start, leg.goals[0]):
            assert min(x, y, sides[0] - x, sides[1] - y) >= curves.RADIUS
            for p in corners(hall):
                gaps = np.hypot(p[:, 0] - x, p[:, 1] - y)
                assert gaps.min() > curves.RADIUS


def test_the_fit_finds_the_exponent_whatever_the_factor():
    xs = [1.0, 10.0, 50.0, 1000.0]
    assert curves.exponent(xs, [7.0 * x**1.5 for x in xs]) == pytest.approx(1.5)
    assert curves.exponent(xs, [0.01 for _ in xs]) == pytest.approx(0.0)


def test_places_suffice_and_are_no_smaller_than_asked_where_they_can():
    assert curves.raster((10.0, 5.0), 50, 1.0) == (10, 5)
    columns, rows = curves.raster((10.0, 5.0), 51, 1.0)
    assert columns * rows >= 51


def told(ident, median, p99, status="OK"):
    return {"query_id": ident, "status": status, "work_units": 10, "ms_median": median, "ms_p99": p99}


def test_the_spread_is_of_one_query_and_not_over_different_ones():
    row = logs.summary([told(1, 1.0, 1.1), told(2, 100.0, 110.0), told(3, 2.0, 5.0)])
    assert row["ms_median"] == 2.0 and row["ms_p99"] == 5.0 and row["spread"] == 2.5
    assert row["work_units"] == 30 and row["solved"] == 3


@pytest.mark.parametrize(
    "queries, target, expected",
    [
        ([told(1, 4.9, 9.0)], 5.0, "ok"),
        ([told(1, 5.1, 9.0)], 5.0, "median over 5 ms"),
        ([told(1, 5.1, 9.0)], None, "ok"),
        ([told(1, 1.0, 2.1)], 5.0, "p99 over 2 x median"),
        ([told(1, 6.0, 13.0), told(2, 6.0, 6.0, "NO_PATH")], 5.0, "1 unsolved; median over 5 ms; p99 over 2 x median"),
    ],
)
def test_verdicts_name_every_target_that_was_missed(queries, target, expected):
    assert logs.verdict(logs.summary(queries), target) == expected


@pytest.mark.parametrize(
    "name, objective, expected",
    [
        ("field_8_disc", "safest", 5.0),
        ("field_8_disc", "shortest", None),
        ("factory_big", "safest", 25.0),
        ("field_8", "safest", 5.0),  # a point: a disc of a millimetre
        ("clutter_50", "safest", None),
    ],
)
def test_targets_are_for_safest_alone_by_hall_and_robot(data, name, objective, expected):
    assert logs.target_ms(read_scenario(data / "scenarios" / f"{name}.json", -1.0), objective) == expected


def test_every_scenario_and_objective_gets_enough_queries():
    for legs in (1, 2, 3, 7, 10):
        assert legs * logs.runs_of(legs) >= logs.QUERIES_MIN and logs.runs_of(legs) >= logs.RUNS_MIN


def test_an_exponent_is_called_what_it_is():
    assert [curves.judged(k) for k in (0.5, 1.0, 1.2, 1.3)] == [
        "less than linear",
        "near-linear",
        "near-linear",
        "more than linear",
    ]
