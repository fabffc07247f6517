"""aisle paper 5: through multi-layer barriers by a genetic algorithm (Chiu 2010), beside ours."""

from __future__ import annotations

import argparse
import json
import math
import os
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import matplotlib
import numpy as np
import shapely
from aisle import options_t, path_t

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

from aisle_tools import geometry, hall, layouts, names, query, vehicle  # noqa: E402
from aisle_tools.bus import LogWriter, Recording  # noqa: E402
from aisle_tools.check import Obstacles, check_path  # noqa: E402
from aisle_tools.errors import UserError  # noqa: E402
from aisle_tools.paper1 import call, median, program, save  # noqa: E402
from aisle_tools.plot import draw_world  # noqa: E402
from aisle_tools.scenario import Scenario, read_scenario  # noqa: E402

GENERATIONS = (500, 5000, 10000)
PLAIN_SEEDS = 10  # of the paper's form, at most: a run of 10000 generations takes seconds
WITHIN = 1.01  # of the exact optimum
TOUCH = 1e-6  # m
PAPER = {  # layers: generations -> OBJ (m), None: crosses; minutes
    1: {5000: 31.1},
    2: {500: 34.5},
    3: {500: None, 5000: 67.3},
    4: {500: None, 5000: None, 10000: 55.1},
}
PAPER_MINUTES = {500: "1.2 to 1.3", 5000: "12 to 13", 10000: "25"}
FOLDERS = {1: "scenarios", 2: "scenarios", 3: "scenarios", 4: "barriers"}
COLOURS = {500: "#d9a441", 5000: "#d62728", 10000: "#9467bd"}


@dataclass
class Barrier:
    layers: int
    scenario: Scenario
    optimum: float  # m

    @property
    def walls(self) -> list[shapely.Polygon]:
        return [shapely.Polygon(p.vertices) for p in self.scenario.world.obstacles()]


def barrier_of(data: Path, layers: int) -> Barrier:
    folder, name = data / FOLDERS[layers], f"barrier_{layers}"
    optima = json.loads((folder / "optimum.json").read_text(encoding="utf-8"))
    return Barrier(layers, read_scenario(folder / f"{name}.json", 0.0), float(optima[name]["upper"]))


# ---- the judge of plain ways: shares nothing with src/


def crossing(barrier: Barrier, points: np.ndarray) -> int:
    """Pieces on which the disc meets a wall."""
    pieces = [shapely.LineString(p) for p in zip(points[:-1], points[1:])]
    reach = barrier.scenario.radius - TOUCH
    return sum(any(wall.distance(piece) < reach for wall in barrier.walls) for piece in pieces)


def length_of(points: np.ndarray) -> float:
    return float(np.hypot(*np.diff(points, axis=0).T).sum())


def plain_rows(barrier: Barrier, runs: list[list[dict]]) -> dict[int, dict]:
    """By generations: how many runs have a free way by then, and what it is."""
    rows: dict[int, dict] = {}
    for k, generations in enumerate(GENERATIONS):
        ways = [np.array(run[k]["points"]) for run in runs]
        free = [way for way in ways if crossing(barrier, way) == 0]
        told = sum(run[k]["crossing"] == 0 for run in runs)
        rows[generations] = {
            "runs": len(runs),
            "solved": len(free),
            "misjudged": abs(told - len(free)),
            "length": median([length_of(way) for way in free]),
            "least": min([length_of(way) for way in free], default=math.nan),
            "ms": 1000.0 * median([run[k]["seconds"] for run in runs]),
        }
    return rows


# ---- runs


def plain(args: argparse.Namespace, barrier: Barrier) -> list[list[dict]]:
    text, words = hall.text(barrier.scenario, 0.0), [program(args, "paper-ga")]

    def one(seed: int) -> list[dict]:
        return json.loads(call([*words, seed, 0, *GENERATIONS], text))

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(one, range(1, min(args.seeds, PLAIN_SEEDS) + 1)))


def ours(args: argparse.Namespace, barrier: Barrier) -> dict:
    """Planner GA by its own defaults, through aisle-replay; each path by the independent checker."""
    scenario, replay = barrier.scenario, program(args, "aisle-replay")
    msg = vehicle.make({"radius": scenario.radius, "margin": -1.0})
    msg.vehicle_revision = 1
    with tempfile.TemporaryDirectory() as folder:
        log, out, ms = (Path(folder) / n for n in ("in.log", "out.log", "ms.json"))
        writer = LogWriter(log, "AISLE")
        for name, part in layouts.make_messages(scenario.world, 1, 1, 0):
            writer.publish(name, part)
        writer.publish("VEHICLE", msg)
        for seed in range(1, args.seeds + 1):
            options = options_t()
            options.planner, options.objective, options.seed = options_t.GA, options_t.SHORTEST, seed
            leg = query.Leg(str(seed), scenario.start, scenario.goals)
            writer.publish("QUERY", query.make_query(leg, seed, 1, options, False))
        writer.close()
        call([replay, log, "--out", out])
        call([replay, log, "--bench", "--repeat", 1, "--json", ms])
        recording, timed = Recording(out, "AISLE"), json.loads(ms.read_text())["queries"]
    replies = {r.query_id: r for r in recording.replies}
    obstacles, body = Obstacles(scenario.world), vehicle.body(msg)
    found = [replies[i] for i in recording.queries]
    paths = [r for r in found if names.is_path(r)]
    faults = [f for r in paths for f in check_path(r, obstacles, body, recording.queries[r.query_id]).faults]
    return {
        "runs": len(found),
        "solved": len(paths),
        "length": median([r.length for r in paths]),
        "longest": max([r.length for r in paths], default=math.nan),
        "ms": median([q["ms_median"] for q in timed]),
        "faults": faults,
        "way": line_of(paths[0]) if paths else np.zeros((0, 2)),
    }


def line_of(reply: path_t) -> np.ndarray:
    return np.array([(s.x, s.y) for s in geometry.sample(reply.waypoints, 0.02)])


# ---- report


def print_head() -> None:
    print("pop 80, bit 40, pc 0.8, pm 0.9; lengths: m, medians of the runs solved; margin none; ms: processor time")
    print(f"the paper: {', '.join(f'{m} min at {g}' for g, m in PAPER_MINUTES.items())}")
    print(
        f"{'layers':>6} {'optimum':>8}  {'method':<24} {'paper':>8} {'solved':>9} {'length':>8} {'over optimum':>12} {'ms':>10}"
    )


def paper_of(layers: int, generations: int) -> str:
    told = PAPER[layers].get(generations, math.nan)
    return "crosses" if told is None else ("-" if math.isnan(told) else f"{told:.1f}")


def print_row(barrier: Barrier, method: str, paper: str, row: dict) -> None:
    over = f"{row['length'] / barrier.optimum - 1.0:.2%}" if row["solved"] else "-"
    length = f"{row['length']:.3f}" if row["solved"] else "-"
    print(
        f"{barrier.layers:>6} {barrier.optimum:>8.3f}  {method:<24} {paper:>8} {row['solved']:>4}/{row['runs']:<4} "
        f"{length:>8} {over:>12} {row['ms']:>10.2f}"
    )


def shortfalls(barrier: Barrier, plain_found: dict[int, dict], default: dict) -> list[str]:
    """What is promised and not kept."""
    what = f"{barrier.layers} layers"
    out = [f"{what}, plain, {g}: {r['misjudged']} misjudged" for g, r in plain_found.items() if r["misjudged"]]
    out += [f"{what}, ours: {fault}" for fault in default["faults"]]
    if default["solved"] < default["runs"]:
        out.append(f"{what}, ours: {default['runs'] - default['solved']} of {default['runs']} not solved")
    if not default["longest"] <= WITHIN * barrier.optimum:
        out.append(f"{what}, ours: {default['longest']:.3f} m, the optimum is {barrier.optimum:.3f} m")
    return out


# ---- pictures


def draw(shown: list[tuple[Barrier, list[dict], dict]], path: Path) -> None:
    figure, axes = plt.subplots(2, 2, figsize=(12.0, 12.4), layout="constrained")
    for axis, (barrier, run, default) in zip(axes.ravel(), shown):
        draw_barrier(axis, barrier, run, default)
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2, fontsize=9)
    save(figure, path)


def draw_barrier(axis: plt.Axes, barrier: Barrier, run: list[dict], default: dict) -> None:
    draw_world(axis, barrier.scenario.world)
    told = []
    for k, generations in enumerate(GENERATIONS):
        points = np.array(run[k]["points"])
        met = crossing(barrier, points)
        line = "--" if met else "-"
        label = f"the paper's form, {generations} generations (dashed: crosses)"
        axis.plot(*points.T, line, marker="o", color=COLOURS[generations], lw=1.4, ms=3, label=label, zorder=4)
        told.append(f"{generations}: crosses {met}" if met else f"{generations}: {length_of(points):.1f} m")
    axis.plot(*default["way"].T, color="#1f4e9c", lw=2.4, label="ours", zorder=5)
    axis.plot(*barrier.scenario.start[:2], "o", ms=8, mfc="#2ca02c", mec="white", zorder=6)
    axis.plot(*barrier.scenario.goals[0][:2], "*", ms=13, mfc="#ff7f0e", mec="white", zorder=6)
    axis.set(xlim=(-0.4, 15.4), ylim=(-0.4, 15.4), aspect="equal", xlabel="x (m)", ylabel="y (m)")
    title = f"{barrier.layers} layer{'s' if barrier.layers > 1 else ''}; {', '.join(told)}\n"
    axis.set_title(f"{title}ours {default['length']:.2f} m in {default['ms']:.1f} ms, optimum {barrier.optimum:.2f} m", fontsize=10)


def run(args: argparse.Namespace) -> int:
    if args.seeds < 1:
        raise UserError("--seeds must be at least 1")
    out, faults, shown = {}, [], []
    print_head()
    for layers in PAPER:
        barrier = barrier_of(args.scenarios.parent, layers)
        runs = plain(args, barrier)
        rows, default = plain_rows(barrier, runs), ours(args, barrier)
        for generations, row in rows.items():
            print_row(barrier, f"plain, {generations} generations", paper_of(layers, generations), row)
        print_row(barrier, "ours", "-", default)
        faults += shortfalls(barrier, rows, default)
        shown.append((barrier, runs[0], default))
        out[barrier.scenario.world.name] = {
            "optimum": barrier.optimum,
            "plain": rows,
            "ours": {k: v for k, v in default.items() if k != "way"},
        }
    print(f"\nnot kept: {len(faults)}")
    for fault in faults:
        print(f"  {fault}")
    if args.json is not None:
        args.json.write_text(json.dumps(out, indent=1))
    if args.out is not None:
        draw(shown, args.out / "paper5.png")
    return 1 if faults else 0
