"""aisle paper 2: a local swarm among mobile obstacles (Islam, Tajmiruzzaman, Muftee, Hossain 2013), beside ours."""

from __future__ import annotations

import argparse
import dataclasses
import json
import math
from dataclasses import dataclass
from pathlib import Path

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

from aisle_tools import hall  # noqa: E402
from aisle_tools.errors import UserError  # noqa: E402
from aisle_tools.paper1 import call, median, program, save  # noqa: E402
from aisle_tools.plot import draw_world  # noqa: E402
from aisle_tools.scenario import Scenario, read_scenario  # noqa: E402

RESOLUTION = 0.1  # m, of the planning grid
TARGETS = [(19.0, 19.0), (7.0, 18.0)]
TOUCH = 1e-9  # m
WITHIN = 1.03  # of the exact optimum, rows without moving obstacles


@dataclass
class Row:
    scenario: str
    moving: int  # of its obstacles, the last ones
    swarm: int
    targets: int
    length: float  # m, the paper's
    seconds: float


ROWS = [
    Row("field_4", 0, 30, 1, 26.24, 2.57),
    Row("field_8", 0, 35, 1, 28.64, 4.71),
    Row("field_12", 0, 40, 1, 27.69, 4.82),
    Row("field_12", 4, 50, 1, 30.56, 6.45),
    Row("field_12", 12, 50, 1, 32.35, 6.70),
    Row("field_12", 12, 50, 2, 43.26, 6.9),
]
MODES = {  # lattice (m), the paper's F, best order
    "paper's F, whole m": (1, 1, 0),
    "ours, whole m": (1, 0, 0),
    "ours": (0, 0, 0),
    "ours, best order": (0, 0, 1),
}


@dataclass
class Field:
    """A row's scenario, its obstacles parted."""

    row: Row
    scenario: Scenario  # with the static ones alone
    blocks: np.ndarray  # [n, 4] moving ones at first: x0, y0, x1, y1

    def text(self) -> str:
        targets = TARGETS[: self.row.targets]
        lines = [hall.text(self.scenario, 0.0), " ".join(str(v) for v in (len(targets), *np.ravel(targets)))]
        return "\n".join([*lines, " ".join(f"{v:.17g}" for v in (len(self.blocks), *self.blocks.ravel()))])


def field_of(folder: Path, row: Row) -> Field:
    scenario = read_scenario(folder / f"{row.scenario}.json", 0.0, RESOLUTION)
    polygons = scenario.world.polygons
    still = len(polygons) - row.moving
    boxes = [[*p.vertices.min(axis=0), *p.vertices.max(axis=0)] for p in polygons[still:]]
    world = dataclasses.replace(scenario.world, polygons=polygons[:still])
    return Field(row, dataclasses.replace(scenario, world=world), np.array(boxes, dtype=float).reshape(-1, 4))


def optimum_of(folder: Path, row: Row) -> float:
    """Exact, where nothing moves."""
    stored = json.loads((folder / "optimum.json").read_text(encoding="utf-8"))
    return float(stored[row.scenario]["upper"]) if row.moving == 0 else math.nan


def episodes(args: argparse.Namespace, field: Field, mode: str) -> list[dict]:
    lattice, beeline, order = MODES[mode]
    words = [program(args, "paper-local"), 1, args.seeds, field.row.swarm, lattice, beeline, order]
    return [json.loads(line) for line in call(words, field.text()).splitlines()]


# ---- the judge: shares nothing with src/


def apart(a: np.ndarray, b: np.ndarray, box: np.ndarray, by: np.ndarray) -> np.ndarray:
    """Are the segments a b off the boxes wherever these are on their ways `by`? Separating axes; [n] each."""
    corners = np.stack([box[:, [0, 1]], box[:, [2, 1]], box[:, [2, 3]], box[:, [0, 3]]], axis=1)
    hull = np.concatenate([corners, corners + by[:, None, :]], axis=1)
    line = np.stack([a, b], axis=1)
    across = [np.stack([-d[:, 1], d[:, 0]], axis=1) for d in (b - a, by)]
    axes = [np.broadcast_to(axis, a.shape) for axis in ((1.0, 0.0), (0.0, 1.0))] + across
    out = np.zeros(len(a), dtype=bool)
    for axis in axes:
        first, second = (np.einsum("nki,ni->nk", points, axis) for points in (line, hull))
        size = np.hypot(*axis.T)
        gap = np.maximum(first.min(axis=1) - second.max(axis=1), second.min(axis=1) - first.max(axis=1))
        out |= (gap > -TOUCH * size) & (size > 0.0)
    return out


def touches(field: Field, episode: dict) -> int:
    """Lines driven that meet a static obstacle, or a block anywhere on its jump of that iteration."""
    lines = np.array(episode["lines"], dtype=float).reshape(-1, 5)
    still = [[*p.vertices.min(axis=0), *p.vertices.max(axis=0)] for p in field.scenario.world.polygons]
    met = 0
    for box in np.array(still, dtype=float).reshape(-1, 4):
        all_of = np.broadcast_to(box, (len(lines), 4))
        met += int((~apart(lines[:, 1:3], lines[:, 3:5], all_of, np.zeros((len(lines), 2)))).sum())
    at = np.array(episode["blocks"], dtype=float).reshape(len(episode["blocks"]), len(field.blocks), 2)
    when = lines[:, 0].astype(int)
    for k, first in enumerate(field.blocks):
        lo, then = at[when, k], at[when + 1, k]
        box = np.concatenate([lo, lo + (first[2:] - first[:2])], axis=1)
        met += int((~apart(lines[:, 1:3], lines[:, 3:5], box, then - lo)).sum())
    return met


def driven(episode: dict) -> float:
    lines = np.array(episode["lines"], dtype=float).reshape(-1, 5)
    return float(np.hypot(*(lines[:, 3:5] - lines[:, 1:3]).T).sum())


def arrives(field: Field, episode: dict) -> bool:
    """From the start without a break to each target."""
    lines = np.array(episode["lines"], dtype=float).reshape(-1, 5)
    if len(lines) == 0 or np.abs(lines[0, 1:3] - field.scenario.start[:2]).max() > 1e-6:
        return False
    joined = np.abs(lines[1:, 1:3] - lines[:-1, 3:5]).max(initial=0.0) < 1e-6
    ends = [np.abs(lines[:, 3:5] - t).max(axis=1).min() < 1e-6 for t in TARGETS[: field.row.targets]]
    return bool(joined and all(ends))


def judge(field: Field, found: list[dict]) -> dict:
    lengths = [driven(e) for e in found if arrives(field, e)]
    ms = [e["ms"] for e in found]
    return {
        "episodes": len(found),
        "arrived": len(lengths),
        "touched": sum(touches(field, e) > 0 for e in found),
        "length": median(lengths),
        "longest": max(lengths, default=math.nan),
        "iterations": median([e["iterations"] for e in found]),
        "waits": median([e["waits"] for e in found]),
        "ms": median(ms),
        "ms_p99": float(np.percentile(ms, 99)),
    }


# ---- report


def print_head() -> None:
    print("row: obstacles/static/moving/swarm/targets; lengths: m, medians; ms: an episode's planning, processor time")
    print(
        f"{'row':<16} {'paper':>7} {'s':>5} {'optimum':>8}  {'method':<18} "
        f"{'arrived':>11} {'touched':>7} {'length':>7} {'longest':>8} "
        f"{'iterations':>10} {'waits':>5} {'ms':>7} {'p99':>7}"
    )


def name_of(field: Field) -> str:
    row, still = field.row, len(field.scenario.world.polygons)
    return f"{still + row.moving}/{still}/{row.moving}/{row.swarm}/{row.targets}"


def print_row(field: Field, mode: str, r: dict, optimum: float) -> None:
    row = field.row
    exact = f"{optimum:.3f}" if math.isfinite(optimum) else "-"
    print(
        f"{name_of(field):<16} {row.length:>7.2f} {row.seconds:>5.2f} {exact:>8}  {mode:<18} "
        f"{r['arrived']:>5}/{r['episodes']:<5} {r['touched']:>7} {r['length']:>7.3f} {r['longest']:>8.3f} "
        f"{r['iterations']:>10.0f} {r['waits']:>5.0f} {r['ms']:>7.2f} {r['ms_p99']:>7.2f}"
    )


def shortfalls(field: Field, mode: str, r: dict, optimum: float) -> list[str]:
    """What the row promises and does not keep."""
    what = f"{name_of(field)}, {mode}"
    out = [f"{what}: {r['touched']} episodes touch an obstacle while moving"] if r["touched"] else []
    if not mode.startswith("ours"):
        return out
    if r["arrived"] < r["episodes"]:
        out.append(f"{what}: {r['episodes'] - r['arrived']} episodes do not arrive")
    most = WITHIN * optimum if math.isfinite(optimum) else field.row.length
    if not r["length"] <= most:
        out.append(f"{what}: median length {r['length']:.3f} above {most:.3f}")
    return out


# ---- pictures


def draw(fields: list[Field], shown: list[tuple[dict, dict]], path: Path) -> None:
    figure, axes = plt.subplots(2, 3, figsize=(14.0, 9.6), layout="constrained")
    for axis, field, (paper, ours) in zip(axes.ravel(), fields, shown):
        draw_field(axis, field, paper, ours)
    axes[0, 0].legend(loc="lower right", fontsize=8)
    save(figure, path)


def draw_field(axis: plt.Axes, field: Field, paper: dict, ours: dict) -> None:
    draw_world(axis, field.scenario.world)
    draw_blocks(axis, field, ours)
    for episode, colour, label in ((paper, "#d9a441", "the paper's F, whole metres"), (ours, "#1f4e9c", "ours")):
        lines = np.array(episode["lines"], dtype=float).reshape(-1, 5)
        if len(lines):
            way = np.vstack([lines[:1, 1:3], lines[:, 3:5]])
            axis.plot(*way.T, "-o", color=colour, lw=1.8, ms=3, label=label, zorder=5)
    axis.plot(*field.scenario.start[:2], "o", ms=8, mfc="#2ca02c", mec="white", zorder=6)
    for target in TARGETS[: field.row.targets]:
        axis.plot(*target, "*", ms=13, mfc="#ff7f0e", mec="white", zorder=6)
    title = f"{name_of(field)}: the paper {field.row.length:g} m, here {driven(paper):.2f} and {driven(ours):.2f} m"
    axis.set(xlim=(-0.2, 20.2), ylim=(-0.2, 20.2), aspect="equal", xlabel="x (m)", ylabel="y (m)")
    axis.set_title(title, fontsize=10)


def draw_blocks(axis: plt.Axes, field: Field, episode: dict) -> None:
    """Where they were at first, and faint at each iteration in which the vehicle of `ours` drove."""
    at = np.array(episode["blocks"], dtype=float).reshape(len(episode["blocks"]), len(field.blocks), 2)
    when = sorted({int(line[0]) for line in episode["lines"]})
    for k, box in enumerate(field.blocks):
        size = box[2:] - box[:2]
        axis.add_patch(plt.Rectangle(box[:2], *size, fc="none", ec="#d62728", lw=1.2, zorder=4))
        for i in when:
            axis.add_patch(plt.Rectangle(at[i, k], *size, fc="#d62728", ec="none", alpha=0.06, zorder=3))


def run(args: argparse.Namespace) -> int:
    if args.seeds < 1:
        raise UserError("--seeds must be at least 1")
    fields = [field_of(args.scenarios, row) for row in ROWS]
    out, faults, shown = {}, [], []
    print_head()
    for field in fields:
        optimum = optimum_of(args.scenarios, field.row)
        first = {}
        for mode in [m for m in MODES if field.row.targets > 1 or not m.endswith("order")]:
            found = episodes(args, field, mode)
            first[mode] = found[0]
            out[f"{name_of(field)}, {mode}"] = judged = judge(field, found)
            print_row(field, mode, judged, optimum)
            faults += shortfalls(field, mode, judged, optimum)
        shown.append((first["paper's F, whole m"], first["ours"]))
    print(f"\nnot kept: {len(faults)}")
    for fault in faults:
        print(f"  {fault}")
    if args.json is not None:
        args.json.write_text(json.dumps(out, indent=1))
    if args.out is not None:
        draw(fields, shown, args.out / "paper2.png")
    return 1 if faults else 0
