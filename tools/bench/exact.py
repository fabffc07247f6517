#!/usr/bin/env python3
"""Exact shortest paths by the program `optimum` (tests/support/optimum_main.c); writes a folder's optimum.json.

build/venv/bin/python tools/bench/exact.py scenarios [folder] [--check | --write]
build/venv/bin/python tools/bench/exact.py maps [folder] [--check | --write] [--radius 0.3]

--check: the folder's optimum.json is reproduced to 1e-5 m; --write: writes it. Without either the lengths are printed.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from aisle_tools import query, rosmap
from aisle_tools.world import World

ROOT = Path(__file__).resolve().parent.parent.parent
PROGRAM = ROOT / "build" / "release" / "optimum"
TOLERANCE = 1e-5  # m, between two makers of an optimum.json
SLACK = 3e-8  # m: the optimum lies so near the length the program prints


def ask(program: Path, scene: list[str], timeout: float | None = None) -> dict:
    done = subprocess.run(
        [str(program)], input="\n".join(scene) + "\n", capture_output=True, text=True, check=False, timeout=timeout
    )
    if done.returncode != 0:
        sys.exit(f"{program}: exit {done.returncode}\n{done.stderr}")
    return json.loads(done.stdout)


class Oracle:
    """The program kept running, for many small scenes; a context manager."""

    def __init__(self, program: Path) -> None:
        self.process = subprocess.Popen([str(program)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def __enter__(self) -> Oracle:
        return self

    def __exit__(self, *_: object) -> None:
        self.process.stdin.close()
        self.process.wait()

    def ask(self, scene: list[str]) -> dict:
        self.process.stdin.write("\n".join(scene) + "\ndone\n")
        self.process.stdin.flush()
        lines = []
        while not lines or lines[-1] != "]}\n":
            lines.append(self.process.stdout.readline())
            if not lines[-1]:
                sys.exit(f"{self.process.args[0]}: exit {self.process.wait()}")
        return json.loads("".join(lines))


def numbers(*values: float) -> str:
    return " ".join(repr(float(v)) for v in values)


def scenario_scene(data: dict, radius: float) -> list[str]:
    """A scenario file's legs, for a disc of this radius."""
    scene = [f"radius {radius!r}", f"bounds {numbers(*data['bounds'])}"]
    scene += [f"polygon {len(p)} {numbers(*np.ravel(p))}" for p in data["obstacles"]]
    stops = [data["start"], *data["goals"]]
    return scene + [f"query {numbers(*a[:2], *b[:2])}" for a, b in zip(stops, stops[1:])]


def scenario_optimum(program: Path, data: dict, radius: float) -> dict:
    """An entry of optimum.json; lengths null where there is no way."""
    answers = ask(program, scenario_scene(data, radius))["queries"]
    stops = [np.array(p[:2]) for p in (data["start"], *data["goals"])]
    legs = [
        {**bounds(a["length"]), "straight": round(float(np.hypot(*(q - p))), 9)}
        for a, p, q in zip(answers, stops, stops[1:])
    ]
    whole = all(a["length"] is not None for a in answers)
    return {
        "radius": radius,
        "lower": round(sum(leg["lower"] for leg in legs), 10) if whole else None,
        "upper": round(sum(leg["upper"] for leg in legs), 10) if whole else None,
        "legs": legs,
    }


def bounds(length: float | None) -> dict:
    if length is None:
        return {"lower": None, "upper": None}
    return {"lower": round(length - SLACK, 10), "upper": round(length + SLACK, 10)}


def of_scenarios(args: argparse.Namespace) -> dict:
    made = {}
    for path in sorted(args.folder.glob("*.json")):
        if path.name in ("optimum.json", "causes.json") or (args.only and path.stem not in args.only):
            continue
        data, began = json.loads(path.read_text()), time.monotonic()
        robot = data["robot"]
        made[path.stem] = scenario_optimum(args.program, data, float(robot.get("radius", 0.0)))
        if "inner_radius" in robot:
            inner = scenario_optimum(args.program, data, float(robot["inner_radius"]))
            made[path.stem]["inner"] = {k: inner[k] for k in ("radius", "legs")}
        print(f"{path.stem:<24} {made[path.stem]['upper']} {time.monotonic() - began:.2f} s", file=sys.stderr)
    return made


def map_scene(world: World, radius: float, legs: list[query.Leg], image: Path) -> list[str]:
    """Legs on a grid; unknown cells are occupied. The image is written for the program."""
    grid = world.grid
    free = (~grid.occupied[::-1]).astype(np.uint8) * 255
    image.write_bytes(b"P5\n%d %d\n255\n" % free.shape[::-1] + free.tobytes())
    scene = [f"radius {radius!r}", f"grid {image} {numbers(grid.origin_x, grid.origin_y, grid.resolution)}"]
    for leg in legs:
        scene += [f"upper {leg.given_length * 1.0001!r}"] if leg.given_length > 0.0 else []
        scene.append(f"query {numbers(*leg.start[:2], *leg.goals[0][:2])}")
    return scene


def of_maps(args: argparse.Namespace) -> dict:
    made = {}
    for path in sorted(args.folder.glob("*.yaml")):
        if args.only and path.stem not in args.only:
            continue
        world = rosmap.read_world(path, True, rosmap.CELLS_MAX)
        legs = query.read_goals(path.with_suffix(".goals.csv"))
        began = time.monotonic()
        with tempfile.TemporaryDirectory() as folder:
            scene = map_scene(world, args.radius, legs, Path(folder) / "map.pgm")
            answer = ask(args.program, scene)
        spent = time.monotonic() - began
        made[path.stem] = {"radius": args.radius, "legs": [bounds(a["length"]) for a in answer["queries"]]}
        print(f"{path.stem:<24} {answer['arcs']} arcs {spent:.2f} s", file=sys.stderr)
    return made


def differences(made: dict, given: dict) -> list[str]:
    out = [f"{name}: missing on one side" for name in sorted(set(made) ^ set(given))]
    for name in sorted(set(made) & set(given)):
        parts = [("", made[name], given[name])]
        if "inner" in given[name]:
            parts.append((" inner", made[name]["inner"], given[name]["inner"]))
        for part, a, b in parts:
            for i, (p, q) in enumerate(zip(a["legs"], b["legs"], strict=True)):
                if not same(p["lower"], q["lower"]) or not same(p["upper"], q["upper"]):
                    out.append(f"{name}{part}, leg {i + 1}: {p['upper']} against {q['upper']}")
    return out


def same(a: float | None, b: float | None) -> bool:
    return a == b if a is None or b is None else abs(a - b) <= TOLERANCE


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("kind", choices=("scenarios", "maps"))
    parser.add_argument("folder", type=Path, nargs="?", help="default: tests/data/scenarios or ros_maps")
    parser.add_argument("--only", metavar="NAME", action="append", help="only these")
    parser.add_argument("--program", type=Path, default=PROGRAM)
    parser.add_argument("--radius", type=float, default=0.3, help="of the disc on maps, m")
    parser.add_argument("--check", action="store_true", help="against the folder's optimum.json")
    parser.add_argument("--write", action="store_true", help="the folder's optimum.json")
    args = parser.parse_args()
    maps = args.kind == "maps"
    args.folder = args.folder or ROOT / "tests" / "data" / ("ros_maps" if maps else "scenarios")
    made = of_maps(args) if maps else of_scenarios(args)
    file = args.folder / "optimum.json"
    if args.write:
        file.write_text(json.dumps(made, indent=1) + "\n")
    if not args.check:
        return 0
    given = json.loads(file.read_text())
    found = differences(made, {k: v for k, v in given.items() if not args.only or k in args.only})
    print("\n".join(found) if found else f"{len(made)} of {file.parent.name} as in optimum.json")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
