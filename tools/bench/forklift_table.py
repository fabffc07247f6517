#!/usr/bin/env python3
"""Long bodies in rack halls: every answer against the exhaustive oracle of tests/support/pose_oracle.h.

build/venv/bin/python tools/bench/forklift_table.py [--halls 30] [--store] [--check] [--fresh] [--failures FILE]

A row a vehicle and quarter of the aisle widths. The oracle parts queries into those that certainly have a way (motions
proved one by one), those that certainly have none (the body shrunk, joined whatever the drive) and undecided ones; stops
in contact are drawn on purpose. "solved": paths of those that have a way; "beyond": of undecided ones; "wrong": refusals
of what has a way; "right": of what has none, "cause": those of them, and of the undecided, that told the right cause:
START_OCCUPIED, GOAL_OCCUPIED, TOO_NARROW or NO_PATH where the disc inside the body does not get through, KINEMATIC where
it does; "open": refusals of undecided ones; "false": paths of what has none; "unclear": paths that are not clear or break
a limit when looked at every centimetre (aisle_tools/check.py). ratio: length over the planner's proved bound; s and risk: duration of a path and its risk by length, in the mean.

The oracle's verdicts are stored in tests/data/racks.json, since they take half a minute a hall; --store makes those that
are missing or do not belong to the hall as drawn. --check: exit 1 on a path that is unclear or false, on a wrong cause,
or if fewer than 98 % of what has a way are solved. --failures: a line a wrong refusal or wrong cause.
"""

from __future__ import annotations

import argparse
import json
import math
import subprocess
import sys
import zlib
from pathlib import Path

import offline
import rack_halls
from aisle import status_t
from aisle_tools import names, query, vehicle

SOLVED_MIN = 0.98
QUERIES = 34  # in each hall
SPREAD = 0.6180339887498949  # of shares: evenly, however many halls
WAY, NONE, UNDECIDED, CONTACT = "+", "-", "?", "x"
STORE = offline.ROOT / "tests" / "data" / "racks.json"
COUNTS = ("asked", "has a way", "solved", "wrong", "beyond", "open", "right", "cause", "false", "unclear")


def main() -> int:
    args = parse()
    stored = json.loads(args.stored.read_text()) if args.stored.exists() else {}
    rows, failures = {}, []
    for i in range(args.halls):
        hall, share = hall_of(i)
        legs = rack_halls.draw_queries(hall, QUERIES)
        verdicts = verdicts_of(args, hall, legs, stored)
        if not args.store:
            row = rows.setdefault((hall.vehicle.name, math.floor(4.0 * share)), new_row())
            judge_hall(args, hall, legs, verdicts, row, failures)
            write_failures(args, failures)
    if args.store:
        return 0
    good = print_rows(rows)
    if args.json is not None:
        told = [
            {"vehicle": name, "aisle": [min(r["aisle"]), max(r["aisle"])]} | {k: r[k] for k in COUNTS}
            for (name, _), r in sorted(rows.items())
        ]
        args.json.write_text(json.dumps(told, indent=1) + "\n")
    return 0 if good or not args.check else 1


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    offline.add_options(parser, offline.ROOT / "tests" / "data" / "scenarios")
    parser.add_argument("--oracle", type=Path, default=offline.ROOT / "build" / "release" / "pose-oracle", metavar="PROGRAM")
    parser.add_argument("--stored", type=Path, default=STORE, metavar="FILE", help="the oracle's verdicts")
    parser.add_argument("--halls", type=int, default=30, help=f"a third for each vehicle, {QUERIES} queries each")
    parser.add_argument("--store", action="store_true", help="make verdicts that are missing, and no more")
    parser.add_argument("--fresh", action="store_true", help="ask the oracle too: exit 1 if verdicts are not as stored")
    parser.add_argument("--no-times", action="store_true", help="no milliseconds")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--failures", type=Path, metavar="FILE")
    parser.set_defaults(objective="shortest")
    return parser.parse_args()


def hall_of(i: int) -> tuple[rack_halls.Hall, float]:
    share = (0.5 + (i // len(rack_halls.VEHICLES)) * SPREAD) % 1.0
    return rack_halls.draw_hall(1000 + i, rack_halls.VEHICLES[i % len(rack_halls.VEHICLES)], share), share


def new_row() -> dict:
    return {k: [] for k in ("ms", "ratio", "aisle", "units", "duration", "exposure", "length")} | dict.fromkeys(COUNTS, 0)


def oracle_lines(hall: rack_halls.Hall, legs: list[query.Leg], mode: str) -> str:
    lines = [f"bounds {rack_halls.WIDTH} {rack_halls.HEIGHT}"]
    for x0, y0, x1, y1 in hall.boxes:
        lines.append(f"polygon 4 {x0} {y0} {x1} {y0} {x1} {y1} {x0} {y1}")
    body = hall.vehicle
    corners = " ".join(f"{x} {y}" for x, y in body.footprint)
    lines.append(f"body {len(body.footprint)} {corners} {rack_halls.MARGIN} {body.radius_min}")
    lines.append(f"mode {mode}")
    for leg in legs:
        poses = [*leg.start, *leg.goals[0]] if len(leg.goals[0]) == 3 else [*leg.start, *leg.goals[0], math.nan]
        lines.append("query " + " ".join(repr(p) for p in poses))
    return "\n".join(lines) + "\n"


def verdicts_of(args: argparse.Namespace, hall: rack_halls.Hall, legs: list[query.Leg], stored: dict) -> str:
    """A letter a query: WAY, NONE, UNDECIDED, or CONTACT of start or goal."""
    digest = zlib.crc32(oracle_lines(hall, legs, "connect").encode())
    known = stored.get(str(hall.seed))
    if known is None or known["digest"] != digest:
        if not args.store:
            raise SystemExit(f"hall {hall.seed} has no verdicts, or those of another one: --store makes them")
        known = {"digest": digest, "verdicts": letters(args.oracle, hall, legs)}
        stored[str(hall.seed)] = known
        rows = [f" {json.dumps(seed)}: {json.dumps(v)}" for seed, v in sorted(stored.items())]
        args.stored.write_text("{\n" + ",\n".join(rows) + "\n}\n")
    if args.fresh and letters(args.oracle, hall, legs) != known["verdicts"]:
        raise SystemExit(f"hall {hall.seed}: the oracle's verdicts are not as stored")
    return known["verdicts"]


def ask_oracle(program: Path, hall: rack_halls.Hall, mode: str, legs: list[query.Leg]) -> list[bool]:
    lines = oracle_lines(hall, legs, mode)
    done = subprocess.run([program], input=lines, capture_output=True, text=True, check=True)
    return [line == "1" for line in done.stdout.split()]


def letters(program: Path, hall: rack_halls.Hall, legs: list[query.Leg]) -> str:
    floor = rack_halls.Floor(hall)
    contact = [contact_of(floor, leg) is not None for leg in legs]
    out = [CONTACT if c else WAY if way else NONE for c, way in zip(contact, ask_oracle(program, hall, "connect", legs))]
    left = [i for i, letter in enumerate(out) if letter == NONE]
    if left:  # the second lattice is dear
        for i, maybe in zip(left, ask_oracle(program, hall, "enclose", [legs[i] for i in left])):
            out[i] = UNDECIDED if maybe else NONE
    return "".join(out)


def contact_of(floor: rack_halls.Floor, leg: query.Leg) -> int | None:
    if not floor.is_free(leg.start):
        return status_t.START_OCCUPIED
    return status_t.GOAL_OCCUPIED if len(leg.goals[0]) == 3 and not floor.is_free(leg.goals[0]) else None


def causes_of(hall: rack_halls.Hall, leg: query.Leg, verdict: str) -> tuple:
    """What a refusal may tell."""
    if verdict == CONTACT:
        return (contact_of(rack_halls.Floor(hall), leg),)
    if not rack_halls.disc_passes(hall, leg):
        return (status_t.NO_PATH, status_t.TOO_NARROW)
    return (status_t.KINEMATIC,)


def judge_hall(
    args: argparse.Namespace, hall: rack_halls.Hall, legs: list[query.Leg], verdicts: str, row: dict, failures: list[str]
) -> None:
    answers = offline.answers(args, hall.world, vehicle.make(hall.vehicle.values), legs, not args.no_times)
    row["aisle"].append(hall.aisle)
    for leg, verdict, answer in zip(legs, verdicts, answers):
        fault = judge(hall, leg, verdict, answer, row)
        if fault is not None:
            goal = leg.goals[0] if len(leg.goals[0]) == 3 else (*leg.goals[0], "any")
            failures.append(
                f"{leg.name} {hall.vehicle.name}, aisle {hall.aisle}: {fault}; {leg.start} to {goal}; "
                f"{answer.reply.work_units} units"
            )


def judge(hall: rack_halls.Hall, leg: query.Leg, verdict: str, answer: offline.Answer, row: dict) -> str | None:
    """Counts an answer; what is wrong with it."""
    row["asked"] += 1
    row["ms"].append(answer.ms)
    row["units"].append(answer.reply.work_units)
    row["has a way"] += verdict == WAY
    if answer.is_path:
        row["ratio"].append(answer.reply.length / max(answer.reply.length_bound, 0.5))
        row["duration"].append(answer.reply.duration)
        row["length"].append(answer.reply.length)
        row["exposure"].append(answer.reply.risk * answer.reply.length)
        row["unclear"] += bool(answer.faults)
        row[{WAY: "solved", UNDECIDED: "beyond"}.get(verdict, "false")] += 1
        if verdict in (NONE, CONTACT):
            return "false path"
        return "unclear: " + answer.faults[0] if answer.faults else None
    if verdict == WAY:
        row["wrong"] += 1
        return "wrong refusal, " + offline.why(answer)
    row["open" if verdict == UNDECIDED else "right"] += 1
    causes = causes_of(hall, leg, verdict)
    row["cause"] += answer.reply.cause in causes
    told = " or ".join(names.cause_name(c) for c in causes)
    return None if answer.reply.cause in causes else f"cause {offline.why(answer)}, right is {told}"


def write_failures(args: argparse.Namespace, failures: list[str]) -> None:
    if args.failures is not None:
        args.failures.write_text("".join(line + "\n" for line in failures))


def print_rows(rows: dict) -> bool:
    print(f"{'vehicle':<36} {'aisles, m':>11} " + " ".join(f"{k:>9}" for k in COUNTS) + "  ratio      s   risk     ms  p99 ms  units")
    everything = new_row()
    for (name, _), row in sorted(rows.items()):
        print_row(name, row)
        for key, value in row.items():
            everything[key] += value
    print_row("all", everything)
    share = everything["solved"] / max(everything["has a way"], 1)
    causes = everything["cause"] == everything["right"] + everything["open"]
    return everything["unclear"] == 0 and everything["false"] == 0 and causes and share >= SOLVED_MIN


def print_row(name: str, row: dict) -> None:
    ms = sorted(row["ms"])
    print(
        f"{name:<36} {min(row['aisle']):5.2f}-{max(row['aisle']):5.2f} "
        + " ".join(f"{row[k]:9d}" for k in COUNTS)
        + f" {offline.median(row['ratio']):6.3f} {sum(row['duration']) / max(1, len(row['duration'])):6.1f}"
        f" {sum(row['exposure']) / max(1e-9, sum(row['length'])):6.3f} {offline.median(ms):6.2f} {ms[math.ceil(0.99 * len(ms)) - 1]:7.1f}"
        f" {offline.median(row['units']):6.0f}"
    )


if __name__ == "__main__":
    sys.exit(main())
