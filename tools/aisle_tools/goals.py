"""aisle goal: a goal list for the vehicle to drive, with a simulated pose if wished."""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence

from aisle import goal_list_t, path_t, pose_t

from aisle_tools import names, query
from aisle_tools.bus import Bus, LogWriter, StatusWatch, now_us, time_revision
from aisle_tools.errors import UserError

POSE_INTERVAL = 0.05  # s


def configure(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--goal", action="append", metavar="X,Y[,TH]", help="several: visited in order; none: cancel")
    parser.add_argument("--any-heading", action="store_true", help="at every goal (the default where TH is not given)")
    parser.add_argument("--any-order", action="store_true", help="let the daemon choose the order")
    parser.add_argument("--pose", metavar="X,Y[,TH]", help="publish this pose at 20 Hz while waiting")
    parser.add_argument("--for", dest="seconds", type=float, default=2.0, metavar="S", help="listen to _PATH so long")
    parser.add_argument("--list-id", type=int, default=1, metavar="N")
    parser.add_argument("--list-revision", type=int, metavar="N", help="default: rises with time")
    parser.add_argument("--map-id", type=int, metavar="N", help="default: the map held (1 with --log)")
    query.add_plan_options(parser)


def make_list(args: argparse.Namespace, map_id: int) -> goal_list_t:
    msg = goal_list_t()
    msg.utime, msg.goal_list_id, msg.map_id = now_us(), args.list_id, map_id
    msg.goal_list_revision = args.list_revision if args.list_revision is not None else time_revision()
    msg.ordering = goal_list_t.ANY_ORDER if args.any_order else goal_list_t.ORDERED
    msg.options = query.make_options(args)
    poses = [query.parse_pose(g, "--goal") for g in args.goal or []]
    if len(poses) > goal_list_t.MAX_GOALS:
        raise UserError(f"{len(poses)} goals is over the limit {goal_list_t.MAX_GOALS}")
    msg.goals = [query.make_goal(i + 1, p, args.any_heading) for i, p in enumerate(poses)]
    msg.num_goals = len(msg.goals)
    return msg


def make_pose(pose: Sequence[float], seq: int, map_id: int) -> pose_t:
    msg = pose_t()
    msg.utime, msg.seq, msg.map_id = now_us(), seq, map_id
    msg.x, msg.y = float(pose[0]), float(pose[1])
    msg.theta = float(pose[2]) if len(pose) == 3 else 0.0
    msg.cov = [0.0] * 6
    msg.localized = True
    return msg


def run(args: argparse.Namespace) -> int:
    pose = query.parse_pose(args.pose, "--pose") if args.pose is not None else None
    if args.log is not None:
        log = LogWriter(args.log, args.prefix)
        if pose is not None:
            log.publish("POSE", make_pose(pose, 1, args.map_id or 1))
        log.publish("GOALS", make_list(args, args.map_id or 1))
        log.close()
        return 0
    return Drive(args, pose).run()


class Drive:
    """Sends the list, publishes the pose, prints each new path until the time is up."""

    def __init__(self, args: argparse.Namespace, pose: Sequence[float] | None) -> None:
        self.args, self.pose = args, pose
        self.bus = Bus(args.lcm_url, args.prefix)
        self.status = StatusWatch(self.bus)
        held = self.status.wait(args.timeout)
        self.map_id = args.map_id if args.map_id is not None else held.map_id
        self.path: path_t | None = None
        self.seq = 0
        self.renewals = 0
        self.bus.subscribe("PATH", path_t, self._take)

    def _take(self, msg: path_t) -> None:
        if self.path is not None and self.path.path_revision == msg.path_revision and self.path.boot_id == msg.boot_id:
            self.renewals += 1
            self.path = msg
            return
        self.path = msg
        text = f"path {msg.path_revision}: {names.result_name(msg.status)}"
        if names.is_path(msg):
            text += f", {msg.length:.2f} m, {msg.duration:.1f} s, clearance {msg.clearance_min:.3f} m"
        print(text + (f", {names.reason(msg)}" if msg.cause else ""), flush=True)

    def run(self) -> int:
        goals = make_list(self.args, self.map_id)
        end = time.monotonic() + self.args.seconds
        sent = 0.0
        while time.monotonic() < end:
            self._publish_pose()
            if not self._is_held(goals) and time.monotonic() - sent > 1.0:
                self.bus.publish("GOALS", goals)
                sent = time.monotonic()
            self.bus.spin(POSE_INTERVAL)
        return self._verdict(goals)

    def _publish_pose(self) -> None:
        if self.pose is not None:
            self.seq += 1
            self.bus.publish("POSE", make_pose(self.pose, self.seq, self.map_id))

    def _is_held(self, goals: goal_list_t) -> bool:
        s = self.status.last
        return s is not None and (s.goal_list_id, s.goal_list_revision) == (goals.goal_list_id, goals.goal_list_revision)

    def _verdict(self, goals: goal_list_t) -> int:
        last = self.status.last
        if not self._is_held(goals) and last is not None:
            raise UserError(f"goal list not acknowledged: cause {names.cause_name(last.cause)} {last.cause_id}")
        if goals.num_goals == 0:
            print("cancelled")
            return 0
        if self.path is None:
            raise UserError(f"no path within {self.args.seconds:g} s: cause {names.cause_name(last.cause) if last else '?'}")
        print(f"lease renewed {self.renewals} times")
        return 0 if self.path.status == path_t.OK else 1
