"""Messages that are malformed, cut off, over a bound or too long: refused, counted, told; nothing else changes."""

import math
import random
import struct

import pytest
from aisle import goal_t, layout_patch_t, layout_t, polygon_t, query_t, status_t, vehicle_t
from aisle_tools import query
from harness import CHANNELS

SEEDS = range(3)
MALFORMED, OVER_LIMIT, OVERSIZE = 105, 106, 102  # counter_id of _DIAG
SNAPSHOTS = ("VEHICLE", "POSE", "OBSTACLES")


def options():
    from aisle import options_t

    return options_t()


def valid_query(ident=1):
    return query.make_query(query.Leg("1", (1.0, 1.0), [(2.0, 2.0)]), ident, 1, options(), False)


def send(daemon, name, data):
    daemon.bus.lcm.publish(f"{daemon.prefix}_{name}", bytes(data))


def refused(daemon, before, count, cause, name):
    """Waits until so many more are counted and the cause is shown with the channel's number."""
    assert daemon.wait(lambda: daemon.status.num_rejected >= before + count)
    assert daemon.wait(lambda: any(s.cause == cause for _, s in daemon.statuses[-20:]))
    ids = {s.cause_id for _, s in daemon.statuses if s.cause == cause}
    assert 1000 + CHANNELS.index(name) in ids
    assert daemon.is_alive()
    assert daemon.fresh_status().num_rejected == before + count


def many_goals():
    msg = valid_query()
    msg.goals = [goal_t() for _ in range(query_t.MAX_GOALS + 1)]
    msg.num_goals = len(msg.goals)
    return "QUERY", msg


def many_vertices():
    msg = vehicle_t()
    msg.footprint = [(math.cos(i / 17 * 6.28), math.sin(i / 17 * 6.28)) for i in range(17)]
    msg.num_vertices = 17
    return "VEHICLE", msg


def many_polygons():
    msg = layout_t()
    msg.map_id = msg.map_revision = msg.num_parts = 1
    polygon = polygon_t()
    polygon.vertices, polygon.num_vertices = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)], 3
    msg.polygons = [polygon] * (layout_t.MAX_POLYGONS + 1)
    msg.num_polygons = msg.total_polygons = len(msg.polygons)
    return "LAYOUT", msg


def many_removed():
    msg = layout_patch_t()
    msg.removed = list(range(257))
    msg.num_removed = 257
    return "LAYOUT_PATCH", msg


@pytest.mark.parametrize("make", [many_goals, many_vertices, many_polygons, many_removed])
def test_counts_over_the_bound_are_refused_as_limit(daemon, make):
    before = daemon.status.num_rejected
    name, msg = make()
    send(daemon, name, msg.encode())
    refused(daemon, before, 1, status_t.LIMIT, name)
    assert daemon.counter(OVER_LIMIT) == 1


@pytest.mark.parametrize("seed", SEEDS)
def test_cut_off_messages_are_refused_as_malformed(daemon, seed):
    before = daemon.status.num_rejected
    whole = valid_query().encode()
    rng = random.Random(seed)
    lengths = rng.sample(range(len(whole)), 40)
    for length in lengths:
        send(daemon, "QUERY", whole[:length])
        daemon.bus.spin(0.002)
    refused(daemon, before, len(lengths), status_t.MALFORMED, "QUERY")
    assert daemon.counter(MALFORMED) == len(lengths)
    assert not daemon.replies


def test_wrong_type_surplus_bytes_and_nan_are_refused(daemon):
    before = daemon.status.num_rejected
    whole = valid_query().encode()
    nan = valid_query()
    nan.goals[0].x = math.nan
    endless = valid_query()
    endless.start.y = math.inf
    negative = bytearray(whole)
    at = whole.rindex(struct.pack(">h", 1) + struct.pack(">i", 1), 0, len(whole))  # num_goals, goals[0].id
    negative[at : at + 2] = struct.pack(">h", -1)
    bad = [b"", b"x", bytes(8) + whole[8:], whole + b"\0", nan.encode(), endless.encode(), bytes(negative)]
    for data in bad:
        send(daemon, "QUERY", data)
    assert daemon.wait(lambda: daemon.status.num_rejected >= before + len(bad))
    assert daemon.fresh_status().num_rejected == before + len(bad)
    assert daemon.is_alive() and not daemon.replies


def test_random_bytes_do_no_harm_and_the_next_query_is_answered(daemon, data):
    path = data / "scenarios" / "field_4_disc.json"
    daemon.aisle("map", path)
    daemon.aisle("vehicle", "--scenario", path)
    held = daemon.fresh_status()
    before = held.num_rejected
    rng = random.Random(5)
    count = 0
    for name in CHANNELS:
        for _ in range(30):
            send(daemon, name, rng.randbytes(rng.randrange(0, 1200)))
            count += name not in SNAPSHOTS  # of those only the newest may be looked at
            daemon.bus.spin(0.002)
    assert daemon.wait(lambda: daemon.status.num_rejected >= before + count + len(SNAPSHOTS))
    now = daemon.fresh_status()
    assert (now.map_id, now.map_revision, now.vehicle_revision) == (held.map_id, held.map_revision, held.vehicle_revision)
    assert " OK " in daemon.aisle("query", "--scenario", path)


@pytest.mark.parametrize("seed", SEEDS)
def test_flipped_bits_never_kill_it(daemon, data, seed):
    path = data / "scenarios" / "field_4_disc.json"
    daemon.aisle("map", path)
    daemon.aisle("vehicle", "--scenario", path)
    rng = random.Random(seed)
    whole = {"QUERY": valid_query().encode(), "VEHICLE": vehicle_t().encode()}
    for i in range(60):
        name = rng.choice(sorted(whole))
        data_bytes = bytearray(whole[name])
        for _ in range(rng.randrange(1, 4)):
            data_bytes[rng.randrange(8, len(data_bytes))] ^= 1 << rng.randrange(8)
        send(daemon, name, data_bytes)
        daemon.bus.spin(0.005 if i % 10 else 0.1)
    daemon.fresh_status()
    assert daemon.is_alive()
    # Flips may have made an odd but sound vehicle: a query is answered, whichever way.
    daemon.aisle("vehicle", "--scenario", path)
    assert " OK " in daemon.aisle("query", "--scenario", path)


def test_message_over_a_datagram_is_refused_whole(daemon):
    before = daemon.status.num_rejected
    send(daemon, "LAYOUT", bytes(100_000))
    assert daemon.wait(lambda: daemon.status.num_rejected > before)
    assert daemon.is_alive() and daemon.counter(OVERSIZE) == 1


def test_map_with_a_wrong_checksum_never_takes_effect(daemon, data):
    from aisle_tools import layouts
    from aisle_tools.scenario import read_scenario

    world = read_scenario(data / "scenarios" / "field_4_disc.json").world
    before = daemon.status.num_rejected
    for name, msg in layouts.make_messages(world, 1, 3, 0):
        msg.crc32 ^= 1
        daemon.bus.publish(name, msg)
    assert daemon.wait(lambda: daemon.status.num_rejected > before)
    assert daemon.fresh_status().map_revision == 0


def test_map_over_the_daemons_limit_names_the_limit(make_daemon, data, tmp_path):
    config = tmp_path / "small.ini"
    config.write_text("[limits]\ncells = 100000\n")
    daemon = make_daemon("--config", str(config))
    out = daemon.aisle("map", data / "ros_maps" / "aws_small_warehouse.yaml", "--timeout", "5", expect=2)
    assert "LIMIT" in out
    assert daemon.fresh_status().map_revision == 0 and daemon.is_alive()
