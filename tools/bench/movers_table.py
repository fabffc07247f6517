#!/usr/bin/env python3
"""What a replan costs over the number of moving obstacles, as table and plot; over LCM from message to answer.

build/venv/bin/python tools/bench/movers_table.py [--counts 1,2,4,...] [--seconds S] [--out movers.png] [--json FILE]
                                                  [--daemon] [--programs DIR]

A hall of 50 x 50 m (1 million cells of 5 cm) with 40 pillars, the default vehicle, constant-velocity movers by one source
at 15 Hz, poses at 20 Hz; aisle-sim drives to and fro and measures the processor time of every input that brought another path ("work"), or the same
one with its lease renewed, too ("with renewals"). With --daemon aisled drives instead, in real time (run it by
tools/netns-lo), and times itself: "verdict" is from the host's receiving a pose or obstacles to the cycle's verdict on it,
"answer" of those that changed the path, until that was sent, and "work" the planner's processor time in an answer.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from aisle import vehicle_t

from aisle_tools import goals, layouts, query
from aisle_tools.bus import LogWriter
from aisle_tools.world import Polygon, World

import numpy as np
import offline

SIDE = 50.0  # m
PILLARS = 40
MAP_ID = 1
GOAL_COUNT = 40
TARGET_MS, TARGET_COUNT = 5.0, 64
CORE = [("work", "change_cpu_ms"), ("with renewals", "answer_cpu_ms")]  # columns, as named in aisle-sim's figures
DAEMON = [("answer", "answer_ms"), ("work", "answer_cpu_ms"), ("verdict", "cycle_ms")]


def main() -> int:
    args = parse()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        setup = Path(folder) / "setup.log"
        write_setup(setup)
        kinds = DAEMON if args.daemon else CORE
        print(f"{'movers':>6} " + "".join(f"{name + ' p50':>20} {'p99':>8} {'max ms':>8}  of" for name, _ in kinds), end="")
        print(f" {'collisions':>10} {'way m':>7}")
        for count in args.counts:
            row = run(args, setup, count)
            rows.append(row)
            print(f"{count:>6} " + " ".join(cells(row[key]) for _, key in kinds), end="")
            print(f" {row['collisions']:>10} {row['way']:>7.1f}", flush=True)
    print("load average " + " ".join(f"{v:.2f}" for v in os.getloadavg()))
    if args.json is not None:
        args.json.write_text(json.dumps({"daemon": args.daemon, "rows": rows}, indent=1) + "\n")
    if args.out is not None:
        draw(args.out, rows, args.daemon)
    return 1 if any(r["collisions"] for r in rows) else 0


def cells(times: dict) -> str:
    return f"{times['p50']:>19.3f} {times['p99']:>8.3f} {times['max']:>8.3f} {times['count']:>4}"


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    counts = [0, 1, 2, 4, 8, 16, 32, 64, 128, 256]
    parser.add_argument("--counts", type=lambda t: [int(v) for v in t.split(",")], default=counts, metavar="N,...")
    parser.add_argument("--seconds", type=float, default=120.0, metavar="S", help="of each drive; default 120")
    parser.add_argument("--v-bound", type=float, default=1.0, metavar="V", help="m/s, of the movers; default 1")
    parser.add_argument("--seed", type=int, default=1, metavar="N")
    parser.add_argument("--out", type=Path, metavar="FILE", help="the plot, PNG")
    parser.add_argument("--json", type=Path, metavar="FILE")
    parser.add_argument("--daemon", action="store_true", help="over LCM by aisled, in real time")
    parser.add_argument("--programs", type=Path, default=offline.ROOT / "build" / "release", metavar="DIR")
    return parser.parse_args()


def write_setup(path: Path) -> None:
    """Hall, vehicle, start and a list of goals to and fro that lasts longer than any drive."""
    draw = random.Random(7)
    boxes = []
    for ident in range(1, PILLARS + 1):
        x, y = draw.uniform(3.0, SIDE - 4.0), draw.uniform(6.0, SIDE - 7.0)
        corners = [(x, y), (x + 0.8, y), (x + 0.8, y + 0.8), (x, y + 0.8)]
        boxes.append(Polygon(ident, np.array(corners)))
    log = LogWriter(path, "AISLE")
    for name, msg in layouts.make_messages(World("pillars", (0.0, 0.0, SIDE, SIDE), boxes), MAP_ID, 1, 0, 256):
        log.publish(name, msg)
    vehicle = vehicle_t()
    vehicle.vehicle_revision = 1
    log.publish("VEHICLE", vehicle)
    log.publish("POSE", goals.make_pose((3.0, 3.0, 0.0), 1, MAP_ID))
    log.publish("GOALS", make_goals())
    log.close()


def make_goals() -> goals.goal_list_t:
    msg = goals.goal_list_t()
    msg.goal_list_id, msg.goal_list_revision, msg.map_id = 1, 1, MAP_ID
    args = argparse.Namespace(planner="auto", objective="safest", interpolation="spline", seed=0, work_units=0)
    msg.options = query.make_options(args)
    ends = [(SIDE - 3.0, SIDE - 3.0), (3.0, 3.0)]
    msg.goals = [query.make_goal(i + 1, ends[i % 2], True) for i in range(GOAL_COUNT)]
    msg.num_goals = len(msg.goals)
    return msg


def run(args: argparse.Namespace, setup: Path, count: int) -> dict:
    out = setup.parent / "sim.json"
    words = [args.programs / "aisle-sim", setup, "--json", out, "--time", args.seconds, "--seed", args.seed]
    words += ["--movers", f"constant:{count}:{args.v_bound}"] if count > 0 else []
    words += ["--bus", ""] if args.daemon else []
    daemon = start_daemon(args) if args.daemon else None
    try:
        done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=False)
    finally:
        if daemon is not None:
            daemon.terminate()
            daemon.wait(10.0)
    if done.returncode not in (0, 1) or done.stderr:
        sys.exit(f"aisle-sim: exit {done.returncode}\n{done.stderr}")
    figures = json.loads(out.read_text())
    collisions = figures["collisions"] + figures["hall_collisions"]
    times = {key: figures[key] for _, key in (DAEMON if args.daemon else CORE)}
    return {"movers": count, **times, "collisions": collisions, "way": figures["way"]}


def start_daemon(args: argparse.Namespace) -> subprocess.Popen:
    process = subprocess.Popen([str(args.programs / "aisled")])
    time.sleep(0.5)  # aisle-sim sends the set-up until it is taken
    return process


def draw(path: Path, rows: list[dict], daemon: bool) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axis = pyplot.subplots(figsize=(7.0, 4.5), constrained_layout=True)
    counts = [max(r["movers"], 0.5) for r in rows]  # 0 has a place on the logarithmic axis, too
    for key, colour in (("p50", "#1f77b4"), ("p99", "#ff7f0e"), ("max", "#d62728")):
        axis.loglog(counts, [r[(DAEMON if daemon else CORE)[0][1]][key] for r in rows], "o-", ms=4, color=colour, label=key)
    axis.plot(TARGET_COUNT, TARGET_MS, "k*", ms=10, label=f"target: p99 {TARGET_MS:g} ms at {TARGET_COUNT}")
    axis.set_xlabel("moving obstacles (0 drawn at 0.5)")
    axis.set_ylabel("ms from message to answer over LCM" if daemon else "ms of work that brought another path")
    axis.grid(True, which="major", color="#dddddd")
    axis.legend(fontsize=8)
    figure.savefig(path, dpi=90)


if __name__ == "__main__":
    sys.exit(main())
