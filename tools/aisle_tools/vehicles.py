"""aisle vehicle: vehicle_t onto the bus until it is acknowledged, or into a log."""

from __future__ import annotations

import argparse
from pathlib import Path

from aisle import vehicle_t

from aisle_tools import vehicle
from aisle_tools.bus import Bus, LogWriter, StatusWatch, now_us, time_revision
from aisle_tools.errors import UserError
from aisle_tools.maps import REFUSALS, refusal_text
from aisle_tools.names import cause_name
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

    def held() -> bool:
        return status.last is not None and status.last.vehicle_revision == msg.vehicle_revision

    def refused() -> bool:
        return status.last is not None and status.last.num_rejected > before.num_rejected

    for _ in range(max(1, int(timeout))):
        bus.publish("VEHICLE", msg)
        bus.spin(1.0, lambda: held() or refused())
        if held():
            return
        if refused() and status.last is not None and status.last.cause in REFUSALS:
            raise UserError(refusal_text("vehicle", status.last))
    last = status.wait(timeout)
    raise UserError(
        f"vehicle revision {msg.vehicle_revision} was not taken within {timeout:g} s: "
        f"the daemon holds {last.vehicle_revision}, cause {cause_name(last.cause)}"
    )
