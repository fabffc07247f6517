"""An independent judge of paths: dense sampling, exact distances (shapely), limits recomputed from the wire convention.

It shares nothing with the planner and its verifier but the message types. Sampling is every `step` metres, so the clearance
found is an upper bound of the true one, off by less than step^2 / (8 * turning radius) on smooth pieces.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import shapely
from aisle import goal_list_t, path_t, polygon_t, query_t, waypoint_t

from aisle_tools import geometry
from aisle_tools.vehicle import Body
from aisle_tools.world import Grid, Polygon, World

OMNI = 2
LENGTH_TOLERANCE = 1e-4  # relative: the sum travels as float
LIMIT_TOLERANCE = 2e-3  # relative, of speeds and accelerations
HEADING_TOLERANCE = 5e-3  # rad, between heading and motion
CLEARANCE_TOLERANCE = 1e-4  # m, a claimed clearance over the sampled one
CONTACT_TOLERANCE = 1e-6  # m, of the margin
ENERGY_TOLERANCE = 1e-3  # relative, beside what float times leave open: see float_slack()
AGAINST_TOLERANCE = 2.5e-3  # rad, of a motion beyond a right angle to a directed zone
ZONE_TOLERANCE = 1e-5  # m, deeper in a zone than this is inside
REST = 1e-6  # m/s
GRAVITY = 9.80665  # m/s2


@dataclass
class Energy:
    """J from the battery."""

    rolling: float = 0.0
    acceleration: float = 0.0
    turning: float = 0.0
    idle: float = 0.0

    @property
    def total(self) -> float:
        return self.rolling + self.acceleration + self.turning + self.idle


@dataclass
class Report:
    clearance: float = math.inf  # m, footprint to the nearest obstacle, least over the path
    where: tuple[float, float] = (math.nan, math.nan)
    violation: float = -math.inf  # m, margin minus clearance; above 0 is a collision
    length: float = 0.0
    duration: float = 0.0
    heading_error: float = 0.0
    samples: int = 0
    piece_clearance: list[float] = field(default_factory=list)
    energy: list[Energy] = field(default_factory=list)  # of the piece that ends at each waypoint but the first
    faults: list[str] = field(default_factory=list)

    @property
    def ok(self) -> bool:
        return not self.faults


class Obstacles:
    """Static obstacles of a World, for distances from many shapes at once."""

    def __init__(self, world: World) -> None:
        self.world = world
        shapes = [shapely.polygons(p.vertices) for p in world.obstacles()]
        if world.grid is not None:
            shapes += list(boundary_boxes(world.grid))
        self.tree = shapely.STRtree(shapes)

    def distances(self, shapes: np.ndarray) -> np.ndarray:
        """m from each shape to the nearest obstacle, 0 on contact; the bounds and cells' insides are not looked at."""
        out = np.full(len(shapes), math.inf)
        if len(self.tree.geometries) == 0:
            return out
        index, distance = self.tree.query_nearest(shapes, return_distance=True, all_matches=False)
        out[index[0]] = distance
        return out

    def clearances(self, body: Body, poses: np.ndarray) -> np.ndarray:
        """m from the footprint at each pose [n, 3] to the nearest obstacle or the bounds; below 0 = overlap."""
        corners = placed(body, poses)
        shapes = shapely.points(poses[:, :2]) if body.is_disc else shapely.polygons(corners)
        gaps = self.distances(shapes)
        for i in np.flatnonzero(gaps == 0.0):
            gaps[i] = -self._depth(shapes[i])
        if self.world.grid is not None:
            inside = [self.world.grid.is_occupied(x, y) for x, y in poses[:, :2]]
            gaps[np.array(inside, dtype=bool) & (gaps > 0.0)] = 0.0  # deep in a block of cells
        return np.minimum(gaps, self._to_bounds(corners)) - body.radius

    def _to_bounds(self, corners: np.ndarray) -> np.ndarray:
        x0, y0, x1, y1 = self.world.bounds
        x, y = corners[:, :, 0], corners[:, :, 1]
        return np.minimum.reduce([x - x0, y - y0, x1 - x, y1 - y]).min(axis=1)

    def _depth(self, shape: shapely.Geometry) -> float:
        """How far obstacles reach into the shape, about; at least a hair, for contact is not free."""
        if shape.geom_type == "Point":
            return 1e-9
        hits = self.tree.geometries[self.tree.query(shape, predicate="intersects")]
        common = shapely.get_coordinates(shapely.intersection(hits, shape))
        if len(common) == 0:
            return 1e-9
        return max(1e-9, float(shapely.distance(shape.exterior, shapely.points(common)).max()))


def boundary_boxes(grid: Grid) -> np.ndarray:
    """Occupied cells beside a free one, joined to runs within a row."""
    occupied = grid.occupied
    free = np.pad(~occupied, 1)
    beside = free[:-2, 1:-1] | free[2:, 1:-1] | free[1:-1, :-2] | free[1:-1, 2:]
    edge = np.pad((occupied & beside).astype(np.int8), ((0, 0), (1, 1)))
    step = np.diff(edge, axis=1)
    rows, begin = np.nonzero(step == 1)
    _, end = np.nonzero(step == -1)
    r = grid.resolution
    x0, x1 = grid.origin_x + begin * r, grid.origin_x + end * r
    y0 = grid.origin_y + rows * r
    return shapely.box(x0, y0, x1, grid.origin_y + (rows + 1) * r)


def placed(body: Body, poses: np.ndarray) -> np.ndarray:
    """Corners of the footprint at each pose: [n, corners, 2]; of a disc, its centre."""
    if body.is_disc:
        return poses[:, None, :2]
    c, s = np.cos(poses[:, 2])[:, None], np.sin(poses[:, 2])[:, None]
    x, y = body.vertices[None, :, 0], body.vertices[None, :, 1]
    return np.stack([poses[:, :1] + c * x - s * y, poses[:, 1:2] + s * x + c * y], axis=2)


def check_path(path: path_t, obstacles: Obstacles, body: Body, query: query_t | None = None, step: float = 0.01) -> Report:
    """Judges a path of status OK or PARTIAL."""
    report = Report()
    if len(path.waypoints) == 0:
        report.faults.append("no waypoints")
        return report
    samples = list(geometry.sample(path.waypoints, step))
    _check_clearance(path, obstacles, body, samples, report)
    _check_sums(path, report)
    _check_motion(path, body, report)
    _check_limits(path, body, report)
    _check_zones(path, obstacles.world, body, samples, report)
    _check_energy(path, body, query, report)
    if query is not None:
        _check_ends(path, query, report)
    return report


def _check_clearance(path: path_t, obstacles: Obstacles, body: Body, samples: list[geometry.Sample], report: Report) -> None:
    poses = np.array([(p.x, p.y, p.theta) for p in samples])
    gaps = obstacles.clearances(body, poses)
    worst = int(np.argmin(gaps))
    report.samples = len(samples)
    report.clearance, report.where = float(gaps[worst]), (samples[worst].x, samples[worst].y)
    report.violation = body.margin - report.clearance
    if report.violation > CONTACT_TOLERANCE:
        x, y = report.where
        report.faults.append(f"clearance {report.clearance:.6f} m at ({x:.3f}, {y:.3f}), margin {body.margin:.3f} m")
    report.piece_clearance = [math.inf] * max(1, len(path.waypoints) - 1)
    for p, gap in zip(samples, gaps):
        report.piece_clearance[p.index] = min(report.piece_clearance[p.index], float(gap))
    if path.clearance_min > report.clearance + CLEARANCE_TOLERANCE:
        report.faults.append(f"clearance_min {path.clearance_min:.4f} m claimed, {report.clearance:.4f} m found")
    for i, gap in enumerate(report.piece_clearance[: len(path.waypoints) - 1]):
        claimed = path.waypoints[i + 1].clearance
        if claimed > gap + CLEARANCE_TOLERANCE:
            report.faults.append(f"waypoint {i + 1}: clearance {claimed:.4f} m claimed, {gap:.4f} m found")
            break
    _check_creep(path, body, samples, gaps, report)


def _check_creep(path: path_t, body: Body, samples: list[geometry.Sample], gaps: np.ndarray, report: Report) -> None:
    creep, near = body.limits["creep_speed"], body.limits["creep_clearance"]
    for p, gap in zip(samples, gaps):
        if gap >= near - CLEARANCE_TOLERANCE or len(path.waypoints) < 2:
            continue
        v0, v1 = path.waypoints[p.index].v, path.waypoints[p.index + 1].v
        v = math.sqrt(max(0.0, v0 * v0 + p.fraction * (v1 * v1 - v0 * v0)))
        if v > creep * (1.0 + LIMIT_TOLERANCE):
            report.faults.append(f"{v:.3f} m/s at clearance {gap:.3f} m ({p.x:.3f}, {p.y:.3f}): above creep_speed")
            return


def _check_sums(path: path_t, report: Report) -> None:
    report.length = geometry.length(path.waypoints)
    report.duration = path.waypoints[-1].t - path.waypoints[0].t
    if abs(report.length - path.length) > LENGTH_TOLERANCE * max(1.0, report.length):
        report.faults.append(f"length {path.length:.4f} m claimed, {report.length:.4f} m found")
    if abs(report.duration - path.duration) > LENGTH_TOLERANCE * max(1.0, report.duration):
        report.faults.append(f"duration {path.duration:.4f} s claimed, {report.duration:.4f} s found")
    if path.length_bound > path.length * (1.0 + LENGTH_TOLERANCE):
        report.faults.append(f"length_bound {path.length_bound:.4f} m above the length {path.length:.4f} m")
    for i, (a, b) in enumerate(zip(path.waypoints, path.waypoints[1:])):
        if not b.t > a.t:
            report.faults.append(f"waypoint {i + 1}: time {b.t:.4f} s does not rise from {a.t:.4f} s")
            return
        if b.s < a.s:
            report.faults.append(f"waypoint {i + 1}: s falls")
            return


def _check_motion(path: path_t, body: Body, report: Report) -> None:
    """Arcs exist, turns on the spot do not move, the heading follows the motion (not of OMNI vehicles)."""
    for i, p in enumerate(geometry.pieces(path.waypoints)):
        a, b = path.waypoints[i], path.waypoints[i + 1]
        chord = math.hypot(b.x - a.x, b.y - a.y)
        if abs(b.curvature) * chord > 2.0 * (1.0 + 1e-6):
            report.faults.append(f"waypoint {i + 1}: no arc of curvature {b.curvature:.4f} spans {chord:.4f} m")
        if a.flags & waypoint_t.TURN_IN_PLACE and chord > 1e-6:
            report.faults.append(f"waypoint {i}: turn on the spot moves {chord:.6f} m")
        if body.drive == OMNI or p.length < 1e-4:
            continue
        for f, theta in ((0.0, p.theta), (1.0, p.theta + p.turn)):
            error = abs(geometry.wrap(p.heading_at(f) - theta))
            report.heading_error = max(report.heading_error, min(error, math.pi - error))
    if report.heading_error > HEADING_TOLERANCE:
        report.faults.append(f"heading is off the motion by {report.heading_error:.4f} rad")


def _check_limits(path: path_t, body: Body, report: Report) -> None:
    points = path.waypoints
    for end in (0, -1):
        if abs(points[end].v) > 1e-6:
            report.faults.append(f"not at rest at {'the end' if end else 'the start'}: {points[end].v:.3f} m/s")
    for i, p in enumerate(geometry.pieces(points)):
        text = _piece_fault(points[i], points[i + 1], p, body)
        if text:
            report.faults.append(f"waypoint {i + 1}: {text}")
            return


def rest_to_rest_time(length: float, v_max: float, lim: dict[str, float]) -> float:
    """Least time from rest to rest: a trapezoid of speed, or a triangle."""
    up, down = lim["a_max"], lim["d_max"]
    peak = min(v_max, math.sqrt(2.0 * length * up * down / (up + down)))
    ramps = peak * peak * (up + down) / (2.0 * up * down)
    return peak / up + peak / down + (length - ramps) / peak


def rest_to_rest_peak(length: float, time: float, lim: dict[str, float]) -> float:
    """m/s, of the trapezoid from rest to rest that takes this time."""
    q = 0.5 / lim["a_max"] + 0.5 / lim["d_max"]
    time = max(time, 1e-9)
    return 2.0 * length / (time + math.sqrt(max(0.0, time * time - 4.0 * q * length)))


def _piece_fault(a: waypoint_t, b: waypoint_t, p: geometry.Piece, body: Body) -> str:
    lim = body.limits
    v, dt = max(abs(a.v), abs(b.v)), b.t - a.t
    backwards = p.length > 1e-4 and math.cos(p.heading - p.theta) < 0.0 and body.drive != OMNI
    v_max = lim["v_reverse_max"] if backwards else lim["v_max"]
    if p.length < 1e-6:
        need = turn_time(abs(p.turn), lim["omega_max"], lim["alpha_max"])
        return "" if dt >= need * (1.0 - LIMIT_TOLERANCE) - 1e-4 else f"turns {p.turn:.3f} rad in {dt:.3f} s"
    change = (b.v * b.v - a.v * a.v) / (2.0 * p.length)
    limit = lim["a_max"] if change > 0.0 else lim["d_max"]
    need = 2.0 * p.length / (abs(a.v) + abs(b.v)) if abs(a.v) + abs(b.v) > 1e-6 else rest_to_rest_time(p.length, v_max, lim)
    checks = [
        (v, v_max, "speed"),
        (abs(change), limit + 1e-4 / p.length, "acceleration"),
        (v * v * abs(p.curvature), lim["lateral_a_max"], "lateral acceleration"),
        (v * abs(p.turn) / p.length, lim["omega_max"], "turn rate"),
        (abs(p.curvature), body.curvature_max or math.inf, "curvature"),
        (need, dt * (1.0 + LIMIT_TOLERANCE) + 1e-3, "time needed"),
    ]
    for value, most, name in checks:
        if value > most * (1.0 + LIMIT_TOLERANCE):
            return f"{name} {value:.4f} above {most:.4f}"
    return ""


def _depth(vertices: np.ndarray, x: float, y: float) -> float:
    """m inside a convex counter-clockwise polygon; below 0 outside."""
    a, e = vertices, np.roll(vertices, -1, axis=0) - vertices
    return float(((e[:, 0] * (y - a[:, 1]) - e[:, 1] * (x - a[:, 0])) / np.hypot(e[:, 0], e[:, 1])).min())


def _check_zones(path: path_t, world: World, body: Body, samples: list[geometry.Sample], report: Report) -> None:
    """SPEED_LIMIT zones by the footprint, DIRECTED ones by the origin's motion."""
    zones = [p for p in world.polygons if p.kind in (polygon_t.SPEED_LIMIT, polygon_t.DIRECTED)]
    if not zones or len(path.waypoints) < 2:
        return
    pieces = geometry.pieces(path.waypoints)
    for zone in zones:
        text = _speed_fault(path, zone, body, samples) if zone.kind == polygon_t.SPEED_LIMIT else _way_fault(zone, pieces, samples)
        if text:
            report.faults.append(f"zone {zone.ident}: {text}")


def _way_fault(zone: Polygon, pieces: list[geometry.Piece], samples: list[geometry.Sample]) -> str:
    for s in samples:
        p = pieces[s.index]
        off = abs(geometry.wrap(p.heading_at(s.fraction) - zone.direction))
        against = p.length > 1e-9 and off > 0.5 * math.pi + AGAINST_TOLERANCE
        if against and _depth(zone.vertices, s.x, s.y) > ZONE_TOLERANCE:
            return f"driven against its direction at ({s.x:.3f}, {s.y:.3f})"
    return ""


def _speed_fault(path: path_t, zone: Polygon, body: Body, samples: list[geometry.Sample]) -> str:
    shape = shapely.buffer(shapely.polygons(zone.vertices), -ZONE_TOLERANCE)
    poses = np.array([(s.x, s.y, s.theta) for s in samples])
    bodies = shapely.points(poses[:, :2]) if body.is_disc else shapely.polygons(placed(body, poses))
    gaps = shapely.distance(bodies, shape) - body.radius
    for s, gap in zip(samples, gaps):
        v0, v1 = path.waypoints[s.index].v, path.waypoints[s.index + 1].v
        v = math.sqrt(max(0.0, v0 * v0 + s.fraction * (v1 * v1 - v0 * v0)))
        if gap <= 0.0 and v > zone.value * (1.0 + LIMIT_TOLERANCE):
            return f"{v:.3f} m/s at ({s.x:.3f}, {s.y:.3f}), its limit is {zone.value:.3f} m/s"
    return ""


def piece_energy(a: waypoint_t, b: waypoint_t, body: Body, dwell: float = 0.0) -> Energy:
    """What the piece from a to b takes; `dwell` s of its time the vehicle stands at a."""
    lim, p = body.limits, geometry.piece(a, b)
    drag = lim["mass"] * GRAVITY * lim["rolling_resistance"] / lim["drive_efficiency"]
    out = Energy(idle=lim["idle_power"] * (b.t - a.t))
    if a.flags & waypoint_t.TURN_IN_PLACE:
        out.turning = drag * body.outer_radius * abs(p.turn)
        return out
    gain = max(0.0, b.v * b.v - a.v * a.v)
    if max(a.v, b.v) <= REST:  # the peak of the trapezoid that takes the time
        gain = rest_to_rest_peak(p.length, b.t - a.t - dwell, lim) ** 2
    out.rolling = drag * p.length
    out.acceleration = 0.5 * lim["mass"] * gain / lim["drive_efficiency"]
    return out


def stands(path: path_t, query: query_t | None) -> list[float]:
    """s, at the start of each piece."""
    dwells = {g.id: max(g.dwell, 0.0) for g in query.goals} if query is not None else {}
    return [dwells.get(w.goal_id, 0.0) if w.flags & waypoint_t.GOAL else 0.0 for w in path.waypoints[:-1]]


def energies(path: path_t, body: Body, query: query_t | None = None) -> list[Energy]:
    """Of the piece that ends at each waypoint but the first."""
    pieces = zip(path.waypoints, path.waypoints[1:], stands(path, query))
    return [piece_energy(a, b, body, dwell) for a, b, dwell in pieces]


def float_slack(path: path_t, body: Body, query: query_t | None) -> float:
    """J: the peak of a piece from rest to rest is told by its time alone, by the root of what that is over the least."""
    lim, out = body.limits, 0.0
    for a, b, dwell in zip(path.waypoints, path.waypoints[1:], stands(path, query)):
        if max(a.v, b.v) > REST or a.flags & waypoint_t.TURN_IN_PLACE:
            continue
        off, length = float(np.spacing(np.float32(b.t))), geometry.piece(a, b).length
        fast, slow = (rest_to_rest_peak(length, b.t - a.t - dwell + by, lim) for by in (-off, off))
        out += 0.5 * lim["mass"] * (fast * fast - slow * slow) / lim["drive_efficiency"]
    return out


def _check_energy(path: path_t, body: Body, query: query_t | None, report: Report) -> None:
    report.energy = energies(path, body, query)
    total = sum(e.total for e in report.energy)
    if query is None and any(w.flags & waypoint_t.GOAL for w in path.waypoints[:-1]):
        return  # how long it stands on the way is not known
    if abs(total - path.energy) > ENERGY_TOLERANCE * max(1.0, total) + float_slack(path, body, query):
        report.faults.append(f"energy {path.energy:.1f} J claimed, {total:.1f} J found")


def turn_time(angle: float, omega: float, alpha: float) -> float:
    """Least time of a turn from rest to rest."""
    if angle * alpha > omega * omega:
        return angle / omega + omega / alpha
    return 2.0 * math.sqrt(angle / alpha)


def _check_ends(path: path_t, query: query_t, report: Report) -> None:
    first = path.waypoints[0]
    if math.hypot(first.x - query.start.x, first.y - query.start.y) > 1e-5:
        report.faults.append(f"starts at ({first.x:.4f}, {first.y:.4f}), not where asked")
    at = 0
    for goal in _goals_in_order(path, query):
        at = _find_goal(path, goal, at)
        if at < 0:
            report.faults.append(f"goal {goal.id} at ({goal.x:.3f}, {goal.y:.3f}) is not reached in order")
            return


def _goals_in_order(path: path_t, query: query_t) -> list:
    """As asked, or of any order as the path says by its ids; one that it leaves out comes last."""
    if query.ordering != goal_list_t.ANY_ORDER:
        return list(query.goals)
    ids = [w.goal_id for w in path.waypoints if w.flags & waypoint_t.GOAL]
    return sorted(query.goals, key=lambda goal: ids.index(goal.id) if goal.id in ids else len(ids))


def _find_goal(path: path_t, goal: object, begin: int) -> int:
    """Index of the first waypoint at or after `begin` that reaches the goal; -1 = none."""
    near = goal.tolerance_xy or 0.05  # type: ignore[attr-defined]
    turn = goal.tolerance_theta or 0.05  # type: ignore[attr-defined]
    for i in range(begin, len(path.waypoints)):
        w = path.waypoints[i]
        if math.hypot(w.x - goal.x, w.y - goal.y) > near + 1e-6:  # type: ignore[attr-defined]
            continue
        if turn >= math.pi or abs(geometry.wrap(w.theta - goal.theta)) <= turn + 1e-6:  # type: ignore[attr-defined]
            return i
    return -1
