#!/usr/bin/env python3
"""Cost curves: layout load and queries over the size of the map and over the number of obstacles, as table and plot.

build/venv/bin/python tools/bench/curves.py [--out curves.png] [--json FILE] [--quick] [--seed N]

size: square halls of 0.1 to 16 million cells of 5 cm, an obstacle per 10 m2. obstacles: 10 to 4096 of one size in a
hall of 100 x 60 m. Each with random solvable queries of a disc of 0.1 m, margin none. y ~ x^k is fitted in logarithms.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import random
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import load_table
import numpy as np
import offline
from aisle_tools import query, vehicle
from aisle_tools.world import Polygon, World

RESOLUTION = 0.05  # m a cell
SIZES = (0.1, 0.3, 1.0, 2.0, 4.0, 8.0, 16.0)  # million cells
COUNTS = (10, 30, 100, 300, 1000, 2000, 4096)
AREA_OF_ONE = 10.0  # m2 of hall for each obstacle, over sizes
HALL = (100.0, 60.0)  # m, over counts
OBJECTIVES = ("shortest", "safest")
RADIUS = 0.1  # m, of the robot
ROOM = 0.05  # m, of ends beyond it
QUERIES, SPARE = 30, 6  # wished; asked beyond them, for some may have no way
LINEAR = 1.2  # an exponent up to here counts as near-linear
CONFIG = "[planner]\nwork_units = 2000000000\n[limits]\ncells = 16777216\nopen_nodes = 2097152\n"
MEASURES = ("load_ms", "shortest_ms", "safest_ms", "shortest_units", "safest_units")


@dataclass
class Hall:
    world: World
    centres: np.ndarray  # [n, 2] m
    sizes: np.ndarray  # [n] m, of the circles around the obstacles


def make_hall(seed: int, sides: tuple[float, float], count: int, slot: float) -> Hall:
    """Obstacles in places of their own on a raster no finer than slot (m), which tells their size too."""
    rng = random.Random(f"{seed} {sides} {count}")
    columns, rows = raster(sides, count, slot)
    wide, high = sides[0] / columns, sides[1] / rows
    centres, sizes, polygons = [], [], []
    for ident, place in enumerate(sorted(rng.sample(range(columns * rows), count))):
        row, column = divmod(place, columns)
        size = slot * rng.uniform(0.2, 0.36)
        x = wide * (column + 0.5) + rng.uniform(-1.0, 1.0) * (0.42 * wide - size)
        y = high * (row + 0.5) + rng.uniform(-1.0, 1.0) * (0.42 * high - size)
        centres.append((x, y))
        sizes.append(size)
        polygons.append(Polygon(ident + 1, ring(rng, x, y, size)))
    world = World("hall", (0.0, 0.0, *sides), polygons, None, RESOLUTION)
    return Hall(world, np.array(centres), np.array(sizes))


def raster(sides: tuple[float, float], count: int, slot: float) -> tuple[int, int]:
    """Columns and rows of places no smaller than slot; where these are too few, as many as it takes."""
    columns, rows = max(1, int(sides[0] / slot)), max(1, int(sides[1] / slot))
    while columns * rows < count:
        columns, rows = (columns + 1, rows) if sides[0] / columns >= sides[1] / rows else (columns, rows + 1)
    return columns, rows


def ring(rng: random.Random, x: float, y: float, size: float) -> np.ndarray:
    """5 to 8 corners on a circle, counter-clockwise: convex."""
    n, turn = rng.randint(5, 8), rng.uniform(0.0, 2.0 * math.pi)
    angles = turn + (np.arange(n) + np.array([rng.uniform(-0.3, 0.3) for _ in range(n)])) * 2.0 * math.pi / n
    return np.round(np.column_stack((x + size * np.cos(angles), y + size * np.sin(angles))), 4)


def make_legs(seed: int, hall: Hall, count: int) -> list[query.Leg]:
    """The same share of the way across in every hall, unless an obstacle is there: halls are compared."""
    x0, y0, x1, y1 = hall.world.bounds
    keep = RADIUS + ROOM

    def end(which: str) -> tuple[float, float]:
        rng = random.Random(f"{which} {seed}")
        while True:
            p = (rng.uniform(x0 + keep, x1 - keep), rng.uniform(y0 + keep, y1 - keep))
            if (np.hypot(*(hall.centres - p).T) > hall.sizes + keep).all():
                return p

    return [query.Leg(str(i + 1), end(f"start {i}"), [end(f"goal {i}")]) for i in range(count)]


def exponent(xs: list[float], ys: list[float]) -> float:
    """k of y ~ x^k, least squares of the logarithms."""
    return float(np.polyfit(np.log(xs), np.log(ys), 1)[0])


def main() -> int:
    args = parse()
    halls = {"size": size_halls(args), "obstacles": count_halls(args)}
    with tempfile.TemporaryDirectory() as folder:
        config = Path(folder) / "large.ini"
        config.write_text(CONFIG)
        curves = {name: measure(args, Path(folder), name, made, config) for name, made in halls.items()}
    load = os.getloadavg()
    found = {name: fits(rows) for name, rows in curves.items()}
    area = {o: area_exponent([r for rows in curves.values() for r in rows], o) for o in OBJECTIVES}
    print_fits(curves, found, area)
    print("load average " + " ".join(f"{v:.2f}" for v in load))
    if args.json is not None:
        data = {"seed": args.seed, "load_average": load, "curves": curves, "exponents": found, "ms_per_work": area}
        args.json.write_text(json.dumps(data, indent=1) + "\n")
    if args.out is not None:
        draw(args.out, curves, found)
    return 0


def parse() -> argparse.Namespace:
    release = offline.ROOT / "build" / "release"
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--out", type=Path, metavar="FILE", help="the plot, PNG")
    parser.add_argument("--json", type=Path, metavar="FILE")
    parser.add_argument("--quick", action="store_true", help="the smaller half of each curve")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--repeat", type=int, default=3, metavar="N", help="runs of each query")
    parser.add_argument("--replay", type=Path, default=release / "aisle-replay", metavar="PROGRAM")
    parser.add_argument("--parts", type=Path, default=release / "bench-parts", metavar="PROGRAM")
    return parser.parse_args()


def size_halls(args: argparse.Namespace) -> list[tuple[float, Hall]]:
    sizes = [1e6 * m for m in (SIZES[:4] if args.quick else SIZES)]
    sides = [math.sqrt(cells) * RESOLUTION for cells in sizes]
    slot = math.sqrt(AREA_OF_ONE)
    return [(n, make_hall(args.seed, (s, s), round(s * s / AREA_OF_ONE), slot * 0.9)) for n, s in zip(sizes, sides)]


def count_halls(args: argparse.Namespace) -> list[tuple[float, Hall]]:
    slot = math.sqrt(HALL[0] * HALL[1] / max(COUNTS)) * 0.98
    return [(n, make_hall(args.seed, HALL, n, slot)) for n in (COUNTS[:4] if args.quick else COUNTS)]


def measure(args: argparse.Namespace, folder: Path, name: str, halls: list[tuple[float, Hall]], config: Path) -> list[dict]:
    logs = [load_table.write_layout(folder / f"{name}-{i}", hall.world) for i, (_, hall) in enumerate(halls)]
    loads = load_table.load_ms(args.parts, logs)
    print(f"{name:>12} {'obstacles':>9} {'load ms':>9}   objective: solved, median ms, median work units")
    rows = []
    for (x, hall), load in zip(halls, loads):
        row = {"x": x, "obstacles": len(hall.sizes), "load_ms": load}
        for objective in OBJECTIVES:
            row |= ask(args, folder, hall, objective, config)
        told = "   ".join(
            f"{o}: {len(row[f'{o}_each'])} {row[f'{o}_ms']:.2f} {row[f'{o}_units']:.0f}" for o in OBJECTIVES
        )
        print(f"{x:>12.0f} {row['obstacles']:>9} {load:>9.2f}   {told}", flush=True)
        rows.append(row)
    return rows


def ask(args: argparse.Namespace, folder: Path, hall: Hall, objective: str, config: Path) -> dict:
    log = folder / "queries.log"
    log.unlink(missing_ok=True)
    options = argparse.Namespace(objective=objective, planner="auto", interpolation="spline", seed=0, work_units=0)
    legs = make_legs(args.seed, hall, QUERIES + SPARE)
    offline.write_log(options, log, hall.world, vehicle.make({"radius": RADIUS, "margin": -1.0}), legs)
    asked = offline.timed(args.replay, log, args.repeat, config)
    solved = [q for q in asked if q["status"] == "OK"][:QUERIES]
    if not solved:
        sys.exit(f"{len(hall.sizes)} obstacles, {objective}: no query solved: {[q['cause'] for q in asked]}")
    return {
        f"{objective}_ms": offline.median([q["ms_median"] for q in solved]),
        f"{objective}_units": offline.median([float(q["work_units"]) for q in solved]),
        f"{objective}_each": [(q["work_units"], q["ms_median"]) for q in solved],
        f"{objective}_refused": sum(q["status"] != "OK" for q in asked),
    }


def fits(rows: list[dict]) -> dict:
    xs = [r["x"] for r in rows]
    return {m: exponent(xs, [r[m] for r in rows]) for m in MEASURES}


def area_exponent(rows: list[dict], objective: str) -> float:
    """Of milliseconds over work units (cells searched, pieces checked, points of the swarm), of every query."""
    pairs = [pair for r in rows for pair in r[f"{objective}_each"]]
    return exponent([units for units, _ in pairs], [ms for _, ms in pairs])


def judged(k: float) -> str:
    return "more than linear" if k > LINEAR else "near-linear" if k > 2.0 - LINEAR else "less than linear"


def print_fits(curves: dict, found: dict, area: dict) -> None:
    print(f"exponents: up to {2.0 - LINEAR:g} less than linear, up to {LINEAR:g} near-linear, else more than linear")
    print("last: between the last two points alone")
    for name, of in found.items():
        steep = fits(curves[name][-2:])
        for m, k in of.items():
            end = ", steeper at the end" if steep[m] > LINEAR >= k else ""
            print(f"{m:<15} over {name:<10} {k:>5.2f}, last {steep[m]:>5.2f}  {judged(k)}{end}")
    for objective, k in area.items():
        print(f"{objective + '_ms':<15} over {'units':<10} {k:>5.2f}  {judged(k)}")


def draw(path: Path, curves: dict, found: dict) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    titles = {"size": "cells of the map, an obstacle per 10 m²", "obstacles": "obstacles, hall of 100 x 60 m"}
    figure, axes = pyplot.subplots(2, 2, figsize=(10.0, 7.0), sharex="col", sharey="row", constrained_layout=True)
    for column, (name, rows) in enumerate(curves.items()):
        xs = [r["x"] for r in rows]
        for axis, wanted in zip(axes[:, column], (MEASURES[:3], MEASURES[3:])):
            for m in wanted:
                what, colour = m.split("_")[0], {"l": "#777777", "sh": "#1f77b4", "sa": "#d62728"}
                tint = next(c for key, c in colour.items() if what.startswith(key))
                axis.loglog(xs, [r[m] for r in rows], "o-", color=tint, label=f"{what}: k = {found[name][m]:.2f}", ms=4)
            axis.grid(True, which="major", color="#dddddd")
            axis.legend(fontsize=9, title="y ~ x^k", title_fontsize=9)
        axes[1, column].set_xlabel(titles[name])
    axes[0, 0].set_ylabel("ms: a load, a query (median)")
    axes[1, 0].set_ylabel("work units of a query (median)")
    figure.savefig(path, dpi=90)


if __name__ == "__main__":
    sys.exit(main())
