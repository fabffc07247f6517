"""aisle vehicle: vehicle_t onto the bus until it is acknowledged, or into a log."""

from __future__ import annotations

import argparse
from pathlib import Path

from aisle import status_t, vehicle_t

from aisle_tools import vehicle
from aisle_tools.acknowledge import send_until_held
from aisle_tools.bus import Bus, LogWriter, StatusWatch, now_us, time_revision
from aisle_tools.errors import UserError
from aisle_tools.scenario import read_scenario


def configure(parser: argparse.ArgumentParser) -> None:
    vehicle.add_options(parser)
    vehicle.add_limit_options(parser)
    parser.add_argument("--scenario", type=Path, metavar="FILE", help="the robot of this scenario, margin none")
    parser.add_argument("--revision", type=int, metavar="N", help="default: rises with time")


def run(args: argparse.Namespace) -> int:
    scenario = read_scenario(args.scenario) if args.scenario is not None else None
    msg = vehicle.from_options(args, scenario)
    if msg is None:
        raise UserError("which vehicle? give --vehicle FILE, --radius, --footprint or --scenario FILE")
    msg.utime = now_us()
    msg.vehicle_revision = args.revision or msg.vehicle_revision or time_revision()
    if args.log is not None:
        log = LogWriter(args.log, args.prefix)
        log.publish("VEHICLE", msg)
        log.close()
        print(f"{describe(msg)} into {args.log}")
        return 0
    send(Bus(args.lcm_url, args.prefix), msg, args.timeout, fixed_revision=args.revision is not None)
    print(f"{describe(msg)} in force")
    return 0


def describe(msg: vehicle_t) -> str:
    body = vehicle.body(msg)
    if body.is_disc:
        shape = f"disc of radius {body.radius:g} m"
    else:
        size = body.vertices.max(axis=0) - body.vertices.min(axis=0) + 2.0 * body.radius
        shape = f"footprint {size[0]:.2f} x {size[1]:.2f} m"
    return f"vehicle revision {msg.vehicle_revision}: {shape}, margin {body.margin:g} m"


def send(bus: Bus, msg: vehicle_t, timeout: float, fixed_revision: bool = False) -> None:
    status = StatusWatch(bus)
    before = status.wait(timeout)
    if not fixed_revision and before.vehicle_revision >= msg.vehicle_revision:
        msg.vehicle_revision = before.vehicle_revision + 1

    def is_held(s: status_t) -> bool:
        return s.vehicle_revision == msg.vehicle_revision

    what = f"vehicle revision {msg.vehicle_revision}"
    send_until_held(bus, status, lambda: bus.publish("VEHICLE", msg), is_held, what, timeout)
