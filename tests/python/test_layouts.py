"""Tiles, parts and checksums on the wire, judged by slow independent code."""

import random
import struct
import zlib

import numpy as np
import pytest
from aisle import grid_chunk_t, layout_t
from aisle_tools import layouts
from aisle_tools.errors import UserError
from aisle_tools.scenario import read_scenario
from aisle_tools.world import Grid, Polygon, World

SEEDS = range(8)


def random_cells(rng, width, height):
    kind = rng.choice(["noise", "blocks", "free", "full"])
    if kind == "noise":
        return np.array([[rng.random() < 0.4 for _ in range(width)] for _ in range(height)])
    cells = np.full((height, width), kind == "full")
    if kind == "blocks":
        for _ in range(5):
            x, y = rng.randrange(width), rng.randrange(height)
            cells[y : y + 7, x : x + 9] ^= True
    return cells


def slow_bit(chunk, column, row):
    """From the words of grid_chunk_t: 8 cells a byte, least significant bit first, each row starts a byte."""
    row_bytes = -(-chunk.width // 8)
    return chunk.data[row * row_bytes + column // 8] >> (column % 8) & 1


def slow_rle(chunk):
    cells, value, shift, occupied = [], 0, 0, 0
    for byte in chunk.data:
        value += (byte % 128) * 2**shift
        shift += 7
        if byte < 128:
            cells += [occupied] * value
            value, shift, occupied = 0, 0, 1 - occupied
    return cells


@pytest.mark.parametrize("seed", SEEDS)
def test_tiles_cover_the_grid_once_and_decode_to_it(seed):
    rng = random.Random(seed)
    width, height = rng.randrange(1, 230), rng.randrange(1, 230)
    grid = Grid(-1.5, 2.25, 0.05, random_cells(rng, width, height))
    seen = np.zeros((height, width), dtype=int)
    tiles = layouts.make_tiles(grid, rng.choice([8, 50, 96, 128]))
    for chunk in tiles:
        for row in range(chunk.height):
            for column in range(chunk.width):
                cell = slow_bit(chunk, column, row) if chunk.encoding == grid_chunk_t.BITS else None
                if cell is not None:
                    assert cell == grid.occupied[chunk.y0 + row, chunk.x0 + column]
        if chunk.encoding == grid_chunk_t.RLE:
            want = grid.occupied[chunk.y0 : chunk.y0 + chunk.height, chunk.x0 : chunk.x0 + chunk.width]
            assert slow_rle(chunk) == want.reshape(-1).astype(int).tolist()
        seen[chunk.y0 : chunk.y0 + chunk.height, chunk.x0 : chunk.x0 + chunk.width] += 1
    assert (seen == 1).all()
    assert [t.part for t in tiles] == list(range(len(tiles))) and {t.num_parts for t in tiles} == {len(tiles)}


@pytest.mark.parametrize("size", [95, 96, 97, 192, 193])
def test_last_row_and_column_get_tiles(size):
    tiles = layouts.make_tiles(Grid(0.0, 0.0, 0.05, np.zeros((size, size), dtype=bool)), 96)
    assert sum(t.width * t.height for t in tiles) == size * size


@pytest.mark.parametrize("seed", SEEDS)
def test_both_encodings_round_trip(seed):
    rng = random.Random(100 + seed)
    cells = random_cells(rng, rng.randrange(1, 60), rng.randrange(1, 60))
    height, width = cells.shape
    assert (layouts.decode_bits(layouts.encode_bits(cells), width, height) == cells).all()
    assert (layouts.decode_rle(layouts.encode_rle(cells), width, height) == cells).all()


def test_run_lengths_start_with_free_and_are_leb128():
    cells = np.zeros((2, 200), dtype=bool)
    cells[0, 0] = True
    cells[1, 199] = True
    # 0 free, 1 occupied, 398 free (0x18e: 0x8e 0x03), 1 occupied
    assert layouts.encode_rle(cells) == bytes([0, 1, 0x8E, 0x03, 1])


def test_bits_of_a_hand_made_tile():
    cells = np.array([[1, 0, 0, 0, 0, 0, 0, 0, 1], [0, 1, 0, 0, 0, 0, 0, 0, 0]], dtype=bool)
    assert layouts.encode_bits(cells) == bytes([0x01, 0x01, 0x02, 0x00])


def test_bad_tile_bytes_are_refused():
    with pytest.raises(ValueError, match="cells"):
        layouts.decode_rle(bytes([3]), 2, 2)
    with pytest.raises(ValueError, match="cells"):
        layouts.decode_rle(bytes([4, 0x80]), 2, 2)
    with pytest.raises(ValueError, match="bytes"):
        layouts.decode_bits(bytes(3), 2, 2)


def test_messages_of_noise_fit_one_frame():
    rng = np.random.default_rng(1)
    grid = Grid(0.0, 0.0, 0.05, rng.random((500, 700)) < 0.5)
    world = World("noise", grid.bounds, [], grid, grid.resolution)
    assert max(len(m.encode()) for _, m in layouts.make_messages(world, 1, 1, 0)) < 1400


def test_too_large_a_tile_is_refused():
    rng = np.random.default_rng(1)
    grid = Grid(0.0, 0.0, 0.05, rng.random((800, 800)) < 0.5)
    with pytest.raises(UserError, match="60000"):
        layouts.make_tiles(grid, 800)


def polygon(rng, ident, n):
    angles = np.sort(rng.random(n)) * 2.0 * np.pi
    return Polygon(ident, np.stack([np.cos(angles), np.sin(angles)], axis=1) * 3.0 + rng.random(2) * 50.0)


@pytest.mark.parametrize(("count", "vertices"), [(0, 3), (1, 3), (5, 16), (829, 4), (4096, 4), (2048, 16)])
def test_parts_hold_every_polygon_in_order_within_the_bounds(count, vertices):
    rng = np.random.default_rng(count)
    world = World("w", (0.0, 0.0, 60.0, 60.0), [polygon(rng, i + 1, vertices) for i in range(count)])
    parts = layouts.make_layouts(world, 0)
    assert 1 <= len(parts) <= layout_t.MAX_PARTS
    assert [p.part for p in parts] == list(range(len(parts))) and {p.num_parts for p in parts} == {len(parts)}
    assert [q.id for p in parts for q in p.polygons] == list(range(1, count + 1))
    assert {p.total_polygons for p in parts} == {count}
    for p in parts:
        assert p.num_polygons == len(p.polygons) <= layout_t.MAX_POLYGONS
        assert len(p.encode()) <= 60100
    if count <= 5:
        assert len(parts[0].encode()) < 1500


def test_crc_is_over_the_polygons_bytes_as_they_stand_in_the_parts():
    rng = np.random.default_rng(7)
    world = World("w", (0.0, 0.0, 60.0, 60.0), [polygon(rng, i + 1, 5) for i in range(40)])
    parts = layouts.make_layouts(world, 0)
    assert len(parts) > 1
    head = 8 + 8 + 4 + 4 + 2 + 2 + 2 + 4 + 4 + 4 * 8 + 4 + 2
    nested = b"".join(p.encode()[head:] for p in parts)
    assert struct.pack(">i", parts[0].crc32) == struct.pack(">I", zlib.crc32(nested))
    assert {p.crc32 for p in parts} == {parts[0].crc32}


def test_empty_layout_has_crc_zero():
    assert layouts.polygons_crc([]) == 0


def test_messages_read_back_give_the_same_world(data):
    scenario = read_scenario(data / "scenarios" / "clutter_50.json", 0.1)
    grid = Grid(-0.45, -0.45, 0.25, np.random.default_rng(3).random((204, 204)) < 0.1)
    world = World("both", scenario.world.bounds, scenario.world.polygons, grid, 0.25)
    messages = [m for _, m in layouts.make_messages(world, 3, 9, 5)]
    assert {(m.map_id, m.map_revision, m.utime) for m in messages} == {(3, 9, 5)}
    parts = [layout_t.decode(m.encode()) for m in messages if isinstance(m, layout_t)]
    tiles = [grid_chunk_t.decode(m.encode()) for m in messages if isinstance(m, grid_chunk_t)]
    back = layouts.read_messages(parts[::-1], tiles[::-1])
    assert back.bounds == world.bounds
    assert (back.grid.occupied == grid.occupied).all()
    assert all((a.vertices == b.vertices).all() for a, b in zip(back.polygons, world.polygons))
    with pytest.raises(UserError, match="grid tiles"):
        layouts.read_messages(parts, tiles[:-1])
    with pytest.raises(UserError, match="incomplete"):
        layouts.read_messages(parts[:-1], tiles)
    parts[0].polygons[0].value = 1.0
    with pytest.raises(UserError, match="crc32"):
        layouts.read_messages(parts, tiles)
