#!/usr/bin/env python3
"""Planner GA through walls with openings: solved, length over the exact optimum and ms, over seeds and drawn halls.

build/venv/bin/python tools/bench/barriers_table.py [--seeds 1000] [--checked 20] [--planner ga] [--replay PROGRAM]

barrier_1 to 4: one hall, --seeds seeds of the search each. "k layers": --seeds halls in all, drawn as generate.py --set
barriers draws them, each of a seed of its own, by which the search is seeded too. --checked: as many of each row by the
independent checker; all are proved by the core. Exit 1 if one is not solved, is faulty, is longer than 1.01 of its optimum
or shorter than it, or a row's median is above 10 ms.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import exact
import generate
import offline
from aisle import options_t, path_t
from aisle_tools import layouts, names, query, vehicle
from aisle_tools.bus import LogWriter, Recording
from aisle_tools.check import Obstacles, check_path
from aisle_tools.scenario import Scenario, read_scenario

WORST, MEDIAN_MS = 1.01, 10.0  # targets
SLACK = 2e-6  # of a length: the wire carries it as float
HALLS = [("scenarios", 1), ("scenarios", 2), ("scenarios", 3), ("barriers", 4)]
DATA = offline.ROOT / "tests" / "data"


@dataclass
class Row:
    name: str
    ratios: list[float] = field(default_factory=list)
    ms: list[float] = field(default_factory=list)
    refused: list[str] = field(default_factory=list)
    faults: list[str] = field(default_factory=list)

    @property
    def asked(self) -> int:
        return len(self.ratios) + len(self.refused)

    @property
    def failures(self) -> list[str]:
        out = self.refused + self.faults
        out += [f"{r:.5f} of the optimum" for r in self.ratios if not 1.0 - SLACK <= r <= WORST]
        return out + ([f"median {offline.median(self.ms):.1f} ms"] if offline.median(self.ms) > MEDIAN_MS else [])


def options_of(args: argparse.Namespace, seed: int) -> options_t:
    options = query.make_options(args)
    options.seed = seed
    return options


def write_log(args: argparse.Namespace, path: Path, scenario: Scenario, seeds: list[int]) -> None:
    log = LogWriter(path, offline.PREFIX)
    for name, part in layouts.make_messages(scenario.world, 1, 1, 0):
        log.publish(name, part)
    msg = vehicle.make({"radius": scenario.radius, "margin": -1.0})
    msg.vehicle_revision = 1
    log.publish("VEHICLE", msg)
    leg = query.Leg("1", scenario.start, scenario.goals)
    for i, seed in enumerate(seeds):
        log.publish("QUERY", query.make_query(leg, i + 1, 1, options_of(args, seed), False))
    log.close()


def ask(args: argparse.Namespace, scenario: Scenario, optimum: float, seeds: list[int], checked: int, row: Row) -> None:
    with tempfile.TemporaryDirectory() as folder:
        log, out = Path(folder) / "in.log", Path(folder) / "out.log"
        write_log(args, log, scenario, seeds)
        offline.run([args.replay, log, "--out", out])
        recording = Recording(out, offline.PREFIX)
        row.ms += [q["ms_median"] for q in offline.timed(args.replay, log, 1)]
    replies = {r.query_id: r for r in recording.replies}
    obstacles = Obstacles(scenario.world)
    body = vehicle.body(vehicle.make({"radius": scenario.radius, "margin": -1.0}))
    for i, seed in enumerate(seeds):
        reply = replies[i + 1]
        if reply.status != path_t.OK:
            row.refused.append(f"seed {seed}: {names.reason(reply)}")
            continue
        row.ratios.append(reply.length / optimum)
        if i < checked:
            row.faults += check_path(reply, obstacles, body, recording.queries[i + 1]).faults


def fixed_row(args: argparse.Namespace, folder: str, layers: int) -> Row:
    row = Row(f"barrier_{layers}")
    optima = json.loads((DATA / folder / "optimum.json").read_text())
    scenario = read_scenario(DATA / folder / f"{row.name}.json", -1.0)
    seeds = list(range(1, args.seeds + 1))
    ask(args, scenario, optima[row.name]["upper"], seeds, args.checked, row)
    return row


def drawn_row(args: argparse.Namespace, layers: int) -> Row:
    row = Row(f"{layers} layer{'s' if layers > 1 else ''}, drawn")
    halls = max(args.seeds // generate.LAYERS_MAX, 1)
    with tempfile.TemporaryDirectory() as folder:
        for i in range(halls):
            seed = layers * 100000 + i
            data, optimum = generate.one("barriers", generate.barriers, (layers,), str(seed), args.program)
            path = Path(folder) / f"barriers_{i}.json"
            path.write_text(generate.text_of(path.stem, data))
            ask(args, read_scenario(path, -1.0), optimum["upper"], [seed], int(i < args.checked), row)
    return row


def print_row(row: Row) -> None:
    ratios, ms = row.ratios or [float("nan")], sorted(row.ms)
    print(
        f"{row.name:<16} {len(row.ratios):>5}/{row.asked:<5} {offline.median(ratios):>9.5f} {max(ratios):>9.5f} "
        f"{offline.median(ms):>8.2f} {ms[int(0.99 * (len(ms) - 1))]:>8.2f} {ms[-1]:>8.2f}  {' | '.join(row.failures[:3])}",
        flush=True,
    )


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--seeds", type=int, default=1000, metavar="N")
    parser.add_argument("--checked", type=int, default=20, metavar="N", help="of each row, by the independent checker")
    parser.add_argument("--replay", type=Path, default=offline.ROOT / "build" / "release" / "aisle-replay", metavar="PROGRAM")
    parser.add_argument("--program", type=Path, default=exact.PROGRAM, help="optimum")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the rows as JSON too")
    query.add_plan_options(parser)
    parser.set_defaults(planner="ga", objective="shortest")
    args = parser.parse_args()
    print(f"planner {args.planner}, {args.objective}, margin none")
    print(f"{'hall':<16} {'solved':>11} {'length/optimum: median, worst':>19} {'ms':>8} {'p99':>8} {'most':>8}  failures")
    rows = []
    for folder, layers in HALLS:
        rows.append(fixed_row(args, folder, layers))
        print_row(rows[-1])
    for layers in range(1, generate.LAYERS_MAX + 1):
        rows.append(drawn_row(args, layers))
        print_row(rows[-1])
    drawn = rows[len(HALLS) :]
    print(
        f"drawn: {sum(len(r.ratios) for r in drawn)} of {sum(r.asked for r in drawn)} solved, worst "
        f"{max(x for r in drawn for x in r.ratios):.5f}, median {offline.median([x for r in drawn for x in r.ms]):.2f} ms"
    )
    if args.json is not None:
        args.json.write_text(json.dumps([{**r.__dict__, "failures": r.failures} for r in rows], indent=1) + "\n")
    return 1 if any(r.failures for r in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
