"""aisle check: an independent judgement of recorded replies and paths against a map."""

from __future__ import annotations

import argparse
from pathlib import Path

from aisle import path_t, vehicle_t

from aisle_tools import maps, names, plot, vehicle
from aisle_tools.bus import Recording
from aisle_tools.check import Obstacles, check_path
from aisle_tools.errors import UserError


def configure(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("log", type=Path, metavar="LOG", help="log of query --save or of a logger")
    parser.add_argument("--map", type=Path, metavar="FILE", help="map_server .yaml; default: the layout in the log")
    parser.add_argument("--scenario", type=Path, metavar="FILE")
    parser.add_argument("--step", type=float, default=0.01, metavar="M", help="distance of samples")
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
        bad += _print_row(path, recording, obstacles, body, args.step)
    print(f"{len(paths)} looked at, {bad} at fault")
    return 1 if bad else 0


def _print_row(path: path_t, recording: Recording, obstacles: Obstacles, body: vehicle.Body, step: float) -> bool:
    ident = path.query_id or path.path_revision
    if not names.is_path(path):
        print(f"{ident:>10} {names.result_name(path.status):>7} {'-':>8} {'-':>9} {'-':>7}  {names.reason(path)}")
        return False
    report = check_path(path, obstacles, body, recording.queries.get(path.query_id), step)
    print(
        f"{ident:>10} {names.result_name(path.status):>7} {report.length:>8.2f} {report.clearance:>9.4f} "
        f"{body.margin:>7.3f}  {'; '.join(report.faults) or 'none'}"
    )
    return not report.ok
