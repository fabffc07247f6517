"""aisle sim: a simulated vehicle among simulated movers; log, figures and a picture of what happened."""

from __future__ import annotations

import argparse
import csv
import json
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import matplotlib
import numpy as np
from aisle import vehicle_t

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.axes import Axes  # noqa: E402
from matplotlib.collections import LineCollection, PolyCollection  # noqa: E402

from aisle_tools import goals, layouts, maps, query, vehicle  # noqa: E402
from aisle_tools.bus import Bus, LogWriter, StatusWatch  # noqa: E402
from aisle_tools.errors import UserError  # noqa: E402
from aisle_tools.plot import draw_world, outlines, view_box  # noqa: E402
from aisle_tools.scenario import Scenario  # noqa: E402
from aisle_tools.vehicle import Body  # noqa: E402
from aisle_tools.world import World  # noqa: E402

ROOT = Path(__file__).resolve().parent.parent.parent
PASSED_ON = ("movers", "tracks", "place", "seed", "time", "room", "sources")  # options of aisle-sim
MAP_ID = 1
MARGIN = 0.1  # m


def configure(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--map", type=Path, metavar="FILE", help="map_server .yaml, scenario .json or MovingAI .map")
    parser.add_argument("--scenario", type=Path, metavar="FILE", help="hall, robot, start and goals of this scenario")
    parser.add_argument("--start", metavar="X,Y[,TH]", help="default: the scenario's")
    parser.add_argument("--goal", action="append", metavar="X,Y[,TH]", help="several: in order; default: the scenario's")
    parser.add_argument("--any-heading", action="store_true", help="at every goal (the default where TH is not given)")
    parser.add_argument("--any-order", action="store_true", help="let the planner choose the order")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="run.log, sim.json, truth.csv, tracks.png")
    parser.add_argument("--programs", type=Path, default=ROOT / "build" / "release", metavar="DIR", help="of the build")
    parser.add_argument("--daemon", action="store_true", help="start aisled and drive it over LCM in real time")
    add_world_options(parser)
    maps.add_read_options(parser)
    vehicle.add_options(parser)
    vehicle.add_limit_options(parser)
    query.add_plan_options(parser)


def add_world_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("the simulated world")
    kinds = "constant, jumps, agv, person, adversarial"
    group.add_argument("--movers", metavar="LIST", help=f"KIND:COUNT[:V_BOUND],...; kinds: {kinds}")
    group.add_argument("--tracks", type=Path, metavar="FILE", help="recorded ways, CSV: t_s,id,kind,x_m,y_m,heading_rad")
    group.add_argument("--place", metavar="X,Y,TURN,SCALE", help="where the middle of the recorded ways goes")
    group.add_argument("--time", type=float, metavar="S", help="end then")
    group.add_argument("--room", type=float, metavar="M", help="between vehicle and movers at first, 2 by default")
    group.add_argument("--sources", type=int, metavar="N", help="1 to 4 sources share the movers")


def run(args: argparse.Namespace) -> int:
    if args.margin is None and args.vehicle is None:
        args.margin = MARGIN  # a scenario's robot has none, and a vehicle that drives needs some
    world, scenario = read_hall(args)
    msg = vehicle.from_options(args, scenario) or vehicle_t()
    msg.vehicle_revision = msg.vehicle_revision or 1
    args.out.mkdir(parents=True, exist_ok=True)
    setup = args.out / "setup.log"
    write_setup(args, world, scenario, msg, setup)
    with daemon(args):
        code = simulate(args, setup)
    picture(args.out, world, vehicle.body(msg), stops_of(args, scenario))
    return max(code, check_log(args))


def read_hall(args: argparse.Namespace) -> tuple[World, Scenario | None]:
    path = args.map or args.scenario
    if path is None:
        raise UserError("which hall? give --map FILE or --scenario FILE")
    margin = args.margin if args.margin is not None else 0.0
    world, scenario = maps.read_any(path, args, margin)
    if args.map is not None and args.scenario is not None:
        scenario = maps.read_scenario(args.scenario, margin)
    return world, scenario


def stops_of(args: argparse.Namespace, scenario: Scenario | None) -> list[tuple[float, ...]]:
    """Start and goals."""
    start = query.parse_pose(args.start, "--start") if args.start else (scenario.start if scenario else None)
    ends = [query.parse_pose(g, "--goal") for g in args.goal] if args.goal else (scenario.goals if scenario else [])
    if start is None or not ends:
        raise UserError("from where to where? give --start and --goal, or --scenario FILE")
    return [start, *ends]


def write_setup(args: argparse.Namespace, world: World, scenario: Scenario | None, msg: vehicle_t, path: Path) -> None:
    """Layout, vehicle, pose and goals as aisle-sim wants them."""
    stops = stops_of(args, scenario)
    path.unlink(missing_ok=True)
    log = LogWriter(path, args.prefix)
    for name, message in layouts.make_messages(world, MAP_ID, 1, 0, layouts.TILE_SIDE):
        log.publish(name, message)
    log.publish("VEHICLE", msg)
    log.publish("POSE", goals.make_pose(stops[0], 1, MAP_ID))
    log.publish("GOALS", make_goals(args, stops[1:]))
    log.close()


def make_goals(args: argparse.Namespace, ends: list[tuple[float, ...]]) -> goals.goal_list_t:
    given = argparse.Namespace(**vars(args))
    given.goal = [",".join(repr(v) for v in end) for end in ends]
    given.list_id, given.list_revision = 1, 1
    msg = goals.make_list(given, MAP_ID)
    msg.utime = 0
    return msg


def program(args: argparse.Namespace, name: str) -> str:
    path = args.programs / name
    if not path.is_file():
        raise UserError(f"{path}: no such program; build it, or give --programs DIR")
    return str(path)


@contextmanager
def daemon(args: argparse.Namespace) -> Iterator[None]:
    """aisled of our own with a record, if it is wanted; ended by its handle."""
    if not args.daemon:
        yield
        return
    words = [program(args, "aisled"), "--prefix", args.prefix, "--record", str(args.out / "record.log")]
    words += ["--lcm-url", args.lcm_url] if args.lcm_url else []
    process = subprocess.Popen(words)
    try:
        StatusWatch(Bus(args.lcm_url, args.prefix)).wait(args.timeout)
        yield
    finally:
        process.terminate()
        process.wait(10.0)


def simulate(args: argparse.Namespace, setup: Path) -> int:
    """Runs aisle-sim; 0: arrived without a collision, 1: not so."""
    out = args.out
    words = [program(args, "aisle-sim"), str(setup), "--prefix", args.prefix, "--out", str(out / "run.log")]
    words += ["--json", str(out / "sim.json"), "--truth", str(out / "truth.csv")]
    values = vars(args)
    words += [w for key in PASSED_ON if values.get(key) is not None for w in (f"--{key}", str(values[key]))]
    words += ["--bus", args.lcm_url or ""] if args.daemon else []
    begin = time.monotonic()
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1) or not done.stdout:
        raise UserError(done.stderr.strip().removeprefix("aisle-sim: ") or "aisle-sim failed")
    print(done.stdout, end="")
    print(f"simulated in {time.monotonic() - begin:.2f} s; {out / 'run.log'}, sim.json, truth.csv, tracks.png")
    (out / "sim.txt").write_text(done.stdout, encoding="utf-8")
    return done.returncode


def check_log(args: argparse.Namespace) -> int:
    """Every path again, byte for byte: from the log of the core, or from the daemon's record."""
    log = args.out / ("record.log" if args.daemon else "run.log")
    words = [program(args, "aisle-replay"), str(log), "--prefix", args.prefix, "--check"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    told = [line for line in done.stdout.splitlines() if line.startswith("check:")]
    print(f"replay of {log}: {told[-1].removeprefix('check: ') if told else done.stderr.strip()}")
    return done.returncode


@dataclass
class Track:
    """Where one body truly was."""

    kind: str
    radius: float
    rows: list[tuple[float, float, float, float, float]] = field(default_factory=list)  # t, x, y, theta, v

    @property
    def array(self) -> np.ndarray:
        return np.array(self.rows)


def read_truth(path: Path) -> dict[int, Track]:
    """By id; 0 is the vehicle. A mover that is away for a second or more begins a new track there."""
    tracks: dict[int, Track] = {}
    with path.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            track = tracks.setdefault(int(row["id"]), Track(row["kind"], float(row["radius"])))
            track.rows.append(tuple(float(row[k]) for k in ("t", "x", "y", "theta", "v")))
    return tracks


def picture(out: Path, world: World, body: Body, stops: list[tuple[float, ...]]) -> None:
    tracks = read_truth(out / "truth.csv")
    figures = json.loads((out / "sim.json").read_text(encoding="utf-8"))
    x0, y0, x1, y1 = view_box(world)
    height = min(max(10.0 * (y1 - y0) / (x1 - x0), 4.0), 14.0)
    figure, axes = plt.subplots(figsize=(11.5, height + 0.6), layout="constrained")
    draw_world(axes, world)
    end = max(t.rows[-1][0] for t in tracks.values())
    for ident, track in sorted(tracks.items(), reverse=True):
        draw_track(axes, track, end, is_vehicle=ident == 0)
    draw_vehicle(axes, tracks[0].array, body)
    draw_stops(axes, stops)
    for c in figures["contacts"]:
        axes.plot(c["x"], c["y"], "X", ms=13, mfc="#d62728" if c["moving"] else "#ff9f40", mec="white", zorder=9)
    axes.set(xlim=(x0, x1), ylim=(y0, y1), aspect="equal", xlabel="x (m)", ylabel="y (m)", title=title(figures))
    mappable = plt.cm.ScalarMappable(norm=plt.Normalize(0.0, end), cmap="viridis")
    figure.colorbar(mappable, ax=axes, label="time (s)", shrink=0.7, aspect=45)
    figure.savefig(out / "tracks.png", dpi=110)
    plt.close(figure)


def title(figures: dict) -> str:
    text = "arrived" if figures["arrived"] else "not arrived"
    if figures["time"] is not None and figures["optimum"] is not None:
        text += f" in {figures['time']:.1f} s ({figures['time'] / figures['optimum']:.2f} of the way without movers)"
    moving = figures["collisions"] + figures["hall_collisions"]
    return f"{text}; {moving} collisions in motion, {figures['contacts_at_rest']} contacts at rest"


def draw_track(axes: Axes, track: Track, end: float, is_vehicle: bool) -> None:
    rows = track.array
    segments = np.stack([rows[:-1, 1:3], rows[1:, 1:3]], axis=1)
    together = np.diff(rows[:, 0]) < 1.0  # a mover that was away comes back elsewhere
    width, strength = (3.0, 1.0) if is_vehicle else (1.0, 0.55)
    look = {"cmap": "viridis", "norm": plt.Normalize(0.0, end), "linewidths": width, "alpha": strength}
    line = LineCollection(list(segments[together]), zorder=6 if is_vehicle else 4, **look)
    line.set_array(rows[:-1, 0][together])
    axes.add_collection(line)
    if not is_vehicle:
        colour = plt.get_cmap("viridis")(rows[-1, 0] / end)
        axes.add_patch(plt.Circle(rows[-1, 1:3], track.radius, fc=colour, ec="black", lw=0.5, alpha=0.7, zorder=5))


def draw_vehicle(axes: Axes, rows: np.ndarray, body: Body) -> None:
    """Its footprint every two seconds."""
    shown = rows[::20, 1:4]
    style = {"facecolors": (0.2, 0.4, 0.8, 0.07), "edgecolors": (0.1, 0.2, 0.5, 0.4), "linewidths": 0.6, "zorder": 3}
    axes.add_collection(PolyCollection(list(outlines(body, shown)), **style))


def draw_stops(axes: Axes, stops: list[tuple[float, ...]]) -> None:
    axes.plot(*stops[0][:2], "o", ms=8, mfc="#2ca02c", mec="white", zorder=8)
    for number, stop in enumerate(stops[1:], 1):
        axes.plot(*stop[:2], "*", ms=14, mfc="#ff7f0e", mec="white", zorder=8)
        axes.annotate(str(number), stop[:2], xytext=(7, 7), textcoords="offset points", weight="bold", zorder=8)


