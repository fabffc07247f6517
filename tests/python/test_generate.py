"""The generator of scenarios and what makes optimum.json, without the program."""

import json
import random
import sys
from pathlib import Path

import numpy as np
import pytest
from aisle_tools.scenario import read_scenario

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tools" / "bench"))

import exact  # noqa: E402
import generate  # noqa: E402

ALL = generate.STANDARD + generate.CLOSED + generate.BARRIERS


@pytest.mark.parametrize("family, make, arguments", ALL)
def test_the_same_seed_makes_the_same_convex_obstacles(family, make, arguments):
    first, again = (make(random.Random("seed"), *arguments) for _ in range(2))
    other = make(random.Random("other"), *arguments)
    assert first == again and first != other
    assert all(generate.is_convex(p) for p in first[2]), family


def test_a_stored_scenario_is_read_as_any_other(tmp_path):
    sides, radius, polygons, ends = generate.slits(random.Random(3), 0.03, True)
    data = {"family": "slits", "bounds": [0, 0, *sides], "robot": {"radius": radius}, "start": ends[0], "goals": ends[1:]}
    path = tmp_path / "slits_01.json"
    path.write_text(generate.text_of("slits_01", {**data, "obstacles": polygons}))
    scenario = read_scenario(path)
    assert scenario.radius == radius and len(scenario.world.polygons) == len(polygons)
    assert len(scenario.goals) == 2


def test_doors_part_a_wall():
    wall = generate.wall_with_doors(random.Random(1), (0.0, 10.0, 5.0), [(7.0, 1.0), (2.0, 2.0)], 0.1, False)
    assert wall == [generate.box(0.0, 4.9, 1.0, 5.1), generate.box(3.0, 4.9, 6.5, 5.1), generate.box(7.5, 4.9, 10.0, 5.1)]


@pytest.mark.parametrize("share", [0.01, 0.03, 0.1, -0.01])
def test_slits_are_as_much_wider_than_the_disc(share):
    _, radius, polygons, _ = generate.slits(random.Random(5), share, False)
    walls = [np.array(p) for p in polygons if len(p) == 4 and p[0][1] == -1.0]
    assert len(walls) == 3
    for wall in walls:
        beyond = [np.array(p) for p in polygons if p[0][0] == wall[0, 0] and p[0][1] > wall[2, 1]]
        gap = min(b[:, 1].min() for b in beyond) - wall[:, 1].max()
        assert gap == pytest.approx(2.0 * radius * (1.0 + share), abs=2e-4)


def test_room_is_the_distance_and_nought_inside():
    box = [generate.box(1.0, 1.0, 3.0, 2.0)]
    assert generate.room_at(box, 2.0, 1.5) == 0.0
    assert generate.room_at(box, 2.0, 3.0) == pytest.approx(1.0)
    assert generate.room_at(box, 0.0, 0.0) == pytest.approx(np.hypot(1.0, 1.0))


def test_optima_that_differ_are_told():
    given = json.loads((ROOT / "tests" / "data" / "scenarios" / "optimum.json").read_text())
    made = json.loads(json.dumps(given))
    assert exact.differences(made, given) == []
    made["field_8_two"]["legs"][1]["upper"] += 2e-5
    made["factory_big"]["inner"]["legs"][0]["lower"] = None
    del made["field_4"]
    assert len(exact.differences(made, given)) == 3
