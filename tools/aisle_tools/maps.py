"""aisle map: a map or scenario to layout_t and grid_chunk_t, onto the bus until it is acknowledged, or into a log."""

from __future__ import annotations

import argparse
from pathlib import Path

from aisle import status_t

from aisle_tools import layouts, movingai, rosmap
from aisle_tools.acknowledge import send_until_held
from aisle_tools.bus import Bus, LogWriter, StatusWatch, now_us, time_revision
from aisle_tools.errors import UserError
from aisle_tools.scenario import Scenario, read_scenario
from aisle_tools.world import World


def read_any(path: Path, args: argparse.Namespace, margin: float = 0.0) -> tuple[World, Scenario | None]:
    """A World from a map_server YAML, MovingAI .map or scenario JSON; the Scenario too, if it is one."""
    resolution = getattr(args, "resolution", 0.0)
    if path.suffix.lower() == ".json":
        scenario = read_scenario(path, margin, resolution)
        return scenario.world, scenario
    if path.suffix.lower() == ".map":
        return movingai.read_world(path, resolution, args.max_cells), None
    if path.suffix.lower() in (".pgm", ".png", ".bmp", ".jpg"):
        raise UserError(f"{path}: give the map's .yaml file, not its image")
    return rosmap.read_world(path, args.strict_free, args.max_cells), None


def add_read_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("reading maps")
    group.add_argument(
        "--strict-free",
        action="store_true",
        help=f"free only if p < min(free_thresh, {rosmap.STRICT_FREE}): grey 205 stays unknown, that is occupied",
    )
    group.add_argument("--max-cells", type=int, default=rosmap.CELLS_DEFAULT, metavar="N", help="aisled's limit 'cells'")


def configure(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "file", type=Path, nargs="+", metavar="FILE", help="map_server .yaml, scenario .json or MovingAI .map"
    )
    add_read_options(parser)
    parser.add_argument("--margin", type=float, default=0.0, metavar="M", help="scenario: grow the bounds by radius + M")
    parser.add_argument(
        "--resolution", type=float, default=0.0, metavar="M", help="scenario: of the planner's grid; .map: of a cell, 0.5"
    )
    parser.add_argument("--map-id", type=int, default=1, metavar="N")
    parser.add_argument("--map-revision", type=int, metavar="N", help="default: rises with time")
    parser.add_argument("--tile", type=int, default=layouts.TILE_SIDE, metavar="N", help="cells a side of a grid tile")


def run(args: argparse.Namespace) -> int:
    if args.tile < 8:
        raise UserError(f"--tile must be at least 8 cells, not {args.tile}")
    if args.resolution < 0.0:
        raise UserError(f"--resolution must not be negative: {args.resolution:g}")
    for i, path in enumerate(args.file):
        world, _ = read_any(path, args, args.margin)
        if args.log is not None:
            write_log(world, args, args.map_id + i)
        else:
            send(world, args, args.map_id + i)
    return 0


def describe(world: World) -> str:
    x0, y0, x1, y1 = world.bounds
    text = f"{world.name}: {x1 - x0:.1f} x {y1 - y0:.1f} m"
    if world.grid is not None:
        free = 100.0 * (1.0 - world.grid.occupied.mean())
        text += f", {world.grid.width} x {world.grid.height} cells of {world.grid.resolution:g} m, {free:.0f} % free"
    if world.polygons:
        text += f", {len(world.polygons)} polygons"
    return text


def write_log(world: World, args: argparse.Namespace, map_id: int) -> None:
    log = LogWriter(args.log, args.prefix)
    revision = args.map_revision if args.map_revision is not None else time_revision()
    messages = layouts.make_messages(world, map_id, revision, now_us(), args.tile)
    for name, msg in messages:
        log.publish(name, msg)
    log.close()
    print(f"{describe(world)}: map {map_id} revision {revision}, {len(messages)} messages into {args.log}")


def send(world: World, args: argparse.Namespace, map_id: int) -> None:
    bus = Bus(args.lcm_url, args.prefix)
    status = StatusWatch(bus)
    before = status.wait(args.timeout)
    revision = args.map_revision
    if revision is None:
        revision = time_revision()
        if before.map_id == map_id:
            revision = max(revision, before.map_revision + 1)
    messages = layouts.make_messages(world, map_id, revision, now_us(), args.tile)

    def publish() -> None:
        for name, msg in messages:
            bus.publish(name, msg)

    def is_held(s: status_t) -> bool:
        return s.map_id == map_id and s.map_revision == revision

    send_until_held(bus, status, publish, is_held, f"map {map_id} revision {revision}", args.timeout)
    print(f"{describe(world)}: map {map_id} revision {revision} in force, {len(messages)} messages")
