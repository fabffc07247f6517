#!/usr/bin/env python3
"""Lengths and their lower bounds against the exact optimum, leg by leg, over a folder of ROS maps or scenarios.

build/venv/bin/python tools/bench/optimum_table.py maps|scenarios [folder] [--objective shortest] [--replay PROGRAM]

The optima are those of the folder's optimum.json (tools/bench/exact.py makes it); a scenario's point robot is planned as
a disc of 1 mm, so its optimum is worked out here for that. Exit 1 if a leg is not solved, is shorter than its optimum,
has a lower bound above it, or is refused where a way exists or the other way round.
"""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import dataclass
from pathlib import Path

import exact
import offline
import scenarios_table
from aisle_tools import query, rosmap, vehicle
from aisle_tools.scenario import read_scenario

MAPS_RATIO, SCENARIOS_RATIO, SCENARIOS_WORST, BOUND = 1.005, 1.001, 1.01, 0.98  # targets; medians but for WORST
SLACK = 2e-6  # of a length: the wire carries it as float


@dataclass
class Row:
    name: str
    optima: list[dict]  # legs of optimum.json
    answers: list[offline.Answer]

    @property
    def solved(self) -> list[tuple[offline.Answer, dict]]:
        return [(a, leg) for a, leg in zip(self.answers, self.optima) if a.is_path and leg["lower"] is not None]

    @property
    def ratios(self) -> list[float]:
        return [a.reply.length / leg["lower"] for a, leg in self.solved]

    @property
    def bounds(self) -> list[float]:
        return [a.reply.length_bound / leg["upper"] for a, leg in self.solved]

    @property
    def right_refusals(self) -> int:
        return sum(leg["lower"] is None and not a.is_path for a, leg in zip(self.answers, self.optima))

    @property
    def faults(self) -> list[str]:
        out = []
        for i, (a, leg) in enumerate(zip(self.answers, self.optima)):
            if a.is_path == (leg["lower"] is None):
                out.append(f"{i + 1}: {'a path where none is' if a.is_path else offline.why(a)}")
            elif a.faults:
                out.append(f"{i + 1}: {offline.why(a)}")
        out += [f"shorter than the optimum: {r:.7f}" for r in self.ratios if r < 1.0 - SLACK]
        return out + [f"bound above the optimum: {b:.7f}" for b in self.bounds if b > 1.0 + SLACK]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("kind", choices=("maps", "scenarios"))
    offline.add_options(parser, offline.ROOT / "tests" / "data" / "ros_maps")
    parser.add_argument("--radius", type=float, default=0.3, help="of the disc on maps, m; as in optimum.json")
    parser.add_argument("--program", type=Path, default=exact.PROGRAM, help="optimum")
    parser.set_defaults(objective="shortest", folder=None)
    args = parser.parse_args()
    args.margin = -1.0  # none, as the optima
    maps = args.kind == "maps"
    args.folder = args.folder or offline.ROOT / "tests" / "data" / ("ros_maps" if maps else "scenarios")
    print(f"{args.kind}, margin none, {args.objective}, {args.interpolation}")
    print(
        f"{'name':<24} {'solved':>6} {'length/optimum: median':>22} {'worst':>7} {'bound/optimum: median':>21} "
        f"{'least':>6} {'most':>6} {'ms':>8}  faults"
    )
    rows = []
    for name, optimum in sorted(json.loads((args.folder / "optimum.json").read_text()).items()):
        if args.only and name not in args.only:
            continue
        row = (map_row if maps else scenario_row)(args, name, optimum)
        if row is not None:
            rows.append(row)
            print_row(row)
    targets = (MAPS_RATIO, None) if maps else (SCENARIOS_RATIO, SCENARIOS_WORST)
    summary(rows, *targets)
    if args.json is not None:
        args.json.write_text(json.dumps([as_data(r) for r in rows], indent=1) + "\n")
    return 1 if any(r.faults for r in rows) else 0


def map_row(args: argparse.Namespace, name: str, optimum: dict) -> Row:
    if optimum["radius"] != args.radius:
        sys.exit(f"{name}: the optima are for a disc of {optimum['radius']:g} m")
    world = rosmap.read_world(args.folder / f"{name}.yaml", True, rosmap.CELLS_MAX)
    legs = query.read_goals(args.folder / f"{name}.goals.csv")
    msg = vehicle.make({"radius": args.radius, "margin": args.margin})
    return Row(name, optimum["legs"], offline.answers(args, world, msg, legs))


def scenario_row(args: argparse.Namespace, name: str, optimum: dict) -> Row | None:
    """None for a footprint: its optimum is not known."""
    scenario = read_scenario(args.folder / f"{name}.json", args.margin)
    if scenario.footprint:
        return None
    if optimum["radius"] == 0.0:
        data = json.loads((args.folder / f"{name}.json").read_text())
        optimum = exact.scenario_optimum(args.program, data, scenario.radius)
    return Row(name, optimum["legs"], scenarios_table.scenario_answers(args, scenario))


def print_row(row: Row) -> None:
    ratios, bounds = row.ratios or [float("nan")], row.bounds or [float("nan")]
    print(
        f"{row.name:<24} {len(row.solved) + row.right_refusals:>3}/{len(row.optima):<2} {offline.median(ratios):>22.5f} "
        f"{max(ratios):>7.4f} {offline.median(bounds):>21.4f} {min(bounds):>6.4f} {max(bounds):>6.4f} "
        f"{offline.median([a.ms for a in row.answers]):>8.1f}  {' | '.join(row.faults)}",
        flush=True,
    )


def summary(rows: list[Row], median: float, worst: float | None) -> None:
    ratios, bounds = [x for r in rows for x in r.ratios], [x for r in rows for x in r.bounds]
    if not ratios:
        return
    limit = f", worst {max(ratios):.5f}" + (f" (target {worst})" if worst is not None else "")
    print(f"{len(ratios)} legs: length/optimum median {offline.median(ratios):.5f} (target {median}){limit}")
    print(
        f"bound/optimum median {offline.median(bounds):.5f} (target {BOUND}), most {max(bounds):.7f} (never above 1); "
        f"{sum(r > 1.001 for r in ratios)} legs above 1.001, {sum(r > 1.01 for r in ratios)} above 1.01"
    )


def as_data(row: Row) -> dict:
    return {
        "name": row.name,
        "legs": len(row.optima),
        "solved": len(row.solved),
        "ratios": row.ratios,
        "bound_ratios": row.bounds,
        "ms": [a.ms for a in row.answers],
        "work_units": [a.reply.work_units for a in row.answers],
        "faults": row.faults,
    }


if __name__ == "__main__":
    sys.exit(main())
