"""aisle paper 4: its cells and figures by hand, and a few seeds of every planner where the host programs are built."""

import json
import os
from pathlib import Path

import numpy as np
import pytest
import shapely
from aisle_tools import cli, paper4

ROOT = Path(__file__).resolve().parent.parent.parent
PROGRAMS = Path(os.environ.get("AISLE_PAPERS", ROOT / "build" / "release"))
SEEDS = 3


def free_for(scene):
    """Where the tool's centre may be."""
    x0, y0, x1, y1 = paper4.BOUNDS
    walls = shapely.union_all([shapely.Polygon(p.vertices) for p in scene.scenario.world.obstacles()])
    return shapely.box(x0, y0, x1, y1).buffer(-paper4.TOOL).difference(walls.buffer(paper4.TOOL))


def test_both_cells_have_a_way_and_the_crooked_one_none_of_whole_steps():
    few, more = (free_for(s) for s in paper4.scenes())
    start, goal = shapely.Point(paper4.START), shapely.Point(paper4.GOAL)
    for free in (few, more):
        assert any(part.covers(start) and part.covers(goal) for part in shapely.get_parts(free))
    xs, ys, angles = np.arange(1.53, 1.68, 0.02), np.arange(1.03, 1.38, 0.02), np.arange(0.0, 6.28, 0.1)
    x, y, angle = (v.ravel() for v in np.meshgrid(xs, ys, angles[np.abs(np.sin(angles)) > 0.9]))
    begins = np.stack([x, y], axis=1)
    for step, some in ((paper4.STEP, False), (0.5 * paper4.STEP, True)):
        ends = begins + step * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        shapely.prepare(more)
        assert shapely.covers(more, shapely.linestrings(np.stack([begins, ends], axis=1))).any() == some  # up between modules


def row(speed, zone, duration, energy, proved=True):
    sums = {"length": 2.0, "duration": duration, "energy": energy, "turning": 10.0, "stops": 0}
    return {"proved": proved, "speed": speed, "zone": zone, "fault": "contact", **sums}


def test_what_is_taken_is_the_mean_of_what_is_proved_without_turning():
    some = [row(400, 200, 6.0, 100.0), row(400, 200, 8.0, 140.0), row(400, 200, 99.0, 999.0, proved=False)]
    table = paper4.taken(some)
    assert (table[400, 200].time, table[400, 200].energy, table[400, 200].paths) == (7.0, 110.0, 2)
    assert table[400, 0].paths == 0 and np.isnan(table[400, 0].time)


def every(slow=False):
    rows = [row(v, z, 3000.0 / v, 500.0 - z) for v in paper4.SPEEDS for z in paper4.ZONES]
    return [{**r, "duration": 5.0} if slow and r["speed"] >= 700 else r for r in rows]


def counts(found):
    return {"found": found, "seeds": 5}


def test_broken_promises_and_trends_not_met_are_told_apart():
    good = {("few", "RRT", True): counts(5), ("more", "RRT", True): counts(0), ("more", "RRT", False): counts(5)}
    assert paper4.shortfalls(good, {"RRT": every()}, {"RRT": every(slow=True)}) == []
    assert len(paper4.shortfalls({**good, ("more", "RRT", True): counts(1)}, {}, {})) == 1
    assert len(paper4.shortfalls({**good, ("more", "adaptive RRT", True): counts(4)}, {}, {})) == 1
    assert len(paper4.shortfalls(good, {"RRT": [*every(), row(400, 0, 1.0, 1.0, proved=False)]}, {})) == 1
    assert paper4.notes({"RRT": every()}, {}) == []
    assert len(paper4.notes({"RRT": every(slow=True)}, {})) == 1
    assert len(paper4.notes({"RRT": [{**r, "energy": 500.0} for r in every()]}, {})) == 1


@pytest.mark.skipif(not (PROGRAMS / "paper-sampling").is_file(), reason="paper-sampling is not built")
def test_few_seeds_of_every_planner_keep_what_is_promised(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(paper4, "NAMED", 1)
    monkeypatch.setattr(paper4, "TIME_SPEEDS", (400, 800))
    monkeypatch.setattr(paper4, "PAPER_TIMES", {p: (t[0], t[-1]) for p, t in paper4.PAPER_TIMES.items()})
    monkeypatch.setattr(paper4, "ENERGY_SPEEDS", (400, 800))
    monkeypatch.setattr(paper4, "SPEEDS", (400, 800))
    monkeypatch.setattr(paper4, "DRAWN_SPEEDS", (400, 800))
    monkeypatch.setattr(paper4, "ZONES", (0, 200))
    words = ["paper", "4", "--seeds", str(SEEDS), "--programs", str(PROGRAMS), "--out", str(tmp_path)]
    assert cli.main([*words, "--json", str(tmp_path / "t.json")]) == 0
    assert "not kept: 0" in capsys.readouterr().out
    assert (tmp_path / "paper4.png").stat().st_size > 20000
    told = json.loads((tmp_path / "t.json").read_text())
    assert len(told["computation"]) == 20
    for r in told["computation"]:
        fails = r["scene"] == "more" and r["form"] == "paper" and r["planner"] in ("RRT", "RRT*")
        assert r["found"] == (0 if fails else SEEDS), r
    beeline = paper4.GOAL[0] - paper4.START[0]
    for how, paths in (("as_found", SEEDS), ("by_name", 1)):
        for planner, rows in told[how].items():
            at = {(r["speed"], r["zone"]): r for r in rows}
            assert all(r["paths"] == paths and r["length"] > beeline for r in rows), (how, planner)
            assert all(r["time"] > r["length"] / (1e-3 * r["speed"]) for r in rows), (how, planner)
            assert at[800, 200]["time"] < at[400, 200]["time"], (how, planner)
            assert at[800, 200]["energy"] < at[800, 0]["energy"] and at[800, 200]["stops"] < at[800, 0]["stops"]


def test_a_missing_program_is_told(tmp_path, capsys):
    assert cli.main(["paper", "4", "--programs", str(tmp_path)]) == 2
    assert "not found" in capsys.readouterr().err
