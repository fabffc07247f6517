"""A vehicle for tests on a real bus: it follows the newest path while its lease lasts, and publishes its pose at 20 Hz."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from aisle import goal_list_t, path_t, pose_t, waypoint_t
from aisle_tools import geometry, goals
from aisle_tools.bus import now_us
from harness import Daemon

PERIOD = 0.05  # s
REST = 1e-6  # m/s


class Rider:
    """Where it is told to be by the path's own times; at rest without a lease."""

    def __init__(self, daemon: Daemon, start: Sequence[float]) -> None:
        self.daemon, self.pose, self.speed, self.turn_rate = daemon, tuple(start), 0.0, 0.0
        self.seq = 0
        self.dwells: dict[int, float] = {}  # s by goal id

    def send(self, goal_list: goal_list_t) -> None:
        self.dwells = {g.id: g.dwell for g in goal_list.goals}
        self.daemon.bus.publish("GOALS", goal_list)

    def ride(self, seconds: float, until: Callable[[], bool] = lambda: False) -> bool:
        """Drives on; True as soon as the condition holds."""
        for _ in range(int(seconds / PERIOD)):
            self._move()
            self.seq += 1
            self.daemon.bus.publish("POSE", self._message())
            self.daemon.bus.spin(PERIOD)
            if until():
                return True
        return False

    def _message(self) -> pose_t:
        msg = goals.make_pose(self.pose, self.seq, 1)
        msg.vx, msg.omega = self.speed, self.turn_rate
        return msg

    def _move(self) -> None:
        self.speed = self.turn_rate = 0.0
        path = self.daemon.paths[-1][1] if self.daemon.paths else None
        if path is None or path.status == path_t.NONE or now_us() > path.valid_until_utime:
            return
        self._follow(path.waypoints, (now_us() - path.t0_utime) * 1e-6)

    def _follow(self, w: Sequence[waypoint_t], t: float) -> None:
        i = next((k for k in range(1, len(w)) if w[k].t > t), len(w) - 1)
        if i < 1:
            return
        before = self.pose
        a, b = w[i - 1], w[i]
        piece = geometry.piece(a, b)
        share, self.speed = self._progress(a, b, piece.length, t)
        if i == len(w) - 1 and t >= b.t:
            share, self.speed = 1.0, 0.0
        self.pose = piece.at(share)
        self.turn_rate = geometry.wrap(self.pose[2] - before[2]) / PERIOD

    def _progress(self, a: waypoint_t, b: waypoint_t, length: float, t: float) -> tuple[float, float]:
        """Share of the piece behind and speed (m/s) at time t; rests come first."""
        moving = 2.0 * length / (a.v + b.v) if a.v + b.v > REST else b.t - a.t - self._dwell(a)
        moving = max(min(moving, b.t - a.t), 1e-6)
        f = max(0.0, min(1.0, (t - (b.t - moving)) / moving))
        if a.v + b.v <= REST:  # from rest to rest: about so
            return f * f * (3.0 - 2.0 * f), 6.0 * f * (1.0 - f) * length / moving
        rate = (b.v - a.v) / moving
        return (a.v + 0.5 * rate * f * moving) * f * moving / length, a.v + rate * f * moving

    def _dwell(self, w: waypoint_t) -> float:
        return self.dwells.get(w.goal_id, 0.0) if w.flags & waypoint_t.GOAL else 0.0
