"""aisle paper 5: its judge by hand, and one seed of everything where the host programs are built."""

import os
from pathlib import Path

import numpy as np
import pytest
from aisle_tools import cli, paper5

ROOT = Path(__file__).resolve().parent.parent.parent
DATA = ROOT / "tests" / "data"
PROGRAMS = Path(os.environ.get("AISLE_PAPERS", ROOT / "build" / "release"))


def barrier(layers):
    return paper5.barrier_of(DATA, layers)


@pytest.mark.parametrize("layers", [1, 2, 3, 4])
def test_barriers_have_as_many_walls_with_an_opening(layers):
    b = barrier(layers)
    assert len(b.walls) == 2 * layers and b.optimum > 17.0
    assert b.scenario.start[:2] == (0.0, 1.0) and b.scenario.goals[0][:2] == (15.0, 9.0)


def test_pieces_cross_where_the_disc_meets_a_wall():
    b = barrier(1)  # its wall from 7.35 to 7.65, open from 11.2 to 12.4
    assert paper5.crossing(b, np.array([[0.0, 1.0], [7.2, 5.0], [7.8, 5.0], [15.0, 9.0]])) == 3
    free = np.array([[0.0, 1.0], [6.0, 11.8], [9.0, 11.8], [15.0, 9.0]])
    assert paper5.crossing(b, free) == 0
    assert paper5.crossing(b, free + [0.0, 0.2]) == 0 and paper5.crossing(b, free + [0.0, 0.4]) == 1
    assert paper5.length_of(free) == pytest.approx(np.hypot(6.0, 10.8) + 3.0 + np.hypot(6.0, 2.8))


def run(points, crossing):
    return [{"points": points, "crossing": crossing, "seconds": 0.5 * (k + 1)} for k in range(3)]


def test_plain_runs_are_counted_by_the_independent_judge():
    free, through = [[0, 1], [6, 11.8], [9, 11.8], [15, 9]], [[0, 1], [15, 9]]
    rows = paper5.plain_rows(barrier(1), [run(free, 0), run(through, 1), run(through, 0)])
    assert rows[500]["solved"] == 1 and rows[500]["runs"] == 3
    assert rows[500]["misjudged"] == 1 and rows[5000]["ms"] == 1000.0


def test_shortfalls_are_told():
    b = barrier(2)
    good = {"runs": 5, "solved": 5, "longest": b.optimum, "faults": []}
    assert paper5.shortfalls(b, {500: {"misjudged": 0}}, good) == []
    assert len(paper5.shortfalls(b, {500: {"misjudged": 1}}, {**good, "solved": 4, "longest": 1.02 * b.optimum})) == 3
    assert len(paper5.shortfalls(b, {}, {**good, "faults": ["contact"]})) == 1


@pytest.mark.skipif(not (PROGRAMS / "paper-ga").is_file(), reason="paper-ga is not built")
def test_one_seed_of_everything_keeps_what_is_promised(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(paper5, "GENERATIONS", (20, 100, 200))
    monkeypatch.setattr(paper5, "COLOURS", {20: "r", 100: "g", 200: "b"})
    words = ["paper", "5", "--seeds", "1", "--programs", str(PROGRAMS), "--out", str(tmp_path)]
    assert cli.main([*words, "--json", str(tmp_path / "t.json")]) == 0
    out = capsys.readouterr().out
    assert "not kept: 0" in out and out.count("ours") == 4
    assert (tmp_path / "paper5.png").stat().st_size > 20000


def test_a_missing_program_is_told(tmp_path, capsys):
    assert cli.main(["paper", "5", "--programs", str(tmp_path)]) == 2
    assert "not found" in capsys.readouterr().err
