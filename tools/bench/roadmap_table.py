#!/usr/bin/env python3
"""The roadmap of PRM: building, asking, and repairing it after a small patch beside building it anew, in one run.

build/venv/bin/python tools/bench/roadmap_table.py [folder] [--only NAME] [--draws 3584] [--box 1.0] [--margin -1]

Milliseconds of the processor, medians. lazy: an edge is tested when a search first comes to it; eager: all while building.
cold, warm: 200 pairs of free configurations at random, asked by A* the first and the second time (p99 beside it). A box of
--box m comes at a random place or goes, 60 times: the repair, the same roadmap built anew, and both with the next ten queries.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path

import offline
from aisle_tools import hall
from aisle_tools.scenario import read_scenario

DEFAULT = ("narrow_10", "clutter_50", "factory_big")


def measure(args: argparse.Namespace, path: Path, eager: bool) -> dict:
    words = [args.program, args.draws, int(eager), args.pairs, args.patches, args.box, 1]
    text = hall.text(read_scenario(path, args.margin), args.margin)
    done = subprocess.run([str(w) for w in words], input=text, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{args.program}: exit {done.returncode}: {done.stderr}")
    return {"scenario": path.stem, "eager": eager, **json.loads(done.stdout)}


def show(row: dict) -> str:
    repair, rebuild = row["repair_us"][0], row["rebuild_us"][0]
    with_repair, with_rebuild = repair + row["after_repair_us"][0], rebuild + row["after_rebuild_us"][0]
    return (
        f"{row['scenario']:<12} {'eager' if row['eager'] else 'lazy':<6} {row['nodes']:>6} {row['build_us'] / 1e3:>9.2f} "
        f"{row['found']:>4}/{row['pairs']:<4} {row['cold_us'][0] / 1e3:>7.3f} {row['warm_us'][0] / 1e3:>7.3f} "
        f"{row['warm_us'][1] / 1e3:>7.3f} {repair / 1e3:>8.3f} {rebuild / 1e3:>8.2f} {rebuild / repair:>6.1f} "
        f"{with_repair / 1e3:>9.2f} {with_rebuild / 1e3:>9.2f} {with_rebuild / with_repair:>6.1f}"
    )


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path, nargs="?", default=offline.ROOT / "tests" / "data" / "scenarios")
    parser.add_argument("--only", metavar="NAME", action="append", help="these scenarios")
    parser.add_argument("--draws", type=int, default=3584)
    parser.add_argument("--pairs", type=int, default=200)
    parser.add_argument("--patches", type=int, default=60)
    parser.add_argument("--box", type=float, default=1.0, help="m")
    parser.add_argument("--margin", type=float, default=-1.0, help="m; negative = none")
    parser.add_argument("--program", type=Path, default=offline.ROOT / "build" / "release" / "bench-roadmap")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the rows as JSON too")
    args = parser.parse_args()
    print(f"{'scenario':<12} {'edges':<6} {'nodes':>6} {'build ms':>9} {'found':>9} {'cold':>7} {'warm':>7} {'p99':>7} "
          f"{'repair':>8} {'anew':>8} {'x':>6} {'+10':>9} {'anew+10':>9} {'x':>6}")
    rows = []
    for name in args.only or DEFAULT:
        for eager in (False, True):
            rows.append(measure(args, args.folder / f"{name}.json", eager))
            print(show(rows[-1]), flush=True)
    if args.json is not None:
        args.json.write_text(json.dumps(rows, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
