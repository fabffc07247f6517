"""Tests of tools/bench/encounters.py: what is drawn, what the oracle is told, what is counted."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tools" / "bench"))

import encounter_halls as halls  # noqa: E402
import encounters  # noqa: E402


NOT_THERE = {"arrived": False, "arrival": None, "time": None}


def gap(box: tuple, x: float, y: float) -> float:
    return math.hypot(max(box[0] - x, x - box[2], 0.0), max(box[1] - y, y - box[3], 0.0))


@pytest.mark.parametrize("hall", halls.HALLS)
def test_stops_have_room_to_turn_and_lie_apart(hall: str) -> None:
    for seed in range(1, 30):
        drive = halls.draw(hall, "person", seed)
        stops = [drive.start[:2], *(g[:2] for g in drive.goals)]
        room = halls.outer_radius(drive.vehicle) + 0.1
        for x, y in stops:
            assert min(x, y, drive.width - x, drive.height - y) > room
            assert all(gap(box, x, y) > room for box in drive.boxes)
        assert all(math.dist(a, b) >= halls.APART for a, b in zip(stops, stops[1:]))


def test_a_name_is_one_drive() -> None:
    assert halls.draw("doors", "agv", 7) == halls.draw("doors", "agv", 7)
    assert halls.draw("doors", "agv", 7) != halls.draw("doors", "agv", 8)
    assert halls.draw("doors", "agv", 7) != halls.draw("doors", "jumps", 7)


def test_walls_have_doors_and_aisles_their_width() -> None:
    for seed in range(1, 20):
        drive = halls.draw("doors", "person", seed)
        for x in {box[0] for box in drive.boxes}:
            wall = sorted(box for box in drive.boxes if box[0] == x)
            gaps = [b[1] - a[3] for a, b in zip(wall, wall[1:])]
            assert gaps and all(1.79 <= g <= 3.01 for g in gaps)
        racks = sorted({(box[1], box[3]) for box in halls.draw("aisles", "person", seed).boxes})
        assert all(2.48 <= b[0] - a[1] <= 4.02 for a, b in zip(racks, racks[1:]))


def outcome(sim: dict, known: encounters.Best = encounters.Best("found", 20.0, 15.0)) -> encounters.Outcome:
    base = {"arrived": True, "arrival": 40.0, "encounters": 3, "collisions": 0, "hall_collisions": 0}
    base |= {"contacts_at_rest": 1, "revisions": 9, "stops": 0, "lapses": 0, "seconds": 60.0, "time": 33.0, "optimum": 17.0}
    base |= {"work_ms": {"p50": 0.1, "p99": 1.0, "max": 9.0}}
    base |= {"visited": 0, "goals": 1, "paths": [], "seconds": 60.0}
    return encounters.Outcome(halls.draw("open", "person", 1), base | sim, known)


def test_the_oracles_loss_is_added_to_the_way_alone() -> None:
    assert outcome({}).over(encounters.Best("found", 20.0, 15.0)) == pytest.approx(33.0 / 22.0)
    assert math.isnan(outcome(NOT_THERE).over(encounters.Best("found", 20.0, 15.0)))
    assert math.isnan(outcome({}).over(encounters.Best("none")))


def test_what_was_possible_is_what_arrived_or_what_the_oracle_finds() -> None:
    row = encounters.Row()
    row.add(outcome({}))
    row.add(outcome({}, encounters.Best("none")))
    row.add(outcome(NOT_THERE))
    row.add(outcome(NOT_THERE, encounters.Best("none")))
    assert (row.sums["drives"], row.sums["arrived"], row.sums["possible"]) == (4, 2, 3)
    assert row.success == pytest.approx(2.0 / 3.0)
    assert len(row.over_oracle) == 1


def test_failures_are_told_by_name(capsys: pytest.CaptureFixture) -> None:
    failures: list = []
    encounters.tell_failure(outcome({}), failures)
    encounters.tell_failure(outcome({"collisions": 1}), failures)
    encounters.tell_failure(outcome(NOT_THERE), failures)
    encounters.tell_failure(outcome({"arrived": False}), failures)
    assert [line.split(":")[0] for line in failures] == ["open/person/1"] * 3
    assert "does not say so" in failures[2]
    assert "COLLISION" in failures[0] and "oracle: found" in failures[1]
    assert "COLLISION" in capsys.readouterr().err


def test_shares_are_of_the_values_themselves() -> None:
    assert encounters.share_of([3.0, 1.0, 2.0], 0.5) == 2.0
    assert encounters.share_of(list(range(1, 101)), 0.95) == 95
    assert math.isnan(encounters.share_of([], 0.5))


def test_truth_becomes_ways_of_movers(tmp_path: Path) -> None:
    path = tmp_path / "truth.csv"
    rows = ["t,id,kind,x,y,theta,v,radius", "0.1,0,vehicle,1,2,0.5,0,0.6", "0.1,4,person,3,4,0,1,0.3"]
    path.write_text("\n".join([*rows, "0.2,0,vehicle,1.1,2,0.5,0,0.6", "0.2,4,person,3.1,4,0,1,0.3"]) + "\n")
    truth = encounters.read_truth(path)
    assert truth.start == ("1", "2", "0.5") and truth.end == 0.2
    assert [(t, float(x)) for t, x, _, _ in truth.movers[4]] == [(0.1, 3.0), (0.2, 3.1)]
