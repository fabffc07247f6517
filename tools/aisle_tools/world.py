"""A static layout in memory: polygons, a scanned grid and bounds, whatever it was read from."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

OBSTACLE_KINDS = (0, 1)  # OBSTACLE, KEEPOUT


@dataclass
class Polygon:
    ident: int
    vertices: np.ndarray  # [n, 2] m, counter-clockwise
    kind: int = 0
    value: float = 0.0
    direction: float = 0.0


@dataclass
class Grid:
    origin_x: float  # m, lower left corner of cell (0, 0)
    origin_y: float
    resolution: float  # m a cell, exactly a float32
    occupied: np.ndarray  # [height, width] bool, row 0 at the bottom; unknown is occupied

    @property
    def width(self) -> int:
        return int(self.occupied.shape[1])

    @property
    def height(self) -> int:
        return int(self.occupied.shape[0])

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        return (
            self.origin_x,
            self.origin_y,
            self.origin_x + self.width * self.resolution,
            self.origin_y + self.height * self.resolution,
        )

    def cell(self, x: float, y: float) -> tuple[int, int]:
        """(row, column); may lie outside."""
        return int((y - self.origin_y) // self.resolution), int((x - self.origin_x) // self.resolution)

    def is_occupied(self, x: float, y: float) -> bool:
        row, column = self.cell(x, y)
        if 0 <= row < self.height and 0 <= column < self.width:
            return bool(self.occupied[row, column])
        return True


@dataclass
class World:
    name: str
    bounds: tuple[float, float, float, float]  # x_min, y_min, x_max, y_max; outside is occupied
    polygons: list[Polygon] = field(default_factory=list)
    grid: Grid | None = None
    resolution: float = 0.0  # of the planner's grid; 0 = its default

    def holds(self, x: float, y: float) -> bool:
        return self.bounds[0] <= x <= self.bounds[2] and self.bounds[1] <= y <= self.bounds[3]

    def obstacles(self) -> list[Polygon]:
        return [p for p in self.polygons if p.kind in OBSTACLE_KINDS]


def float32(value: float) -> float:
    """The value as it travels in a float field."""
    return float(np.float32(value))
