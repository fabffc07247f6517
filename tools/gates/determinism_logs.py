#!/usr/bin/env python3
"""Logs for determinism.sh that the aisle command does not make, and whether what they are for happens in them.

    determinism_logs.py make FOLDER        racks.log: a forklift with a turning circle in a rack hall, some of whose stops
                                           take a manoeuvre; zones.log: slow, dear and one-way ground
    determinism_logs.py look LOG OUTPUT    aisle-replay's output of one of them; exit 1: no reversal in racks.log, or no
                                           way in zones.log that a zone lengthens or slows
"""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path

import numpy as np
from aisle import options_t, path_t, polygon_t, waypoint_t
from aisle_tools import layouts, query, vehicle
from aisle_tools.bus import LogWriter, Recording
from aisle_tools.world import Polygon, World

PREFIX = "AISLE"
UP, DOWN = 0.5 * math.pi, -0.5 * math.pi
OBJECTIVES = (options_t.SHORTEST, options_t.SAFEST, options_t.FASTEST)
FORKLIFT = {
    "footprint": [[-0.5, -0.5], [1.9, -0.5], [1.9, 0.5], [-0.5, 0.5]],
    "margin": 0.05,
    "drive": "tricycle",
    "curvature_max": 0.6666,
}
SLOW = 0.2  # m/s


def box(ident: int, kind: int, x0: float, y0: float, x1: float, y1: float, **more: float) -> Polygon:
    return Polygon(ident, np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)]), kind, **more)


def racks() -> tuple[World, dict, list[query.Leg]]:
    """Aisles of 1.3 m, the middle one closed at its upper end; cross aisles of 3.5 m."""
    boxes = [box(i + 1, polygon_t.OBSTACLE, x, 3.5, x + 1.1, 10.5) for i, x in enumerate((1.3, 3.7, 6.1, 8.5))]
    boxes.append(box(9, polygon_t.OBSTACLE, 4.8, 9.5, 6.1, 10.5))
    legs = [
        query.Leg("aisle to aisle", (0.65, 7.0, UP), [(7.85, 7.0, DOWN)]),
        query.Leg("out of the dead end", (5.45, 7.0, UP), [(12.0, 12.0, 0.0)]),
        query.Leg("in again", (12.0, 2.0, math.pi), [(5.45, 7.0, UP)]),
    ]
    return World("racks", (0.0, 0.0, 14.0, 14.0), boxes), FORKLIFT, legs


def zones() -> tuple[World, dict, list[query.Leg]]:
    """A wall with three doors: one-way against the first leg, slow, and dear."""
    wall = [box(i + 1, polygon_t.OBSTACLE, 6.0, y0, 7.0, y1) for i, (y0, y1) in enumerate(((0, 1), (3, 5), (7, 9), (11, 12)))]
    ground = [
        box(11, polygon_t.DIRECTED, 5.5, 1.0, 7.5, 3.0, direction=math.pi),
        box(12, polygon_t.SPEED_LIMIT, 5.0, 4.5, 8.0, 7.5, value=SLOW),
        box(13, polygon_t.PENALTY, 5.0, 8.5, 8.0, 11.5, value=0.5),
    ]
    legs = [
        query.Leg("to", (2.0, 2.0), [(11.0, 2.0)]),
        query.Leg("fro", (11.0, 2.0), [(2.0, 2.0), (11.0, 10.0)]),
    ]
    return World("zones", (0.0, 0.0, 13.0, 12.0), [*wall, *ground]), {"radius": 0.4, "margin": 0.05}, legs


def write(path: Path, world: World, body: dict, legs: list[query.Leg]) -> None:
    path.unlink(missing_ok=True)
    log = LogWriter(path, PREFIX)
    for name, part in layouts.make_messages(world, 1, 1, 0):
        log.publish(name, part)
    log.publish("VEHICLE", vehicle.make({**body, "vehicle_revision": 1}))
    asked = [(leg, objective) for objective in OBJECTIVES for leg in legs]
    for i, (leg, objective) in enumerate(asked):
        options = options_t()
        options.objective = objective
        log.publish("QUERY", query.make_query(leg, i + 1, 1, options, False))
    log.close()


def has_reversal(path: path_t) -> bool:
    return any(w.flags & waypoint_t.REVERSE for w in path.waypoints) and any(w.curvature for w in path.waypoints)


def minds_a_zone(path: path_t) -> bool:
    slow = any(0.0 < w.v <= SLOW + 1e-6 and 5.0 < w.x < 8.0 and 4.5 < w.y < 7.5 for w in path.waypoints)
    return slow or path.length > 1.2 * path.length_bound


def look(log: Path, output: Path) -> int:
    paths = [p for p in Recording(output, PREFIX).replies if p.status == path_t.OK]
    wanted = {"racks": has_reversal, "zones": minds_a_zone}[log.stem]
    if any(map(wanted, paths)):
        return 0
    print(f"determinism: none of {len(paths)} paths of {log.name} is what the log is for", file=sys.stderr)
    return 1


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("what", choices=("make", "look"))
    parser.add_argument("paths", type=Path, nargs="+", metavar="FILE")
    args = parser.parse_args()
    if args.what == "look":
        return look(*args.paths)
    write(args.paths[0] / "racks.log", *racks())
    write(args.paths[0] / "zones.log", *zones())
    return 0


if __name__ == "__main__":
    sys.exit(main())
