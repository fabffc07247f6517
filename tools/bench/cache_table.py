#!/usr/bin/env python3
"""What a remembered answer costs beside planning it: milliseconds of the same queries in the same run, by aisle-replay.

build/venv/bin/python tools/bench/cache_table.py [folder] [--only NAME] [--objective NAME] [--planner NAME] [--repeat N] [--json FILE]

plan: every run planned (remember = no). hit: remembered, nothing changed since its proof. proved: remembered, proved as a
whole since the layout has another revision. Each is the median over the runs of all legs; target: hit 100 times faster.
"""

from __future__ import annotations

import argparse
import itertools
import json
import sys
import tempfile
from pathlib import Path

import offline
from aisle_tools.scenario import read_scenario
from logs import OBJECTIVES, write_log

TARGET = 100.0
ROUNDS = 3  # in turn, so that a busy machine is busy for all of them
KINDS = {"plan": [], "hit": ["--cached"], "proved": ["--cached", "--proofs"]}


def main() -> int:
    args = parse()
    names = sorted(json.loads((args.folder / "optimum.json").read_text()))
    print(f"{'scenario':<14} {'planner':<18} {'objective':<12} {'plan ms':>9} {'hit ms':>9} {'ratio':>8} {'proved ms':>9} {'ratio':>8}")
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name in (n for n in names if not args.only or n in args.only):
            scenario = read_scenario(args.folder / f"{name}.json", args.margin)
            for planner, objective in itertools.product(args.planner or ("auto",), args.objective or OBJECTIVES):
                log = write_log(args, Path(folder), scenario, objective, planner)
                rows.append({"scenario": name, "planner": planner, "objective": objective, **measure(args, log)})
                print_row(rows[-1])
    if args.json is not None:
        args.json.write_text(json.dumps(rows, indent=1) + "\n")
    for planner, kind in itertools.product(args.planner or ("auto",), ("hit", "proved")):
        of_it = [r for r in rows if r["planner"] == planner]
        ratios = sorted(r["plan"] / r[kind] for r in of_it)
        fast = sum(r >= TARGET for r in ratios)
        print(f"{planner}, {kind}: {fast} of {len(ratios)} at least {TARGET:.0f} times faster; least {ratios[0]:.1f}, median "
              f"{offline.median(ratios):.0f}, sums {sum(r['plan'] for r in of_it) / sum(r[kind] for r in of_it):.0f}")
    return 0


def parse() -> argparse.Namespace:
    root = offline.ROOT
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path, nargs="?", default=root / "tests" / "data" / "scenarios")
    parser.add_argument("--only", metavar="NAME", action="append", help="only these scenarios")
    parser.add_argument("--objective", choices=OBJECTIVES, action="append", help="only these objectives")
    parser.add_argument("--planner", metavar="NAME", action="append", help="by these planners (auto); PRM plans on the roadmap "
                        "that the runs before left")
    parser.add_argument("--replay", type=Path, default=root / "build" / "release" / "aisle-replay", metavar="PROGRAM")
    parser.add_argument("--repeat", type=int, default=20, metavar="N", help="runs of each query and round (hits: 10 N)")
    parser.add_argument("--margin", type=float, default=-1.0, help="m; negative = none")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the rows as JSON too")
    return parser.parse_args()


def measure(args: argparse.Namespace, log: Path) -> dict[str, float]:
    found: dict[str, list[float]] = {kind: [] for kind in KINDS}
    for _ in range(ROUNDS):
        for kind, options in KINDS.items():
            repeat = args.repeat * (1 if kind == "plan" else 10)
            found[kind].append(median_ms(args.replay, log, repeat, options))
    return {kind: min(ms) for kind, ms in found.items()}


def median_ms(replay: Path, log: Path, repeat: int, options: list[str]) -> float:
    """Of the median leg."""
    out = log.with_suffix(".json")
    offline.run([replay, log, "--bench", *options, "--repeat", repeat, "--json", out])
    return offline.median([q["ms_median"] for q in json.loads(out.read_text())["queries"]])


def print_row(row: dict) -> None:
    print(f"{row['scenario']:<14} {row['planner']:<18} {row['objective']:<12} {row['plan']:>9.4f} {row['hit']:>9.4f} "
          f"{row['plan'] / row['hit']:>8.1f} {row['proved']:>9.4f} {row['plan'] / row['proved']:>8.1f}", flush=True)


if __name__ == "__main__":
    sys.exit(main())
