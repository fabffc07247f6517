"""The curve that waypoints define, from the convention of waypoint_t alone.

Between two waypoints the origin moves on a straight line or, where the later one's curvature k is not 0, on the minor arc
of signed curvature k (positive = left turn along the motion). theta changes linearly, the short way round.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from aisle import waypoint_t


def wrap(angle: float) -> float:
    """Into (-pi, pi]."""
    angle = math.fmod(angle, 2.0 * math.pi)
    if angle <= -math.pi:
        return angle + 2.0 * math.pi
    return angle - 2.0 * math.pi if angle > math.pi else angle


@dataclass
class Piece:
    """The motion between two waypoints."""

    x: float
    y: float
    theta: float
    turn: float  # rad, change of theta
    heading: float  # rad, direction of motion at the start; theta where nothing moves
    curvature: float
    length: float  # m, of the origin's way

    def at(self, f: float) -> tuple[float, float, float]:
        """(x, y, theta) at the fraction f of the way."""
        s, k = f * self.length, self.curvature
        theta = self.theta + f * self.turn
        if k == 0.0:
            return self.x + s * math.cos(self.heading), self.y + s * math.sin(self.heading), theta
        half = 0.5 * k * s
        chord = s if half == 0.0 else 2.0 * math.sin(half) / k
        return self.x + chord * math.cos(self.heading + half), self.y + chord * math.sin(self.heading + half), theta

    def heading_at(self, f: float) -> float:
        return self.heading + self.curvature * f * self.length


def piece(a: waypoint_t, b: waypoint_t) -> Piece:
    dx, dy = b.x - a.x, b.y - a.y
    chord = math.hypot(dx, dy)
    turn = wrap(b.theta - a.theta)
    if chord == 0.0:
        return Piece(a.x, a.y, a.theta, turn, a.theta, 0.0, 0.0)
    direction = math.atan2(dy, dx)
    k = b.curvature
    if k == 0.0:
        return Piece(a.x, a.y, a.theta, turn, direction, 0.0, chord)
    half = math.asin(max(-1.0, min(1.0, 0.5 * chord * k)))  # of the arc's angle, signed
    return Piece(a.x, a.y, a.theta, turn, direction - half, k, 2.0 * half / k)


def pieces(waypoints: Sequence[waypoint_t]) -> list[Piece]:
    return [piece(a, b) for a, b in zip(waypoints, waypoints[1:])]


@dataclass
class Sample:
    x: float
    y: float
    theta: float
    index: int  # of the piece
    fraction: float  # along it


def sample(waypoints: Sequence[waypoint_t], step: float = 0.01, turn_step: float = 0.01) -> Iterator[Sample]:
    """Poses at most `step` metres and `turn_step` radians apart, ends of every piece included."""
    if len(waypoints) == 1:
        yield Sample(waypoints[0].x, waypoints[0].y, waypoints[0].theta, 0, 0.0)
    for i, p in enumerate(pieces(waypoints)):
        n = max(1, math.ceil(p.length / step), math.ceil(abs(p.turn) / turn_step))
        for j in range(0 if i == 0 else 1, n + 1):
            x, y, theta = p.at(j / n)
            yield Sample(x, y, theta, i, j / n)


def length(waypoints: Sequence[waypoint_t]) -> float:
    return sum(p.length for p in pieces(waypoints))
