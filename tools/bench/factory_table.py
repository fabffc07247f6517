#!/usr/bin/env python3
"""factory_big's 1.8 x 0.9 m vehicle: its six legs and 200 random ones, with a heading at both ends, beside OMPL.

build/venv/bin/python tools/bench/factory_table.py [--random 200] [--peer-legs 30] [--cap 1] [--store] [--check]

Each answer is held against the oracle of tests/support/pose_oracle.h (its verdicts are stored in
tests/data/factory_ways.json; --store makes them, a run of minutes), its length against the exact shortest way of the
disc inside the body, which is a lower bound, and looked at every centimetre (aisle_tools/check.py). The six legs' stops
are the scenario's; of the random ones, start and goal have a heading but for a third of the goals.

Peers: OMPL with the exact footprint tested every 5 cm, on the first --peer-legs legs, with the headings of Aisle's answer:
RRTConnect, BIT*, and BIT* over ways of Reeds and Shepp (1.5 m). Time and length of the first path and of what there is
after --cap s of processor time; each is looked at every centimetre by the same checker. The first two move over SE(2) in
any direction whatever the heading, as no vehicle with this drive can: so of paths that are shorter than Aisle's it is told
how many do without slipping sideways. Optional, as in peers.py.
--check: exit 1 if a leg that has a way is refused or a path is not clear.
"""

from __future__ import annotations

import argparse
import json
import math
import random
import subprocess
import sys
import zlib
from pathlib import Path

import numpy as np
import offline
import peers
from aisle_tools import query, vehicle
from aisle_tools.check import Obstacles
from aisle_tools.scenario import Scenario, read_scenario

STORE = offline.ROOT / "tests" / "data" / "factory_ways.json"
STEP = 0.05  # m, the oracle's
SHIFT = 1.0  # m, what its hall reaches beyond the scenario's bounds
SPARE = 2e-3  # m, that no stop is nearer to being in contact
INNER = 0.45  # m, radius of the disc inside the body
RADIUS_MIN = 1.5  # m, of the peer that steers as a car
SLIP, SLIP_LENGTH = math.radians(5.0), 0.05  # rad, m: what a vehicle that cannot move sideways may seem to
PLANNERS = ("RRTConnect", "BITstar", "ReedsShepp")


def main() -> int:
    args = parse()
    scenario = read_scenario(args.folder / "factory_big.json", 0.0)
    msg = vehicle.from_options(argparse.Namespace(**vars(args), vehicle=None, radius=None, footprint=None), scenario)
    legs = six_legs(scenario) + random_legs(scenario, msg, args.random)
    verdicts = verdicts_of(args, scenario, legs)
    if args.store:
        return 0
    answers = offline.answers(args, scenario.world, msg, legs)
    bounds = lower_bounds(args, scenario, legs)
    good = print_answers("six legs", legs[:6], answers[:6], bounds[:6], verdicts[:6])
    good &= print_answers("random legs", legs[6:], answers[6:], bounds[6:], verdicts[6:])
    program = None if args.peer_legs == 0 else build_peer()
    if program is not None:
        print_peers(args, program, scenario, msg, legs[: args.peer_legs], answers, bounds)
    return 0 if good or not args.check else 1


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    offline.add_options(parser, offline.ROOT / "tests" / "data" / "scenarios")
    release = offline.ROOT / "build" / "release"
    parser.add_argument("--oracle", type=Path, default=release / "pose-oracle", metavar="PROGRAM")
    parser.add_argument("--optimum", type=Path, default=release / "optimum", metavar="PROGRAM")
    parser.add_argument("--random", type=int, default=200, metavar="N", help="random legs, at most those stored")
    parser.add_argument("--peer-legs", type=int, default=30, metavar="N", help="0: no peers")
    parser.add_argument("--cap", type=float, default=1.0, metavar="S", help="of each peer and leg")
    parser.add_argument("--store", action="store_true", help="ask the oracle, and no more")
    parser.add_argument("--check", action="store_true")
    parser.set_defaults(objective="shortest")
    return parser.parse_args()


def six_legs(scenario: Scenario) -> list[query.Leg]:
    stops = [scenario.start, *scenario.goals]
    return [query.Leg(f"leg {i + 1}", a, [b]) for i, (a, b) in enumerate(zip(stops, stops[1:]))]


def random_legs(scenario: Scenario, msg: object, count: int) -> list[query.Leg]:
    rng = random.Random(20260806)
    obstacles, body = Obstacles(scenario.world), vehicle.body(msg)
    x0, y0, x1, y1 = scenario.world.bounds

    def stop() -> tuple:
        while True:
            x, y = (round(STEP * rng.randint(0, math.floor(side / STEP)), 2) for side in (x1 - 1.1, y1 - 1.1))
            pose = x, y, 0.5 * math.pi * rng.choice((-1, 0, 1, 2))
            if x > x0 and y > y0 and obstacles.clearances(body, np.array([pose]))[0] > SPARE:
                return pose

    legs = []
    for i in range(count):
        start, goal = stop(), stop()
        legs.append(query.Leg(f"random {i}", start, [goal[:2] if rng.random() < 1.0 / 3.0 else goal]))
    return legs


def oracle_lines(scenario: Scenario, legs: list[query.Leg]) -> str:
    x0, y0, x1, y1 = scenario.world.bounds
    lines = [f"bounds {math.floor(x1) + SHIFT:.2f} {math.floor(y1) + SHIFT:.2f}"]
    for p in scenario.world.polygons:
        lines.append(
            f"polygon {len(p.vertices)} " + " ".join(f"{x + SHIFT!r} {y + SHIFT!r}" for x, y in p.vertices.tolist())
        )
    lines.append(f"body {len(scenario.footprint)} " + " ".join(f"{x} {y}" for x, y in scenario.footprint) + " 0 0")
    lines.append("mode connect")
    for leg in legs:
        poses = [(p[0] + SHIFT, p[1] + SHIFT, p[2] if len(p) == 3 else math.nan) for p in (leg.start, leg.goals[0])]
        lines.append("query " + " ".join(repr(v) for p in poses for v in p))
    return "\n".join(lines) + "\n"


def verdicts_of(args: argparse.Namespace, scenario: Scenario, legs: list[query.Leg]) -> str:
    """A letter a leg: + has a way, ? none was found."""
    if args.store:
        lines = oracle_lines(scenario, legs)
        done = subprocess.run([args.oracle], input=lines, capture_output=True, text=True, check=True)
        letters = "".join("+" if line == "1" else "?" for line in done.stdout.split())
        STORE.write_text(json.dumps({"digest": zlib.crc32(lines.encode()), "legs": len(legs), "verdicts": letters}) + "\n")
    stored = json.loads(STORE.read_text())
    if len(legs) == stored["legs"] and zlib.crc32(oracle_lines(scenario, legs).encode()) != stored["digest"]:
        raise SystemExit("the stored verdicts are of other legs: --store makes them")
    return stored["verdicts"][: len(legs)]


def lower_bounds(args: argparse.Namespace, scenario: Scenario, legs: list[query.Leg]) -> list[float]:
    """The exact shortest way of the disc inside the body; nan: none."""
    x0, y0, x1, y1 = scenario.world.bounds
    lines = [f"radius {INNER}", f"bounds {x0 + INNER!r} {y0 + INNER!r} {x1 - INNER!r} {y1 - INNER!r}"]
    for p in scenario.world.polygons:
        lines.append(f"polygon {len(p.vertices)} " + " ".join(f"{x!r} {y!r}" for x, y in p.vertices.tolist()))
    lines += ["query " + " ".join(repr(float(v)) for v in (*leg.start[:2], *leg.goals[0][:2])) for leg in legs]
    told = peers.call([args.optimum], "\n".join(lines) + "\n")
    return [q["length"] if q["length"] is not None else math.nan for q in told["queries"]]


def p99(values: list[float]) -> float:
    ordered = sorted(values)
    return ordered[math.ceil(0.99 * len(ordered)) - 1] if ordered else math.nan


def print_answers(name: str, legs: list, answers: list, bounds: list[float], verdicts: str) -> bool:
    if not legs:
        return True
    ways = [a for a in answers if a.is_path]
    wrong = [(leg, a) for leg, a, v in zip(legs, answers, verdicts) if v == "+" and not a.is_path]
    unclear = [(leg, a) for leg, a in zip(legs, answers) if a.is_path and a.faults]
    ratios = [a.reply.length / b for a, b in zip(answers, bounds) if a.is_path and b > 0.5]
    ms, units = [a.ms for a in answers], [a.reply.work_units for a in answers]
    print(
        f"aisle, {name}: {len(legs)} asked, {verdicts.count('+')} have a way, {len(ways)} solved, {len(wrong)} refused "
        f"wrongly, {len(unclear)} unclear; length / bound: median {offline.median(ratios):.4f}, p99 {p99(ratios):.3f}, sum "
        f"{sum(a.reply.length for a in ways):.1f} m; ms: median {offline.median(ms):.2f}, p99 {p99(ms):.1f}; units: "
        f"median {offline.median(units):.0f}, p99 {p99(units)}"
    )
    for leg, a in wrong + unclear:
        print(f"  {leg.name}: {offline.why(a)}; {leg.start} to {leg.goals[0]}; {a.reply.work_units} units")
    return not wrong and not unclear


def build_peer() -> Path | None:
    program = peers.build_ompl()
    return None if program is None else program.with_name("ompl-poses")


def peer_lines(args: argparse.Namespace, scenario: Scenario, planner: str, answer: offline.Answer, seed: int) -> str:
    x0, y0, x1, y1 = scenario.world.bounds
    ends = answer.reply.waypoints[0], answer.reply.waypoints[-1]
    words: list = [planner, seed, x0, y0, x1, y1, RADIUS_MIN, args.cap, len(scenario.footprint)]
    words += [v for p in scenario.footprint for v in p] + [v for w in ends for v in (w.x, w.y, w.theta)]
    words.append(len(scenario.world.polygons))
    for p in scenario.world.polygons:
        words += [len(p.vertices), *p.vertices.ravel().tolist()]
    return " ".join(repr(w) if isinstance(w, float) else str(w) for w in words) + "\n"


def slipped(poses: np.ndarray) -> float:
    """m, that the origin moves at more than SLIP off the heading, forwards or backwards."""
    way = np.diff(poses[:, :2], axis=0)
    heading = poses[:-1, 2] + 0.5 * np.angle(np.exp(1j * np.diff(poses[:, 2])))
    along = way[:, 0] * np.cos(heading) + way[:, 1] * np.sin(heading)
    across = way[:, 1] * np.cos(heading) - way[:, 0] * np.sin(heading)
    return float(np.hypot(*way.T)[np.abs(across) > math.tan(SLIP) * np.abs(along)].sum())


def print_peers(
    args: argparse.Namespace, program: Path, scenario: Scenario, msg: object, legs: list, answers: list, bounds: list[float]
) -> None:
    obstacles, body = Obstacles(scenario.world), vehicle.body(msg)
    asked = [(a, b) for _, a, b in zip(legs, answers, bounds) if a.is_path and b > 0.5]
    own = [a.reply.length / b for a, b in asked]
    print(
        f"the same {len(asked)} legs: aisle ms median {offline.median([a.ms for a, _ in asked]):.2f}, length / bound median "
        f"{offline.median(own):.4f}, worst {max(own):.3f}; all clear"
    )
    for planner in PLANNERS:
        first_ms, first, last, unclear, none, beaten, driven = [], [], [], 0, 0, 0, 0
        for i, (answer, bound) in enumerate(asked):
            told = peers.call([program], peer_lines(args, scenario, planner, answer, i + 1))
            if told["first_ms"] is None:
                none += 1
                continue
            first_ms.append(told["first_ms"])
            first.append(told["first"] / bound)
            last.append(told["last"] / bound)
            gaps = [obstacles.clearances(body, np.array(told[k])).min() for k in ("first_poses", "last_poses")]
            unclear += min(gaps) < -1e-6
            shorter = told["last"] < answer.reply.length * (1.0 - 1e-6) and gaps[1] >= -1e-6
            beaten += shorter
            driven += shorter and slipped(np.array(told["last_poses"])) <= SLIP_LENGTH
        print(
            f"  OMPL {planner}: first path ms median {offline.median(first_ms):.2f}, p99 {p99(first_ms):.0f}, length / "
            f"bound {offline.median(first):.3f}; after {args.cap:g} s {offline.median(last):.4f}; none in time {none}; "
            f"not clear {unclear}; clear and shorter than aisle {beaten}, of these without slipping sideways {driven}"
        )
        sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main())
