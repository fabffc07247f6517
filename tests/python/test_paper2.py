"""aisle paper 2: its judge by hand, and a few seeds of every row where the host program is built."""

import os
from pathlib import Path

import numpy as np
import pytest
from aisle_tools import cli, paper2

ROOT = Path(__file__).resolve().parent.parent.parent
SCENARIOS = ROOT / "tests" / "data" / "scenarios"
PROGRAMS = Path(os.environ.get("AISLE_PAPERS", ROOT / "build" / "release"))


def apart(line, box, by=(0.0, 0.0)):
    a, b = np.array([line[:2]], dtype=float), np.array([line[2:]], dtype=float)
    return bool(paper2.apart(a, b, np.array([box], dtype=float), np.array([by], dtype=float))[0])


def test_a_line_is_off_a_box_or_through_it():
    box = (2.0, 2.0, 4.0, 3.0)
    assert apart((0.0, 0.0, 1.0, 5.0), box)
    assert not apart((0.0, 2.5, 6.0, 2.5), box)
    assert not apart((3.0, 2.5, 3.1, 2.6), box)  # inside
    assert apart((0.0, 2.0, 2.0, 4.5), box)  # past a corner, aslant
    assert apart((0.0, 3.0, 6.0, 3.0), box)  # touches a side


def test_a_box_is_met_anywhere_on_its_jump():
    box = (2.0, 2.0, 3.0, 3.0)
    assert apart((4.0, 0.0, 4.0, 6.0), box)
    assert not apart((3.5, 0.0, 3.5, 6.0), box, (1.0, 0.0))
    assert apart((1.9, 3.2, 2.3, 4.0), box, (1.0, 1.0))  # the corner the jump leaves behind
    assert not apart((2.5, 3.4, 2.9, 3.2), box, (1.0, 1.0))


def test_a_box_that_stands_meets_a_point():
    assert not apart((2.5, 2.5, 2.5, 2.5), (2.0, 2.0, 3.0, 3.0))
    assert apart((3.5, 2.5, 3.5, 2.5), (2.0, 2.0, 3.0, 3.0))


def field(k):
    return paper2.field_of(SCENARIOS, paper2.ROWS[k])


def test_rows_part_the_obstacles_as_the_paper_counts_them():
    assert [paper2.name_of(field(k)) for k in range(6)] == [
        "4/4/0/30/1", "8/8/0/35/1", "12/12/0/40/1", "12/8/4/50/1", "12/0/12/50/1", "12/0/12/50/2",
    ]


def episode(lines, blocks):
    return {"lines": lines, "blocks": blocks, "ms": 1.0, "iterations": 1, "waits": 0}


def test_touches_and_arrivals_are_judged_by_the_lines_driven():
    f = field(3)
    at = [v for b in f.blocks for v in b[:2]]
    x, y = f.blocks[0, :2] + 0.1
    through = episode([[0, 1.0, 1.0, x, y], [0, x, y, 19.0, 19.0]], [at, at])
    assert paper2.touches(f, through) >= 2
    assert paper2.arrives(f, through)
    assert not paper2.arrives(f, episode([[0, 1.0, 1.0, 5.0, 5.0], [0, 6.0, 5.0, 19.0, 19.0]], [at, at]))  # a break
    assert not paper2.arrives(f, episode([[0, 1.0, 1.0, 18.0, 19.0]], [at, at]))
    assert not paper2.arrives(f, episode([], [at]))
    edge = episode([[0, 0.0, 0.0, 0.0, 20.0]], [at, at])
    assert paper2.touches(f, edge) == 0
    assert paper2.driven(edge) == pytest.approx(20.0)


def test_shortfalls_are_told():
    good = {"episodes": 5, "arrived": 5, "touched": 0, "length": 26.0}
    assert paper2.shortfalls(field(0), "ours", good, 25.845) == []
    assert len(paper2.shortfalls(field(0), "ours", {**good, "length": 27.0}, 25.845)) == 1
    assert len(paper2.shortfalls(field(4), "ours", {**good, "length": 32.4}, float("nan"))) == 1
    assert len(paper2.shortfalls(field(4), "ours", {**good, "arrived": 4, "touched": 1}, float("nan"))) == 2
    assert len(paper2.shortfalls(field(0), "paper's F, whole m", {**good, "arrived": 1}, 25.845)) == 0


@pytest.mark.skipif(not (PROGRAMS / "paper-local").is_file(), reason="paper-local is not built")
def test_five_seeds_of_every_row_keep_what_is_promised(tmp_path, capsys):
    words = ["paper", "2", "--seeds", "5", "--programs", str(PROGRAMS), "--out", str(tmp_path)]
    assert cli.main([*words, "--json", str(tmp_path / "t.json")]) == 0
    out = capsys.readouterr().out
    assert "not kept: 0" in out
    assert out.count(" 5/5 ") == 19
    assert (tmp_path / "paper2.png").stat().st_size > 20000


def test_a_missing_program_is_told(tmp_path, capsys):
    assert cli.main(["paper", "2", "--programs", str(tmp_path)]) == 2
    assert "not found" in capsys.readouterr().err
