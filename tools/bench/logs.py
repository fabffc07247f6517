#!/usr/bin/env python3
"""A log of queries per scenario and objective, timed by aisle-replay --bench: median and p99 of every query's runs.

build/venv/bin/python tools/bench/logs.py [folder] [--only NAME] [--repeat 200] [--keep FOLDER] [--json FILE]

--keep writes the logs there, for aisle-replay by hand. A query's p99 is over its own runs, at least 200 of them by
default. Targets: SAFEST at most 5 ms in the median for disc robots on the 20 x 20 m scenarios and 25 ms on factory_big
(median of its legs), p99 at most twice the median.
"""

from __future__ import annotations

import argparse
import copy
import json
import sys
import tempfile
from pathlib import Path

import offline
from aisle_tools import query, vehicle
from aisle_tools.scenario import Scenario, read_scenario

OBJECTIVES = ("shortest", "safest", "fastest", "least_energy")
SAFEST_MS = {"factory_big": 25.0}  # others: SAFEST_SMALL_MS
SAFEST_SMALL_MS, SPREAD = 5.0, 2.0


def write(args: argparse.Namespace, scenario: Scenario, objective: str, path: Path) -> None:
    asked = copy.copy(args)
    asked.objective = objective
    shape = {"footprint": scenario.footprint} if scenario.footprint else {"radius": scenario.radius}
    stops = [scenario.start, *scenario.goals]
    legs = [query.Leg(str(i + 1), a, [b]) for i, (a, b) in enumerate(zip(stops, stops[1:]))]
    offline.write_log(asked, path, scenario.world, vehicle.make({**shape, "margin": args.margin}), legs)


def bench(args: argparse.Namespace, log: Path, repeat: int) -> list[dict]:
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "ms.json"
        config = ["--config", str(args.config)] if args.config is not None else []
        offline.run([args.replay, log, "--bench", "--repeat", repeat, "--json", out, *config])
        return json.loads(out.read_text())["queries"]


def verdict(name: str, objective: str, median: float, spread: float) -> str:
    if objective != "safest":
        return ""
    target = SAFEST_MS.get(name, SAFEST_SMALL_MS)
    return f"{'met' if median <= target else 'missed'} ({target:g} ms), p99 {'met' if spread <= SPREAD else 'missed'}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    offline.add_options(parser, offline.ROOT / "tests" / "data" / "scenarios")
    parser.add_argument("--margin", type=float, default=-1.0, help="m; negative = none (default)")
    parser.add_argument("--objectives", default=",".join(OBJECTIVES), metavar="O,...", help="default: all four")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="write the logs there")
    parser.set_defaults(repeat=200)
    args = parser.parse_args()
    print(f"{'scenario':<16} {'objective':<13} {'legs':>4} {'runs':>5} {'median ms':>10} {'p99 ms':>9} {'p99/median':>10}  "
          "target")
    rows = []
    with tempfile.TemporaryDirectory() as temporary:
        folder = args.keep or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        for path in sorted(args.folder.glob("*.json")):
            if path.stem in ("optimum", "causes") or (args.only and path.stem not in args.only):
                continue
            scenario = read_scenario(path, args.margin)
            for objective in args.objectives.split(","):
                log = folder / f"{path.stem}_{objective}.log"
                write(args, scenario, objective, log)
                rows.append(print_row(path.stem, objective, bench(args, log, args.repeat), args.repeat))
    if args.json is not None:
        args.json.write_text(json.dumps(rows, indent=1))
    return 0


def print_row(name: str, objective: str, queries: list[dict], repeat: int) -> dict:
    median = offline.median([q["ms_median"] for q in queries])
    spread = max(q["ms_p99"] / q["ms_median"] for q in queries)
    p99 = max(q["ms_p99"] for q in queries)
    print(f"{name:<16} {objective:<13} {len(queries):>4} {repeat * len(queries):>5} {median:>10.3f} {p99:>9.3f} "
          f"{spread:>10.2f}  {verdict(name, objective, median, spread)}", flush=True)
    return {"scenario": name, "objective": objective, "median_ms": median, "p99_ms": p99, "spread": spread,
            "queries": queries}


if __name__ == "__main__":
    sys.exit(main())
