#!/usr/bin/env python3
"""Generated polygon scenarios and their optima, in the format of tests/data/scenarios: the same seed, the same files.

build/venv/bin/python tools/bench/generate.py FOLDER [--seed 1] [--set standard|closed|barriers] [--count N]

standard: clutter (convex polygons of 3 to 8 corners, many overlap), boxes (turned, overlapping), aisles (racks, straight
or slanted), rooms (walls, doors, furniture), slits (the only way or the shorter one, wider than the disc by 1, 3 and
10 %): every leg has a way, and but for slits none that a millimetre more radius would close. closed: slits narrower
than the disc by 0.1, 1 and 3 %, goals walled in: no leg has one (null in optimum.json; optimum_table.py knows that).
barriers: one to eight walls across, each with one or two openings. --count: rounds of a set, each of a seed of its own, for larger trials.
"""

from __future__ import annotations

import argparse
import json
import math
import random
import sys
from pathlib import Path

import exact
import numpy as np

TRIES = 200
MORE_RADIUS, MORE_LENGTH = 1e-3, 1.002  # a scenario is kept if so much more radius costs at most so much length
END_ROOM = 0.02  # m, of ends beyond the radius
Polygon = list  # of [x, y]


def rounded(points: list) -> Polygon:
    return [[round(x, 4), round(y, 4)] for x, y in points]


def is_convex(p: Polygon) -> bool:
    turns = []
    for a, b, c in zip(p, p[1:] + p[:1], p[2:] + p[:2]):
        turns.append((b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]))
    return min(turns) > 1e-7


def convex(rng: random.Random, x: float, y: float, size: float) -> Polygon:
    """3 to 8 corners on an ellipse, counter-clockwise."""
    while True:
        n, flat, turn = rng.randint(3, 8), rng.uniform(0.4, 1.0), rng.uniform(0.0, 2.0 * math.pi)
        angles = sorted(rng.uniform(0.0, 2.0 * math.pi) for _ in range(n))
        ring = [(size * math.cos(a), size * flat * math.sin(a)) for a in angles]
        made = rounded([turned(p, turn, x, y) for p in ring])
        if is_convex(made):
            return made


def turned(p: tuple, angle: float, x: float, y: float) -> tuple:
    c, s = math.cos(angle), math.sin(angle)
    return x + c * p[0] - s * p[1], y + s * p[0] + c * p[1]


def radius_of(rng: random.Random, low: float, high: float) -> float:
    return round(rng.uniform(low, high), 3)


def box(x0: float, y0: float, x1: float, y1: float) -> Polygon:
    return rounded([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])


def turned_box(x: float, y: float, length: float, width: float, angle: float) -> Polygon:
    corners = [(-length, -width), (length, -width), (length, width), (-length, width)]
    return rounded([turned((0.5 * a, 0.5 * b), angle, x, y) for a, b in corners])


# Each family: (rng, how much) -> side lengths, radius, obstacles, ends or None for random ones.


def clutter(rng: random.Random, count: int) -> tuple:
    side, radius, share = rng.uniform(20.0, 60.0), radius_of(rng, 0.2, 0.5), rng.uniform(0.2, 0.5)
    size = math.sqrt(share * side * side / count) * 0.8
    polygons = [
        convex(rng, rng.uniform(0.0, side), rng.uniform(0.0, side), size * rng.uniform(0.5, 1.5)) for _ in range(count)
    ]
    return (side, side), radius, polygons, None


def boxes(rng: random.Random, count: int) -> tuple:
    side, radius, share = rng.uniform(20.0, 60.0), radius_of(rng, 0.2, 0.5), rng.uniform(0.15, 0.4)
    size = math.sqrt(share * side * side / count)
    polygons = [
        turned_box(
            rng.uniform(0.0, side),
            rng.uniform(0.0, side),
            size * rng.uniform(0.8, 2.5),
            size * rng.uniform(0.2, 0.8),
            rng.choice((0.0, 0.25 * math.pi, rng.uniform(0.0, math.pi))),
        )
        for _ in range(count)
    ]
    return (side, side), radius, polygons, None


def aisles(rng: random.Random, rows: int) -> tuple:
    radius, depth = radius_of(rng, 0.3, 0.6), rng.uniform(0.8, 1.6)
    aisle = 2.0 * radius * rng.uniform(1.3, 2.5)
    height, width = rows * (depth + aisle) + 4.0, rng.uniform(25.0, 60.0)
    angle = rng.choice((0.0, 0.0, rng.uniform(-0.5, 0.5)))
    polygons = []
    for row in range(rows):
        y = (row + 0.5) * (depth + aisle) - 0.5 * rows * (depth + aisle)
        x = rng.uniform(2.0, 4.0)
        while x < width - 4.0:
            length = rng.uniform(3.0, 12.0)
            length = min(length, width - 2.5 - x)
            cx, cy = turned((x + 0.5 * length - 0.5 * width, y), angle, 0.5 * width, 0.5 * height)
            polygons.append(turned_box(cx, cy, length, depth, angle))
            x += length + (aisle if rng.random() < 0.5 else 0.0)  # without a gap: they touch
    return (width, height), radius, polygons, None


def wall_with_doors(rng: random.Random, ends: tuple, doors: list, half: float, upright: bool) -> list:
    """From ends[0] to ends[1] along an axis, at ends[2] across it; doors are (middle, width)."""
    out, at = [], ends[0]
    for middle, width in [*sorted(doors), (ends[1] + 1e9, 0.0)]:
        to = min(middle - 0.5 * width, ends[1])
        if to > at:
            out.append(box(ends[2] - half, at, ends[2] + half, to) if upright else box(at, ends[2] - half, to, ends[2] + half))
        at = middle + 0.5 * width
    return out


def rooms(rng: random.Random, columns: int) -> tuple:
    radius, size, half = radius_of(rng, 0.25, 0.4), rng.uniform(5.0, 8.0), rng.uniform(0.05, 0.15)
    lines = max(2, columns - rng.randint(0, 1))
    polygons = []
    for upright, across, along in ((True, columns, lines), (False, lines, columns)):
        for i in range(1, across):
            doors = []
            for k in range(along):
                if rng.random() < 0.7:
                    width = 2.0 * radius * rng.uniform(1.1, 2.2)
                    doors.append((k * size + rng.uniform(1.0 + width, size - 1.0 - width), width))
            polygons += wall_with_doors(rng, (-1.0, along * size + 1.0, i * size), doors, half, upright)
    for i in range(columns):
        for k in range(lines):
            for _ in range(rng.randint(0, 3)):
                x, y = (i + rng.uniform(0.2, 0.8)) * size, (k + rng.uniform(0.2, 0.8)) * size
                angle = rng.choice((0.0, 0.5 * math.pi, rng.uniform(0.0, math.pi)))
                polygons.append(turned_box(x, y, rng.uniform(0.5, 2.0), rng.uniform(0.4, 1.0), angle))
    return (columns * size, lines * size), radius, polygons, None


def slits(rng: random.Random, excess: float, detour: bool, walls: int = 3) -> tuple:
    """Walls across, each with a slit wider than the disc by the share `excess`; detour: a wide gap farther off."""
    side, radius = 20.0, radius_of(rng, 0.2, 0.5)
    polygons = []
    for i in range(walls):
        x, width = side / (walls + 1) * (i + 1) + rng.uniform(-1.0, 1.0), 2.0 * radius * (1.0 + excess)
        doors = [(rng.uniform(2.0, 11.0), width)] + ([(17.5, 4.0 * radius + 1.0)] if detour else [])
        polygons += wall_with_doors(rng, (-1.0, side + 1.0, x), doors, rng.uniform(0.1, 0.4), True)
    for _ in range(6):
        polygons.append(convex(rng, rng.uniform(1.0, side), rng.uniform(14.5, 16.0), rng.uniform(0.3, 0.8)))
    ends = [[1.0, 1.0], [round(side - 1.0, 4), round(rng.uniform(1.0, 9.0), 4)], [1.5, round(rng.uniform(6.0, 12.0), 4)]]
    return (side, side), radius, polygons, ends


def barriers(rng: random.Random, layers: int) -> tuple:
    """Walls across, evenly, each with one or two openings; the ends of barrier_1 to 4."""
    side, radius, polygons = 15.0, 0.3, []
    for i in range(layers):
        doors: list = []
        while len(doors) < 1 + (rng.random() < 0.3):
            width = 2.0 * radius * rng.uniform(1.3, 2.5)
            middle = rng.uniform(0.5 + 0.5 * width, side - 0.5 - 0.5 * width)
            if all(abs(middle - m) > width + w for m, w in doors):
                doors.append((middle, width))
        polygons += wall_with_doors(rng, (-1.0, side + 1.0, side / (layers + 1) * (i + 1)), doors, 0.15, True)
    return (side, side), radius, polygons, [[0.0, 1.0], [15.0, 9.0]]


def walled_in(rng: random.Random, count: int) -> tuple:
    """A ring of overlapping boxes round the goal, clutter elsewhere."""
    side, radius, x, y = 20.0, radius_of(rng, 0.2, 0.4), 14.0, 13.0
    polygons = []
    for i in range(12):
        a = 2.0 * math.pi * i / 12
        polygons.append(turned_box(x + 3.0 * math.cos(a), y + 3.0 * math.sin(a), 1.8, 0.4, a + 0.5 * math.pi))
    for _ in range(count):
        polygons.append(convex(rng, rng.uniform(2.0, 18.0), rng.uniform(2.0, 8.0), rng.uniform(0.3, 1.0)))
    return (side, side), radius, polygons, [[1.0, 1.0], [x, y]]


LAYERS_MAX = 8
STANDARD = [
    *[("clutter", clutter, (n,)) for n in (10, 15, 20, 30, 40, 60, 80, 100, 130, 160, 220, 300)],
    *[("boxes", boxes, (n,)) for n in (12, 20, 30, 50, 80, 120)],
    *[("aisles", aisles, (n,)) for n in (3, 4, 5, 6, 7, 8, 9, 12)],
    *[("rooms", rooms, (n,)) for n in (3, 3, 4, 4, 5, 5, 6, 7)],
    *[("slits", slits, (share, detour)) for share in (0.01, 0.03, 0.1) for detour in (False, True)],
]
CLOSED = [
    *[("closed", slits, (share, False, walls)) for share, walls in ((-0.001, 1), (-0.01, 2), (-0.03, 3))],
    *[("walled", walled_in, (n,)) for n in (0, 10, 30)],
]

BARRIERS = [("barriers", barriers, (n,)) for n in range(1, LAYERS_MAX + 1)]
SETS = {"standard": STANDARD, "closed": CLOSED, "barriers": BARRIERS}


def room_at(polygons: list, x: float, y: float) -> float:
    """Distance to the nearest polygon, 0 inside."""
    nearest, p = math.inf, np.array([x, y])
    for polygon in polygons:
        a = np.array(polygon)
        edge, to = np.roll(a, -1, axis=0) - a, p - a
        if (edge[:, 0] * to[:, 1] - edge[:, 1] * to[:, 0] >= 0.0).all():
            return 0.0
        f = np.clip((to * edge).sum(axis=1) / (edge * edge).sum(axis=1), 0.0, 1.0)
        nearest = min(nearest, float(np.hypot(*(to - f[:, None] * edge).T).min()))
    return nearest


def random_ends(rng: random.Random, sides: tuple, radius: float, polygons: list) -> list | None:
    """Near two corners, then anywhere; neighbours 0.4 of a side or more apart."""
    ends: list = []
    for _ in range(400):
        w, h = sides
        spans = [((0.5, 0.15 * w), (0.5, 0.15 * h)), ((0.85 * w, w - 0.5), (0.85 * h, h - 0.5))]
        (x0, x1), (y0, y1) = spans[len(ends)] if len(ends) < 2 else ((0.5, w - 0.5), (0.5, h - 0.5))
        x, y = round(rng.uniform(x0, x1), 4), round(rng.uniform(y0, y1), 4)
        far = not ends or math.hypot(x - ends[-1][0], y - ends[-1][1]) > 0.4 * max(w, h)
        if far and room_at(polygons, x, y) > radius + END_ROOM:
            ends.append([x, y])
        if len(ends) == 4:
            return ends
    return None


def one(family: str, make: object, arguments: tuple, seed: str, program: Path) -> tuple[dict, dict]:
    """(scenario, optimum) by the first of TRIES tries that serves."""
    for attempt in range(TRIES):
        rng = random.Random(f"{seed} {attempt}")
        sides, radius, polygons, ends = make(rng, *arguments)  # type: ignore[operator]
        ends = ends or random_ends(rng, sides, radius, polygons)
        if ends is None:
            continue
        data = {
            "family": family,
            "bounds": [0, 0, round(sides[0], 4), round(sides[1], 4)],
            "robot": {"radius": radius},
            "start": ends[0],
            "goals": ends[1:],
            "obstacles": polygons,
        }
        optimum = exact.scenario_optimum(program, data, radius)
        if serves(family, data, optimum, program):
            return data, optimum
    raise SystemExit(f"{family} {arguments}: no try of {TRIES} serves")


def serves(family: str, data: dict, optimum: dict, program: Path) -> bool:
    if any(room_at(data["obstacles"], *p) < data["robot"]["radius"] for p in (data["start"], *data["goals"])):
        return False
    lengths = [leg["lower"] for leg in optimum["legs"]]
    if family in ("closed", "walled"):
        return all(length is None for length in lengths)
    if any(length is None for length in lengths):
        return False
    if family == "slits":
        return True
    wider = exact.scenario_optimum(program, data, data["robot"]["radius"] + MORE_RADIUS)["legs"]
    return all(w["lower"] is not None and w["lower"] <= MORE_LENGTH * a for w, a in zip(wider, lengths))


def text_of(name: str, data: dict) -> str:
    """One obstacle a line."""
    head = {"name": name, **{k: v for k, v in data.items() if k != "obstacles"}}
    rows = ",\n  ".join(json.dumps(p) for p in data["obstacles"])
    return json.dumps(head, indent=1)[:-2] + ',\n "obstacles": [\n  ' + rows + "\n ]\n}\n"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--set", choices=sorted(SETS), default="standard")
    parser.add_argument("--count", type=int, default=1, metavar="N", help="rounds")
    parser.add_argument("--program", type=Path, default=exact.PROGRAM, help="optimum")
    args = parser.parse_args()
    args.folder.mkdir(parents=True, exist_ok=True)
    optima, number = {}, {}
    for i in range(args.count):
        for k, (family, make, arguments) in enumerate(SETS[args.set]):
            number[family] = number.get(family, 0) + 1
            name = f"{family}_{number[family]:02d}"
            data, optima[name] = one(family, make, arguments, f"{args.seed + i} {k}", args.program)
            (args.folder / f"{name}.json").write_text(text_of(name, data))
            print(f"{name}: {len(data['obstacles'])} obstacles, {optima[name]['upper']}", flush=True)
    (args.folder / "optimum.json").write_text(json.dumps(dict(sorted(optima.items())), indent=1) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
