#!/usr/bin/env python3
"""The arm on its scenarios: how many seeds find a motion, whether it holds what it must, how long it takes to plan and to run.

build/venv/bin/python tools/bench/arm_table.py [folder] [--seeds 1000] [--only NAME] [--planner P] [--objective O] [--check]

Each motion is judged from its waypoints alone (aisle_tools/arms.py; nothing of src/): at 10,000 times joint limits, velocity,
acceleration, jerk and torque (Newton and Euler's recursion), at 1,000 the distance of each link to obstacles, bounds, body and
first link. `over least`: the told duration over the least one in which the same curve of joint angles holds all limits at
10,000 places a stretch. Milliseconds are the processor's. --check: exit 1 where a seed finds none, a limit is passed, or the
duration is more than 1 % over the least one.
"""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import shapely
from aisle import arm_path_t, options_t, path_t
from aisle_tools import arms, names, vehicle
from aisle_tools.errors import UserError

ROOT = Path(__file__).resolve().parent.parent.parent
SAMPLES = 10_000
CONTACT_SAMPLES = 1_000
LIMIT_SLACK = 1e-6  # relative: what floats round
OVER_LEAST = 1.01
TARGET_MS = 50.0


@dataclass
class Row:
    name: str
    seeds: int
    found: int
    causes: dict[str, int]
    worst: float  # share of a limit used
    clear: float  # m, least seen
    over_least: float
    duration: float
    travel: float
    planners: dict[str, int]
    ms: np.ndarray
    faults: list[str]


def make_options(args: argparse.Namespace, seed: int) -> options_t:
    options = options_t()
    options.planner = names.option_value(args.planner, names.PLANNERS)
    options.objective = names.option_value(args.objective, names.OBJECTIVES)
    options.seed = seed
    return options


class Judge:
    """What a motion must hold, by geometry of its own."""

    def __init__(self, scenario: arms.Scenario) -> None:
        self.arm = arms.arm_of(scenario.vehicle)
        self.base = arms.base_of(self.arm, scenario.pose)
        self.obstacles = shapely.union_all([shapely.Polygon(p.vertices) for p in scenario.world.polygons])
        self.bounds = scenario.world.bounds
        body = vehicle.body(scenario.vehicle)
        c, s = np.cos(scenario.pose[2]), np.sin(scenario.pose[2])
        vertices = body.vertices @ np.array([[c, s], [-s, c]]) + np.array(scenario.pose[:2])
        self.body = shapely.Polygon(vertices)
        self.body_radius = body.radius
        at = shapely.Point(self.base[:2])
        depth = shapely.distance(self.body.exterior, at) if self.body.covers(at) else -shapely.distance(self.body, at)
        self.exempt = max(depth + body.radius, 0.0) + 2.0 * float(self.arm.radius[0])

    def use(self, path: arm_path_t) -> dict[str, float]:
        motion = arms.motion_of(path, self.arm.links, SAMPLES)
        return arms.worst_use(self.arm, motion, arms.torques(self.arm, self.base[2], motion))

    def clearance(self, path: arm_path_t) -> float:
        """m, least over links and samples; negative is as deep as a link's radius at most."""
        motion = arms.motion_of(path, self.arm.links, CONTACT_SAMPLES)
        points = arms.places(self.arm, self.base, motion.q)
        least = np.inf
        x0, y0, x1, y1 = self.bounds
        lines = [shapely.linestrings(points[:, i : i + 2]) for i in range(self.arm.links)]
        for i, line in enumerate(lines):
            radius = self.arm.radius[i]
            ends = points[:, i : i + 2]
            low, high = ends.min(axis=(0, 1)), ends.max(axis=(0, 1))
            least = min(least, low[0] - x0 - radius, low[1] - y0 - radius, x1 - high[0] - radius, y1 - high[1] - radius)
            if not self.obstacles.is_empty:
                least = min(least, float(shapely.distance(line, self.obstacles).min()) - radius)
            own = line if i > 0 else self._beyond_mount(points)
            if own is not None:
                least = min(least, float(shapely.distance(own, self.body).min()) - radius - self.body_radius)
        if self.arm.links == 3:
            apart = shapely.distance(lines[0], lines[2])
            least = min(least, float(apart.min()) - self.arm.radius[0] - self.arm.radius[2])
        return least

    def _beyond_mount(self, points: np.ndarray):  # noqa: ANN202
        share = self.exempt / self.arm.length[0]
        if share >= 1.0:
            return None
        first = points[:, 0] + share * (points[:, 1] - points[:, 0])
        return shapely.linestrings(np.stack([first, points[:, 1]], axis=1))


def judge_all(judge: Judge, answers: dict[int, arm_path_t]) -> tuple[float, float, float, list[str]]:
    """Worst share of a limit, least clearance, worst duration over the least one, what is wrong."""
    worst, clear, over, faults, seen = 0.0, np.inf, 1.0, [], set()
    for ident, path in answers.items():
        if path.status != path_t.OK:
            continue
        key = b"".join(w.encode() for w in path.waypoints)
        if key in seen:
            continue
        seen.add(key)
        use = judge.use(path)
        worst = max(worst, *(use[k] for k in ("velocity", "acceleration", "jerk", "torque")))
        least = judge.clearance(path)
        clear = min(clear, least)
        ratio = path.duration / arms.least_duration(judge.arm, judge.base[2], path, SAMPLES) if path.duration > 0.0 else 1.0
        over = max(over, ratio)
        if worst > 1.0 + LIMIT_SLACK or use["joints"] > 1e-6 or least <= 0.0 or ratio > OVER_LEAST:
            faults.append(f"seed {ident - 1}: {use}, clearance {least:.5f}, {ratio:.4f} of the least duration")
    return worst, clear, over, faults


def row_of(args: argparse.Namespace, path: Path) -> Row:
    scenario = arms.read_scenario(path)
    answers, ms = arms.plan_all(args.program, scenario, [make_options(args, seed) for seed in range(args.seeds)])
    worst, clear, over, faults = judge_all(Judge(scenario), answers)
    found = [a for a in answers.values() if a.status == path_t.OK]
    causes: dict[str, int] = {}
    planners: dict[str, int] = {}
    for a in answers.values():
        if a.status != path_t.OK:
            causes[arms.reason(a)] = causes.get(arms.reason(a), 0) + 1
        else:
            planners[names.PLANNERS[a.planner]] = planners.get(names.PLANNERS[a.planner], 0) + 1
    middle = [float(np.median([getattr(a, k) for a in found])) if found else np.nan for k in ("duration", "travel")]
    return Row(scenario.name, args.seeds, len(found), causes, worst, clear, over, *middle, planners, np.array(ms), faults)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, nargs="?", default=ROOT / "tests" / "data" / "arms")
    parser.add_argument("--seeds", type=int, default=1000, metavar="N")
    parser.add_argument("--only", action="append", metavar="NAME")
    parser.add_argument("--planner", default="auto", metavar="P")
    parser.add_argument("--objective", default="safest", metavar="O")
    parser.add_argument("--program", type=Path, default=ROOT / "build" / "release" / "bench-arm", metavar="PROGRAM")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--json", type=Path, metavar="FILE")
    args = parser.parse_args()
    rows = []
    print(f"{'scenario':<14} {'found':>10} {'limits':>8} {'clear, m':>8} {'over least':>10} {'s':>6} {'rad':>6} {'ms p50':>7} {'p99':>7}")
    for path in sorted(args.folder.glob("*.json")):
        if args.only and not any(o in path.stem for o in args.only):
            continue
        try:
            row = row_of(args, path)
        except UserError as e:
            raise SystemExit(f"arm_table: {e}") from None
        rows.append(row)
        print(
            f"{row.name:<14} {row.found:>5}/{row.seeds:<4} {row.worst:>8.5f} {row.clear:>8.4f} {row.over_least:>10.5f} "
            f"{row.duration:>6.2f} {row.travel:>6.2f} {np.median(row.ms):>7.1f} {np.percentile(row.ms, 99):>7.1f}  "
            f"{row.planners} {row.causes or ''}",
            flush=True,
        )
        for fault in row.faults[:5]:
            print("   ", fault)
    if args.json is not None:
        args.json.write_text(json.dumps([{**r.__dict__, "ms": r.ms.tolist()} for r in rows], indent=1))
    good = all(r.found == r.seeds and not r.faults for r in rows)
    return 0 if good or not args.check else 1


if __name__ == "__main__":
    sys.exit(main())
