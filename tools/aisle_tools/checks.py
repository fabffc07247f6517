"""aisle check: an independent judgement of recorded replies and paths against a map."""

from __future__ import annotations

import argparse
from pathlib import Path

from aisle import path_t, vehicle_t

from aisle_tools import maps, names, plot, vehicle
from aisle_tools.bus import Recording
from aisle_tools.check import Energy, Obstacles, Report, check_path
from aisle_tools.errors import UserError


def configure(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("log", type=Path, metavar="LOG", help="log of query --save or of a logger")
    parser.add_argument("--map", type=Path, metavar="FILE", help="map_server .yaml; default: the layout in the log")
    parser.add_argument("--scenario", type=Path, metavar="FILE")
    parser.add_argument("--step", type=float, default=0.01, metavar="M", help="distance of samples")
    parser.add_argument("--waypoints", action="store_true", help="a row for each waypoint: time, speed, clearance, energy by cause")
    maps.add_read_options(parser)
    vehicle.add_options(parser)


def run(args: argparse.Namespace) -> int:
    recording = Recording(args.log, args.prefix)
    world = plot.find_world(args, [recording])
    scenario = maps.read_scenario(args.scenario) if args.scenario is not None else None
    body = vehicle.body(vehicle.from_options(args, scenario) or recording.vehicle or vehicle_t())
    paths = recording.replies + plot.last_paths(recording.paths)
    if not paths:
        raise UserError(f"{args.log}: no replies or paths of prefix {args.prefix}")
    obstacles = Obstacles(world)
    print(f"{'path':>10} {'status':>7} {'length':>8} {'clearance':>9} {'margin':>7}  faults")
    bad = 0
    for path in paths:
        bad += _print_row(path, recording, obstacles, body, args)
    print(f"{len(paths)} looked at, {bad} at fault")
    return 1 if bad else 0


def _print_row(path: path_t, recording: Recording, obstacles: Obstacles, body: vehicle.Body, args: argparse.Namespace) -> bool:
    ident = path.query_id or path.path_revision
    if not names.is_path(path):
        print(f"{ident:>10} {names.result_name(path.status):>7} {'-':>8} {'-':>9} {'-':>7}  {names.reason(path)}")
        return False
    report = check_path(path, obstacles, body, recording.queries.get(path.query_id), args.step)
    print(
        f"{ident:>10} {names.result_name(path.status):>7} {report.length:>8.2f} {report.clearance:>9.4f} "
        f"{body.margin:>7.3f}  {'; '.join(report.faults) or 'none'}"
    )
    if args.waypoints:
        _print_waypoints(path, report)
    return not report.ok


def _print_waypoints(path: path_t, report: Report) -> None:
    """J are of the piece that ends there, their sum so far last."""
    columns = ("", "s m", "t s", "v m/s", "a m/s2", "1/m", "clear m", "found m", "roll J", "accel J", "turn J", "idle J", "sum J")
    print(" ".join(f"{c:>8}" for c in columns))
    total = 0.0
    for i, w in enumerate(path.waypoints):
        e = report.energy[i - 1] if i > 0 else Energy()
        found = report.piece_clearance[i - 1] if i > 0 else report.piece_clearance[0]
        total += e.total
        row = (w.s, w.t, w.v, w.a, w.curvature, w.clearance, found, e.rolling, e.acceleration, e.turning, e.idle, total)
        print(f"{i:>8} " + " ".join(f"{v:>8.3f}" for v in row))
