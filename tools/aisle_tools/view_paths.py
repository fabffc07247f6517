"""Paths for the page of aisle view: points along them with speeds and times, and why each revision came."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import shapely
from aisle import path_t, query_t, waypoint_t

from aisle_tools import geometry, names
from aisle_tools.check import rest_to_rest_peak
from aisle_tools.vehicle import Body

STEP = 0.25  # m between points where speed or direction changes
TURN_STEP = 0.1  # rad
SAME_WAY = 0.02  # m, a path within this of the one before goes the same way
REST = 1e-6  # m/s


def number(value: float, digits: int) -> float:
    """Rounded; 0 for what is no number, as JSON has none."""
    return round(value, digits) if math.isfinite(value) else 0.0


def integers(values: Sequence[float] | np.ndarray, scale: float) -> list[int]:
    """Differences of the values in units of 1 / scale: small numbers, which compress well."""
    rounded = np.round(np.asarray(values, dtype=float) * scale).astype(np.int64)
    return np.diff(rounded, prepend=0).tolist()


def speeds_along(a: waypoint_t, b: waypoint_t, length: float, parts: np.ndarray, limits: dict[str, float]) -> np.ndarray:
    """m/s at parts of the piece: v^2 is linear in the way; from rest to rest a trapezoid."""
    if max(abs(a.v), abs(b.v)) > REST:
        return np.sqrt((1.0 - parts) * a.v * a.v + parts * b.v * b.v)
    peak = rest_to_rest_peak(length, b.t - a.t, limits)
    up = np.sqrt(2.0 * limits["a_max"] * length * parts)
    down = np.sqrt(2.0 * limits["d_max"] * length * (1.0 - parts))
    return np.minimum(np.minimum(up, down), peak)


def points_of(waypoints: Sequence[waypoint_t], limits: dict[str, float]) -> tuple[np.ndarray, list[int]]:
    """[n, 5] of x, y, theta, v, t along the path, and the row of each waypoint."""
    first = waypoints[0]
    rows = [(first.x, first.y, first.theta, first.v, first.t)]
    at = [0]
    for a, b in zip(waypoints, waypoints[1:]):
        piece = geometry.piece(a, b)
        count = max(1, math.ceil(abs(piece.turn) / TURN_STEP))
        if piece.curvature != 0.0 or abs(a.v - b.v) > REST or abs(a.v) <= REST:  # else both ends tell all
            count = max(count, math.ceil(piece.length / STEP))
        parts = np.arange(1, count + 1) / count
        v = speeds_along(a, b, piece.length, parts, limits) if piece.length > 0.0 else np.zeros(count)
        times = times_along(a, b, np.concatenate([[abs(a.v)], v]))
        rows += [(*piece.at(f), v[i], times[i]) for i, f in enumerate(parts)]
        at.append(len(rows) - 1)
    return np.array(rows), at


def times_along(a: waypoint_t, b: waypoint_t, v: np.ndarray) -> np.ndarray:
    """s at equal steps with these speeds at their ends, fitted to the times of the waypoints."""
    mean = 0.5 * (v[:-1] + v[1:])
    if mean.min(initial=1.0) <= REST:
        return a.t + (b.t - a.t) * np.arange(1, len(v)) / (len(v) - 1)
    share = np.cumsum(1.0 / mean)
    return a.t + (b.t - a.t) * share / share[-1]


def encode(path: path_t, body: Body, with_pose: bool = False) -> dict:
    """Points of a path; of a refusal, the places that tell its reason."""
    if not names.is_path(path):
        return {"hints": hints_of(path)}
    waypoints = path.waypoints[: path.num_waypoints]
    if not all(math.isfinite(c) for w in waypoints for c in (w.x, w.y, w.theta, w.v, w.t, w.curvature)):
        return {"hints": None}
    rows, at = points_of(waypoints, body.limits)
    base = at[min(max(path.num_base, 1), len(at)) - 1]
    out = {"x": integers(rows[:, 0], 1e3), "y": integers(rows[:, 1], 1e3), "v": integers(rows[:, 3], 100), "base": base}
    if with_pose:
        out |= {"th": integers(np.unwrap(rows[:, 2]), 1e3), "t": integers(rows[:, 4], 1e3)}
    return out


def hints_of(path: path_t) -> dict:
    """As aisle plot marks them: place, gap, a free place, polygons to remove."""
    spot = names.place(path)
    free = names.free_place(path)
    return {
        "place": [number(c, 3) for c in spot] if spot else None,
        "free": [number(c, 3) for c in free] if free else None,
        "gap": [[number(w.x, 3), number(w.y, 3)] for w in names.gap_sides(path)],
        "without": [[number(w.x, 3), number(w.y, 3), w.goal_id] for w in names.removals(path)],
    }


def line_of(path: path_t) -> shapely.LineString | None:
    points = [(w.x, w.y) for w in path.waypoints[: path.num_waypoints] if math.isfinite(w.x + w.y)]
    return shapely.LineString(points) if len(points) > 1 and names.is_path(path) else None


def change_of(path: path_t, before: path_t | None) -> str:
    """What is new about a revision beside the one before."""
    if before is None or path.boot_id != before.boot_id:
        return "first path" if before is None else "daemon restarted"
    if (path.goal_list_id, path.goal_list_revision) != (before.goal_list_id, before.goal_list_revision):
        return "new goals"
    if (path.map_id, path.map_revision) != (before.map_id, before.map_revision):
        return "layout changed"
    if path.vehicle_revision != before.vehicle_revision:
        return "vehicle changed"
    new, old = line_of(path), line_of(before)
    if new is None:
        return "path revoked" if old is not None else "still none"
    if old is None:
        return "goes on"
    return "same way, other speeds" if same_way(new, old) else "another way"


def same_way(new: shapely.LineString, old: shapely.LineString) -> bool:
    """One begins within the other and runs along it; a shorter one may end early."""
    return shapely.distance(old, shapely.points(new.coords)).max() < SAME_WAY or new.buffer(SAME_WAY).covers(old)


def result_of(path: path_t, body: Body, with_pose: bool = False) -> dict:
    """What the page shows of a path or reply."""
    return {
        "rev": path.path_revision,
        "status": path.status,
        "result": names.result_name(path.status),
        "cause": path.cause,
        "by": path.cause_id,
        "why": names.path_in_words(path),
        "map": [path.map_id, path.map_revision],
        "vehicle": path.vehicle_revision,
        "length": number(path.length, 2),
        "duration": number(path.duration, 2),
        "clearance": number(path.clearance_min, 3),
        **encode(path, body, with_pose),
    }


def reply_of(reply: path_t, asked: query_t | None, body: Body) -> dict:
    stops = [asked.start, *asked.goals[: asked.num_goals]] if asked is not None else []
    places = [[number(s.x, 3), number(s.y, 3), number(s.theta, 3)] for s in stops]
    return {"query": reply.query_id, "stops": places, "bound": number(reply.length_bound, 2), **result_of(reply, body, True)}
