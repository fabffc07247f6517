"""Maps and queries through aisle-replay, without any bus; shared by the tables beside it."""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from aisle import path_t, query_t, vehicle_t
from aisle_tools import layouts, names, query, vehicle
from aisle_tools.bus import LogWriter, Recording
from aisle_tools.check import Obstacles, Report, check_path
from aisle_tools.world import World

ROOT = Path(__file__).resolve().parent.parent.parent
PREFIX = "AISLE"


@dataclass
class Answer:
    query: query_t
    reply: path_t
    ms: float
    report: Report | None  # of the independent checker; None: not checked

    @property
    def is_path(self) -> bool:
        return self.reply.status == path_t.OK

    @property
    def faults(self) -> list[str]:
        return self.report.faults if self.report is not None else []


def add_options(parser: argparse.ArgumentParser, folder: Path) -> None:
    parser.add_argument("folder", type=Path, nargs="?", default=folder, help=f"default: {folder.relative_to(ROOT)}")
    parser.add_argument("--only", metavar="NAME", action="append", help="only these")
    parser.add_argument("--replay", type=Path, default=ROOT / "build" / "release" / "aisle-replay", metavar="PROGRAM")
    parser.add_argument("--config", type=Path, metavar="FILE", help="settings of aisled, e.g. larger limits")
    parser.add_argument("--repeat", type=int, default=1, metavar="N", help="runs of each query for the milliseconds")
    parser.add_argument("--no-check", action="store_true", help="leave the independent checker out")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the rows as JSON too")
    query.add_plan_options(parser)


def answers(
    args: argparse.Namespace, world: World, msg: vehicle_t, legs: list[query.Leg], times: bool = True
) -> list[Answer]:
    """One per leg, in order; without times their milliseconds are 0."""
    with tempfile.TemporaryDirectory() as folder:
        log, out = (Path(folder) / n for n in ("in.log", "out.log"))
        write_log(args, log, world, msg, legs)
        config = ["--config", str(args.config)] if args.config is not None else []
        run([args.replay, log, "--out", out, *config])
        recording = Recording(out, PREFIX)
        told = timed(args.replay, log, args.repeat, args.config) if times else []
        times_ms = {q["query_id"]: q["ms_median"] for q in told}
    replies = {r.query_id: r for r in recording.replies}
    obstacles = None if args.no_check else Obstacles(world)
    made = []
    for ident, asked in recording.queries.items():
        if ident not in replies:
            raise SystemExit(f"{world.name}: query {ident} was not answered")
        reply = replies[ident]
        judged = reply.status == path_t.OK and obstacles is not None
        report = check_path(reply, obstacles, vehicle.body(msg), asked) if judged else None
        made.append(Answer(asked, reply, times_ms.get(ident, 0.0), report))
    return made


def write_log(args: argparse.Namespace, path: Path, world: World, msg: vehicle_t, legs: list[query.Leg], any_order: bool = False) -> None:
    log = LogWriter(path, PREFIX)
    for name, part in layouts.make_messages(world, 1, 1, 0):
        log.publish(name, part)
    msg.vehicle_revision = 1
    log.publish("VEHICLE", msg)
    options = query.make_options(args)
    for i, leg in enumerate(legs):
        log.publish("QUERY", query.make_query(leg, i + 1, 1, options, False, any_order))
    log.close()


def timed(replay: Path, log: Path, repeat: int, config: Path | None = None) -> list[dict]:
    """The queries of a log as aisle-replay --bench tells them: status, work_units, ms_median, ms_p99, ms_max."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "ms.json"
        more = ["--config", config] if config is not None else []
        run([replay, log, "--bench", "--repeat", repeat, "--json", out, *more])
        return json.loads(out.read_text())["queries"]


def run(words: list) -> None:
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(str(w) for w in words)}: exit {done.returncode}\n{done.stderr}")


def why(answer: Answer) -> str:
    if answer.is_path:
        return "; ".join(answer.faults)
    return names.reason(answer.reply)


def median(values: list[float]) -> float:
    ordered = sorted(values)
    n = len(ordered)
    return 0.5 * (ordered[(n - 1) // 2] + ordered[n // 2]) if n else float("nan")
