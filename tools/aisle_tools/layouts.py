"""A World as layout_t parts and grid_chunk_t tiles, and back."""

from __future__ import annotations

import zlib
from collections.abc import Iterable
from io import BytesIO

import numpy as np
from aisle import grid_chunk_t, layout_t, polygon_t

from aisle_tools.errors import UserError
from aisle_tools.world import Grid, Polygon, World

PART_BYTES = 1300  # wished size of a part's polygons: below one Ethernet frame
PART_BYTES_MAX = 60000
TILE_SIDE = 96  # cells: at most 1152 bytes as bits, so a message fits one Ethernet frame
CHUNKS_MAX = 32767


# ---- grid tiles
def encode_bits(tile: np.ndarray) -> bytes:
    """8 cells a byte, least significant bit first, each row starts a byte."""
    return np.packbits(tile, axis=1, bitorder="little").tobytes()


def decode_bits(data: bytes, width: int, height: int) -> np.ndarray:
    row_bytes = (width + 7) // 8
    if len(data) != row_bytes * height:
        raise ValueError(f"{len(data)} bytes of bits, not {row_bytes * height}")
    rows = np.frombuffer(data, dtype=np.uint8).reshape(height, row_bytes)
    return np.unpackbits(rows, axis=1, bitorder="little")[:, :width].astype(bool)


def encode_rle(tile: np.ndarray) -> bytes:
    """Alternating run lengths, free first, each an unsigned LEB128, over the tile as one row."""
    flat = tile.reshape(-1)
    edges = np.flatnonzero(flat[1:] != flat[:-1]) + 1
    runs = np.diff(np.concatenate(([0], edges, [flat.size])))
    out = bytearray()
    if flat[0]:
        out.append(0)
    for run in runs.tolist():
        while run >= 0x80:
            out.append((run & 0x7F) | 0x80)
            run >>= 7
        out.append(run)
    return bytes(out)


def decode_rle(data: bytes, width: int, height: int) -> np.ndarray:
    runs, value, shift = [], 0, 0
    for byte in data:
        value |= (byte & 0x7F) << shift
        shift += 7
        if byte < 0x80:
            runs.append(value)
            value, shift = 0, 0
    if shift != 0 or sum(runs) != width * height:
        raise ValueError(f"run lengths cover {sum(runs)} cells, not {width * height}")
    flat = np.repeat(np.arange(len(runs)) % 2 == 1, runs)
    return flat.reshape(height, width)


def decode_tile(chunk: grid_chunk_t) -> np.ndarray:
    decode = decode_rle if chunk.encoding == grid_chunk_t.RLE else decode_bits
    return decode(bytes(chunk.data[: chunk.num_bytes]), chunk.width, chunk.height)


def make_tile(grid: Grid, x0: int, y0: int, side: int) -> grid_chunk_t:
    """The tile at cell (x0, y0), in the shorter of the two encodings."""
    cells = grid.occupied[y0 : y0 + side, x0 : x0 + side]
    bits, rle = encode_bits(cells), encode_rle(cells)
    chunk = grid_chunk_t()
    chunk.origin_x, chunk.origin_y, chunk.resolution = grid.origin_x, grid.origin_y, grid.resolution
    chunk.x0, chunk.y0 = x0, y0
    chunk.height, chunk.width = (int(n) for n in cells.shape)
    chunk.encoding = grid_chunk_t.RLE if len(rle) < len(bits) else grid_chunk_t.BITS
    chunk.data = rle if len(rle) < len(bits) else bits
    chunk.num_bytes = len(chunk.data)
    if chunk.num_bytes > grid_chunk_t.MAX_BYTES:
        raise UserError(f"a tile of {side} cells a side needs {chunk.num_bytes} bytes, over {grid_chunk_t.MAX_BYTES}")
    return chunk


def make_tiles(grid: Grid, side: int = TILE_SIDE) -> list[grid_chunk_t]:
    tiles = [make_tile(grid, x, y, side) for y in range(0, grid.height, side) for x in range(0, grid.width, side)]
    if len(tiles) > CHUNKS_MAX:
        raise UserError(f"{len(tiles)} tiles is over the limit {CHUNKS_MAX}; use larger tiles")
    for part, tile in enumerate(tiles):
        tile.part, tile.num_parts = part, len(tiles)
    return tiles


# ---- polygons
def make_polygon(polygon: Polygon) -> polygon_t:
    msg = polygon_t()
    msg.id, msg.kind, msg.value, msg.direction = polygon.ident, polygon.kind, polygon.value, polygon.direction
    msg.vertices = [(float(x), float(y)) for x, y in polygon.vertices]
    msg.num_vertices = len(msg.vertices)
    return msg


def nested_bytes(polygon: polygon_t) -> bytes:
    """As it stands inside a layout_t: no fingerprint."""
    buffer = BytesIO()
    polygon._encode_one(buffer)
    return buffer.getvalue()


def signed32(value: int) -> int:
    return value - (1 << 32) if value >= 1 << 31 else value


def polygons_crc(polygons: Iterable[polygon_t]) -> int:
    crc = 0
    for polygon in polygons:
        crc = zlib.crc32(nested_bytes(polygon), crc)
    return signed32(crc)


def split_polygons(polygons: list[polygon_t]) -> list[list[polygon_t]]:
    """Parts of PART_BYTES or, where that makes too many, as much larger as needed."""
    sizes = [len(nested_bytes(p)) for p in polygons]
    limit = max(PART_BYTES, 2 * sum(sizes) // layout_t.MAX_PARTS)
    if limit > PART_BYTES_MAX:
        raise UserError(f"{len(polygons)} polygons of {sum(sizes)} bytes do not fit {layout_t.MAX_PARTS} parts")
    parts: list[list[polygon_t]] = [[]]
    used = 0
    for polygon, size in zip(polygons, sizes):
        if parts[-1] and (used + size > limit or len(parts[-1]) == layout_t.MAX_POLYGONS):
            parts.append([])
            used = 0
        parts[-1].append(polygon)
        used += size
    return parts


def make_layouts(world: World, num_grid_chunks: int) -> list[layout_t]:
    polygons = [make_polygon(p) for p in world.polygons]
    crc = polygons_crc(polygons)
    parts = split_polygons(polygons)
    out = []
    for part, content in enumerate(parts):
        msg = layout_t()
        msg.part, msg.num_parts, msg.num_grid_chunks = part, len(parts), num_grid_chunks
        msg.total_polygons, msg.crc32 = len(polygons), crc
        msg.x_min, msg.y_min, msg.x_max, msg.y_max = world.bounds
        msg.resolution = world.resolution
        msg.num_polygons, msg.polygons = len(content), content
        out.append(msg)
    return out


def make_messages(
    world: World, map_id: int, revision: int, utime: int, tile_side: int = TILE_SIDE
) -> list[tuple[str, layout_t | grid_chunk_t]]:
    """(channel without prefix, message), layout parts first."""
    tiles = make_tiles(world.grid, tile_side) if world.grid is not None else []
    out: list[tuple[str, layout_t | grid_chunk_t]] = [("LAYOUT", m) for m in make_layouts(world, len(tiles))]
    out += [("GRID", t) for t in tiles]
    for _, msg in out:
        msg.utime, msg.map_id, msg.map_revision = utime, map_id, revision
    return out


# ---- and back
def read_messages(layouts: list[layout_t], tiles: list[grid_chunk_t], name: str = "log") -> World:
    """The World that these parts and tiles of one revision describe; complains about what is missing or does not fit."""
    layouts = sorted({m.part: m for m in layouts}.values(), key=lambda m: m.part)
    if not layouts or len(layouts) != layouts[0].num_parts:
        raise UserError(f"{name}: the layout is incomplete")
    first = layouts[0]
    polygons = [p for m in layouts for p in m.polygons]
    if len(polygons) != first.total_polygons or polygons_crc(polygons) != first.crc32:
        raise UserError(f"{name}: the layout's polygons do not match their crc32")
    tiles = list({t.part: t for t in tiles}.values())
    if len(tiles) != first.num_grid_chunks:
        raise UserError(f"{name}: {len(tiles)} of {first.num_grid_chunks} grid tiles")
    bounds = (first.x_min, first.y_min, first.x_max, first.y_max)
    shapes = [Polygon(p.id, np.array(p.vertices), p.kind, p.value, p.direction) for p in polygons]
    return World(name, bounds, shapes, _join_tiles(tiles) if tiles else None, first.resolution)


def _join_tiles(tiles: list[grid_chunk_t]) -> Grid:
    width = max(t.x0 + t.width for t in tiles)
    height = max(t.y0 + t.height for t in tiles)
    occupied = np.ones((height, width), dtype=bool)
    for t in tiles:
        occupied[t.y0 : t.y0 + t.height, t.x0 : t.x0 + t.width] = decode_tile(t)
    return Grid(tiles[0].origin_x, tiles[0].origin_y, tiles[0].resolution, occupied)
