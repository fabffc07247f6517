"""MovingAI grid maps (.map, type octile): ".", "G" and "S" are free, all else is occupied. Unitless: cells get a side."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from aisle_tools.errors import UserError
from aisle_tools.rosmap import CELLS_DEFAULT, check_size
from aisle_tools.world import Grid, World, float32

FREE = b".GS"
RESOLUTION = 0.5  # m a cell, unless told otherwise
HEAD = 4  # lines


def read_world(path: Path, resolution: float = 0.0, max_cells: int = CELLS_DEFAULT) -> World:
    """The map's lower left corner is the origin; its first row is the top."""
    try:
        lines = path.read_bytes().splitlines()
    except OSError as e:
        raise UserError(f"{path}: {e.strerror}") from None
    width, height = _size(path, lines[:HEAD])
    check_size(path, width, height, max_cells)
    rows = lines[HEAD : HEAD + height]
    for i in range(height):
        if i >= len(rows) or len(rows[i]) != width:
            raise UserError(f"{path}:{HEAD + i + 1}: needs {width} cells, has {len(rows[i]) if i < len(rows) else 0}")
    cells = np.frombuffer(b"".join(rows), dtype=np.uint8).reshape(height, width)
    free = np.isin(cells, np.frombuffer(FREE, dtype=np.uint8))[::-1]
    grid = Grid(0.0, 0.0, float32(resolution or RESOLUTION), ~free)
    return World(path.stem, grid.bounds, [], grid, grid.resolution)


def _size(path: Path, head: list[bytes]) -> tuple[int, int]:
    try:
        if head[0].split() != [b"type", b"octile"] or head[3].strip() != b"map":
            raise ValueError
        sizes = {key: int(value) for key, value in (line.split() for line in head[1:3])}
        width, height = sizes[b"width"], sizes[b"height"]
    except (ValueError, KeyError, IndexError):
        raise UserError(f"{path}:1: not a MovingAI map (type octile, height N, width N, map)") from None
    if width < 1 or height < 1:
        raise UserError(f"{path}: a map of {width} x {height} cells")
    return width, height
