#!/usr/bin/env python3
"""A log per scenario and objective, run by aisle-replay --bench: median and p99 of at least 200 queries, with verdicts.

build/venv/bin/python tools/bench/logs.py [folder] [--out FOLDER] [--only NAME] [--json FILE] [--replay PROGRAM]
"""

from __future__ import annotations

import argparse
import json
import math
import os
import sys
import tempfile
from pathlib import Path

import offline
from aisle_tools import query, vehicle
from aisle_tools.scenario import Scenario, read_scenario

OBJECTIVES = ("shortest", "safest", "fastest", "least_energy")
QUERIES_MIN = 200  # of a scenario and objective
RUNS_MIN = 100  # of each query: below, p99 would be the slowest run
HALL_SIDE, HALL_MS = 20.0, 5.0  # SAFEST, disc robots
BIG_NAME, BIG_MS = "factory_big", 25.0
SPREAD = 2.0  # p99 / median of one query


def main() -> int:
    args = parse()
    names = sorted(json.loads((args.folder / "optimum.json").read_text()))
    print(f"margin {max(args.margin, 0.0):g} m; milliseconds: the median leg's; p99/med: the worst leg's; units: all legs'")
    print(
        f"{'scenario':<14} {'objective':<12} {'queries':>7} {'legs':>4} {'median ms':>9} {'p99 ms':>9} {'p99/med':>7} "
        f"{'units':>10}  verdict"
    )
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name in (n for n in names if not args.only or n in args.only):
            scenario = read_scenario(args.folder / f"{name}.json", args.margin)
            for objective in args.objective or OBJECTIVES:
                log = write_log(args, args.out or Path(folder), scenario, objective)
                rows.append(print_row(args, name, objective, scenario, log))
    if args.json is not None:
        args.json.write_text(json.dumps(rows, indent=1) + "\n")
    missed = [r for r in rows if r["verdict"] != "ok"]
    load = " ".join(f"{v:.2f}" for v in os.getloadavg())
    print(f"{len(rows) - len(missed)} of {len(rows)} rows within the targets; load average {load} on {os.cpu_count()} cores")
    return 1 if missed else 0


def parse() -> argparse.Namespace:
    root = offline.ROOT
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path, nargs="?", default=root / "tests" / "data" / "scenarios")
    parser.add_argument("--out", type=Path, metavar="FOLDER", help="keep the logs here")
    parser.add_argument("--only", metavar="NAME", action="append", help="only these scenarios")
    parser.add_argument("--objective", choices=OBJECTIVES, action="append", help="only these objectives")
    parser.add_argument("--replay", type=Path, default=root / "build" / "release" / "aisle-replay", metavar="PROGRAM")
    parser.add_argument("--repeat", type=int, default=0, metavar="N", help="runs of each query; 0: as many as p99 needs")
    parser.add_argument("--margin", type=float, default=-1.0, help="m; negative = none")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the rows as JSON too")
    args = parser.parse_args()
    if args.out is not None:
        args.out.mkdir(parents=True, exist_ok=True)
    return args


def write_log(args: argparse.Namespace, folder: Path, scenario: Scenario, objective: str, planner: str = "auto") -> Path:
    shape = {"footprint": scenario.footprint} if scenario.footprint else {"radius": scenario.radius}
    msg = vehicle.make({**shape, "margin": args.margin})
    path = folder / f"{scenario.world.name}-{planner}-{objective}.log"
    path.unlink(missing_ok=True)
    offline.write_log(plan_options(objective, planner), path, scenario.world, msg, legs_of(scenario))
    return path


def legs_of(scenario: Scenario) -> list[query.Leg]:
    stops = [scenario.start, *scenario.goals]
    return [query.Leg(str(i + 1), a, [b]) for i, (a, b) in enumerate(zip(stops, stops[1:]))]


def plan_options(objective: str, planner: str = "auto") -> argparse.Namespace:
    return argparse.Namespace(objective=objective, planner=planner, interpolation="spline", seed=0, work_units=0)


def runs_of(legs: int) -> int:
    """Of each query."""
    return max(RUNS_MIN, math.ceil(QUERIES_MIN / legs))


def target_ms(scenario: Scenario, objective: str) -> float | None:
    """For the median over the legs; None: none given."""
    if objective != "safest":
        return None
    if scenario.world.name == BIG_NAME:
        return BIG_MS
    x0, y0, x1, y1 = scenario.world.bounds
    side = max(x1 - x0, y1 - y0) - 2.0 * scenario.radius
    is_hall = abs(side - HALL_SIDE) < 0.5
    return HALL_MS if is_hall and not scenario.footprint else None


def summary(queries: list[dict]) -> dict:
    return {
        "legs": len(queries),
        "solved": sum(q["status"] == "OK" for q in queries),
        "ms_median": offline.median([q["ms_median"] for q in queries]),
        "ms_p99": offline.median([q["ms_p99"] for q in queries]),
        "spread": max(q["ms_p99"] / max(q["ms_median"], 1e-9) for q in queries),
        "work_units": sum(q["work_units"] for q in queries),
    }


def verdict(row: dict, target: float | None) -> str:
    missed = []
    if row["solved"] < row["legs"]:
        missed.append(f"{row['legs'] - row['solved']} unsolved")
    if target is not None and row["ms_median"] > target:
        missed.append(f"median over {target:g} ms")
    if row["spread"] > SPREAD:
        missed.append(f"p99 over {SPREAD:g} x median")
    return "; ".join(missed) or "ok"


def print_row(args: argparse.Namespace, name: str, objective: str, scenario: Scenario, log: Path) -> dict:
    repeat = args.repeat or runs_of(len(scenario.goals))
    queries = offline.timed(args.replay, log, repeat)
    target = target_ms(scenario, objective)
    row = {"scenario": name, "objective": objective, "queries": repeat * len(queries), **summary(queries)}
    row |= {"target_ms": target, "verdict": verdict(row, target), "of_each": queries}
    told = row["verdict"] if target is None else f"{row['verdict']} (target {target:g} ms)"
    print(
        f"{name:<14} {objective:<12} {row['queries']:>7} {row['legs']:>4} {row['ms_median']:>9.3f} {row['ms_p99']:>9.3f} "
        f"{row['spread']:>7.2f} {row['work_units']:>10}  {told}",
        flush=True,
    )
    return row


if __name__ == "__main__":
    sys.exit(main())
