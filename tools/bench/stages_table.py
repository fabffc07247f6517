#!/usr/bin/env python3
"""Grid seed, taut seed and swarm of every scenario's legs, by each objective's own density (metres, less is better).

build/venv/bin/python tools/bench/stages_table.py [folder] [--only NAME] [--program build/release/bench-stages]

The swarm's worth is the last column: what it takes off the taut seed, in per cent. On pure length a taut string cannot
be beaten.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path

from aisle_tools import hall
from aisle_tools.scenario import read_scenario

ROOT = Path(__file__).resolve().parent.parent.parent


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path, nargs="?", default=ROOT / "tests" / "data" / "scenarios")
    parser.add_argument("--only", metavar="NAME", action="append", help="only these")
    parser.add_argument("--margin", type=float, default=-1.0, help="m; negative = none (default)")
    parser.add_argument("--program", type=Path, default=ROOT / "build" / "release" / "bench-stages")
    args = parser.parse_args()
    print(f"{'scenario':<16} {'leg':>3} {'objective':<13} {'grid seed':>10} {'taut seed':>10} {'swarm':>10} {'taut %':>7} {'swarm %':>8}")
    for path in sorted(args.folder.glob("*.json")):
        if path.stem in ("optimum", "causes") or (args.only and path.stem not in args.only):
            continue
        scenario = read_scenario(path, args.margin)
        for leg in range(len(scenario.goals)):
            done = subprocess.run([str(args.program)], input=hall.text(scenario, args.margin, leg), text=True,
                                  capture_output=True, check=False)
            if done.returncode != 0:
                sys.exit(f"{path.stem}: {done.stderr}")
            for objective, value in json.loads(done.stdout).items():
                print(row(path.stem, leg, objective, value), flush=True)
    return 0


def gain(before: float | None, after: float | None) -> str:
    return f"{100.0 * (1.0 - after / before):.2f}" if before and after else "-"


def row(name: str, leg: int, objective: str, value: dict) -> str:
    cells = " ".join(f"{value[k]:>10.3f}" if value[k] is not None else f"{'-':>10}" for k in ("seed", "taut", "swarm"))
    return (f"{name:<16} {leg + 1:>3} {objective:<13} {cells} {gain(value['seed'], value['taut']):>7} "
            f"{gain(value['taut'], value['swarm']):>8}")


if __name__ == "__main__":
    sys.exit(main())
