#!/usr/bin/env python3
"""Drives among moving obstacles, judged by the simulator's judge and by a space-time oracle that knows the future.

build/venv/bin/python tools/bench/encounters.py [--drives 20] [--halls ...] [--kinds ...] [--json FILE] [--failures FILE]
build/venv/bin/python tools/bench/encounters.py --mass 20000 [--kinds ...]

A row a hall and kind of movers, --drives drives each: encounters (sim/judge.h), collisions while moving (with movers and
with the hall), contacts at rest, drives that arrived; "possible": drives of which the oracle of
tests/support/spacetime_oracle.h finds a way within the same time, or that arrived; "success": those that arrived of them.
"/ oracle": time over the oracle's, median and 95th percentile of the drives that arrived; the oracle's time is the way's
without movers as planned plus what the oracle loses by them (its time with them less its time without: its lattice costs
both the same). "/ alone": time over the way's without movers. Replans: new revisions of the path; stops: rests the first
path did not have; ms: of the work of each input and deadline, p50 and p99 in the median drive, and the worst of all.
Movers of kind adversarial follow the vehicle: to the oracle they come where the vehicle drove, so for them its figures
say less.

--mass N: N encounters of each kind by `aisle-sim --batch` in the halls that it draws itself, without the oracle.
Failures are told by name, HALL/KIND/SEED; --only NAME runs one again, --keep DIR keeps its log, truth and figures.
Ends with 1 if anything collided while moving.
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

import encounter_halls as halls
import offline
from aisle_tools import vehicle

GOALS_AT = 0.52  # s, when aisle-sim sends the goals
TIME_LIMIT = 180.0  # s of a drive
TOLERANCE = 0.1  # m, of goals
SUM = ("drives", "encounters", "collisions", "hall", "at_rest", "arrived", "possible", "undecided", "replans", "stops")


@dataclass
class Outcome:
    drive: halls.Drive
    sim: dict  # aisle-sim's figures
    verdict: str = "not asked"  # the oracle's: found, none, undecided
    oracle_time: float = math.nan  # s, from the goals on
    oracle_alone: float = math.nan

    @property
    def arrived(self) -> bool:
        return bool(self.sim["arrived"])

    @property
    def possible(self) -> bool:
        return self.arrived or self.verdict == "found"

    @property
    def over_oracle(self) -> float:
        """NAN: the oracle found nothing in the time that the vehicle took."""
        best = self.sim["optimum"] + self.oracle_time - self.oracle_alone
        return self.sim["time"] / best if self.arrived and self.verdict == "found" else math.nan


@dataclass
class Row:
    sums: dict = field(default_factory=lambda: dict.fromkeys(SUM, 0))
    over_oracle: list = field(default_factory=list)
    over_alone: list = field(default_factory=list)
    p50: list = field(default_factory=list)
    p99: list = field(default_factory=list)
    worst_ms: float = 0.0

    def add(self, outcome: Outcome) -> None:
        sim = outcome.sim
        counts = (1, sim["encounters"], sim["collisions"], sim["hall_collisions"], sim["contacts_at_rest"])
        verdicts = (outcome.arrived, outcome.possible, outcome.verdict == "undecided" and not outcome.arrived)
        for key, value in zip(SUM, (*counts, *verdicts, sim["revisions"], sim["stops"])):
            self.sums[key] += int(value)
        if outcome.arrived:
            self.over_alone.append(sim["time"] / sim["optimum"])
        if not math.isnan(outcome.over_oracle):
            self.over_oracle.append(outcome.over_oracle)
        self.p50.append(sim["work_ms"]["p50"])
        self.p99.append(sim["work_ms"]["p99"])
        self.worst_ms = max(self.worst_ms, sim["work_ms"]["max"])

    def merge(self, other: Row) -> None:
        for key in SUM:
            self.sums[key] += other.sums[key]
        for name in ("over_oracle", "over_alone", "p50", "p99"):
            getattr(self, name).extend(getattr(other, name))
        self.worst_ms = max(self.worst_ms, other.worst_ms)

    @property
    def success(self) -> float:
        return self.sums["arrived"] / self.sums["possible"] if self.sums["possible"] else math.nan

    def figures(self) -> dict:
        return self.sums | {
            "success": self.success,
            "over_oracle_median": share_of(self.over_oracle, 0.5),
            "over_oracle_p95": share_of(self.over_oracle, 0.95),
            "over_alone_median": share_of(self.over_alone, 0.5),
            "ms_p50": share_of(self.p50, 0.5),
            "ms_p99": share_of(self.p99, 0.5),
            "ms_max": self.worst_ms,
        }


def main() -> int:
    args = parse()
    if args.mass > 0:
        return mass(args)
    start = time.monotonic()
    names = [one.split("/") for one in args.only] if args.only else None
    asked = [(h, k, int(s)) for h, k, s in names] if names else [
        (h, k, args.seed + i) for h in args.halls for k in args.kinds for i in range(args.drives)
    ]
    rows: dict = {}
    failures = []
    with ThreadPoolExecutor(args.jobs) as pool:
        for outcome in pool.map(lambda one: run(args, halls.draw(*one)), asked):
            rows.setdefault((outcome.drive.hall, outcome.drive.kind), Row()).add(outcome)
            tell_failure(outcome, failures)
    total = print_rows(rows)
    print(f"seeds {args.seed} to {args.seed + args.drives - 1}; {time.monotonic() - start:.0f} s")
    write(args, rows, total, failures)
    return 1 if total.sums["collisions"] + total.sums["hall"] > 0 else 0


def parse() -> argparse.Namespace:
    release = offline.ROOT / "build" / "release"
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--drives", type=int, default=20, metavar="N", help="in each hall with each kind of movers")
    parser.add_argument("--seed", type=int, default=1, help="of the first of them")
    parser.add_argument("--halls", nargs="+", choices=halls.HALLS, default=halls.HALLS)
    parser.add_argument("--kinds", nargs="+", choices=halls.KINDS, default=halls.KINDS)
    parser.add_argument("--only", metavar="NAME", action="append", help="HALL/KIND/SEED")
    parser.add_argument("--mass", type=int, default=0, metavar="N", help="encounters of each kind, in aisle-sim's halls")
    parser.add_argument("--no-oracle", action="store_true")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="drives at once; more make milliseconds worse")
    parser.add_argument("--keep", type=Path, metavar="DIR", help="logs, truths and figures of the drives")
    parser.add_argument("--failures", type=Path, metavar="FILE", help="a line each, too")
    parser.add_argument("--json", type=Path, metavar="FILE")
    parser.add_argument("--sim", type=Path, default=release / "aisle-sim", metavar="PROGRAM")
    parser.add_argument("--oracle", type=Path, default=release / "spacetime-oracle", metavar="PROGRAM")
    return parser.parse_args()


# ---- a drive


def run(args: argparse.Namespace, drive: halls.Drive) -> Outcome:
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch) if args.keep is None else args.keep / drive.name.replace("/", "-")
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "setup.log").unlink(missing_ok=True)
        halls.write_log(drive, folder / "setup.log", offline.PREFIX)
        outcome = Outcome(drive, simulate(args, drive, folder))
        if not args.no_oracle and outcome.sim["optimum"] is not None:
            ask_oracle(args, outcome, folder)
    return outcome


def simulate(args: argparse.Namespace, drive: halls.Drive, folder: Path) -> dict:
    words = [args.sim, folder / "setup.log", "--movers", drive.movers_option, "--seed", drive.seed, "--time", TIME_LIMIT]
    words += ["--truth", folder / "truth.csv", "--json", folder / "sim.json"]
    words += ["--out", folder / "run.log"] if args.keep is not None else []
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1) or not (folder / "sim.json").stat().st_size:
        sys.exit(f"{drive.name}: {' '.join(str(w) for w in words)}: exit {done.returncode}\n{done.stderr}")
    return json.loads((folder / "sim.json").read_text())


def ask_oracle(args: argparse.Namespace, outcome: Outcome, folder: Path) -> None:
    text = oracle_text(outcome.drive, folder / "truth.csv")
    (folder / "oracle.txt").write_text(text)
    done = subprocess.run([str(args.oracle)], input=text, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{outcome.drive.name}: {args.oracle}: exit {done.returncode}\n{done.stderr}")
    word, with_movers, alone, _ = done.stdout.split()
    outcome.verdict = word
    outcome.oracle_time = float(with_movers) - GOALS_AT if word == "found" else math.nan
    outcome.oracle_alone = float(alone) - GOALS_AT if word == "found" else math.nan


def oracle_text(drive: halls.Drive, truth: Path) -> str:
    body = vehicle.body(halls.message(drive.vehicle))
    limits = body.limits
    keys = ("v_max", "a_max", "d_max", "omega_max", "alpha_max", "reaction_time", "creep_clearance", "creep_speed")
    lines = [f"bounds 0 0 {drive.width} {drive.height}"]
    lines += [f"polygon 4 {x0} {y0} {x1} {y0} {x1} {y1} {x0} {y1}" for x0, y0, x1, y1 in drive.boxes]
    corners = " ".join(f"{x} {y}" for x, y in body.vertices)
    lines.append(f"body {len(body.vertices)} {corners} {body.radius}")
    lines.append(f"limits {body.margin} " + " ".join(str(limits[k]) for k in keys))
    tracks, end = read_truth(truth)
    for track in tracks.values():
        samples = " ".join(f"{t} {x} {y}" for t, x, y, _ in track)
        lines.append(f"mover {track[0][3]} {drive.v_bound} {len(track)} {samples}")
    lines.append("start {} {} {} {}".format(*drive.start, GOALS_AT))
    lines += [f"goal {x} {y} {TOLERANCE} 0 4 {dwell}" for x, y, dwell in drive.goals]
    lines.append(f"solve {end}")
    return "\n".join(lines) + "\n"


def read_truth(path: Path) -> tuple[dict, float]:
    """Of each mover (t, x, y, radius) ten times a second; when it ends."""
    tracks: dict = {}
    end = 0.0
    with path.open() as file:
        for row in csv.DictReader(file):
            end = float(row["t"])
            if row["kind"] != "vehicle":
                tracks.setdefault(row["id"], []).append((end, row["x"], row["y"], row["radius"]))
    return tracks, end


# ---- telling


def tell_failure(outcome: Outcome, failures: list) -> None:
    sim = outcome.sim
    what = []
    if sim["collisions"] + sim["hall_collisions"] > 0:
        what.append(f"COLLISION ({sim['collisions']} with movers, {sim['hall_collisions']} with the hall)")
    if not outcome.arrived:
        ways = "; ".join(f"{p['status']}/{p['cause']} {p['count']}" for p in sim["paths"])
        what.append(f"not arrived, {sim['visited']} of {sim['goals']} goals, oracle: {outcome.verdict}; {ways}")
    if what:
        drive = outcome.drive
        line = f"{drive.name}: {', '.join(what)} ({drive.vehicle}, {drive.movers_option}, {sim['seconds']:.0f} s)"
        failures.append(line)
        print(line, file=sys.stderr, flush=True)


def share_of(values: list, share: float) -> float:
    ordered = sorted(values)
    return ordered[min(math.ceil(share * len(ordered)), len(ordered)) - 1] if ordered else math.nan


HEAD = (
    f"{'hall':<10} {'movers':<12} {'drives':>6} {'met':>6} {'coll':>5} {'hall':>5} {'rest':>5} {'arrived':>7} {'possible':>8} "
    f"{'success':>7} {'/ oracle':>8} {'p95':>6} {'/ alone':>8} {'replans':>8} {'stops':>6} {'ms p50':>7} {'p99':>6} {'max':>7}"
)


def print_rows(rows: dict) -> Row:
    print(HEAD)
    total = Row()
    for (hall, kind), row in sorted(rows.items()):
        print_row(hall, kind, row)
        total.merge(row)
    for kind in dict.fromkeys(k for _, k in rows):
        part = Row()
        for (_, k), row in rows.items():
            if k == kind:
                part.merge(row)
        print_row("all", kind, part)
    print_row("all", "all", total)
    return total


def print_row(hall: str, kind: str, row: Row) -> None:
    s, f = row.sums, row.figures()
    print(
        f"{hall:<10} {kind:<12} {s['drives']:>6} {s['encounters']:>6} {s['collisions']:>5} {s['hall']:>5} {s['at_rest']:>5} "
        f"{s['arrived']:>7} {s['possible']:>8} {f['success']:>7.3f} {f['over_oracle_median']:>8.3f} {f['over_oracle_p95']:>6.2f} "
        f"{f['over_alone_median']:>8.3f} {s['replans'] / s['drives']:>8.1f} {s['stops'] / s['drives']:>6.2f} {f['ms_p50']:>7.3f} "
        f"{f['ms_p99']:>6.3f} {f['ms_max']:>7.1f}"
    )


def write(args: argparse.Namespace, rows: dict, total: Row, failures: list) -> None:
    if args.failures is not None:
        args.failures.write_text("".join(line + "\n" for line in failures))
    if args.json is not None:
        told = [{"hall": h, "kind": k} | row.figures() for (h, k), row in sorted(rows.items())]
        data = {"seed": args.seed, "rows": told, "all": total.figures(), "failures": failures}
        args.json.write_text(json.dumps(data, indent=1) + "\n")


# ---- by the thousand


def mass(args: argparse.Namespace) -> int:
    told = []
    for kind in args.kinds:
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "batch.json"
            words = [args.sim, "--batch", args.mass, "--kind", kind, "--seed", args.seed, "--json", out]
            done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=False)
            print(done.stdout, end="", flush=True)
            if done.returncode not in (0, 1) or not out.exists():
                sys.exit(f"aisle-sim --batch: exit {done.returncode}\n{done.stderr}")
            told.append(json.loads(out.read_text()))
    met, hits = (sum(t[k] for t in told) for k in ("encounters", "collisions"))
    hits += sum(t["hall_collisions"] for t in told)
    print(f"encounters {met}, collisions while moving {hits}")
    if args.json is not None:
        args.json.write_text(json.dumps(told, indent=1) + "\n")
    return 1 if hits > 0 else 0


if __name__ == "__main__":
    sys.exit(main())
