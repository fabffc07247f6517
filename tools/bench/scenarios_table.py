#!/usr/bin/env python3
"""Every scenario of a folder: length against the exact optimum (optimum.json), per leg summed up; median and worst.

build/venv/bin/python tools/bench/scenarios_table.py [folder] [--objective shortest] [--replay PROGRAM]
"""

from __future__ import annotations

import argparse
import json
import sys

import offline
from aisle import path_t
from aisle_tools import query, vehicle
from aisle_tools.scenario import Scenario, read_scenario

RISK_WEIGHT = 15.0  # as in src/plan/objective.h
TARGET_MEDIAN, TARGET_WORST = 1.001, 1.01  # of disc robots, shortest, margin none


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    offline.add_options(parser, offline.ROOT / "tests" / "data" / "scenarios")
    parser.add_argument("--margin", type=float, default=-1.0, help="m; negative = none (default, as the optima are)")
    parser.set_defaults(objective="shortest")
    args = parser.parse_args()
    optima = json.loads((args.folder / "optimum.json").read_text())
    print(f"margin {max(args.margin, 0.0):g} m, {args.objective}, {args.interpolation}")
    print(
        f"{'scenario':<16} {'robot':>10} {'legs':>5} {'length':>9} {'optimum':>9} {'ratio':>7} {'worst leg':>9} "
        f"{'cost':>9} {'ms':>8} {'units':>9}  faults"
    )
    rows = []
    for name, optimum in sorted(optima.items()):
        if args.only and name not in args.only:
            continue
        scenario = read_scenario(args.folder / f"{name}.json", args.margin)
        rows.append(print_row(name, args.objective, scenario, optimum, scenario_answers(args, scenario)))
    discs = [r for r in rows if r["disc"] and r["solved"] == r["legs"]]
    ratios = [leg for r in discs for leg in r["leg_ratios"]]
    if ratios:
        print(
            f"disc robots solved: {len(discs)}, legs {len(ratios)}: ratio median {offline.median(ratios):.5f}, "
            f"worst {max(ratios):.5f} (targets {TARGET_MEDIAN}, {TARGET_WORST})"
        )
    for r in rows:
        if not r["disc"] and r["solved"] == r["legs"]:
            outer = sum(leg["upper"] for leg in optima[r["scenario"]]["legs"])
            print(f"{r['scenario']}: {r['length'] / outer:.4f} of the optimum of the footprint's outer circle")
    if args.json is not None:
        args.json.write_text(json.dumps(rows, indent=1))
    return 0 if all(r["solved"] == r["legs"] and not r["faults"] for r in rows) else 1


def scenario_answers(args: argparse.Namespace, scenario: Scenario) -> list[offline.Answer]:
    shape = {"footprint": scenario.footprint} if scenario.footprint else {"radius": scenario.radius}
    stops = [scenario.start, *scenario.goals]
    legs = [query.Leg(str(i + 1), a, [b]) for i, (a, b) in enumerate(zip(stops, stops[1:]))]
    return offline.answers(args, scenario.world, vehicle.make({**shape, "margin": args.margin}), legs)


def cost(objective: str, reply: path_t) -> float:
    """What the objective makes of the whole path: m, m weighed with the default risk weight, s, J."""
    if objective == "safest":
        return reply.length * (1.0 + RISK_WEIGHT * reply.risk)
    return {"fastest": reply.duration, "least_energy": reply.energy}.get(objective, reply.length)


def print_row(
    name: str, objective: str, scenario: Scenario, optimum: dict, answers: list[offline.Answer]
) -> dict:
    # A footprint cannot be shorter than the disc inside it: its ratio is to that bound.
    legs = optimum.get("inner", optimum)["legs"]
    solved = [(a, leg) for a, leg in zip(answers, legs) if a.is_path]
    length, best = sum(a.reply.length for a, _ in solved), sum(leg["lower"] for _, leg in solved)
    row = {
        "scenario": name,
        "disc": not scenario.footprint,
        "legs": len(legs),
        "solved": len(solved),
        "length": length,
        "optimum": best,
        "leg_ratios": [a.reply.length / leg["lower"] for a, leg in solved],
        "cost": sum(cost(objective, a.reply) for a, _ in solved),
        "ms": [a.ms for a in answers],
        "work_units": [a.reply.work_units for a in answers],
        "faults": [f"{i + 1}: {offline.why(a)}" for i, a in enumerate(answers) if offline.why(a)],
    }
    robot = f"disc {scenario.radius:g}" if not scenario.footprint else "footprint"
    ratio = f"{length / best:>7.4f} {max(row['leg_ratios']):>9.4f}" if solved else f"{'-':>7} {'-':>9}"
    print(
        f"{name:<16} {robot:>10} {len(solved)}/{len(legs):<3} {length:>9.3f} {best:>9.3f} {ratio} "
        f"{row['cost']:>9.3f} {sum(row['ms']):>8.1f} {sum(row['work_units']):>9}  {' | '.join(row['faults'])}",
        flush=True,
    )
    return row


if __name__ == "__main__":
    sys.exit(main())
