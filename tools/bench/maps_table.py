#!/usr/bin/env python3
"""Every goal pair of every ROS map of a folder: solved, length against the geodesic given with the map, ms, work units.

build/venv/bin/python tools/bench/maps_table.py [folder] [--margin M] [--objective shortest] [--replay PROGRAM]
"""

from __future__ import annotations

import argparse
import json
import sys

import offline
from aisle_tools import query, rosmap, vehicle


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    offline.add_options(parser, offline.ROOT / "tests" / "data" / "ros_maps")
    parser.add_argument("--radius", type=float, default=0.3, help="of the disc, m")
    parser.add_argument("--margin", type=float, default=-1.0, help="m; negative = none (default)")
    parser.add_argument("--by-letter", action="store_true", help="without --strict-free: grey 205 as the YAML says")
    args = parser.parse_args()
    msg = vehicle.make({"radius": args.radius, "margin": args.margin})
    print(f"disc of {args.radius:g} m, margin {max(args.margin, 0.0):g} m, {args.objective}, {args.interpolation}")
    print(
        f"{'map':<24} {'cells':>9} {'solved':>6} {'length / geodesic':>21} {'length / bound':>14} {'clearance':>9} "
        f"{'ms median':>9} {'max':>8} {'units median':>12} {'max':>8}  faults"
    )
    rows, good = [], True
    for path in sorted(args.folder.glob("*.yaml")):
        if args.only and path.stem not in args.only:
            continue
        world = rosmap.read_world(path, not args.by_letter, rosmap.CELLS_MAX)
        legs = query.read_goals(path.with_suffix(".goals.csv"))
        answers = offline.answers(args, world, msg, legs)
        rows.append(print_row(path.stem, world, legs, answers))
        good = good and all(a.is_path and not a.faults for a in answers)
    if args.json is not None:
        args.json.write_text(json.dumps(rows, indent=1))
    return 0 if good else 1


def print_row(name: str, world: object, legs: list, answers: list[offline.Answer]) -> dict:
    solved = [(leg, a) for leg, a in zip(legs, answers) if a.is_path]
    ratios = sorted(a.reply.length / leg.given_length for leg, a in solved)
    bounds = [a.reply.length / a.reply.length_bound for _, a in solved if a.reply.length_bound > 0.0]
    ms, units = [a.ms for a in answers], [a.reply.work_units for a in answers]
    row = {
        "map": name,
        "cells": int(world.grid.occupied.size),  # type: ignore[attr-defined]
        "pairs": len(legs),
        "solved": len(solved),
        "ratios": ratios,
        "bound_ratio_median": offline.median(bounds),
        "clearance_min": min((a.report.clearance for _, a in solved if a.report is not None), default=float("nan")),
        "ms": ms,
        "work_units": units,
        "faults": [f"{leg.name}: {offline.why(a)}" for leg, a in zip(legs, answers) if offline.why(a)],
    }
    three = f"{ratios[0]:.3f} {offline.median(ratios):.3f} {ratios[-1]:.3f}" if ratios else "-"
    print(
        f"{name:<24} {row['cells']:>9} {len(solved)}/{len(legs):<4} {three:>21} {row['bound_ratio_median']:>14.3f} "
        f"{row['clearance_min']:>9.3f} {offline.median(ms):>9.1f} {max(ms):>8.1f} {offline.median(units):>12.0f} "
        f"{max(units):>8}  {' | '.join(row['faults'])}",
        flush=True,
    )
    return row


if __name__ == "__main__":
    sys.exit(main())
