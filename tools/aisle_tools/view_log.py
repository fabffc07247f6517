"""What a page of aisle view plays: an LCM log as compact columns over the seconds since its first message."""

from __future__ import annotations

import base64
import math
import struct
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from aisle import (
    command_t,
    goal_list_t,
    grid_chunk_t,
    layout_patch_t,
    layout_t,
    obstacle_t,
    obstacles_t,
    path_t,
    pose_t,
    query_t,
    status_t,
    vehicle_t,
)
from PIL import Image

from aisle_tools import layouts, names, plot, vehicle
from aisle_tools.bus import read_events
from aisle_tools.errors import UserError
from aisle_tools.vehicle import Body
from aisle_tools.view_paths import change_of, integers, number, result_of
from aisle_tools.world import Grid, Polygon, World

TYPES = {
    "LAYOUT": layout_t,
    "LAYOUT_PATCH": layout_patch_t,
    "GRID": grid_chunk_t,
    "VEHICLE": vehicle_t,
    "POSE": pose_t,
    "GOALS": goal_list_t,
    "QUERY": query_t,
    "OBSTACLES": obstacles_t,
    "COMMAND": command_t,
    "PATH": path_t,
    "REPLY": path_t,
    "STATUS": status_t,
}
INTERVAL = 0.045  # s, poses and snapshots nearer to the one before are left out
POSES_MAX = 40_000
MOVER_ROWS_MAX = 400_000
GRID_CELLS_MAX = 4_000_000  # of the picture
LEVEL = 100  # grey steps between free, solid and wall in the picture
SAME_CLOCK = 2.0  # s, a message older than this when logged has another clock
MOVER_SCALES = {"x": 100, "y": 100, "theta": 50, "vx": 100, "vy": 100}
SIGMA_DEFAULT = 0.05  # m, where cov_xy is all 0
BOUND_BY_KIND = {obstacle_t.PERSON: 1.6, obstacle_t.STATIC: 0.0}
BOUND = 2.0  # m/s, of every other kind
COMMANDS = ["hold", "resume", "cancel", "resend"]


@dataclass
class Stamped:
    """Messages of one channel with the log's time, s since its first message."""

    t: list[float] = field(default_factory=list)
    msg: list[Any] = field(default_factory=list)

    def pairs(self) -> zip:
        return zip(self.t, self.msg)


class Log:
    """A log of one prefix, decoded by channel."""

    def __init__(self, path: Path, prefix: str) -> None:
        self.path = path
        self.of = {name: Stamped() for name in TYPES}
        self.undecodable = 0
        events = read_events(path)
        known = {f"{prefix}_{name}": name for name in TYPES}
        mine = [(utime, known[channel], data) for utime, channel, data in events if channel in known]
        if not mine:
            raise UserError(f"{path}: {nothing_of(prefix, events)}")
        self.t0 = mine[0][0]
        for utime, name, data in mine:
            self._take((utime - self.t0) / 1e6, name, data)
        self.end = (max(e[0] for e in mine) - self.t0) / 1e6

    def _take(self, t: float, name: str, data: bytes) -> None:
        try:
            msg = TYPES[name].decode(data)
        except (ValueError, TypeError, struct.error):
            self.undecodable += 1
            return
        self.of[name].t.append(t)
        self.of[name].msg.append(msg)

    def clock(self, t: float, utime: int) -> float:
        """Seconds of a time stamp on the log's clock; the log's time if the two clocks are far apart."""
        own = (utime - self.t0) / 1e6
        return own if abs(own - t) < SAME_CLOCK else t


def nothing_of(prefix: str, events: list) -> str:
    found = sorted({c.rsplit("_", 1)[0] for _, c, _ in events if c.rsplit("_", 1)[-1] in TYPES})
    if found:
        return f"no messages of prefix {prefix}; give --prefix {' or '.join(found)}"
    return f"no messages of prefix {prefix}" if events else "the log is empty"


def thinned(times: np.ndarray, interval: float) -> np.ndarray:
    """Which of the rising times to keep so that kept ones are at least so far apart; always the first and the last."""
    keep, last = [], -math.inf
    for i, t in enumerate(times):
        if t - last >= interval:
            keep.append(i)
            last = t
    if len(times) and keep[-1] != len(times) - 1:
        keep.append(len(times) - 1)
    return np.array(keep, dtype=int)


# ---- layout
def worlds_of(log: Log) -> list[tuple[float, World, tuple[int, int]]]:
    """Every layout revision with the time from which all its parts and tiles are in, patches applied."""
    groups: dict[tuple[int, int], Revision] = {}
    for name in ("LAYOUT", "GRID"):
        for t, msg in log.of[name].pairs():
            groups.setdefault((msg.map_id, msg.map_revision), Revision()).take(t, name, msg)
    found: dict[tuple[int, int], tuple[float, World]] = {}
    faults: list[str] = []
    for key, group in groups.items():
        try:
            world = layouts.read_messages(*group.messages(), f"{log.path}: map {key[0]} revision {key[1]}")
            found[key] = (group.since, world)
        except (UserError, ValueError) as e:
            faults.append(str(e))
    for t, patch in log.of["LAYOUT_PATCH"].pairs():
        base = found.get((patch.map_id, patch.base_revision))
        if base is not None:
            found.setdefault((patch.map_id, patch.map_revision), (t, patched(base[1], patch)))
    if not found and faults:
        raise UserError(f"{faults[0]} (--map FILE shows the run on a map of your own)")
    return sorted(((t, world, key) for key, (t, world) in found.items()), key=lambda entry: entry[0])


class Revision:
    """Parts and tiles of one layout revision; repeats do not count."""

    def __init__(self) -> None:
        self.known: dict[tuple[str, int], Any] = {}
        self.since = 0.0

    def take(self, t: float, name: str, msg: Any) -> None:
        if (name, msg.part) not in self.known:
            self.known[(name, msg.part)] = msg
            self.since = max(self.since, t)

    def messages(self) -> tuple[list, list]:
        parts = [m for (name, _), m in self.known.items() if name == "LAYOUT"]
        return parts, [m for (name, _), m in self.known.items() if name == "GRID"]


def patched(world: World, patch: layout_patch_t) -> World:
    gone = {*patch.removed, *(p.id for p in patch.polygons)}
    new = [Polygon(p.id, np.array(p.vertices), p.kind, p.value, p.direction) for p in patch.polygons]
    return World(world.name, world.bounds, [p for p in world.polygons if p.ident not in gone] + new, world.grid)


def grid_picture(grid: Grid) -> dict:
    """Levels 0 free, 1 behind walls, 2 wall; of very large maps a coarser picture that shows every wall."""
    level = grid.occupied.astype(np.uint8)
    level[plot.near_free(grid.occupied, 2)] = 2
    factor = max(1, math.ceil(math.sqrt(level.size / GRID_CELLS_MAX)))
    if factor > 1:
        pads = [(0, -n % factor) for n in level.shape]
        level = np.pad(level, pads, constant_values=1)
        level = level.reshape(level.shape[0] // factor, factor, -1, factor).max(axis=(1, 3))
    buffer = BytesIO()
    Image.fromarray(level[::-1] * LEVEL).save(buffer, "PNG", optimize=True)
    size = grid.resolution * factor
    png = "data:image/png;base64," + base64.b64encode(buffer.getvalue()).decode()
    return {"x": grid.origin_x, "y": grid.origin_y, "w": level.shape[1] * size, "h": level.shape[0] * size, "png": png}


def encode_world(t: float, world: World, key: tuple[int, int]) -> dict:
    shapes = [
        {"id": p.ident, "kind": p.kind, "dir": round(p.direction, 4), "v": np.round(p.vertices, 4).tolist()}
        for p in world.polygons
    ]
    box = [round(float(c), 3) for c in plot.view_box(world)]
    grid = grid_picture(world.grid) if world.grid is not None else None
    return {"t": round(t, 3), "key": key, "bounds": list(world.bounds), "box": box, "polygons": shapes, "grid": grid}


# ---- vehicle and poses
def encode_body(t: float, body: Body, revision: int) -> dict:
    return {
        "t": round(t, 3),
        "rev": revision,
        "v": np.round(body.vertices, 4).tolist(),
        "r": round(body.radius, 4),
        "margin": round(body.margin, 4),
        "v_max": round(body.limits["v_max"], 3),
    }


def poses_of(log: Log, begin: float, end: float) -> tuple[np.ndarray, np.ndarray]:
    """[n, 5] of t, x, y, theta, v and [n] localized."""
    rows = [(t, p.x, p.y, p.theta, math.copysign(math.hypot(p.vx, p.vy), p.vx)) for t, p in log.of["POSE"].pairs()]
    rows_array = np.array(rows, dtype=float).reshape(-1, 5)
    localized = np.array([bool(p.localized) for p in log.of["POSE"].msg], dtype=bool)
    inside = (rows_array[:, 0] >= begin) & (rows_array[:, 0] <= end) & np.isfinite(rows_array).all(axis=1)
    rows_array, localized = rows_array[inside], localized[inside]
    interval = INTERVAL
    keep = thinned(rows_array[:, 0], interval)
    while len(keep) > POSES_MAX:
        interval *= 2.0
        keep = thinned(rows_array[:, 0], interval)
    return rows_array[keep], localized[keep]


def encode_poses(rows: np.ndarray, localized: np.ndarray) -> dict:
    return {
        "t": integers(rows[:, 0], 1e3),
        "x": integers(rows[:, 1], 1e3),
        "y": integers(rows[:, 2], 1e3),
        "th": integers(np.unwrap(rows[:, 3]), 1e3),
        "v": integers(rows[:, 4], 1e3),
        "lost": np.flatnonzero(~localized).tolist(),
    }


# ---- movers
@dataclass
class Snapshot:
    t: float  # s, of the log
    stamp: float  # s, of the measurement
    source: int
    movers: list[obstacle_t]


def traits(o: obstacle_t, source: int) -> tuple:
    """What seldom changes of a mover: id, source, kind, rounding radius, reach radius, 3 sigma, bound, corners."""
    corners = tuple((number(x, 3), number(y, 3)) for x, y in o.vertices[: o.num_vertices])
    whole = o.radius + max((math.hypot(x, y) for x, y in corners), default=0.0)
    xx, xy, yy = o.cov_xy
    largest = 0.5 * (xx + yy) + math.hypot(0.5 * (xx - yy), xy)
    sigma = math.sqrt(max(largest, 0.0)) if any(o.cov_xy) else SIGMA_DEFAULT
    bound = max(o.v_bound or BOUND_BY_KIND.get(o.kind, BOUND), math.hypot(o.vx, o.vy))
    spread = number(3.0 * sigma, 2)
    return (o.id, source, o.kind, number(o.radius, 3), number(whole, 3), spread, number(bound, 2), corners)


def snapshots_of(log: Log, begin: float, end: float) -> list[Snapshot]:
    """Those from `begin` to `end` and, of each source, the last one before."""
    out: list[Snapshot] = []
    for source in sorted({m.source for m in log.of["OBSTACLES"].msg}):
        mine = [(t, m) for t, m in log.of["OBSTACLES"].pairs() if m.source == source and t <= end]
        first = max(0, sum(t < begin for t, _ in mine) - 1)
        out += [Snapshot(t, log.clock(t, m.utime), source, m.obstacles[: m.num_obstacles]) for t, m in mine[first:]]
    return decimated(out)


def decimated(snapshots: list[Snapshot]) -> list[Snapshot]:
    """Snapshots of a source nearer than the interval are left out, the interval doubled until the rows are few enough."""
    interval = INTERVAL
    while True:
        kept = []
        for source in sorted({s.source for s in snapshots}):
            mine = [s for s in snapshots if s.source == source]
            kept += [mine[i] for i in thinned(np.array([s.t for s in mine]), interval)]
        if sum(len(s.movers) for s in kept) <= MOVER_ROWS_MAX:
            return kept
        interval *= 2.0


def encode_movers(snapshots: list[Snapshot]) -> dict:
    """One column set a source: rows in the order of its snapshots, each with the index of its traits."""
    known: dict[tuple, int] = {}
    sources = []
    for source in sorted({s.source for s in snapshots}):
        mine = [s for s in snapshots if s.source == source]
        rows = [o for s in mine for o in s.movers]
        columns = {name: since_last(rows, name, scale) for name, scale in MOVER_SCALES.items()}
        columns["t"] = integers([s.t for s in mine], 1e3)
        columns["stamp"] = integers([s.stamp for s in mine], 1e3)
        columns["count"] = [len(s.movers) for s in mine]
        columns["trait"] = [known.setdefault(traits(o, source), len(known)) for o in rows]
        columns["id"] = [o.id for o in rows]
        sources.append(columns)
    return {"sources": sources, "traits": [list(key) for key in known], "scales": MOVER_SCALES}


def since_last(rows: list[obstacle_t], name: str, scale: float) -> list[int]:
    """Differences against the same mover's last row, in units of 1 / scale: small numbers, which compress well."""
    last: dict[int, int] = {}
    out = []
    for o in rows:
        value = getattr(o, name)
        number = round(value * scale) if math.isfinite(value) else 0
        out.append(number - last.get(o.id, 0))
        last[o.id] = number
    return out


# ---- least gap
def outline(corners: np.ndarray, x: np.ndarray, y: np.ndarray, theta: np.ndarray) -> np.ndarray:
    """Corners [k, 2] placed at n poses, as n polygons (or points, without corners)."""
    if len(corners) == 0:
        return shapely.points(x, y)
    c, s = np.cos(theta)[:, None], np.sin(theta)[:, None]
    px = x[:, None] + c * corners[:, 0] - s * corners[:, 1]
    py = y[:, None] + s * corners[:, 0] + c * corners[:, 1]
    return shapely.polygons(np.stack([px, py], axis=2))


def gaps_of(poses: np.ndarray, snapshots: list[Snapshot], body: Body) -> np.ndarray:
    """m from footprint to the nearest mover's body at each pose, movers moved on with their speed; nan without one."""
    gaps = np.full(len(poses), math.nan)
    if len(poses) == 0:
        return gaps
    for source in {s.source for s in snapshots}:
        mine = sorted((s for s in snapshots if s.source == source), key=lambda s: s.t)
        newest = np.searchsorted([s.t for s in mine], poses[:, 0], side="right") - 1
        pairs = [(i, mine[k], o) for i, k in enumerate(newest) if k >= 0 for o in mine[k].movers if is_placed(o)]
        if pairs:
            np.fmin.at(gaps, [p[0] for p in pairs], distances(poses, pairs, body))
    return gaps


def is_placed(o: obstacle_t) -> bool:
    flat = [c for corner in o.vertices[: o.num_vertices] for c in corner]
    return all(math.isfinite(c) for c in (o.x, o.y, o.theta, o.vx, o.vy, o.radius, *flat))


def distances(poses: np.ndarray, pairs: list, body: Body) -> np.ndarray:
    index = np.array([p[0] for p in pairs])
    at = poses[index]
    own = outline(body.vertices, at[:, 1], at[:, 2], at[:, 3])
    others = np.empty(len(pairs), dtype=object)
    by_shape: dict[tuple, list[int]] = {}
    for j, (_, _, o) in enumerate(pairs):
        by_shape.setdefault(tuple(map(tuple, o.vertices[: o.num_vertices])), []).append(j)
    for shape, members in by_shape.items():
        rows = [pairs[j] for j in members]
        age = np.array([poses[i, 0] - s.stamp for i, s, _ in rows])
        x = np.array([o.x for *_, o in rows]) + age * [o.vx for *_, o in rows]
        y = np.array([o.y for *_, o in rows]) + age * [o.vy for *_, o in rows]
        theta = np.array([o.theta for *_, o in rows])
        others[members] = outline(np.array(shape).reshape(-1, 2), x, y, theta)
    radii = np.array([o.radius for *_, o in pairs]) + body.radius
    return np.maximum(shapely.distance(own, others) - radii, 0.0)


# ---- paths, goals, status
def paths_of(log: Log, body: Body, begin: float, end: float) -> list[dict]:
    """Each revision once, with the leases it was given: (time sent, valid until)."""
    out: list[dict] = []
    before: path_t | None = None
    for t, p in log.of["PATH"].pairs():
        until = round(t + (p.valid_until_utime - p.utime) / 1e6, 3)
        if before is None or (p.boot_id, p.path_revision) != (before.boot_id, before.path_revision):
            out.append({"t": round(t, 3), "change": change_of(p, before), "lease": [], **result_of(p, body)})
            out[-1]["left"] = goals_left(p)
        out[-1]["lease"].append([round(t, 3), until])
        before = p
    ends = [p["t"] for p in out[1:]] + [math.inf]
    return [p for p, last in zip(out, ends) if last > begin and p["t"] <= end]


def goals_left(p: path_t) -> list[int] | None:
    """Ids of the goals a whole path still visits."""
    return [w.goal_id for w in p.waypoints if w.flags & 8] if p.status == path_t.OK else None


def goal_lists_of(log: Log) -> list[dict]:
    """Each list, and when each of its goals was reached or given up."""
    out: list[dict] = []
    for t, m in log.of["GOALS"].pairs():
        key = (m.goal_list_id, m.goal_list_revision)
        if out and out[-1]["key"] == key:
            continue
        goals = [{"id": g.id, "x": number(g.x, 3), "y": number(g.y, 3), "th": heading(g), "done": None} for g in m.goals]
        out.append({"t": round(t, 3), "key": key, "goals": goals})
    for entry, nxt in zip(out, [*out[1:], None]):
        mark_done(entry, log, nxt["t"] if nxt else math.inf)
    return out


def heading(g: Any) -> float | None:
    return None if g.tolerance_theta >= math.pi else number(g.theta, 3)


def mark_done(entry: dict, log: Log, until: float) -> None:
    """A goal is done when the daemon drives to another one, or has none left."""
    aim = 0
    for t, s in log.of["STATUS"].pairs():
        if (s.goal_list_id, s.goal_list_revision) != entry["key"] or t >= until:
            continue
        if aim not in (0, s.goal_id):
            mine = [g for g in entry["goals"] if g["id"] == aim and g["done"] is None]
            for g in mine[:1]:
                g["done"] = round(t, 3)
        aim = s.goal_id


def statuses_of(log: Log) -> list[dict]:
    """Every change of state, cause, thing meant or goal."""
    out: list[dict] = []
    key = None
    for t, s in log.of["STATUS"].pairs():
        now = (s.state, s.cause, s.cause_id, s.goal_id)
        if now == key:
            continue
        key = now
        told = {"state": s.state, "cause": s.cause, "by": s.cause_id, "goal": s.goal_id}
        words = names.in_words(s.state, s.cause, s.cause_id)
        out.append({"t": round(t, 3), "name": names.cause_name(s.cause), "text": words, **told})
    return out


def remaining_of(log: Log) -> dict:
    """Distance and time left as the daemon told them."""
    rows = np.array([(t, s.distance_remaining, s.time_remaining) for t, s in log.of["STATUS"].pairs()]).reshape(-1, 3)
    rows = np.nan_to_num(rows[thinned(rows[:, 0], 0.15)], nan=0.0, posinf=0.0, neginf=0.0)
    return {"t": integers(rows[:, 0], 1e3), "m": integers(rows[:, 1], 100), "s": integers(rows[:, 2], 10)}


def commands_of(log: Log) -> list[dict]:
    out = []
    for t, c in log.of["COMMAND"].pairs():
        word = COMMANDS[c.command] if 0 <= c.command < len(COMMANDS) else f"command {c.command}"
        out.append({"t": round(t, 3), "text": f"told: {word}" + (f" goal {c.arg}" if c.arg else "")})
    return out
