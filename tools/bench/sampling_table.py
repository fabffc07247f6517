#!/usr/bin/env python3
"""The sampling planners beside OMPL's of the same name: the first path, and lengths as time goes by, in one run.

build/venv/bin/python tools/bench/sampling_table.py [folder] [--only NAME] [--seeds 30] [--cap 0.1] [--no-ompl]

Disc robots, margin none, first leg; the trees alone, nothing simplified, no proof. Both sides test every motion exactly and
keep the same radius: the disc's and the half millimetre that ours keeps for the proof. Milliseconds are the processor's, to
the first path: median and p99 over the seeds (a seed without a path within --cap s counts as that). Lengths: the median of
the seeds, none where half have no path. `x`: OMPL's median over ours. Ours: what `planner` does by itself (steps of a fifth
of the hall's diagonal, goal bias 0.05, each new node tries the goal, stars informed); OMPL's: its own defaults (steps of a
fifth, goal bias 0.05). RRTConnect, InformedRRTstar and BITstar have no namesake and stand beside RRT and RRT*.
"""

from __future__ import annotations

import argparse
import json
import math
import subprocess
import sys
from pathlib import Path

import offline
import peers
from aisle import options_t
from aisle_tools import hall
from aisle_tools.scenario import read_scenario

SLACK = 5e-4  # m, that ours keeps beyond the margin (AISLE_SPACE_SLACK)
OURS = {
    "RRT": options_t.RRT,
    "RRT_ADAPTIVE": options_t.RRT_ADAPTIVE,
    "RRT_STAR": options_t.RRT_STAR,
    "RRT_STAR_ADAPTIVE": options_t.RRT_STAR_ADAPTIVE,
}
NAMESAKE = {"RRT": "RRT", "RRT_ADAPTIVE": "RRT", "RRT_STAR": "RRTstar", "RRT_STAR_ADAPTIVE": "RRTstar"}
THEIRS = ("RRT", "RRTConnect", "RRTstar", "InformedRRTstar", "BITstar")
MARKS = (1, 5, 20, 100)  # ms
TARGET = 3.0
NOISE = 1e-4  # of a length


def ours(program: Path, text: str, planner: int, seeds: int, cap: float) -> list[dict]:
    words = [program, planner, 0, 0, 1, seeds, 0, 1e3 * cap]
    done = subprocess.run([str(w) for w in words], input=text, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{program}: exit {done.returncode}: {done.stderr}")
    return json.loads(done.stdout)


def theirs(program: Path, raw: dict, name: str, pair: tuple[float, ...], seeds: int, cap: float) -> list[dict]:
    radius = (raw["robot"].get("radius") or 1e-3) + SLACK
    x0, y0, x1, y1 = raw["bounds"]
    box = (x0 + radius, y0 + radius, x1 - radius, y1 - radius)
    numbers = [1, seeds, cap, *box, radius, *pair, len(raw["obstacles"])]
    for o in raw["obstacles"]:
        numbers += [len(o), *(v for p in o for v in p)]
    return peers.call([program], name + " " + " ".join(repr(float(n)) for n in numbers))


def summary(runs: list[dict], cap: float) -> dict:
    times = sorted(r["first_ms"] if r["first_ms"] is not None else 1e3 * cap for r in runs)
    lengths = []
    for i in range(len(MARKS)):
        values = [r["at"][i] if r["at"][i] is not None else math.inf for r in runs]
        lengths.append(offline.median(values) if values else math.inf)
    return {
        "found": sum(r["first_ms"] is not None for r in runs),
        "ms": offline.median(times),
        "p99": times[min(len(times) - 1, math.ceil(0.99 * len(times)) - 1)],
        "first": offline.median([r["first"] for r in runs if r["first"] is not None]),
        "at": lengths,
    }


def show(scenario: str, name: str, row: dict, seeds: int, factor: float | None) -> str:
    text = f"{scenario:<14} {name:<18} {row['found']:>4}/{seeds:<4} {row['ms']:>8.3f} {row['p99']:>8.3f} "
    text += f"{factor:>6.1f} " if factor is not None else f"{'':>7}"
    return text + " ".join(f"{v:>9.3f}" if v < math.inf else f"{'-':>9}" for v in row["at"])


def compare(args: argparse.Namespace, path: Path, ompl: Path | None) -> dict:
    raw, scenario = json.loads(path.read_text()), read_scenario(path, -1.0)
    text = hall.text(scenario, -1.0)
    rows: dict = {"scenario": path.stem, "ours": {}, "ompl": {}}
    pair = (*scenario.start[:2], *scenario.goals[0][:2])
    for name in THEIRS if ompl is not None else ():
        rows["ompl"][name] = summary(theirs(ompl, raw, name, pair, args.seeds, args.cap), args.cap)
    for name, planner in OURS.items():
        rows["ours"][name] = summary(ours(args.program, text, planner, args.seeds, args.cap), args.cap)
    for name, row in rows["ours"].items():
        peer = rows["ompl"].get(NAMESAKE[name])
        row["factor"] = peer["ms"] / row["ms"] if peer is not None else None
        print(show(path.stem, name, row, args.seeds, row["factor"]), flush=True)
    for name, row in rows["ompl"].items():
        print(show(path.stem, "OMPL " + name, row, args.seeds, None), flush=True)
    return rows


def verdict(rows: list[dict]) -> None:
    for name, peer in NAMESAKE.items():
        factors = [r["ours"][name]["factor"] for r in rows if r["ompl"]]
        if not factors:
            return
        behind = sum(f < TARGET for f in factors)
        print(f"{name}: first path, OMPL's {peer} over it: median {offline.median(factors):.1f}, least "
              f"{min(factors):.1f}, below {TARGET:g} on {behind} of {len(factors)}")
        if peer == "RRTstar":
            longer = [r["scenario"] for r in rows
                      if r["ours"][name]["at"][2] > r["ompl"][peer]["at"][3] * (1.0 + NOISE)]
            print(f"{name}: at 20 ms longer than OMPL's at 100 ms on {len(longer)} {' '.join(longer)}")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path, nargs="?", default=offline.ROOT / "tests" / "data" / "scenarios")
    parser.add_argument("--only", metavar="NAME", action="append", help="only these")
    parser.add_argument("--seeds", type=int, default=30)
    parser.add_argument("--cap", type=float, default=0.1, help="s for each run")
    parser.add_argument("--no-ompl", action="store_true")
    parser.add_argument("--program", type=Path, default=offline.ROOT / "build" / "release" / "bench-sampling")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the rows as JSON too")
    args = parser.parse_args()
    built = None if args.no_ompl else peers.build_ompl()
    ompl = built.parent / "ompl-sampling" if built is not None else None
    print(f"{'scenario':<14} {'planner':<18} {'found':>9} {'ms':>8} {'p99':>8} {'x':>6} "
          + " ".join(f"{f'm, {m} ms':>9}" for m in MARKS))
    rows = []
    for path in sorted(args.folder.glob("*.json")):
        if path.stem == "optimum" or (args.only and path.stem not in args.only):
            continue
        rows.append(compare(args, path, ompl))
    verdict(rows)
    if args.json is not None:
        args.json.write_text(json.dumps(rows, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main())
