#!/usr/bin/env python3
"""Drives among moving obstacles, judged by the simulator's judge and by a space-time oracle that knows the future.

build/venv/bin/python tools/bench/encounters.py [--drives 20] [--halls ...] [--kinds ...] [--json FILE]
build/venv/bin/python tools/bench/encounters.py --mass 20000 [--kinds ...]

A row a hall and kind of movers, --drives drives each: encounters (sim/judge.h), collisions while moving, with movers
and with the hall, contacts at rest, drives that arrived; "possible": drives of which the oracle of
tests/support/spacetime_oracle.h finds a way within the same time, or that arrived; "success": those that arrived of
them. "/ oracle": time over the oracle's, median and 95th percentile of the drives that arrived. The oracle's time is
that of the way without movers as planned, and what the oracle loses by them: its time with them less its time without,
since its lattice costs both the same. "/ wary": over an oracle with Aisle's delays (--wary s more of reaction time,
movers 0.09 m wider); "raw": over the oracle's own time, lattice and all. "/ alone": over the way's time without movers.
Replans: new revisions of the path; stops: rests the first path did not have; lapses: of a lease, under way (all drives);
s: a drive's time, arrived or not. ms: of the work of each input and
deadline, by the clock, p50 and p99 in the median drive, and the worst of all.
Hall "drawn": what `aisle-sim --drawn SEED` draws, 120 s a drive.
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
import lcm
import offline
from aisle import goal_list_t, layout_t, obstacle_t, obstacles_t, vehicle_t
from aisle_tools import names, vehicle

EPOCH_US = 1600000000000000  # of aisle-sim's clock
TIME_LIMIT = 180.0  # s of a drive
WARY = 0.3625  # s: latency and lag of the drives 0.1 each, the shortest lease 0.0625, age of what is known 0.1
WARY_RADIUS = 0.09  # m: three deviations of a mover's place
USUAL_BOUND = {obstacle_t.PERSON: 1.6, obstacle_t.STATIC: 0.0}  # m/s, where none is told
SUM = (
    "drives",
    "encounters",
    "collisions",
    "hall",
    "at_rest",
    "arrived",
    "possible",
    "undecided",
    "replans",
    "stops",
    "lapses",
    "seconds",
)
LISTS = ("over_oracle", "over_wary", "over_raw", "over_alone", "p50", "p99")


@dataclass(frozen=True)
class Best:
    """By the oracle; s from the goals on."""

    verdict: str = "not asked"  # found, none, undecided
    time: float = math.nan
    alone: float = math.nan  # without movers


@dataclass
class Outcome:
    drive: halls.Drive
    sim: dict  # aisle-sim's figures
    known: Best = Best()  # by the oracle
    wary: Best = Best()

    @property
    def arrived(self) -> bool:
        """All goals visited, by the simulator's judge."""
        return self.sim["arrival"] is not None

    @property
    def possible(self) -> bool:
        return self.arrived or self.known.verdict == "found"

    def over(self, best: Best) -> float:
        """NAN: not arrived, or the oracle found nothing in the time that the vehicle took."""
        least = (self.sim["optimum"] or math.nan) + best.time - best.alone
        return self.sim["time"] / least if self.arrived else math.nan

    @property
    def over_raw(self) -> float:
        return self.sim["time"] / self.known.time if self.arrived else math.nan


@dataclass
class Row:
    sums: dict = field(default_factory=lambda: dict.fromkeys(SUM, 0))
    over_oracle: list = field(default_factory=list)
    over_wary: list = field(default_factory=list)
    over_raw: list = field(default_factory=list)
    over_alone: list = field(default_factory=list)
    p50: list = field(default_factory=list)
    p99: list = field(default_factory=list)
    worst_ms: float = 0.0

    def add(self, outcome: Outcome) -> None:
        sim = outcome.sim
        counts = (1, sim["encounters"], sim["collisions"], sim["hall_collisions"], sim["contacts_at_rest"])
        verdicts = (outcome.arrived, outcome.possible, outcome.known.verdict == "undecided" and not outcome.arrived)
        driven = (sim["revisions"], sim["stops"], sim["lapses"], sim["seconds"])
        for key, value in zip(SUM, (*counts, *verdicts, *driven)):
            self.sums[key] += value
        if outcome.arrived:
            self.over_alone.append(sim["time"] / sim["optimum"])
        ratios = (outcome.over(outcome.known), outcome.over(outcome.wary), outcome.over_raw)
        for values, ratio in zip((self.over_oracle, self.over_wary, self.over_raw), ratios):
            values += [] if math.isnan(ratio) else [ratio]
        self.p50.append(sim["work_ms"]["p50"])
        self.p99.append(sim["work_ms"]["p99"])
        self.worst_ms = max(self.worst_ms, sim["work_ms"]["max"])

    def merge(self, other: Row) -> None:
        for key in SUM:
            self.sums[key] += other.sums[key]
        for name in LISTS:
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
            "over_wary_median": share_of(self.over_wary, 0.5),
            "over_raw_median": share_of(self.over_raw, 0.5),
            "over_alone_median": share_of(self.over_alone, 0.5),
            "replans_mean": self.sums["replans"] / max(self.sums["drives"], 1),
            "stops_mean": self.sums["stops"] / max(self.sums["drives"], 1),
            "seconds_mean": self.sums["seconds"] / max(self.sums["drives"], 1),
            "ms_p50": share_of(self.p50, 0.5),
            "ms_p99": share_of(self.p99, 0.5),
            "ms_max": self.worst_ms,
        }


def main() -> int:
    args = parse()
    if args.mass > 0:
        return mass(args)
    start = time.monotonic()
    asked = [(h, k, args.seed + i) for h in args.halls for k in args.kinds for i in range(args.drives)]
    if args.only:
        asked = [(h, k, int(s)) for h, k, s in (one.split("/") for one in args.only)]
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
    parser.add_argument("--halls", nargs="+", choices=(*halls.HALLS, halls.DRAWN), default=halls.HALLS)
    parser.add_argument("--kinds", nargs="+", choices=halls.KINDS, default=halls.KINDS)
    parser.add_argument("--only", metavar="NAME", action="append", help="HALL/KIND/SEED")
    parser.add_argument("--mass", type=int, default=0, metavar="N", help="encounters of each kind by --batch")
    parser.add_argument("--objective", default="safest", metavar="O", help="of the goals but in hall drawn")
    parser.add_argument("--no-oracle", action="store_true")
    parser.add_argument("--time", type=float, default=TIME_LIMIT, metavar="S", help="of a drive, default 180")
    parser.add_argument("--late", type=float, default=0.0, metavar="S", help="that paths are longer under way")
    parser.add_argument("--config", type=Path, metavar="FILE", help="settings of aisled")
    parser.add_argument("--wary", type=float, default=WARY, metavar="S", help="delays of the wary oracle, default 0.3625")
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
        for name in ("setup.log", "run.log", "sim.json"):
            (folder / name).unlink(missing_ok=True)
        outcome = Outcome(drive, simulate(args, drive, folder))
        if not args.no_oracle and outcome.sim["optimum"] is not None:
            ask_oracle(args, outcome, folder)
    return outcome


def simulate(args: argparse.Namespace, drive: halls.Drive, folder: Path) -> dict:
    words = [args.sim, "--truth", folder / "truth.csv", "--json", folder / "sim.json", "--out", folder / "run.log"]
    if drive.hall == halls.DRAWN:
        words += ["--drawn", drive.seed, "--kind", drive.kind]
    else:
        objective = names.option_value(args.objective, names.OBJECTIVES)
        halls.write_log(drive, folder / "setup.log", offline.PREFIX, objective)
        words += [folder / "setup.log", "--movers", drive.movers_option, "--seed", drive.seed, "--time", args.time, "--late", args.late]
    words += ["--config", args.config] if args.config else []
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1) or not (folder / "sim.json").stat().st_size:
        sys.exit(f"{drive.name}: {' '.join(str(w) for w in words)}: exit {done.returncode}\n{done.stderr}")
    return json.loads((folder / "sim.json").read_text())


def ask_oracle(args: argparse.Namespace, outcome: Outcome, folder: Path) -> None:
    setup, tracks = read_setup(folder / "run.log"), read_truth(folder / "truth.csv")
    for wary, name in ((0.0, "known"), (args.wary, "wary")):
        text = oracle_text(setup, tracks, wary)
        (folder / f"oracle-{name}.txt").write_text(text)
        done = subprocess.run([str(args.oracle)], input=text, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"{outcome.drive.name}: {args.oracle}: exit {done.returncode}\n{done.stderr}")
        word, with_movers, alone, _ = done.stdout.split()
        best = Best(word)
        if word == "found":
            best = Best(word, float(with_movers) - setup.goals_at, float(alone) - setup.goals_at)
        setattr(outcome, name, best)


@dataclass
class Setup:
    """What was sent: the hall, the vehicle, the goals and when, and how fast each mover may be."""

    layout: layout_t | None = None
    body: vehicle.Body | None = None
    goals: goal_list_t | None = None
    goals_at: float = math.nan  # s
    v_bound: dict = field(default_factory=dict)  # by id


def read_setup(log: Path) -> Setup:
    setup = Setup()
    for event in lcm.EventLog(str(log), "r"):
        channel = event.channel.split("_", 1)[1]
        if channel == "LAYOUT":
            setup.layout = layout_t.decode(event.data)
        elif channel == "VEHICLE":
            setup.body = vehicle.body(vehicle_t.decode(event.data))
        elif channel == "GOALS" and setup.goals is None:
            setup.goals, setup.goals_at = goal_list_t.decode(event.data), (event.timestamp - EPOCH_US) * 1e-6
        elif channel == "OBSTACLES":
            for seen in obstacles_t.decode(event.data).obstacles:
                setup.v_bound[seen.id] = seen.v_bound or USUAL_BOUND.get(seen.kind, 2.0)
    return setup


def oracle_text(setup: Setup, truth: Truth, wary: float) -> str:
    """What tests/support/spacetime_oracle_main.c reads."""
    layout, body = setup.layout, setup.body
    limits = body.limits | {"reaction_time": body.limits["reaction_time"] + wary}
    keys = ("v_max", "a_max", "d_max", "omega_max", "alpha_max", "reaction_time", "creep_clearance", "creep_speed")
    lines = [f"bounds {layout.x_min} {layout.y_min} {layout.x_max} {layout.y_max}"]
    for p in layout.polygons:
        lines.append(f"polygon {p.num_vertices} " + " ".join(f"{x} {y}" for x, y in p.vertices[: p.num_vertices]))
    corners = " ".join(f"{x} {y}" for x, y in body.vertices)
    lines.append(f"body {len(body.vertices)} {corners} {body.radius}")
    lines.append(f"limits {body.margin} " + " ".join(str(limits[k]) for k in keys))
    for ident, track in truth.movers.items():
        radius = float(track[0][3]) + (WARY_RADIUS if wary > 0.0 else 0.0)
        samples = " ".join(f"{t} {x} {y}" for t, x, y, _ in track)
        lines.append(f"mover {radius} {setup.v_bound[ident]} {len(track)} {samples}")
    lines.append("start {} {} {} {}".format(*truth.start, setup.goals_at))
    for g in setup.goals.goals:
        lines.append(f"goal {g.x} {g.y} {g.tolerance_xy or 0.05} {g.theta} {g.tolerance_theta or 0.05} {g.dwell}")
    lines.append(f"solve {truth.end}")
    return "\n".join(lines) + "\n"


@dataclass
class Truth:
    start: tuple = ()  # x, y, theta
    movers: dict = field(default_factory=dict)  # by id: (t, x, y, radius) ten times a second
    end: float = 0.0  # s


def read_truth(path: Path) -> Truth:
    truth = Truth()
    with path.open() as file:
        for row in csv.DictReader(file):
            truth.end = float(row["t"])
            if row["kind"] != "vehicle":
                truth.movers.setdefault(int(row["id"]), []).append((truth.end, row["x"], row["y"], row["radius"]))
            elif not truth.start:
                truth.start = (row["x"], row["y"], row["theta"])
    return truth


# ---- telling


def tell_failure(outcome: Outcome, failures: list) -> None:
    sim = outcome.sim
    what = []
    if sim["collisions"] + sim["hall_collisions"] > 0:
        what.append(f"COLLISION ({sim['collisions']} with movers, {sim['hall_collisions']} with the hall)")
    if outcome.arrived and not sim["arrived"]:
        what.append("there, but the planner does not say so")
    if not outcome.arrived:
        ways = "; ".join(f"{p['status']}/{p['cause']} {p['count']}" for p in sim["paths"])
        what.append(f"not arrived, {sim['visited']} of {sim['goals']} goals, oracle: {outcome.known.verdict}, wary: {outcome.wary.verdict}; {ways}")
    if what:
        drive = outcome.drive
        line = f"{drive.name}: {', '.join(what)} ({drive.vehicle}, {drive.movers_option}, {sim['seconds']:.0f} s)"
        failures.append(line)
        print(line, file=sys.stderr, flush=True)


def share_of(values: list, share: float) -> float:
    ordered = sorted(values)
    return ordered[min(math.ceil(share * len(ordered)), len(ordered)) - 1] if ordered else math.nan


COLUMNS = {  # of a row: how it is printed, from its figures
    "drives": ("drives", ">6"),
    "met": ("encounters", ">6"),
    "coll": ("collisions", ">5"),
    "hall": ("hall", ">5"),
    "rest": ("at_rest", ">5"),
    "arrived": ("arrived", ">7"),
    "possible": ("possible", ">8"),
    "success": ("success", ">7.3f"),
    "/ oracle": ("over_oracle_median", ">8.3f"),
    "p95": ("over_oracle_p95", ">6.2f"),
    "/ wary": ("over_wary_median", ">6.3f"),
    "raw": ("over_raw_median", ">6.2f"),
    "/ alone": ("over_alone_median", ">7.3f"),
    "replans": ("replans_mean", ">7.1f"),
    "stops": ("stops_mean", ">5.2f"),
    "lapses": ("lapses", ">6"),
    "s": ("seconds_mean", ">6.1f"),
    "ms p50": ("ms_p50", ">7.3f"),
    "ms p99": ("ms_p99", ">7.3f"),
    "ms max": ("ms_max", ">7.1f"),
}


def print_rows(rows: dict) -> Row:
    heads = " ".join(format(head, form.split(".")[0]) for head, (_, form) in COLUMNS.items())
    print(f"{'hall':<10} {'movers':<12} {heads}")
    total = merged(list(rows.values()))
    for (hall, kind), row in sorted(rows.items()):
        print_row(hall, kind, row)
    for kind in dict.fromkeys(k for _, k in rows):
        print_row("all", kind, merged([row for (_, k), row in rows.items() if k == kind]))
    if any(k == "adversarial" for _, k in rows):
        print_row("all", "all others", merged([row for (_, k), row in rows.items() if k != "adversarial"]))
    print_row("all", "all", total)
    return total


def merged(parts: list[Row]) -> Row:
    whole = Row()
    for part in parts:
        whole.merge(part)
    return whole


def print_row(hall: str, kind: str, row: Row) -> None:
    figures = row.figures()
    told = " ".join(format(figures[key], form) for key, form in COLUMNS.values())
    print(f"{hall:<10} {kind:<12} {told}")


def write(args: argparse.Namespace, rows: dict, total: Row, failures: list) -> None:
    if args.failures is not None:
        args.failures.write_text("".join(line + "\n" for line in failures))
    if args.json is not None:
        told = [{"hall": h, "kind": k} | known(row.figures()) for (h, k), row in sorted(rows.items())]
        data = {"seed": args.seed, "rows": told, "all": known(total.figures()), "failures": failures}
        args.json.write_text(json.dumps(data, indent=1) + "\n")


def known(figures: dict) -> dict:
    """JSON has no NAN."""
    return {k: None if isinstance(v, float) and math.isnan(v) else v for k, v in figures.items()}


# ---- by the thousand


def mass(args: argparse.Namespace) -> int:
    with ThreadPoolExecutor(args.jobs) as pool:
        told = list(pool.map(lambda kind: batch(args, kind), args.kinds))
    met, hits = (sum(t[k] for t in told) for k in ("encounters", "collisions"))
    hits += sum(t["hall_collisions"] for t in told)
    print(f"encounters {met}, collisions while moving {hits}")
    if args.json is not None:
        args.json.write_text(json.dumps(told, indent=1) + "\n")
    return 1 if hits > 0 else 0


def batch(args: argparse.Namespace, kind: str) -> dict:
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "batch.json"
        words = [args.sim, "--batch", args.mass, "--kind", kind, "--seed", args.seed, "--json", out]
        done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=False)
        print(done.stdout, end="", flush=True)
        if done.returncode not in (0, 1) or not out.exists():
            sys.exit(f"aisle-sim --batch: exit {done.returncode}\n{done.stderr}")
        return json.loads(out.read_text())


if __name__ == "__main__":
    sys.exit(main())
