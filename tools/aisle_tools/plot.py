"""aisle plot: layout, paths coloured by clearance, footprints along them, and why a query has no path."""

from __future__ import annotations

import argparse
import math
from pathlib import Path

import matplotlib
import numpy as np
from aisle import path_t, query_t, status_t, vehicle_t

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.axes import Axes  # noqa: E402
from matplotlib.collections import LineCollection, PolyCollection  # noqa: E402
from matplotlib.colors import ListedColormap, Normalize  # noqa: E402
from matplotlib.patches import Circle  # noqa: E402

from aisle_tools import geometry, layouts, maps, names, query, vehicle  # noqa: E402
from aisle_tools.bottleneck import ClearanceField, narrowest  # noqa: E402
from aisle_tools.bus import Recording  # noqa: E402
from aisle_tools.check import Obstacles, placed  # noqa: E402
from aisle_tools.errors import UserError  # noqa: E402
from aisle_tools.vehicle import Body  # noqa: E402
from aisle_tools.world import World  # noqa: E402

STEP = 0.05  # m, of the coloured line
SURROUNDINGS = 1.0  # m, shown around what is free
KIND_COLOURS = ("#4a4a4a", "#b07d62", "#f2d492", "#d9c2e9", "#bcd8f0")
REFUSED = "#d62728"
HINT = "#7a3db8"  # what would help


def configure(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--replies", type=Path, action="append", metavar="FILE", help="log of query --save or of a logger")
    parser.add_argument("--map", type=Path, metavar="FILE", help="map_server .yaml; default: the layout in the log")
    parser.add_argument("--out", type=Path, required=True, metavar="FILE", help=".png, .svg or .pdf")
    parser.add_argument("--title", metavar="TEXT")
    parser.add_argument("--dpi", type=int, default=110)
    parser.add_argument("--step", type=float, metavar="M", help="distance of the footprints drawn")
    maps.add_read_options(parser)
    vehicle.add_options(parser)
    query.add_leg_options(parser)
    query.add_plan_options(parser)


def run(args: argparse.Namespace) -> int:
    recordings = [Recording(f, args.prefix) for f in args.replies or []]
    world = find_world(args, recordings)
    default = vehicle.from_options(args, _scenario(args))
    picture = Picture(world, args.title, args.dpi)
    count = 0
    for recording in recordings:
        body = vehicle.body(default or recording.vehicle or vehicle_t())
        pairs = [(recording.queries.get(r.query_id), r) for r in recording.replies]
        pairs += [(None, p) for p in last_paths(recording.paths)]
        count += len(pairs)
        picture.add(pairs, body, args.step)
    if not recordings and (args.start or args.goals or args.scenario):
        pairs = query.ask_all(args, query.legs_of(args), print_row=False)
        count += len(pairs)
        picture.add(pairs, vehicle.body(default or vehicle_t()), args.step)
    picture.save(args.out)
    print(f"{args.out}: {count} queries and paths")
    return 0


def _scenario(args: argparse.Namespace) -> object:
    return maps.read_scenario(args.scenario) if args.scenario is not None else None


def find_world(args: argparse.Namespace, recordings: list[Recording]) -> World:
    path = args.map or args.scenario
    if path is not None:
        margin = args.margin if args.margin is not None else 0.0
        return maps.read_any(path, args, margin)[0]
    for recording in recordings:
        parts, tiles = recording.newest_map()
        if parts:
            return layouts.read_messages(parts, tiles, recording.path.stem)
    raise UserError("which map? give --map FILE or --scenario FILE (no layout is in the log)")


def last_paths(paths: list[path_t]) -> list[path_t]:
    """One of each revision: a lease is renewed many times."""
    return list({(p.boot_id, p.path_revision): p for p in paths}.values())


class Picture:
    def __init__(self, world: World, title: str | None, dpi: int) -> None:
        self.world, self.dpi = world, dpi
        self.obstacles = Obstacles(world)
        self.field: ClearanceField | None = None
        self.lines: list[tuple[np.ndarray, np.ndarray]] = []  # points [n, 2], clearances [n]
        self.number = 0
        x0, y0, x1, y1 = view_box(world)
        width = 11.0
        height = min(max(width * (y1 - y0) / (x1 - x0), 4.0), 16.0)
        width = min(width, max(height * (x1 - x0) / (y1 - y0), 5.0))
        self.figure, self.axes = plt.subplots(figsize=(width + 1.6, height + 0.6), layout="constrained")
        self.axes.set_xlim(x0, x1)
        self.axes.set_ylim(y0, y1)
        self.axes.set_aspect("equal")
        self.axes.set_xlabel("x (m)")
        self.axes.set_ylabel("y (m)")
        self.axes.set_title(title or world.name)
        draw_world(self.axes, world)

    def add(self, pairs: list, body: Body, footprint_step: float | None) -> None:
        for asked, reply in pairs:
            self.number += 1
            if names.is_path(reply):
                self._add_path(reply, body, footprint_step)
                self._mark_ends(asked, reply)
            else:
                self._mark_refusal(asked, reply)

    def _add_path(self, reply: path_t, body: Body, footprint_step: float | None) -> None:
        samples = list(geometry.sample(reply.waypoints, STEP))
        poses = np.array([(s.x, s.y, s.theta) for s in samples])
        self.lines.append((poses[:, :2], self.obstacles.clearances(body, poses)))
        self._add_footprints(poses, body, footprint_step)

    def _add_footprints(self, poses: np.ndarray, body: Body, step: float | None) -> None:
        size = 2.0 * body.radius if body.is_disc else float(np.ptp(body.vertices[:, 0]))
        step = step or max(1.5 * size, 0.3)
        travelled = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(poses[:, :2], axis=0).T))])
        picks = np.searchsorted(travelled, np.arange(0.0, travelled[-1] + 1e-9, step)).clip(max=len(poses) - 1)
        shown = poses[np.unique(np.append(picks, len(poses) - 1))]
        style = {"facecolors": (0.2, 0.4, 0.8, 0.08), "edgecolors": (0.1, 0.2, 0.5, 0.35), "linewidths": 0.6, "zorder": 3}
        self.axes.add_collection(PolyCollection(list(outlines(body, shown)), **style))

    def _mark_ends(self, asked: query_t | None, reply: path_t) -> None:
        first, last = reply.waypoints[0], reply.waypoints[-1]
        start = (asked.start.x, asked.start.y) if asked is not None else (first.x, first.y)
        goals = [(g.x, g.y) for g in asked.goals] if asked is not None else [(last.x, last.y)]
        self.axes.plot(*start, "o", ms=7, mfc="#2ca02c", mec="white", zorder=6)
        for goal in goals:
            self.axes.plot(*goal, "*", ms=12, mfc="#ff7f0e", mec="white", zorder=6)
        for place, what in [(start, "start"), (goals[-1], "goal")]:
            self._label(place, str(self.number), "#2ca02c" if what == "start" else "#c75f00")

    def _label(self, place: tuple[float, float], text: str, colour: str, box: dict | None = None) -> None:
        look = {"fontsize": 8, "color": colour, "weight": "bold", "zorder": 7, "bbox": box}
        note = self.axes.annotate(text, place, xytext=(7, 7), textcoords="offset points", **look)
        note.set_in_layout(False)

    def _mark_refusal(self, asked: query_t | None, reply: path_t) -> None:
        text = f"{self.number}: {names.reason(reply)}"
        self._mark_hints(reply)
        if asked is None:
            self._mark_unasked(reply, text)
            return
        start, goals = (asked.start.x, asked.start.y), [(g.x, g.y) for g in asked.goals]
        self.axes.plot(*zip(start, *goals), "--", color=REFUSED, lw=0.8, alpha=0.6, zorder=4)
        self.axes.plot(*start, "o", ms=7, mfc="white", mec=REFUSED, mew=1.5, zorder=6)
        for goal in goals:
            self.axes.plot(*goal, "*", ms=12, mfc="white", mec=REFUSED, mew=1.2, zorder=6)
        self._mark_place(self._place(reply, start, goals), text)

    def _mark_unasked(self, reply: path_t, text: str) -> None:
        told = names.place(reply)
        if told is not None:
            self._mark_place((*told, 0.5), text)
            return
        self.axes.plot([], [], "x", color=REFUSED, label=text)
        self.axes.legend(loc="upper left", fontsize=8)

    def _mark_hints(self, reply: path_t) -> None:
        """The gap as a line, a free place as a ring with an arrow to it, polygons to remove as squares."""
        sides = names.gap_sides(reply)
        if len(sides) == 2:
            self.axes.plot([w.x for w in sides], [w.y for w in sides], "o-", color=REFUSED, ms=4, lw=2.5, zorder=8)
        to, at = names.free_place(reply), names.place(reply)
        if to is not None and at is not None:
            arrow = {"arrowstyle": "->", "color": HINT, "lw": 1.8}
            self.axes.annotate("", to, xytext=at, arrowprops=arrow, zorder=9)
            self.axes.plot(*to, "o", ms=8, mfc="none", mec=HINT, mew=2.0, zorder=9)
        for w in names.removals(reply):
            self.axes.plot(w.x, w.y, "s", ms=11, mfc="none", mec=HINT, mew=2.0, zorder=9)
            self._label((w.x, w.y), f"without {w.goal_id}", HINT, box={"boxstyle": "round", "fc": "white", "ec": HINT})

    def _place(self, reply: path_t, start: tuple, goals: list[tuple]) -> tuple[float, float, float]:
        """(x, y, radius) of what stands in the way: as told, else guessed from the cause."""
        told = names.place(reply)
        if told is not None:
            return (*told, max(0.5 * reply.cause_value if reply.cause == status_t.TOO_NARROW else 0.0, 0.5))
        if reply.cause in (status_t.START_OCCUPIED, status_t.POSE_OUTSIDE):
            return (*start, 0.5)
        if reply.cause == status_t.GOAL_OUTSIDE and 1 <= reply.cause_id <= len(goals):
            return (*goals[reply.cause_id - 1], 0.5)
        if reply.cause in (status_t.NO_PATH, status_t.TOO_NARROW, status_t.KINEMATIC):
            if self.field is None:
                self.field = ClearanceField(self.obstacles)
            stops = [start, *goals]
            places = [narrowest(self.field, a, b) for a, b in zip(stops, stops[1:])]
            worst = min(places, key=lambda p: p.clearance)
            return worst.x, worst.y, max(worst.clearance, 0.5)
        return (*goals[-1], 0.5)

    def _mark_place(self, place: tuple[float, float, float], text: str) -> None:
        x, y, radius = place
        size = max(radius, 0.02 * float(np.ptp(self.axes.get_xlim())))
        self.axes.add_patch(Circle((x, y), size, fill=False, ec=REFUSED, lw=2.0, zorder=8))
        self.axes.plot(x, y, "x", color=REFUSED, ms=9, mew=2.5, zorder=8)
        right = x > float(np.mean(self.axes.get_xlim()))
        top = y > float(np.mean(self.axes.get_ylim()))
        self.axes.annotate(
            wrap_text(text),
            (x, y),
            xytext=(-30 if right else 30, -45 if top else 45),
            textcoords="offset points",
            ha="right" if right else "left",
            va="top" if top else "bottom",
            fontsize=9,
            color="white",
            zorder=9,
            bbox={"boxstyle": "round", "fc": REFUSED, "ec": "none"},
            arrowprops={"arrowstyle": "->", "color": REFUSED},
        )

    def save(self, path: Path) -> None:
        if self.lines:
            most = max(float(np.quantile(c, 0.98)) for _, c in self.lines)
            norm = Normalize(0.0, max(most, 0.2))
            for points, clearances in self.lines:
                segments = np.stack([points[:-1], points[1:]], axis=1)
                line = LineCollection(list(segments), cmap="viridis", norm=norm, linewidths=2.2, zorder=5)
                line.set_array(0.5 * (clearances[:-1] + clearances[1:]))
                self.axes.add_collection(line)
            mappable = plt.cm.ScalarMappable(norm=norm, cmap="viridis")
            self.figure.colorbar(
                mappable, ax=self.axes, label="clearance of the footprint (m)", shrink=0.7, aspect=45, extend="max"
            )
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            self.figure.savefig(path, dpi=self.dpi)
        except (OSError, ValueError) as e:
            raise UserError(f"{path}: cannot be written: {e}") from None
        plt.close(self.figure)


def wrap_text(text: str, width: int = 44) -> str:
    lines = [""]
    for word in text.split():
        if lines[-1] and len(lines[-1]) + len(word) >= width:
            lines.append("")
        lines[-1] += (" " if lines[-1] else "") + word
    return "\n".join(lines)


def outlines(body: Body, poses: np.ndarray) -> np.ndarray:
    """The footprint's outline at each pose [n, points, 2]; a rounded footprint is drawn by its corners."""
    if not body.is_disc:
        return placed(body, poses)
    angle = np.linspace(0.0, 2.0 * math.pi, 25)[:-1]
    ring = body.radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return poses[:, None, :2] + ring[None, :, :]


def view_box(world: World) -> tuple[float, float, float, float]:
    """What is free, with some surroundings; the whole bounds where there is no scan."""
    if world.grid is None:
        x0, y0, x1, y1 = world.bounds
        edge = 0.02 * max(x1 - x0, y1 - y0)
        return x0 - edge, y0 - edge, x1 + edge, y1 + edge
    grid = world.grid
    rows = np.flatnonzero(~grid.occupied.all(axis=1))
    columns = np.flatnonzero(~grid.occupied.all(axis=0))
    r = grid.resolution
    return (
        grid.origin_x + columns[0] * r - SURROUNDINGS,
        grid.origin_y + rows[0] * r - SURROUNDINGS,
        grid.origin_x + (columns[-1] + 1) * r + SURROUNDINGS,
        grid.origin_y + (rows[-1] + 1) * r + SURROUNDINGS,
    )


def draw_world(axes: Axes, world: World) -> None:
    axes.set_facecolor("#c8c8c8" if world.grid is not None else "white")
    x0, y0, x1, y1 = world.bounds
    if world.grid is not None:
        # Walls dark, what lies behind them (unknown or solid) light grey.
        shade = world.grid.occupied.astype(np.uint8)
        shade[near_free(world.grid.occupied, 2)] = 2
        colours = ListedColormap(["white", "#c8c8c8", "#303030"])
        axes.imshow(shade, origin="lower", extent=(x0, x1, y0, y1), cmap=colours, interpolation="nearest", vmin=0, vmax=2)
    axes.plot([x0, x1, x1, x0, x0], [y0, y0, y1, y1, y0], color="#4a4a4a", lw=1.0)
    for kind, colour in enumerate(KIND_COLOURS):
        shapes = [p.vertices for p in world.polygons if p.kind == kind]
        axes.add_collection(PolyCollection(shapes, facecolors=colour, edgecolors="black", linewidths=0.4, zorder=2))


def near_free(occupied: np.ndarray, cells: int) -> np.ndarray:
    """Occupied cells within so many steps of a free one."""
    grown = ~occupied
    for _ in range(cells):
        padded = np.pad(grown, 1)
        grown = grown | padded[:-2, 1:-1] | padded[2:, 1:-1] | padded[1:-1, :-2] | padded[1:-1, 2:]
    return grown & occupied
