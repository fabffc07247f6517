"""aisle watch: a live view of driving, status, diagnosis and path."""

from __future__ import annotations

import argparse
import math
import time

from aisle import diag_t, obstacle_t, obstacles_t, path_t, pose_t, status_t
from rich.console import Console, Group
from rich.live import Live
from rich.table import Table

from aisle_tools import names
from aisle_tools.bus import Bus, now_us

REFRESH = 0.2  # s


def configure(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--once", action="store_true", help="print one view and end")
    parser.add_argument("--for", dest="seconds", type=float, metavar="S", help="end after so long")


class View:
    """The newest message of each kind as tables."""

    def __init__(self, bus: Bus) -> None:
        self.status: status_t | None = None
        self.diag: diag_t | None = None
        self.pose: pose_t | None = None
        self.movers: dict[int, obstacles_t] = {}  # by source
        self.paths: dict[str, path_t] = {}
        bus.subscribe("STATUS", status_t, lambda m: setattr(self, "status", m))
        bus.subscribe("POSE", pose_t, lambda m: setattr(self, "pose", m))
        bus.subscribe("OBSTACLES", obstacles_t, lambda m: self.movers.__setitem__(m.source, m))
        bus.subscribe("DIAG", diag_t, lambda m: setattr(self, "diag", m))
        bus.subscribe("PATH", path_t, lambda m: self.paths.__setitem__("path", m))
        bus.subscribe("REPLY", path_t, lambda m: self.paths.__setitem__("reply", m))

    def render(self) -> Group:
        parts = [self._driving(), self._status(), *(self._path(kind, p) for kind, p in self.paths.items())]
        if self.diag is not None:
            parts.append(self._diag(self.diag))
        return Group(*parts)

    def _driving(self) -> Table:
        table = facts("driving")
        s = self.status
        if s is None:
            return table
        table.add_row("now", names.in_words(s.state, s.cause, s.cause_id))
        if s.cause in (status_t.YIELDING, status_t.BLOCKED_BY):
            for mover in self.known(s.cause_id):
                table.add_row("in the way", describe(mover, self.pose))
        goal = f"goal {s.goal_id}: " if s.goal_id else ""
        table.add_row("to go", f"{goal}{s.distance_remaining:.2f} m, {s.time_remaining:.1f} s")
        if self.pose is not None:
            table.add_row("speed", f"{self.pose.vx:.2f} m/s" + ("" if self.pose.localized else ", not localised"))
        if self.movers:
            told = sum(m.num_obstacles for m in self.movers.values())
            table.add_row("movers", f"{told} of {len(self.movers)} source(s), {s.obstacles_age:.2f} s old")
        return table

    def known(self, ident: int) -> list[obstacle_t]:
        """Movers of this id; every source counts its own."""
        return [o for m in self.movers.values() for o in m.obstacles[: m.num_obstacles] if o.id == ident]

    def _status(self) -> Table:
        table = facts("status")
        s = self.status
        if s is None:
            table.add_row("waiting for", "a status_t")
            return table
        table.add_row("state", names.state_name(s.state))
        table.add_row("cause", names.cause_name(s.cause) + (f" {s.cause_id}" if s.cause_id else ""))
        table.add_row("boot, uptime", f"{s.boot_id}, {s.uptime / 1e6:.1f} s")
        table.add_row("map", f"{s.map_id} revision {s.map_revision}")
        table.add_row("vehicle", f"revision {s.vehicle_revision}")
        table.add_row("goals", f"list {s.goal_list_id} revision {s.goal_list_revision}, goal {s.goal_id}")
        table.add_row("path", f"revision {s.path_revision}")
        table.add_row("pose age", f"{s.pose_age:.2f} s")
        table.add_row("rejected, late", f"{s.num_rejected}, {s.num_deadline_missed}")
        return table

    @staticmethod
    def _path(kind: str, p: path_t) -> Table:
        table = facts(f"last {kind}")
        table.add_row("status", f"{names.result_name(p.status)}: {names.path_in_words(p)}")
        table.add_row("length, bound", f"{p.length:.2f} m, {p.length_bound:.2f} m")
        table.add_row("duration", f"{p.duration:.1f} s")
        table.add_row("clearance", f"{p.clearance_min:.3f} m")
        table.add_row("waypoints", f"{p.num_waypoints}")
        table.add_row("work units", f"{p.work_units}")
        if kind == "path":
            table.add_row("lease left", f"{(p.valid_until_utime - now_us()) / 1e6:.2f} s")
        return table

    @staticmethod
    def _diag(d: diag_t) -> Table:
        table = facts("diagnosis")
        table.add_row("arena", f"{d.arena_bytes / 2**20:.1f} MiB, most used {d.arena_used_max / 2**20:.1f} MiB")
        table.add_row("resident", f"{d.rss_bytes / 2**20:.1f} MiB")
        for i in range(d.num_timers):
            p50, p99, most = (1000.0 * x[i] for x in (d.timer_p50, d.timer_p99, d.timer_max))
            name = names.TIMERS.get(d.timer_id[i], f"timer {d.timer_id[i]}")
            table.add_row(name, f"{d.timer_count[i]} x, p50 {p50:.2f} p99 {p99:.2f} max {most:.2f} ms")
        for i in range(d.num_counters):
            table.add_row(names.COUNTERS.get(d.counter_id[i], f"counter {d.counter_id[i]}"), str(d.counter[i]))
        return table


def describe(o: obstacle_t, pose: pose_t | None) -> str:
    """What a mover is, how fast, and how far from the vehicle's origin."""
    text = f"{names.MOVERS.get(o.kind, 'unknown mover')} {o.id} at ({o.x:.2f}, {o.y:.2f}), {math.hypot(o.vx, o.vy):.2f} m/s"
    return text + (f", {math.hypot(o.x - pose.x, o.y - pose.y):.2f} m away" if pose is not None else "")


def facts(title: str) -> Table:
    table = Table(title=title, title_justify="left", show_header=False, box=None, padding=(0, 2))
    table.add_column(style="bold", min_width=16)
    table.add_column()
    return table


def run(args: argparse.Namespace) -> int:
    bus = Bus(args.lcm_url, args.prefix)
    view = View(bus)
    if not bus.spin(args.timeout, lambda: view.status is not None):
        raise bus.no_answer(args.timeout)
    console = Console()
    if args.once:
        bus.spin(1.2, lambda: view.diag is not None)
        console.print(view.render())
        return 0
    end = time.monotonic() + args.seconds if args.seconds is not None else float("inf")
    with Live(view.render(), console=console, refresh_per_second=1.0 / REFRESH) as live:
        while time.monotonic() < end:
            bus.spin(REFRESH)
            live.update(view.render())
    return 0
