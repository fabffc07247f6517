#!/usr/bin/env python3
"""Rack halls closed on purpose: is every refusal proved, with the right cause, gap, obstacle and what would open it?

build/venv/bin/python tools/bench/closed_halls.py [--halls 60] [--check] [--failures FILE] [--no-times]

A row a way of closing, for three vehicles and drawn aisles; four queries a hall, to the place closed in and out of it, with
and without headings. The judge is the exact oracle of a disc (tests/support/optimum.h), for the disc inside the body with
its margin: "gap" is the diameter of the largest disc that gets through, to 1e-7 m, the bounds left where they are (none
below 2 mm: shut), "openers" what opens the way if it alone is removed, by trying each polygon.
Right is NO_PATH with the goal's id where it is shut; else TOO_NARROW with the gap to 1 mm, cause_id and the two obstacles
told, each at a place on it, as far apart; a set told to open the way is one of the oracle's. In "bend" the disc gets through and the
body does not, which its length alone proves: KINEMATIC.
"cause", "gap", "ids": refusals that are right in that; "told": refusals of those that one obstacle opens (the next number)
that told one which does. --check: exit 1 on a path, a refusal that is not right, or one that does not tell what would open the way.
"""

from __future__ import annotations

import argparse
import math
import random
import sys
from dataclasses import dataclass, field, replace
from pathlib import Path

import closed
import exact
import offline
import rack_halls
from aisle import path_t, status_t, waypoint_t
from aisle_tools import names, query, vehicle
from rack_halls import HEIGHT, MARGIN, RACK, STEP, WIDTH, Floor, Hall, Vehicle
from shapely.geometry import Point, box
from shapely.geometry.base import BaseGeometry

WITHIN = 1e-3  # m
QUERIES = 4
BOUNDS_ID = -2
LACKING = (0.001, 0.003, 0.01, 0.03, 0.1, 0.3)  # m, that a gap is too narrow by
COUNTS = ("asked", "refused", "cause", "gap", "ids", "told", "one opens")


@dataclass
class Closed:
    """A hall and the ground that nothing leads to: (x0, y0, x1, y1)."""

    hall: Hall
    inside: tuple
    kind: str
    passes: bool = False  # the disc inside the body does


@dataclass
class Verdict:
    gap: float | None  # m; None: shut
    openers: list = field(default_factory=list)  # ids


def reach_of(body: Vehicle) -> float:
    return min(min(abs(x), abs(y)) for x, y in body.footprint) + MARGIN


def racks(rng: random.Random, body: Vehicle, low: float = 1.4) -> tuple[list, float, float]:
    """Racks with aisles between them and cross aisles: boxes, the aisles' width and the cross aisles'."""
    aisle = round(rng.uniform(low, body.aisles[1]), 2)
    cross = round(rng.uniform(2.6, 4.0), 2)
    boxes, x = [], 0.0
    while x + aisle + RACK + 1.2 < WIDTH:
        x = round(x + aisle, 3)
        boxes.append((x, cross, round(x + RACK, 3), round(HEIGHT - cross, 3)))
        x = round(x + RACK, 3)
    return boxes, aisle, cross


def an_aisle(rng: random.Random, boxes: list) -> tuple:
    """Left and right side of one between two racks, and its ends."""
    i = rng.randrange(len(boxes) - 1)
    return boxes[i][2], boxes[i + 1][0], boxes[i][1], boxes[i][3]


def pallets(rng: random.Random, body: Vehicle, lacking: float) -> Closed:
    """An aisle with a pallet across at either end; one leaves a gap that wants so much, the other none. 0: both shut."""
    boxes, aisle, cross = racks(rng, body)
    left, right, low, high = an_aisle(rng, boxes)
    gap = 2.0 * reach_of(body) - lacking if lacking > 0.0 else 0.0
    ends = [(low, round(low + 0.8, 3)), (round(high - 0.8, 3), high)]
    rng.shuffle(ends)
    side = (left + gap, right) if rng.random() < 0.5 else (left, right - gap)
    boxes += [(side[0], ends[0][0], side[1], ends[0][1]), (left, ends[1][0], right, ends[1][1])]
    return Closed(Hall(0, body, aisle, boxes), (left, low + 0.8, right, high - 0.8), "pallets")


def cage(rng: random.Random, body: Vehicle, lacking: float) -> Closed:
    """Four walls around a place in an empty hall, one ending before the next if something is to be lacking."""
    side = round(rng.uniform(3.4, 5.0), 2)
    x, y = round(rng.uniform(2.0, WIDTH - side - 2.0), 2), round(rng.uniform(2.0, HEIGHT - side - 2.0), 2)
    gap = 2.0 * reach_of(body) - lacking if lacking > 0.0 else 0.0
    t = 0.2
    boxes = [
        (x - t, y - t, x + side + t, y),
        (x - t, y + side, x + side + t, y + side + t),
        (x - t, y, x, y + side),
        (x + side, y, x + side + t, y + side - gap),
    ]
    for _ in range(rng.randint(0, 3)):  # what has no part in it
        px, py = round(rng.uniform(0.0, WIDTH - 1.2), 2), round(rng.choice((0.0, HEIGHT - 0.8)), 2)
        boxes.append((px, py, px + 1.2, py + 0.8))
    return Closed(Hall(0, body, side, boxes), (x, y, x + side, y + side), "cage")


def door(rng: random.Random, body: Vehicle, lacking: float) -> Closed:
    """A wall through the hall with one door; the racks stand on one side of it."""
    x = round(rng.uniform(5.0, 8.0), 2)
    y = round(rng.uniform(1.0, HEIGHT - 3.0), 2)
    gap = 2.0 * reach_of(body) - lacking if lacking > 0.0 else 0.0
    boxes = [(x, 0.0, x + 0.2, y), (x, y + gap, x + 0.2, HEIGHT)]
    at = x + 4.0
    while at + RACK + 3.0 < WIDTH:
        boxes.append((at, 4.0, at + RACK, HEIGHT - 4.0))
        at += RACK + rng.uniform(1.4, 3.0)
    return Closed(Hall(0, body, gap, boxes), (0.0, 0.0, x, HEIGHT), "door")


def wall_gap(rng: random.Random, body: Vehicle, lacking: float) -> Closed:
    """The gap is between a wall and the hall's own: its other side has the bounds' id."""
    x = round(rng.uniform(5.0, WIDTH - 8.0), 2)
    gap = 2.0 * reach_of(body) - max(lacking, LACKING[0])
    top = rng.random() < 0.5
    boxes = [(x, 0.0, x + 0.3, HEIGHT - gap) if top else (x, gap, x + 0.3, HEIGHT)]
    return Closed(Hall(0, body, gap, boxes), (0.0, 0.0, x, HEIGHT), "bounds")


def bend(rng: random.Random, body: Vehicle, _lacking: float) -> Closed:
    """A corridor of right angles, 0.1 m wider than the body with its margins: no body of twice its width turns there.

    Through a right angle between corridors of width w a body of width b and length l gets only if l <= 2 sqrt(2) w - 2 b.
    """
    b = 2.0 * reach_of(body)
    w = b + 0.1
    length = body.footprint[1][0] - body.footprint[0][0]
    assert length > 2.0 * math.sqrt(2.0) * w - 2.0 * b
    x = round(rng.uniform(5.0, 9.0), 2)
    low = round(rng.uniform(2.0, 4.0), 2)
    high = HEIGHT - 2.0
    boxes = [  # in at (x, low + w / 2), up, and out to the right at the upper end
        (x, 0.0, x + 3.0 + w, low),
        (x, low + w, x + 3.0, HEIGHT),
        (x + 3.0 + w, 0.0, x + 8.0, high - w),
        (x + 3.0, high, x + 8.0, HEIGHT),
    ]
    return Closed(Hall(0, body, w, boxes), (0.0, 0.0, x, HEIGHT), "bend", True)


KINDS = (pallets, cage, door, wall_gap, bend)


def draw(seed: int) -> tuple[Closed, list[query.Leg]]:
    """The seed's hall and queries."""
    rng = random.Random(seed)
    body = rack_halls.VEHICLES[seed % len(rack_halls.VEHICLES)]
    kind = KINDS[seed // len(rack_halls.VEHICLES) % len(KINDS)]
    lacking = rng.choice((0.0, *LACKING))
    while True:
        made = kind(rng, body, lacking)
        made.hall = replace(made.hall, seed=seed, boxes=[tuple(round(v, 4) for v in b) for b in made.hall.boxes])
        stops = draw_stops(rng, made)
        if stops is not None:
            break
    legs = []
    for i in range(QUERIES):
        inside, outside = stops[i]
        goal = inside if i % 2 == 0 else outside
        start = outside if i % 2 == 0 else inside
        legs.append(query.Leg(f"{seed}/{i}", start, [goal if i < 2 else goal[:2]]))
    return made, legs


def draw_stops(rng: random.Random, made: Closed) -> list | None:
    """Pairs of a free pose inside and one outside; None: too little room."""
    floor = Floor(made.hall)
    x0, y0, x1, y1 = made.inside
    inner, pairs = box(x0, y0, x1, y1), []
    for _ in range(QUERIES):
        found: dict[bool, tuple] = {}
        for _ in range(4000):
            wanted = True not in found
            area = (x0, y0, x1, y1) if wanted else (0.0, 0.0, WIDTH, HEIGHT)
            x, y = (round(STEP * round(rng.uniform(a, b) / STEP), 2) for a, b in ((area[0], area[2]), (area[1], area[3])))
            pose = x, y, 0.5 * math.pi * rng.choice((-1, 0, 1, 2))
            shape = rack_halls.placed(made.hall.vehicle, pose)
            apart = inner.contains(shape) if wanted else not inner.intersects(shape)
            if made.passes and not wanted:
                apart = apart and x > made.hall.boxes[-1][2] + 0.5
            if apart and floor.is_free(pose):
                found[wanted] = pose
                if len(found) == 2:
                    break
        if len(found) < 2:
            return None
        pairs.append((found[True], found[False]))
    return pairs


def verdict_of(oracle: exact.Oracle, made: Closed, leg: query.Leg) -> Verdict:
    reach = reach_of(made.hall.vehicle)
    data = {
        "robot": {"radius": reach},
        "bounds": [reach, reach, WIDTH - reach, HEIGHT - reach],
        "obstacles": [[[x0, y0], [x1, y0], [x1, y1], [x0, y1]] for x0, y0, x1, y1 in made.hall.boxes],
        "start": list(leg.start[:2]),
        "goals": [list(leg.goals[0][:2])],
    }
    if closed.is_open(oracle, data, 0, reach):
        return Verdict(2.0 * reach)
    each = range(len(data["obstacles"]))
    return Verdict(closed.gap(oracle, data, 0), [i + 1 for i in each if closed.is_open(oracle, data, 0, reach, (i,))])


def shape_of(hall: Hall, ident: int) -> BaseGeometry:
    return Floor(hall).walls if ident == BOUNDS_ID else box(*hall.boxes[ident - 1])


def sides_fault(made: Closed, reply: path_t, gap: float) -> str | None:
    """Both obstacles of the gap are told, each at a place that is on it, so far apart as the gap is wide."""
    sides = [w for w in reply.waypoints[1:] if not w.flags & waypoint_t.GOAL]
    told = [w.goal_id for w in sides]
    if len(sides) != 2 or reply.cause_id != told[0] or 0 in told:
        return f"sides {told}, cause_id {reply.cause_id}"
    off = max(shape_of(made.hall, w.goal_id).distance(Point(w.x, w.y)) for w in sides)
    apart = math.dist((sides[0].x, sides[0].y), (sides[1].x, sides[1].y))
    if off > WITHIN or abs(apart - gap) > WITHIN:
        return f"sides {told} are told {apart:.4f} m apart, {off:.4f} m off them"
    return None


def judge(made: Closed, verdict: Verdict, answer: offline.Answer, row: dict) -> str | None:
    """Counts an answer; what is wrong with it."""
    reply = answer.reply
    row["asked"] += 1
    row["ms"].append(answer.ms)
    if answer.is_path:
        return "a path"
    row["refused"] += 1
    shut = verdict.gap is None
    right = status_t.KINEMATIC if made.passes else status_t.NO_PATH if shut else status_t.TOO_NARROW
    if reply.cause != right:
        gap = "shut" if shut else f"gap {verdict.gap:.4f}"
        return f"{names.reason(reply)}, right is {names.cause_name(right)}, {gap}"
    row["cause"] += 1
    fault = None
    if right == status_t.TOO_NARROW:
        good = abs(reply.cause_value - verdict.gap) <= WITHIN
        row["gap"] += good
        fault = None if good else f"gap {reply.cause_value:.4f}, right is {verdict.gap:.4f}"
        named = sides_fault(made, reply, verdict.gap)
    else:
        row["gap"] += 1
        named = None if right != status_t.NO_PATH or reply.cause_id == 1 else f"cause_id {reply.cause_id}"
    row["ids"] += named is None
    told = [w.goal_id for w in reply.waypoints if w.flags & waypoint_t.GOAL] if right != status_t.KINEMATIC else []
    row["one opens"] += bool(verdict.openers)
    row["told"] += len(told) == 1 and told[0] in verdict.openers
    wrong = f"{told} would open it, not one of {verdict.openers}" if told and told[0] not in verdict.openers else None
    return fault or named or wrong


def main() -> int:
    args = parse()
    rows: dict[str, dict] = {}
    failures = []
    with exact.Oracle(args.optimum) as oracle:
        for seed in range(args.halls):
            made, legs = draw(seed)
            legs = legs[: args.bends] if made.passes else legs
            row = rows.setdefault(made.kind, {"ms": []} | dict.fromkeys(COUNTS, 0))
            answers = offline.answers(args, made.hall.world, vehicle.make(made.hall.vehicle.values), legs, not args.no_times)
            for leg, answer in zip(legs, answers):
                fault = judge(made, verdict_of(oracle, made, leg), answer, row)
                if fault is not None:
                    what = f"{leg.name} {made.kind}, {made.hall.vehicle.name}: {fault}"
                    failures.append(f"{what}; {leg.start} to {leg.goals[0]}")
    if args.failures is not None:
        args.failures.write_text("".join(line + "\n" for line in failures))
    good = print_rows(rows)
    for line in failures:
        print(line, file=sys.stderr)
    return 0 if (good and not failures) or not args.check else 1


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    offline.add_options(parser, offline.ROOT / "tests" / "data" / "scenarios")
    parser.add_argument("--optimum", type=Path, default=exact.PROGRAM, metavar="PROGRAM", help="the oracle")
    parser.add_argument("--halls", type=int, default=60, help=f"{QUERIES} queries each")
    parser.add_argument("--bends", type=int, default=QUERIES, help="queries of a hall of kind bend, which take seconds each")
    parser.add_argument("--no-times", action="store_true", help="no milliseconds")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--failures", type=Path, metavar="FILE")
    parser.set_defaults(objective="shortest")
    return parser.parse_args()


def print_rows(rows: dict) -> bool:
    print(f"{'closed by':<10} " + " ".join(f"{k:>9}" for k in COUNTS) + f" {'ms':>8} {'p99':>8}")
    everything = {"ms": []} | dict.fromkeys(COUNTS, 0)
    for kind, row in [*sorted(rows.items()), ("all", everything)]:
        ms = sorted(row["ms"])
        print(
            f"{kind:<10} " + " ".join(f"{row[k]:9d}" for k in COUNTS)
            + f" {offline.median(ms):8.2f} {ms[math.ceil(0.99 * len(ms)) - 1]:8.1f}"
        )
        if row is not everything:
            for key, value in row.items():
                everything[key] += value
    right = all(everything["asked"] == everything[k] for k in ("refused", "cause", "gap", "ids"))
    return right and everything["told"] == everything["one opens"]


if __name__ == "__main__":
    sys.exit(main())
