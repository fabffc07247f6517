"""What a way risks by its true clearance, the way that risks least, and the exact shortest way of a disc.

Exposure of a way (m): integral over its length of max(1 - clearance / creep_clearance, 0); the clearance is that of the
disc's edge to the nearest obstacle's true shape or the bounds.
"""

from __future__ import annotations

import heapq
import math

import numpy as np
import shapely

from aisle_tools.check import Obstacles

MOVES = [(i, j) for i in range(-3, 4) for j in range(-3, 4) if math.gcd(i, j) == 1]
TIE = 1e-4  # of a metre of length beside a metre of exposure: of equally safe ways the shorter
ARC = 12  # corners of a quarter circle: lengths are below the truth by less than 0.1 %
SPECK = 1e-7  # m


def gaps(obstacles: Obstacles, radius: float, points: np.ndarray) -> np.ndarray:
    """Clearance of the disc at points [n, 2]."""
    x0, y0, x1, y1 = obstacles.world.bounds
    x, y = points[:, 0], points[:, 1]
    walls = np.minimum.reduce([x - x0, y - y0, x1 - x, y1 - y])
    return np.minimum(obstacles.distances(shapely.points(points)), walls) - radius


def danger(clearance: np.ndarray, creep: float) -> np.ndarray:
    return np.maximum(1.0 - np.maximum(clearance, 0.0) / creep, 0.0)


def resample(points: np.ndarray, step: float) -> np.ndarray:
    """Evenly by length, ends kept."""
    s = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    at = np.linspace(0.0, s[-1], max(int(math.ceil(s[-1] / step)), 1) + 1)
    return np.column_stack([np.interp(at, s, points[:, 0]), np.interp(at, s, points[:, 1])])


def length(points: np.ndarray) -> float:
    return float(np.hypot(*np.diff(points, axis=0).T).sum())


def exposure(obstacles: Obstacles, radius: float, creep: float, points: np.ndarray, step: float = 0.01) -> float:
    fine = resample(points, step)
    d = danger(gaps(obstacles, radius, fine), creep)
    return float((0.5 * (d[1:] + d[:-1]) * np.hypot(*np.diff(fine, axis=0).T)).sum())


def least_exposure(
    obstacles: Obstacles,
    radius: float,
    margin: float,
    creep: float,
    start: tuple[float, float],
    goal: tuple[float, float],
    step: float = 0.1,
) -> np.ndarray:
    """The way [n, 2] of least exposure that keeps the margin, over a lattice through the start, 32 moves a node (Dijkstra).

    An edge's exposure is by the trapezium over its ends and thirds. Empty: no way on this lattice.
    """
    x0, y0, x1, y1 = obstacles.world.bounds
    columns = int((x1 - x0) / step) + 1
    rows = int((y1 - y0) / step) + 1
    sx, sy = start[0] - x0, start[1] - y0
    ox, oy = x0 + sx % step, y0 + sy % step
    gx, gy = np.meshgrid(ox + step * np.arange(columns), oy + step * np.arange(rows))
    nodes = np.column_stack([gx.ravel(), gy.ravel()])
    from_ = int(round((start[1] - oy) / step)) * columns + int(round((start[0] - ox) / step))
    to = int(round((goal[1] - oy) / step)) * columns + int(round((goal[0] - ox) / step))
    forwards = {m: _edge_costs(obstacles, radius, margin, creep, gx, gy, m[0] * step, m[1] * step) for m in MOVES if m > (0, 0)}
    # The way back costs the same; what wraps round the edge is never asked for.
    costs = [forwards[m] if m in forwards else np.roll(forwards[-m[0], -m[1]], (-m[1], -m[0]), (0, 1)) for m in MOVES]
    costs = [c.ravel().tolist() for c in costs]
    way = _dijkstra(costs, rows, columns, from_, to)
    return np.vstack([[start], nodes[way][1:-1], [goal]]) if way else np.empty((0, 2))


def _edge_costs(
    obstacles: Obstacles, radius: float, margin: float, creep: float, gx: np.ndarray, gy: np.ndarray, dx: float, dy: float
) -> np.ndarray:
    """Of this move from every node; infinite where the margin is not kept."""
    total, least = np.zeros(gx.size), np.full(gx.size, math.inf)
    for k, weight in enumerate((0.5, 1.0, 1.0, 0.5)):
        points = np.column_stack([(gx + dx * k / 3.0).ravel(), (gy + dy * k / 3.0).ravel()])
        gap = gaps(obstacles, radius, points)
        least = np.minimum(least, gap)
        total += weight / 3.0 * danger(gap, creep)
    size = math.hypot(dx, dy)
    return np.where(least >= margin - SPECK, size * (total + TIE), math.inf).reshape(gx.shape)


def _dijkstra(costs: list[list[float]], rows: int, columns: int, start: int, goal: int) -> list[int]:
    best, parent = {start: 0.0}, {start: -1}
    heap = [(0.0, start)]
    done = bytearray(rows * columns)
    while heap:
        value, node = heapq.heappop(heap)
        if done[node]:
            continue
        done[node] = 1
        if node == goal:
            break
        row, column = divmod(node, columns)
        for (i, j), cost in zip(MOVES, costs):
            r, c = row + j, column + i
            if not (0 <= r < rows and 0 <= c < columns):
                continue
            other, reached = r * columns + c, value + cost[node]
            if not done[other] and reached < best.get(other, math.inf):
                best[other], parent[other] = reached, node
                heapq.heappush(heap, (reached, other))
    if goal not in parent:
        return []
    way = [goal]
    while parent[way[-1]] >= 0:
        way.append(parent[way[-1]])
    return way[::-1]


def shortest(obstacles: Obstacles, reach: float, start: tuple[float, float], goal: tuple[float, float]) -> float:
    """Length of the shortest way whose points keep `reach` from everything: visibility graph over the grown shapes.

    Round corners are inscribed polygons of 4 * ARC corners: never above the truth.
    """
    grown = shapely.union_all(shapely.buffer(obstacles.tree.geometries, reach, quad_segs=ARC))
    x0, y0, x1, y1 = obstacles.world.bounds
    inner = shapely.box(x0 + reach, y0 + reach, x1 - reach, y1 - reach)
    free = shapely.buffer(shapely.difference(inner, grown), SPECK)
    shapely.prepare(free)
    corners = np.unique(np.round(shapely.get_coordinates(shapely.difference(inner, grown)), 9), axis=0)
    nodes = np.vstack([[start, goal], corners])
    weights = np.full((len(nodes), len(nodes)), math.inf)
    for i in range(len(nodes) - 1):
        others = nodes[i + 1 :]
        lines = shapely.linestrings(np.stack([np.broadcast_to(nodes[i], others.shape), others], axis=1))
        sees = shapely.covers(free, lines)
        weights[i, i + 1 :] = np.where(sees, np.hypot(*(others - nodes[i]).T), math.inf)
    weights = np.minimum(weights, weights.T)
    return _dense_dijkstra(weights)


def _dense_dijkstra(weights: np.ndarray) -> float:
    """From node 0 to node 1."""
    best = np.full(len(weights), math.inf)
    open_ = np.ones(len(weights), dtype=bool)
    best[0] = 0.0
    while True:
        node = int(np.argmin(np.where(open_, best, math.inf)))
        if node == 1 or not open_[node] or math.isinf(best[node]):
            return float(best[1])
        open_[node] = False
        best = np.minimum(best, best[node] + weights[node])
