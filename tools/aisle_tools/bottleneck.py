"""The narrowest place on the widest way between two points: where to look when there is no path."""

from __future__ import annotations

import heapq
import math
from dataclasses import dataclass

import numpy as np
import shapely

from aisle_tools.check import Obstacles

CELLS = 150_000  # of the lattice looked at
POWER = 6.0
STEPS = [(-1, 0, 1.0), (1, 0, 1.0), (0, -1, 1.0), (0, 1, 1.0)]
STEPS += [(i, j, math.sqrt(2.0)) for i in (-1, 1) for j in (-1, 1)]


@dataclass
class Place:
    x: float
    y: float
    clearance: float  # m, half of the gap


class ClearanceField:
    """Distance to the nearest obstacle at the cells of a coarse lattice."""

    def __init__(self, obstacles: Obstacles, cells: int = CELLS) -> None:
        x0, y0, x1, y1 = obstacles.world.bounds
        self.step = max(math.sqrt((x1 - x0) * (y1 - y0) / cells), 0.02)
        xs = np.arange(x0 + 0.5 * self.step, x1, self.step)
        ys = np.arange(y0 + 0.5 * self.step, y1, self.step)
        self.x0, self.y0 = x0, y0
        gx, gy = np.meshgrid(xs, ys)
        gap = obstacles.distances(shapely.points(gx.ravel(), gy.ravel())).reshape(gx.shape)
        gap = np.minimum(gap, np.minimum.reduce([gx - x0, gy - y0, x1 - gx, y1 - gy]))
        grid = obstacles.world.grid
        if grid is not None:
            rows = np.clip(((gy - grid.origin_y) / grid.resolution).astype(int), 0, grid.height - 1)
            columns = np.clip(((gx - grid.origin_x) / grid.resolution).astype(int), 0, grid.width - 1)
            gap[grid.occupied[rows, columns]] = 0.0
        self.gap = gap

    def cell(self, x: float, y: float) -> tuple[int, int]:
        row = int((y - self.y0) / self.step)
        column = int((x - self.x0) / self.step)
        return min(max(row, 0), self.gap.shape[0] - 1), min(max(column, 0), self.gap.shape[1] - 1)

    def centre(self, row: int, column: int) -> tuple[float, float]:
        return self.x0 + (column + 0.5) * self.step, self.y0 + (row + 0.5) * self.step


def narrowest(field: ClearanceField, start: tuple[float, float], goal: tuple[float, float]) -> Place:
    """The narrowest inner cell of the widest way; cost per metre clearance^-POWER, finite within obstacles."""
    parent = _widest_tree(field, field.cell(*start), field.cell(*goal))
    way = [field.cell(*goal)]
    while parent[way[-1]] is not None:
        way.append(parent[way[-1]])
    row, column = min(_inner(way, field), key=lambda c: field.gap[c])
    return Place(*field.centre(row, column), float(field.gap[row, column]))


def _inner(way: list, field: ClearanceField) -> list:
    """The way without its ends, where it only widens: a narrow start is not a gap."""
    begin, end = 0, len(way) - 1
    while begin < end and field.gap[way[begin + 1]] >= field.gap[way[begin]]:
        begin += 1
    while end > begin and field.gap[way[end - 1]] >= field.gap[way[end]]:
        end -= 1
    return way[begin : end + 1]


def _widest_tree(field: ClearanceField, begin: tuple[int, int], end: tuple[int, int]) -> dict:
    cost = np.maximum(field.gap, 0.25 * field.step) ** -POWER
    height, width = cost.shape
    done: dict = {}
    queue: list = [(0.0, begin, None)]
    while queue:
        spent, cell, origin = heapq.heappop(queue)
        if cell in done:
            continue
        done[cell] = origin
        if cell == end:
            break
        for di, dj, d in STEPS:
            i, j = cell[0] + di, cell[1] + dj
            if 0 <= i < height and 0 <= j < width and (i, j) not in done:
                heapq.heappush(queue, (spent + d * float(cost[i, j]), (i, j), cell))
    return done
