#!/usr/bin/env python3
"""The sampling planners beside OMPL's of the same name: the first path, and lengths as time goes by, in one run.

build/venv/bin/python tools/bench/sampling_table.py [folder] [--only NAME] [--seeds 30] [--cap 0.1] [--no-ompl]
    [--planner NAME] [--namesakes] [--steps]

Disc robots (of others the disc in which they turn), margin none, every leg; the planners alone, no proof, the layout in
force; nothing is simplified but what ours do by themselves. Both sides test every motion exactly and keep the same radius:
the disc's and the half millimetre that ours keeps for the proof; every path is measured again here. Milliseconds are the
processor's, to the first path: median and p99 over the seeds (a seed without a path within --cap s counts as that, ours going
on as long). Lengths: the median of the seeds, none where half have no path. `x`: OMPL's median over ours, `p99 x` the same of
p99. Ours: what `planner` does by itself (steps of a fifth of the hall's diagonal, goal bias 0.05, each new node tries the
goal, stars informed, paths leave out nodes that they can; PRM lazy, 10 neighbours, from 8 draws on, doubled: by name it begins
with more, for the queries to come); OMPL's: its own defaults (steps of a fifth, goal bias 0.05, PRM 10 neighbours). RRTConnect,
InformedRRTstar, BITstar and PRMstar have no namesake and stand beside the others. Bytes: of a node.

--steps: the paper's plain form alone (no goal bias, whole steps for the fixed planners, one halving for the adaptive ones)
over the step, on the slits: seeds with a path within 100,000 samples.
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
import shapely
from aisle import options_t
from aisle_tools import hall
from aisle_tools.scenario import read_scenario

SLACK = 5e-4  # m, that ours keeps beyond the margin (AISLE_SPACE_SLACK)
OURS = {
    "RRT": options_t.RRT,
    "RRT_ADAPTIVE": options_t.RRT_ADAPTIVE,
    "RRT_STAR": options_t.RRT_STAR,
    "RRT_STAR_ADAPTIVE": options_t.RRT_STAR_ADAPTIVE,
    "PRM": options_t.PRM,
}
NAMESAKE = {"RRT": "RRT", "RRT_ADAPTIVE": "RRT", "RRT_STAR": "RRTstar", "RRT_STAR_ADAPTIVE": "RRTstar", "PRM": "PRM"}
THEIRS = ("RRT", "RRTConnect", "RRTstar", "InformedRRTstar", "BITstar", "PRM", "PRMstar")
BYTES = {"RRT": 82, "RRT_ADAPTIVE": 82, "RRT_STAR": 82, "RRT_STAR_ADAPTIVE": 82, "PRM": 175}  # algo/rrt.h, algo/roadmap.h
MARKS = (1, 5, 20, 100)  # ms
TARGET = 3.0
NOISE = 1e-4  # of a length
STEPS = (0.1, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0)  # m
SLITS = ("narrow_10", "narrow_03")


def ours(program: Path, text: str, planner: int, seeds: int, cap: float, step: float = 0.0) -> list[dict]:
    """step above 0: the paper's form with this step, to the first path, without a cap."""
    words = [program, planner, step, int(step > 0.0), 1, seeds, 0, -1 if step > 0.0 else 1e3 * cap]
    done = subprocess.run([str(w) for w in words], input=text, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{program}: exit {done.returncode}: {done.stderr}")
    return json.loads(done.stdout)


def radius_of(raw: dict) -> float:
    return (raw["robot"].get("radius") or 1e-3) + SLACK


def theirs(program: Path, raw: dict, bounds: tuple[float, ...], name: str, pair: tuple[float, ...], seeds: int,
           cap: float) -> list[dict]:
    radius = radius_of(raw)
    x0, y0, x1, y1 = bounds
    box = (x0 + radius, y0 + radius, x1 - radius, y1 - radius)
    numbers = [1, seeds, cap, *box, radius, *pair, len(raw["obstacles"])]
    for o in raw["obstacles"]:
        numbers += [len(o), *(v for p in o for v in p)]
    return peers.call([program], name + " " + " ".join(repr(float(n)) for n in numbers))


def check_paths(runs: list[dict], raw: dict, pair: tuple[float, ...], name: str) -> None:
    """Every path keeps the radius, joins the ends and is as long as was said."""
    obstacles = shapely.STRtree([shapely.Polygon(o) for o in raw["obstacles"]])
    for run in (r for r in runs if r["path"]):
        line = shapely.LineString(run["path"])
        _, gap = obstacles.query_nearest(line, return_distance=True, all_matches=False)
        ends = math.dist(run["path"][0], pair[:2]) + math.dist(run["path"][-1], pair[2:])
        best = min(v for v in [run["first"], *run["at"]] if v is not None)
        if gap[0] < radius_of(raw) - SLACK or ends > 1e-6 or line.length > best * (1.0 + NOISE):
            raise SystemExit(f"{name}: a path {gap[0]:.6f} m from an obstacle, {line.length} m long, {best} m told")


def summary(runs: list[dict], cap: float) -> dict:
    most = 1e3 * cap
    times = sorted(r["first_ms"] if r["first_ms"] is not None and r["first_ms"] <= most else most for r in runs)
    lengths = []
    for i in range(len(MARKS)):
        values = [r["at"][i] if r["at"][i] is not None else math.inf for r in runs]
        lengths.append(offline.median(values) if values else math.inf)
    return {
        "found": sum(t < most for t in times),
        "ms": offline.median(times),
        "p99": times[min(len(times) - 1, math.ceil(0.99 * len(times)) - 1)],
        "first": offline.median([r["first"] for r in runs if r["first"] is not None] or [math.inf]),
        "at": lengths,
        "bytes": offline.median([r["bytes"] / max(r["nodes"], 1) for r in runs]) if "bytes" in runs[0] else None,
    }


def show(scenario: str, name: str, row: dict, seeds: int) -> str:
    text = f"{scenario:<15} {name:<20} {row['found']:>4}/{seeds:<4} {row['ms']:>8.3f} {row['p99']:>8.3f} "
    text += f"{row['factor']:>6.1f} {row['p99_factor']:>6.1f} " if row.get("factor") else f"{'':>14}"
    text += " ".join(f"{v:>9.3f}" if v < math.inf else f"{'-':>9}" for v in row["at"])
    return text + f" {row['bytes']:>6.0f}"


def compare(args: argparse.Namespace, path: Path, leg: int, ompl: Path | None) -> dict:
    raw, scenario = json.loads(path.read_text()), read_scenario(path, -1.0)
    text = hall.text(scenario, -1.0, leg)
    stops = peers.stops_of(scenario)
    pair = (*stops[leg][:2], *stops[leg + 1][:2])
    title = path.stem + (f" {leg + 1}" if len(stops) > 2 else "")
    rows: dict = {"scenario": title, "ours": {}, "ompl": {}}
    wanted = args.planner or list(OURS)
    peers_asked = sorted({NAMESAKE[n] for n in wanted}) if args.namesakes else THEIRS
    for name in peers_asked if ompl is not None else ():
        runs = theirs(ompl, raw, scenario.world.bounds, name, pair, args.seeds, args.cap)
        check_paths(runs, raw, pair, f"{title}: OMPL {name}")
        rows["ompl"][name] = summary(runs, args.cap)
    for name, planner in ((n, OURS[n]) for n in wanted):
        runs = ours(args.program, text, planner, args.seeds, args.cap)
        check_paths(runs, raw, pair, f"{title}: {name}")
        row = rows["ours"][name] = summary(runs, args.cap)
        row["bytes"] = BYTES[name]
        peer = rows["ompl"].get(NAMESAKE[name])
        row["factor"] = peer["ms"] / row["ms"] if peer is not None else None
        row["p99_factor"] = peer["p99"] / row["p99"] if peer is not None else None
        print(show(title, name, row, args.seeds), flush=True)
    for name, row in rows["ompl"].items():
        print(show(title, "OMPL " + name, row, args.seeds), flush=True)
    return rows


def verdict(rows: list[dict]) -> None:
    for name, peer in ((n, p) for n, p in NAMESAKE.items() if n in rows[0]["ours"]):
        factors = [r["ours"][name]["factor"] for r in rows if r["ompl"]]
        if not factors:
            return
        last = [r["ours"][name]["p99_factor"] for r in rows]
        behind = [r["scenario"] for r in rows if r["ours"][name]["factor"] < TARGET]
        print(f"{name}: first path, OMPL's {peer} over it: median {offline.median(factors):.1f}, least "
              f"{min(factors):.1f}, below {TARGET:g} on {len(behind)} of {len(factors)} ({', '.join(behind)}); of p99: "
              f"median {offline.median(last):.1f}, least {min(last):.1f}")
        for i, mark in enumerate(MARKS):
            pairs = [(r["ours"][name]["at"][i], r["ompl"][peer]["at"][i]) for r in rows]
            longer = sum(a > b * (1.0 + NOISE) for a, b in pairs)
            print(f"    at {mark} ms longer than it on {longer}", end="")
        later = [r["scenario"] for r in rows if r["ours"][name]["at"][2] > r["ompl"][peer]["at"][3] * (1.0 + NOISE)]
        print(f"; at 20 ms longer than it at 100 ms on {len(later)} ({', '.join(later)})")


def steps_table(args: argparse.Namespace) -> list[dict]:
    rows = []
    names = [n for n in OURS if n != "PRM"]
    print(f"{'scenario':<15} {'step m':>7} " + " ".join(f"{n:>18}" for n in names))
    for path in sorted(args.folder.glob("*.json")):
        if path.stem not in (args.only or SLITS):
            continue
        text = hall.text(read_scenario(path, -1.0), -1.0)
        for step in STEPS:
            found = {}
            for name in names:
                runs = ours(args.program, text, OURS[name], args.seeds, 0.0, step)
                found[name] = sum(r["first"] is not None for r in runs)
            rows.append({"scenario": path.stem, "step": step, "found": found})
            print(f"{path.stem:<15} {step:>7.2f} " + " ".join(f"{found[n]:>14}/{args.seeds:<3}" for n in names), flush=True)
    return rows


def whole_table(args: argparse.Namespace) -> list[dict]:
    built = None if args.no_ompl else peers.build_ompl()
    ompl = built.parent / "ompl-sampling" if built is not None else None
    print(f"{'scenario':<15} {'planner':<20} {'found':>9} {'ms':>8} {'p99':>8} {'x':>6} {'p99 x':>6} "
          + " ".join(f"{f'm, {m} ms':>9}" for m in MARKS) + f" {'bytes':>6}")
    rows = []
    for path in sorted(args.folder.glob("*.json")):
        if path.stem == "optimum" or (args.only and path.stem not in args.only):
            continue
        for leg in range(len(json.loads(path.read_text())["goals"])):
            rows.append(compare(args, path, leg, ompl))
    verdict(rows)
    return rows


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path, nargs="?", default=offline.ROOT / "tests" / "data" / "scenarios")
    parser.add_argument("--only", metavar="NAME", action="append", help="only these")
    parser.add_argument("--seeds", type=int, default=30)
    parser.add_argument("--cap", type=float, default=0.1, help="s for each run")
    parser.add_argument("--no-ompl", action="store_true")
    parser.add_argument("--planner", choices=OURS, action="append", help="of ours only these")
    parser.add_argument("--namesakes", action="store_true", help="of OMPL's planners only those of the same names")
    parser.add_argument("--steps", action="store_true", help="the paper's plain form over the step")
    parser.add_argument("--program", type=Path, default=offline.ROOT / "build" / "release" / "bench-sampling")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the rows as JSON too")
    args = parser.parse_args()
    rows = steps_table(args) if args.steps else whole_table(args)
    if args.json is not None:
        args.json.write_text(json.dumps(rows, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main())
