"""aisle paper 3: what it counts, by answers made by hand, and a few seeds of every method where bench-arm is built."""

import json
import os
from pathlib import Path

import pytest
from aisle import arm_path_t, arm_waypoint_t, options_t, path_t
from aisle_tools import arms, cli, paper3
from aisle_tools.errors import UserError

ROOT = Path(__file__).resolve().parent.parent.parent
PROGRAMS = Path(os.environ.get("AISLE_PAPERS", ROOT / "build" / "release"))
FOLDER = ROOT / "tests" / "data" / "arms"
SEEDS = 2
is_built = pytest.mark.skipif(not (PROGRAMS / "bench-arm").is_file(), reason="bench-arm is not built")


def answer(status, travel, duration):
    path = arm_path_t()
    path.status, path.travel, path.duration = status, travel, duration
    path.waypoints, path.num_waypoints = [arm_waypoint_t()], 1
    return path


def test_escapes_are_counted_and_medians_are_of_those_that_escaped(monkeypatch):
    scenario = arms.read_scenario(FOLDER / "arm_2_post.json")
    asked = []

    def plan_all(_program, _scenario, options):  # noqa: ANN001, ANN202
        asked.extend(options)
        rows = ((path_t.OK, 3.0, 1.0), (path_t.NONE, 9.0, 9.0), (path_t.OK, 2.0, 5.0), (path_t.OK, 4.0, 2.0))
        return {i: answer(*row) for i, row in enumerate(rows, 1)}, [1.0, 20.0, 3.0, 4.0]

    monkeypatch.setattr(arms, "plan_all", plan_all)
    got = paper3.ask(Path("bench-arm"), scenario, "case", "paper: GA, death penalty", 4)
    assert (got.escaped, got.seeds, got.travel, got.duration, got.ms) == (3, 4, 3.0, 2.0, 3.5)
    assert got.example.travel == 2.0  # the shortest
    assert [o.seed for o in asked] == [0, 1, 2, 3]
    assert {(o.planner, o.objective) for o in asked} == {(options_t.GA, options_t.PAPER)}


@is_built
def test_a_few_seeds_of_everything(tmp_path, capsys):
    words = ["paper", "3", "--seeds", str(SEEDS), "--programs", str(PROGRAMS), "--out", str(tmp_path)]
    assert cli.main([*words, "--json", str(tmp_path / "t.json")]) == 0
    rows = json.loads((tmp_path / "t.json").read_text())
    assert len(rows) == len(paper3.CASES) * len(paper3.METHODS)
    assert all(r["seeds"] == SEEDS and 0 <= r["escaped"] <= SEEDS for r in rows)
    ours = [r for r in rows if r["method"] == "AUTO"]
    assert len(ours) == len(paper3.CASES) and all(r["escaped"] == SEEDS for r in ours)
    assert capsys.readouterr().out.count(f"{SEEDS}/{SEEDS}") >= len(paper3.CASES)
    assert (tmp_path / "paper3.png").stat().st_size > 20_000


@is_built
def test_the_papers_search_keeps_its_box_and_comes_to_the_least_duration():
    scenario = arms.read_scenario(FOLDER / "arm_4_complex.json")
    one = arms.arm_of(scenario.vehicle)
    base = arms.base_of(one, scenario.pose)
    got = paper3.ask(PROGRAMS / "bench-arm", scenario, "complex", "paper: GA, death penalty", SEEDS)
    assert got.escaped > 0
    least = arms.least_duration(one, base[2], got.example, 10_000)
    assert least <= got.example.duration * (1.0 + 1e-6) and got.example.duration <= 1.01 * least


def test_a_missing_program_is_told(tmp_path, capsys):
    assert cli.main(["paper", "3", "--programs", str(tmp_path)]) == 2
    assert "no such program; build it" in capsys.readouterr().err


def test_a_program_that_fails_is_told(tmp_path):
    (tmp_path / "bench-arm").write_text("#!/bin/sh\necho broken >&2\nexit 3\n")
    (tmp_path / "bench-arm").chmod(0o755)
    scenario = arms.read_scenario(FOLDER / "arm_2_post.json")
    with pytest.raises(UserError, match="exit 3: broken"):
        arms.plan_all(tmp_path / "bench-arm", scenario, [options_t()])
