"""Scenario files (JSON): bounds of the robot's centre, convex obstacles, robot, start and goals."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from aisle_tools.errors import UserError
from aisle_tools.world import Polygon, World

POINT_RADIUS = 0.001  # m: a point robot is a disc of 1 mm
BOUNDS_SLACK = 0.001  # m: a centre right on the bounds is allowed, and a proof needs some room
POLYGONS_MAX = 4096
POLYGON_VERTICES_MAX = 16
VERTICES_MAX = 32768


@dataclass
class Scenario:
    world: World
    radius: float  # of the disc, or the outer circle of the footprint; never 0
    footprint: list[list[float]]  # empty = disc
    start: tuple[float, ...]
    goals: list[tuple[float, ...]]


def read_scenario(path: Path, margin: float = 0.0, resolution: float = 0.0) -> Scenario:
    """The bounds are grown by radius and margin (negative = none): a layout's bounds are walls."""
    data = _load(path)
    robot = _get(path, data, "robot", dict)
    radius = float(robot.get("radius", 0.0)) or POINT_RADIUS
    grow = radius + max(margin, 0.0) + BOUNDS_SLACK
    x0, y0, x1, y1 = _numbers(path, _get(path, data, "bounds", list), "bounds", 4)
    if x0 >= x1 or y0 >= y1:
        raise UserError(f"{path}: bounds must be [x_min, y_min, x_max, y_max]")
    polygons = [_polygon(path, i + 1, p) for i, p in enumerate(_get(path, data, "obstacles", list))]
    check_counts(path, polygons)
    world = World(path.stem, (x0 - grow, y0 - grow, x1 + grow, y1 + grow), polygons, None, resolution)
    goals = [tuple(_numbers(path, g, "goals", None)) for g in _get(path, data, "goals", list)]
    start = tuple(_numbers(path, _get(path, data, "start", list), "start", None))
    return Scenario(world, radius, [list(map(float, v)) for v in robot.get("footprint", [])], start, goals)


def _load(path: Path) -> dict:
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except OSError as e:
        raise UserError(f"{path}: {e.strerror}") from None
    except json.JSONDecodeError as e:
        raise UserError(f"{path}:{e.lineno}: not valid JSON: {e.msg}") from None
    if not isinstance(data, dict) or "obstacles" not in data:
        raise UserError(f"{path}: not a scenario (needs bounds, robot, start, goals, obstacles)")
    return data


def _get(path: Path, data: dict, key: str, kind: type) -> list | dict:
    if not isinstance(data.get(key), kind):
        raise UserError(f"{path}: key '{key}' is missing or not a {kind.__name__}")
    return data[key]


def _numbers(path: Path, values: object, name: str, count: int | None) -> list[float]:
    ok = isinstance(values, list) and all(isinstance(v, (int, float)) and math.isfinite(v) for v in values)
    if not ok or (len(values) not in (2, 3) if count is None else len(values) != count):
        raise UserError(f"{path}: {name}: {values} is not {count or '2 or 3'} numbers")
    return [float(v) for v in values]


def _polygon(path: Path, ident: int, points: object) -> Polygon:
    if not isinstance(points, list) or not 3 <= len(points) <= POLYGON_VERTICES_MAX:
        raise UserError(f"{path}: obstacle {ident} must have 3 to {POLYGON_VERTICES_MAX} vertices")
    vertices = np.array([_numbers(path, p, f"obstacle {ident}", 2) for p in points])
    edges = np.roll(vertices, -1, axis=0) - vertices
    following = np.roll(edges, -1, axis=0)
    turn = edges[:, 0] * following[:, 1] - edges[:, 1] * following[:, 0]
    if (turn < 0.0).all():  # clockwise
        return Polygon(ident, vertices[::-1].copy())
    if not (turn >= 0.0).all():
        raise UserError(f"{path}: obstacle {ident} is not convex; cut it into convex pieces")
    return Polygon(ident, vertices)


def check_counts(path: Path, polygons: list[Polygon]) -> None:
    if len(polygons) > POLYGONS_MAX:
        raise UserError(f"{path}: {len(polygons)} polygons is over the limit 'polygons' = {POLYGONS_MAX}")
    vertices = sum(len(p.vertices) for p in polygons)
    if vertices > VERTICES_MAX:
        raise UserError(f"{path}: {vertices} vertices is over the limit 'vertices' = {VERTICES_MAX}")
