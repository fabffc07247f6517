#!/usr/bin/env python3
"""Aisle beside the polyanya crate and OMPL: the same discs, halls and pairs, in the same run, rounds taken in turn.

build/venv/bin/python tools/bench/peers.py [folder] [--only NAME] [--repeat 200] [--rounds 3] [--quarter 12] [--no-ompl]

Aisle's time is a whole cold query: check, search, pieces, proof, encoding, and the reply's decoding. polyanya's is the
search alone on a mesh of obstacles grown beforehand, which took `mesh` ms: sides exactly, arcs as tangents around them,
--quarter to a right angle (few: quick and long, many: slow and short; one for a robot of millimetres, whose arcs nobody
measures). So a factor is worth no more than the two ratios beside it. OMPL's is the time until planner and simplifier
together first reach aisle's own length ratio (its motion test is exact), or --ompl-ratio if that is more, the best of
its planners, or a lower bound where none did so within --cap seconds. Ratios are to the exact optimum (optimum.json).
The peers are optional: tools/bench/peers/polyanya needs cargo, tools/bench/peers/ompl cmake, Debian's libompl-dev and
the libboost-*-dev that its cmake files ask for. Footprints are taken as the disc around them.
"""

from __future__ import annotations

import argparse
import json
import math
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import offline
import shapely
from aisle_tools import query, vehicle
from aisle_tools.scenario import Scenario, read_scenario
from shapely.geometry import Polygon, box
from shapely.geometry.polygon import orient

PEERS = Path(__file__).resolve().parent / "peers"
QUARTER = 12  # tangents of a right angle of a grown obstacle's arc
POINT_RADIUS = 0.01  # m, up to which one is enough
SCALE = 10.0  # polyanya's units a metre: at 1 its absolute tolerances let ways cut 1 mm into obstacles
NOISE = 1e-5  # of a length: coordinates in single precision, on both sides
TARGET_POLYANYA, TARGET_OMPL = 3.0, 50.0


def tangents(obstacle: Polygon, radius: float, quarter: int) -> Polygon:
    """A convex obstacle grown by the radius: its sides moved out exactly, each arc as tangents around it."""
    corners = np.array(orient(obstacle).exterior.coords[:-1])
    sides = np.roll(corners, -1, axis=0) - corners
    normals = np.arctan2(-sides[:, 0], sides[:, 1])
    out = []
    for corner, before, after in zip(corners, np.roll(normals, 1), normals):
        turn = (after - before) % (2.0 * math.pi)
        turn = 0.0 if turn > math.pi else turn  # a straight corner, rounded
        pieces = max(1, math.ceil(turn / (0.5 * math.pi) * quarter - 1e-9))
        half = 0.5 * turn / pieces
        for k in range(pieces):
            angle = before + (2 * k + 1) * half
            out.append(corner + radius / math.cos(half) * np.array([math.cos(angle), math.sin(angle)]))
    return Polygon(out)


def grown(obstacles: list[Polygon], radius: float, quarter: int = QUARTER) -> list[Polygon]:
    """The obstacles grown by the radius, united."""
    united = shapely.union_all([tangents(p, radius, quarter if radius > POINT_RADIUS else 1) for p in obstacles])
    return [p for p in shapely.get_parts(united) if not p.is_empty]


def free_space(
    bounds: tuple[float, ...],
    obstacles: list[Polygon],
    radius: float,
    start: tuple[float, ...],
    quarter: int = QUARTER,
) -> Polygon:
    """What a disc's centre may reach from start, as one polygon with holes."""
    free = shapely.get_parts(box(*bounds).difference(shapely.union_all(grown(obstacles, radius, quarter))))
    place = shapely.Point(start[0], start[1])
    return min(free, key=lambda p: p.distance(place))


def stops_of(scenario: Scenario) -> list[tuple[float, ...]]:
    return [scenario.start, *scenario.goals]


def scene_of(raw: dict, scenario: Scenario, repeat: int, quarter: int = QUARTER) -> dict:
    obstacles = [Polygon(o) for o in raw["obstacles"]]
    free = free_space(tuple(raw["bounds"]), obstacles, raw["robot"]["radius"] or 1e-3, scenario.start, quarter)
    stops = stops_of(scenario)
    return {
        "outer": [list(c) for c in free.exterior.coords[:-1]],
        "holes": [[list(c) for c in ring.coords[:-1]] for ring in free.interiors],
        "pairs": [[*a[:2], *b[:2]] for a, b in zip(stops, stops[1:])],
        "repeat": repeat,
        "scale": SCALE,
    }


def call(words: list, text: str) -> dict:
    done = subprocess.run([str(w) for w in words], input=text, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{words[0]}: exit {done.returncode}\n{done.stderr[-2000:]}")
    return json.loads(done.stdout)


def build_polyanya() -> Path | None:
    if shutil.which("cargo") is None:
        print("polyanya: no cargo here (rustup, or Debian's cargo); left out")
        return None
    target = offline.ROOT / "build" / "peers" / "polyanya"
    done = subprocess.run(["cargo", "build", "--release", "--locked", "-q", "--target-dir", target], check=False,
                          cwd=PEERS / "polyanya")
    return target / "release" / "polyanya-bench" if done.returncode == 0 else None


def build_ompl() -> Path | None:
    target = offline.ROOT / "build" / "peers" / "ompl"
    steps = [["cmake", "-S", PEERS / "ompl", "-B", target, "-DCMAKE_BUILD_TYPE=Release"], ["cmake", "--build", target]]
    for words in steps:
        if subprocess.run([str(w) for w in words], capture_output=True, check=False).returncode != 0:
            boost = " ".join(f"libboost-{part}-dev" for part in ("serialization", "filesystem", "system"))
            print(f"OMPL: does not build here (apt-get install libompl-dev {boost}); left out")
            return None
    return target / "ompl-bench"


class AisleLog:
    """A scenario's queries in a log, for aisle-replay --bench."""

    def __init__(self, args: argparse.Namespace, scenario: Scenario, radius: float, folder: Path) -> None:
        self.args = args
        self.log, self.json = (folder / f"{scenario.world.name}.{kind}" for kind in ("log", "json"))
        stops = stops_of(scenario)
        legs = [query.Leg(str(i + 1), a, [b]) for i, (a, b) in enumerate(zip(stops, stops[1:]))]
        offline.write_log(args, self.log, scenario.world, vehicle.make({"radius": radius, "margin": -1.0}), legs)
        out = folder / "out.log"
        offline.run([args.replay, self.log, "--out", out])
        self.lengths = {r.query_id: r.length for r in offline.Recording(out, offline.PREFIX).replies}

    def run(self) -> list[dict]:
        offline.run([self.args.replay, self.log, "--bench", "--repeat", self.args.repeat, "--json", self.json])
        rows = json.loads(self.json.read_text())["queries"]
        return [{"ms": r["ms_median"], "p99": r["ms_p99"], "length": self.lengths[r["query_id"]]} for r in rows]


def middle(values: list[float]) -> float:
    return offline.median(values)


def merged(rounds: list[list[dict]]) -> list[dict]:
    """Leg by leg the median over the rounds."""
    return [{**legs[0], "ms": middle([r["ms"] for r in legs]), "p99": middle([r["p99"] for r in legs])}
            for legs in zip(*rounds)]


def compare(args: argparse.Namespace, path: Path, programs: dict, folder: Path, best: list[dict]) -> list[dict]:
    raw, scenario = json.loads(path.read_text()), read_scenario(path, -1.0)
    aisle = AisleLog(args, scenario, raw["robot"]["radius"] or 1e-3, folder)
    scene = scene_of(raw, scenario, args.repeat, args.quarter)
    ours, theirs = [], []
    for _ in range(args.rounds):  # in turn: what the machine does meanwhile meets both
        ours.append(aisle.run())
        if programs["polyanya"] is not None:
            theirs.append(call([programs["polyanya"]], json.dumps(scene)))
    rows = []
    for i, row in enumerate(merged(ours)):
        row.update(scenario=path.stem, leg=i + 1, ratio=row["length"] / best[i]["lower"])
        if theirs:
            legs = [t["pairs"][i] for t in theirs]
            row["polyanya"] = {"ms": middle([t["ms"] for t in legs]), "p99": middle([t["p99"] for t in legs]),
                               "mesh_ms": middle([t["mesh_ms"] for t in theirs]),
                               "ratio": legs[0]["length"] / best[i]["lower"] if legs[0]["length"] else math.nan}
            row["factor"] = row["ms"] / row["polyanya"]["ms"]
        if programs["ompl"] is not None:
            length = best[i]["lower"] * max(row["ratio"], args.ompl_ratio)
            row["ompl"] = ask_ompl(args, raw, scene["pairs"][i], length, programs["ompl"])
        rows.append(row)
    return rows


def ask_ompl(args: argparse.Namespace, raw: dict, pair: list[float], length: float, program: Path) -> dict:
    numbers = [*raw["bounds"], raw["robot"]["radius"] or 1e-3, *pair, length, args.cap, len(raw["obstacles"])]
    for o in raw["obstacles"]:
        numbers += [len(o), *(v for p in o for v in p)]
    return call([program], " ".join(repr(float(n)) for n in numbers))


def show(row: dict) -> str:
    text = f"{row['scenario']:<16} {row['leg']:>3} {row['ms']:>8.3f} {row['p99']:>8.3f} {row['ratio']:>8.5f}"
    if "polyanya" in row:
        p = row["polyanya"]
        text += f" {p['ms']:>9.3f} {p['p99']:>8.3f} {p['ratio']:>8.5f} {p['mesh_ms']:>8.2f} {row['factor']:>7.2f}"
    if "ompl" in row:
        o = row["ompl"]
        reached = o["ms"] is not None
        ms = o["ms"] if reached else 1e3 * o["cap"]
        text += f" {'' if reached else '>':>2}{ms:>8.1f} {ms / row['ms']:>8.0f} {o['planner'] or '-':<12}"
        text += f" {o['best']:.4f}"
    return text


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    offline.add_options(parser, offline.ROOT / "tests" / "data" / "scenarios")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--no-ompl", action="store_true")
    parser.add_argument("--quarter", type=int, default=QUARTER, help="tangents to a right angle in polyanya's mesh")
    parser.add_argument("--ompl-ratio", type=float, default=1.0001, help="OMPL need not come nearer to the optimum")
    parser.add_argument("--cap", type=float, default=2.0, help="s for each OMPL planner and leg")
    parser.set_defaults(objective="shortest", repeat=200)
    args = parser.parse_args()
    programs = {"polyanya": build_polyanya(), "ompl": None if args.no_ompl else build_ompl()}
    optima = json.loads((args.folder / "optimum.json").read_text())
    print("disc robots, margin none, SHORTEST; ms: median of the rounds' medians")
    print(f"{'scenario':<16} {'leg':>3} {'aisle ms':>8} {'p99':>8} {'ratio':>8} {'polyanya':>9} {'p99':>8} "
          f"{'ratio':>8} {'mesh ms':>8} {'factor':>7} {'OMPL ms':>10} {'factor':>8} planner, best ratio")
    rows: list[dict] = []
    with tempfile.TemporaryDirectory() as folder:
        for name, optimum in sorted(optima.items()):
            if args.only and name not in args.only:
                continue
            for row in compare(args, args.folder / f"{name}.json", programs, Path(folder), optimum["legs"]):
                rows.append(row)
                print(show(row), flush=True)
    summary(rows)
    if args.json is not None:
        args.json.write_text(json.dumps(rows, indent=1))
    return 0


def summary(rows: list[dict]) -> None:
    factors = [r["factor"] for r in rows if "factor" in r]
    longer = [r for r in rows if "polyanya" in r and r["ratio"] > r["polyanya"]["ratio"] * (1 + NOISE)]
    inside = [r for r in rows if "polyanya" in r and r["polyanya"]["ratio"] < 1 - NOISE]
    if factors:
        missed = sum(f > TARGET_POLYANYA for f in factors)
        print(f"aisle / polyanya: median {middle(factors):.2f}, worst {max(factors):.2f}, above the target of "
              f"{TARGET_POLYANYA:g} on {missed} of {len(factors)} legs; aisle longer on {len(longer)}; polyanya "
              f"shorter than the optimum, so through an obstacle, on {len(inside)}")
    ahead = [(r["ompl"]["ms"] or 1e3 * r["ompl"]["cap"]) / r["ms"] for r in rows if "ompl" in r]
    if ahead:
        print(f"OMPL / aisle: median at least {middle(ahead):.0f}, least {min(ahead):.0f} (target {TARGET_OMPL:g})")


if __name__ == "__main__":
    sys.exit(main())
