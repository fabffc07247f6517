"""aisle query: asks for paths, prints one row each, saves the replies."""

from __future__ import annotations

import argparse
import csv
import json
import math
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from aisle import goal_list_t, goal_t, options_t, path_t, query_t, vehicle_t

from aisle_tools import maps, names, vehicle
from aisle_tools.bus import Bus, LogWriter, StatusWatch, now_us
from aisle_tools.errors import UserError
from aisle_tools.scenario import read_scenario
from aisle_tools.world import World

ANY_HEADING = 4.0  # rad, at least pi
PASSES = 3  # a query is asked so often within the time limit


@dataclass
class Leg:
    """One query to be: poses of 2 (any heading) or 3 numbers."""

    name: str
    start: tuple[float, ...]
    goals: list[tuple[float, ...]]
    given_length: float = math.nan  # from the goals file


def parse_pose(text: str, option: str) -> tuple[float, ...]:
    try:
        values = tuple(float(v) for v in text.split(","))
    except ValueError:
        values = ()
    if len(values) not in (2, 3) or not all(math.isfinite(v) for v in values):
        raise UserError(f"{option} '{text}' is not X,Y or X,Y,TH (metres, radians)")
    return values


def read_goals(path: Path) -> list[Leg]:
    """CSV with a header: start_x, start_y, goal_x, goal_y; optional start_theta, goal_theta, name and any ...length... ."""
    try:
        with path.open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
    except OSError as e:
        raise UserError(f"{path}: {e.strerror}") from None
    if not rows:
        raise UserError(f"{path}: no rows")
    for key in ("start_x", "start_y", "goal_x", "goal_y"):
        if key not in rows[0]:
            raise UserError(f"{path}:1: column '{key}' is missing")
    length_key = next((k for k in rows[0] if k and "length" in k), None)
    return [_leg_of_row(path, i, row, length_key) for i, row in enumerate(rows)]


def _leg_of_row(path: Path, index: int, row: dict, length_key: str | None) -> Leg:
    def pose(which: str) -> tuple[float, ...]:
        keys = [f"{which}_x", f"{which}_y"] + ([f"{which}_theta"] if row.get(f"{which}_theta") else [])
        return tuple(float(row[k]) for k in keys)

    try:
        length = float(row[length_key]) if length_key and row[length_key] else math.nan
        return Leg(row.get("name") or str(index + 1), pose("start"), [pose("goal")], length)
    except (TypeError, ValueError):
        raise UserError(f"{path}:{index + 2}: not numbers: {','.join(str(v) for v in row.values())}") from None


def make_goal(ident: int, pose: Sequence[float], any_heading: bool) -> goal_t:
    goal = goal_t()
    goal.id, goal.x, goal.y = ident, float(pose[0]), float(pose[1])
    goal.theta = float(pose[2]) if len(pose) == 3 else 0.0
    if len(pose) == 2 or any_heading:
        goal.tolerance_theta = ANY_HEADING
    return goal


def make_options(args: argparse.Namespace) -> options_t:
    options = options_t()
    options.planner = names.option_value(args.planner, names.PLANNERS)
    options.objective = names.option_value(args.objective, names.OBJECTIVES)
    options.interpolation = names.option_value(args.interpolation, names.INTERPOLATIONS)
    options.seed, options.work_units = args.seed, args.work_units
    return options


def make_query(leg: Leg, ident: int, map_id: int, options: options_t, any_heading: bool, any_order: bool = False) -> query_t:
    query = query_t()
    query.utime, query.query_id, query.map_id, query.options = now_us(), ident, map_id, options
    # Without a heading the start looks at the first goal and may be turned at will.
    start = leg.start
    facing = math.atan2(leg.goals[0][1] - start[1], leg.goals[0][0] - start[0])
    query.start = make_goal(0, start, any_heading)
    query.start.theta = start[2] if len(start) == 3 else facing
    query.goals = [make_goal(i + 1, g, any_heading) for i, g in enumerate(leg.goals)]
    query.num_goals = len(query.goals)
    query.ordering = goal_list_t.ANY_ORDER if any_order else goal_list_t.ORDERED
    return query


def add_leg_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("what to ask")
    group.add_argument("--start", metavar="X,Y[,TH]")
    group.add_argument("--goal", action="append", metavar="X,Y[,TH]", help="several: visited in order")
    group.add_argument("--goals", type=Path, metavar="FILE", help="CSV of start_x,start_y,goal_x,goal_y: a query a row")
    group.add_argument("--scenario", type=Path, metavar="FILE", help="a query for each leg of this scenario (and its robot)")
    group.add_argument("--any-heading", action="store_true", help="at every goal (the default where TH is not given)")
    group.add_argument("--any-order", action="store_true", help="let the daemon choose the order of several goals")
    group.add_argument("--map-id", type=int, metavar="N", help="default: the map held (1 with --log)")


def add_plan_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("how to plan")
    group.add_argument("--objective", default="safest", metavar="O", help=", ".join(names.OBJECTIVES).lower())
    group.add_argument("--planner", default="auto", metavar="P", help=", ".join(names.PLANNERS).lower())
    group.add_argument("--interpolation", default="spline", metavar="I", help="spline, linear")
    group.add_argument("--seed", type=int, default=0, metavar="N")
    group.add_argument("--work-units", type=int, default=0, metavar="N", help="budget of each query, 0 = from settings")


def legs_of(args: argparse.Namespace) -> list[Leg]:
    if args.goals is not None:
        return read_goals(args.goals)
    if args.scenario is not None and args.start is None:
        scenario = read_scenario(args.scenario)
        stops = [scenario.start, *scenario.goals]
        return [Leg(str(i + 1), a, [b]) for i, (a, b) in enumerate(zip(stops, stops[1:]))]
    if args.start is None or not args.goal:
        raise UserError("what to ask? give --start and --goal, --goals FILE or --scenario FILE")
    if len(args.goal) > query_t.MAX_GOALS:
        raise UserError(f"{len(args.goal)} goals is over the limit {query_t.MAX_GOALS}")
    return [Leg("1", parse_pose(args.start, "--start"), [parse_pose(g, "--goal") for g in args.goal])]


def check_inside(legs: list[Leg], world: World) -> None:
    for leg in legs:
        for what, pose in [("start", leg.start), *(("goal", g) for g in leg.goals)]:
            if not world.holds(pose[0], pose[1]):
                x0, y0, x1, y1 = world.bounds
                raise UserError(
                    f"query {leg.name}: {what} ({pose[0]:g}, {pose[1]:g}) is outside the map {world.name}: "
                    f"x {x0:g} to {x1:g}, y {y0:g} to {y1:g}"
                )


def configure(parser: argparse.ArgumentParser) -> None:
    add_leg_options(parser)
    add_plan_options(parser)
    maps.add_read_options(parser)
    parser.add_argument("--map", type=Path, metavar="FILE", help="check start and goals against this map first")
    vehicle.add_options(parser)
    parser.add_argument("--json", action="store_true", help="one JSON object a line instead of the table")
    parser.add_argument(
        "--save", type=Path, metavar="FILE", help="LCM log of vehicle (--vehicle ...), queries and replies, for plot, check"
    )


def run(args: argparse.Namespace) -> int:
    legs = legs_of(args)
    if args.map is not None:
        check_inside(legs, maps.read_any(args.map, args)[0])
    if args.log is not None:
        return write_log(args, legs)
    pairs = ask_all(args, legs, print_row=True)
    if args.save is not None:
        save(args, pairs)
    return 0 if all(reply.status == path_t.OK for _, reply in pairs) else 1


def write_log(args: argparse.Namespace, legs: list[Leg]) -> int:
    log = LogWriter(args.log, args.prefix)
    options = make_options(args)
    for i, leg in enumerate(legs):
        log.publish("QUERY", make_query(leg, i + 1, args.map_id or 1, options, args.any_heading, args.any_order))
    log.close()
    print(f"{len(legs)} queries into {args.log}")
    return 0


def ask_all(args: argparse.Namespace, legs: list[Leg], print_row: bool) -> list[tuple[query_t, path_t]]:
    bus = Bus(args.lcm_url, args.prefix)
    asker = Asker(bus, args.timeout)
    status = StatusWatch(bus)
    held = status.wait(args.timeout)
    map_id = args.map_id if args.map_id is not None else held.map_id
    options = make_options(args)
    table = Table(args.json, any(not math.isnan(leg.given_length) for leg in legs)) if print_row else None
    pairs = []
    base = (time.time_ns() // 1_000_000) % 1_000_000_000 + 1
    for i, leg in enumerate(legs):
        query = make_query(leg, base + i, map_id, options, args.any_heading, args.any_order)
        reply, seconds = asker.ask(query)
        pairs.append((query, reply))
        if table is not None:
            table.row(leg, reply, seconds)
    return pairs


class Asker:
    """Sends a query and waits for its reply."""

    def __init__(self, bus: Bus, timeout: float) -> None:
        self.bus, self.timeout = bus, timeout
        self.replies: dict[int, path_t] = {}
        bus.subscribe("REPLY", path_t, self._take)

    def _take(self, msg: path_t) -> None:
        self.replies[msg.query_id] = msg

    def ask(self, query: query_t) -> tuple[path_t, float]:
        """(reply, seconds from asking to hearing)."""
        begin = time.monotonic()
        for _ in range(PASSES):
            self.bus.publish("QUERY", query)
            if self.bus.spin(self.timeout / PASSES, lambda: query.query_id in self.replies):
                return self.replies.pop(query.query_id), time.monotonic() - begin
        raise self.bus.no_answer(self.timeout)


class Table:
    """Rows as text or JSON."""

    def __init__(self, as_json: bool, with_given: bool) -> None:
        self.as_json, self.with_given = as_json, with_given
        if not as_json:
            given = f"{'given':>8} " if with_given else ""
            print(
                f"{'query':>5} {'start':>16} {'goal':>16} {'status':>7} {'length':>8} {given}{'bound':>8} "
                f"{'clear':>6} {'time':>7} {'units':>8} {'ms':>7}  reason"
            )

    def row(self, leg: Leg, reply: path_t, seconds: float) -> None:
        if self.as_json:
            print(json.dumps(as_dict(leg, reply, seconds)), flush=True)
            return
        given = f"{blank(leg.given_length, 8, 2)} " if self.with_given else ""
        has = names.is_path(reply)
        print(
            f"{leg.name:>5} {place(leg.start):>16} {place(leg.goals[-1]):>16} {names.result_name(reply.status):>7} "
            f"{blank(reply.length if has else math.nan, 8, 2)} {given}{blank(reply.length_bound or math.nan, 8, 2)} "
            f"{blank(reply.clearance_min if has else math.nan, 6, 3)} {blank(reply.duration if has else math.nan, 7, 1)} "
            f"{reply.work_units:>8} {1000.0 * (reply.planning_time or seconds):>7.1f}  "
            f"{names.reason(reply) if reply.cause else ''}".rstrip(),
            flush=True,
        )


def place(pose: Sequence[float]) -> str:
    return f"{pose[0]:.2f},{pose[1]:.2f}"


def blank(value: float, width: int, digits: int) -> str:
    return f"{'-':>{width}}" if math.isnan(value) else f"{value:>{width}.{digits}f}"


def as_dict(leg: Leg, reply: path_t, seconds: float) -> dict:
    out = {
        "query": leg.name,
        "start": leg.start,
        "goals": leg.goals,
        "status": names.result_name(reply.status),
        "cause": names.cause_name(reply.cause) if reply.cause else None,
        "reason": names.reason(reply) if reply.cause else None,
        "cause_id": reply.cause_id,
        "cause_value": reply.cause_value,
        "length": reply.length,
        "length_bound": reply.length_bound,
        "clearance": reply.clearance_min,
        "duration": reply.duration,
        "work_units": reply.work_units,
        "ms": 1000.0 * (reply.planning_time or seconds),
        "waypoints": reply.num_waypoints if names.is_path(reply) else 0,
        "place": names.place(reply),
        "gap_between": [w.goal_id for w in names.gap_sides(reply)],
        "move_to": names.free_place(reply),
        "remove": [w.goal_id for w in names.removals(reply)],
        "certificate": reply.certificate & 0xFFFFFFFF,
    }
    if not math.isnan(leg.given_length):
        out["given_length"] = leg.given_length
    return out


def save(args: argparse.Namespace, pairs: list[tuple[query_t, path_t]]) -> None:
    args.save.unlink(missing_ok=True)
    log = LogWriter(args.save, args.prefix)
    msg: vehicle_t | None = vehicle.from_options(args, read_scenario(args.scenario) if args.scenario else None)
    if msg is not None:
        log.publish("VEHICLE", msg)
    for query, reply in pairs:
        log.publish("QUERY", query)
        log.publish("REPLY", reply)
    log.close()
