#!/usr/bin/env python3
"""Why scenarios have no way, by brute force over the exact oracle: the widest gap and what to remove.

build/venv/bin/python tools/bench/closed.py [folder] [--check | --write]

Writes causes.json: for each leg without a way
  gap      2 * the largest radius of a disc that gets through, m (to 1e-7; the walls of the layout stay where they are);
           null: not even a disc of 2 mm does
  openers  all smallest sets of obstacles whose removal opens the way, one or two of them, as indices from 1 (the ids
           `aisle` gives them); empty: no two suffice
"""

from __future__ import annotations

import argparse
import itertools
import json
import sys
from pathlib import Path

import exact

LEAST_RADIUS = 0.001  # m
GAP_TOLERANCE = 1e-7  # m


def is_open(oracle: exact.Oracle, data: dict, leg: int, radius: float, without: tuple = ()) -> bool:
    """Bounds are those of the centre for the scenario's own radius: walls that stay for others."""
    shift = radius - float(data["robot"]["radius"])
    x0, y0, x1, y1 = data["bounds"]
    stops = [data["start"], *data["goals"]]
    changed = {
        "bounds": [x0 + shift, y0 + shift, x1 - shift, y1 - shift],
        "obstacles": [p for i, p in enumerate(data["obstacles"]) if i not in without],
        "start": stops[leg],
        "goals": [stops[leg + 1]],
    }
    return oracle.ask(exact.scenario_scene(changed, radius))["queries"][0]["result"] == "found"


def gap(oracle: exact.Oracle, data: dict, leg: int) -> float | None:
    low, high = LEAST_RADIUS, float(data["robot"]["radius"])
    if not is_open(oracle, data, leg, low):
        return None
    while high - low > 0.25 * GAP_TOLERANCE:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if is_open(oracle, data, leg, middle) else (low, middle)
    return round(2.0 * low, 7)


def openers(oracle: exact.Oracle, data: dict, leg: int) -> list[list[int]]:
    radius = float(data["robot"]["radius"])
    for size in (1, 2):
        sets = itertools.combinations(range(len(data["obstacles"])), size)
        found = [[i + 1 for i in s] for s in sets if is_open(oracle, data, leg, radius, s)]
        if found:
            return found
    return []


def of_folder(folder: Path, oracle: exact.Oracle) -> dict:
    made = {}
    for name, optimum in json.loads((folder / "optimum.json").read_text()).items():
        data = json.loads((folder / f"{name}.json").read_text())
        shut = [i for i, leg in enumerate(optimum["legs"]) if leg["lower"] is None]
        if shut:
            made[name] = [
                {"leg": i + 1, "gap": gap(oracle, data, i), "openers": openers(oracle, data, i)} for i in shut
            ]
            print(f"{name}: {made[name]}", file=sys.stderr)
    return made


def same(a: dict, b: dict) -> bool:
    gaps = (a["gap"], b["gap"])
    near = gaps[0] == gaps[1] if None in gaps else abs(gaps[0] - gaps[1]) <= 2.0 * GAP_TOLERANCE
    return near and (a["leg"], a["openers"]) == (b["leg"], b["openers"])


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path, nargs="?", default=exact.ROOT / "tests" / "data" / "generated_closed")
    parser.add_argument("--program", type=Path, default=exact.PROGRAM, help="optimum")
    parser.add_argument("--check", action="store_true", help="against the folder's causes.json")
    parser.add_argument("--write", action="store_true", help="the folder's causes.json")
    args = parser.parse_args()
    file = args.folder / "causes.json"
    with exact.Oracle(args.program) as oracle:
        made = of_folder(args.folder, oracle)
    if args.write:
        file.write_text("{\n" + ",\n".join(f" {json.dumps(k)}: {json.dumps(v)}" for k, v in made.items()) + "\n}\n")
    if args.check:
        given = json.loads(file.read_text())
        alike = made.keys() == given.keys() and all(
            len(made[k]) == len(given[k]) and all(map(same, made[k], given[k])) for k in made
        )
        print(f"{len(made)} of {args.folder.name} {'as' if alike else 'NOT as'} in causes.json")
        return 0 if alike else 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
