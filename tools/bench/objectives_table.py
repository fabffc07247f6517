#!/usr/bin/env python3
"""What the objectives make of the same queries: each answer by every measure, and what the swarm adds to the seeds.

build/venv/bin/python tools/bench/objectives_table.py [folder] [--check] [--only NAME] [--replay PROGRAM]

Rows: a leg and a measure (m, risk, s, J); columns: the answers to SHORTEST, SAFEST, FASTEST, LEAST_ENERGY by that
measure, the own one marked with *, and for the own objective the seeds' best (planner astar: no swarm) and the swarm's gain on
it, in per cent (of the risk, for the safest).
--check: exits 1 if an objective's answer is beaten by another's by its own measure.
"""

from __future__ import annotations

import argparse
import copy
import sys
from pathlib import Path

import offline
from aisle import path_t
from aisle_tools import query, vehicle
from aisle_tools.scenario import Scenario, read_scenario

OBJECTIVES = ("shortest", "safest", "fastest", "least_energy")
RISK_STEP = 1e-4  # as src/plan/route_ways.c: risks nearer to each other than this are alike
SAME = 1e-6  # of the value, more than rounding to float


def measure(objective: str, path: path_t) -> tuple[float, ...]:
    """Compared from left to right."""
    if objective == "safest":
        return (round(path.risk / RISK_STEP) * RISK_STEP, path.length)
    return ({"shortest": path.length, "fastest": path.duration, "least_energy": path.energy}[objective],)


def beats(a: tuple[float, ...], b: tuple[float, ...]) -> bool:
    for x, y in zip(a, b):
        if abs(x - y) > SAME * max(1.0, abs(y)):
            return x < y
    return False


def shown(objective: str, value: tuple[float, ...]) -> str:
    if objective == "safest":
        return f"{value[0]:.4f} {value[1]:8.3f}"
    return f"{value[0]:.3f}"


def answers(args: argparse.Namespace, scenario: Scenario, objective: str, planner: str) -> list[offline.Answer]:
    asked = copy.copy(args)
    asked.objective, asked.planner, asked.repeat = objective, planner, 1
    shape = {"footprint": scenario.footprint} if scenario.footprint else {"radius": scenario.radius}
    stops = [scenario.start, *scenario.goals]
    legs = [query.Leg(str(i + 1), a, [b]) for i, (a, b) in enumerate(zip(stops, stops[1:]))]
    return offline.answers(asked, scenario.world, vehicle.make({**shape, "margin": args.margin}), legs)


def table(args: argparse.Namespace, path: Path) -> tuple[int, list[str]]:
    """Prints the rows of a scenario; the number of comparisons and what is wrong."""
    scenario = read_scenario(path, args.margin)
    auto = {o: answers(args, scenario, o, "auto") for o in OBJECTIVES}
    seeds = {o: answers(args, scenario, o, "astar") for o in OBJECTIVES}
    count, wrong = 0, []
    for leg in range(len(auto["shortest"])):
        if not all(auto[o][leg].is_path for o in OBJECTIVES):
            wrong.append(f"{path.stem} leg {leg + 1}: not solved")
            continue
        for own in OBJECTIVES:
            values = {o: measure(own, auto[o][leg].reply) for o in OBJECTIVES}
            seed = measure(own, seeds[own][leg].reply) if seeds[own][leg].is_path else None
            cells = [f"{shown(own, values[o])}{'*' if o == own else ' '}" for o in OBJECTIVES]
            gain = 1.0 - values[own][0] / seed[0] if seed and seed[0] > 0.0 else 0.0 # of the risk, for the safest
            told = shown(own, seed) if seed else "-"
            print(f"{path.stem:<14} {leg + 1:>3} {own:<12} " + " ".join(f"{c:>17}" for c in cells) +
                  f" {told:>16} {100.0 * gain:>7.2f}", flush=True)
            for other in OBJECTIVES:
                count += 1
                if beats(values[other], values[own]):
                    wrong.append(f"{path.stem} leg {leg + 1}: {own} {values[own]} is beaten by {other} {values[other]}")
    return count, wrong


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    offline.add_options(parser, offline.ROOT / "tests" / "data" / "scenarios")
    parser.add_argument("--margin", type=float, default=-1.0, help="m; negative = none (default)")
    parser.add_argument("--check", action="store_true", help="exit 1 if an answer is beaten by its own measure")
    args = parser.parse_args()
    args.no_check = True
    print(f"{'scenario':<14} {'leg':>3} {'measure':<12} " + " ".join(f"{o:>17}" for o in OBJECTIVES) +
          f" {'own, no swarm':>16} {'gain %':>7}")
    count, wrong = 0, []
    for path in sorted(args.folder.glob("*.json")):
        if path.stem in ("optimum", "causes") or (args.only and path.stem not in args.only):
            continue
        some, faults = table(args, path)
        count, wrong = count + some, wrong + faults
    print(f"{count} comparisons, {len(wrong)} wrong")
    print("\n".join(wrong))
    return 1 if args.check and (wrong or count == 0) else 0


if __name__ == "__main__":
    sys.exit(main())
