"""Layout patches over the bus: only what changed is worked on, the answers are those of a daemon that was given the
layout whole, and a patch that does not fit leaves all as it was."""

import copy
import math

import pytest
from aisle import layout_patch_t, layout_t, path_t, status_t
from aisle_tools import layouts
from aisle_tools.bus import Recording
from aisle_tools.scenario import read_scenario

LAYOUTS, LAYOUT_WORK = 3, 21  # counter_id of _DIAG
BASE = 5  # revision


@pytest.fixture
def factory(data):
    return data / "scenarios" / "factory_big.json"


def load(daemon, world, revision, factory):
    for name, msg in layouts.make_messages(world, 1, revision, 0):
        daemon.bus.publish(name, msg)
    assert daemon.wait(lambda: daemon.status.map_revision == revision and daemon.counter(LAYOUTS) > 0)
    daemon.aisle("vehicle", "--scenario", factory)


def make_patch(base, removed=(), polygons=()):
    msg = layout_patch_t()
    msg.map_id, msg.base_revision, msg.map_revision = 1, base, base + 1
    msg.removed, msg.num_removed = list(removed), len(removed)
    msg.polygons, msg.num_polygons = [layouts.make_polygon(p) for p in polygons], len(polygons)
    return msg


def moved(polygon, dx, dy):
    other = copy.copy(polygon)
    other.vertices = polygon.vertices + (dx, dy)
    return other


def ask(daemon, factory, log):
    daemon.aisle("query", "--scenario", factory, "--objective", "shortest", "--map-id", "1", "--save", log, expect=0)
    return [[w.encode() for w in r.waypoints] for r in Recording(log, daemon.prefix).replies if r.status == path_t.OK]


def test_a_patch_costs_its_own_area_and_answers_as_the_whole_layout_does(make_daemon, daemon, factory, tmp_path):
    world = read_scenario(factory).world
    load(daemon, world, BASE, factory)
    whole = daemon.counter(LAYOUT_WORK)
    assert whole > 3 * 1241  # rows of the field, three sweeps
    first, second, gone = world.polygons[100], world.polygons[101], world.polygons[200]
    patch = make_patch(BASE, [gone.ident], [moved(first, 0.2, 0.0), moved(second, 0.0, 0.1)])
    daemon.bus.publish("LAYOUT_PATCH", patch)
    assert daemon.wait(lambda: daemon.status.map_revision == BASE + 1)
    assert daemon.wait(lambda: daemon.counter(LAYOUTS) == 2)
    assert 0 < daemon.counter(LAYOUT_WORK) - whole < 0.5 * whole
    world.polygons[100:102] = [moved(first, 0.2, 0.0), moved(second, 0.0, 0.1)]
    del world.polygons[200]
    other = make_daemon()
    load(other, world, BASE + 1, factory)
    answers = ask(daemon, factory, tmp_path / "patched.log")
    assert len(answers) == 6
    assert answers == ask(other, factory, tmp_path / "whole.log")


def test_the_whole_layout_after_its_patch_is_a_repeat(daemon, factory):
    world = read_scenario(factory).world
    load(daemon, world, BASE, factory)
    world.polygons[7] = moved(world.polygons[7], 0.1, 0.1)
    patch = make_patch(BASE, [], [world.polygons[7]])
    daemon.bus.publish("LAYOUT_PATCH", patch)
    assert daemon.wait(lambda: daemon.status.map_revision == BASE + 1)
    rejected, work = daemon.fresh_status().num_rejected, daemon.counter(LAYOUT_WORK)
    daemon.bus.publish("LAYOUT_PATCH", patch)
    for name, msg in layouts.make_messages(world, 1, BASE + 1, 0):
        assert isinstance(msg, layout_t)
        daemon.bus.publish(name, msg)
    assert daemon.fresh_status().num_rejected == rejected
    assert (daemon.counter(LAYOUTS), daemon.counter(LAYOUT_WORK)) == (2, work)


def test_patches_that_do_not_fit_are_refused_and_change_nothing(daemon, factory, tmp_path):
    world = read_scenario(factory).world
    load(daemon, world, BASE, factory)
    before = ask(daemon, factory, tmp_path / "before.log")
    some = world.polygons[3]
    dented = copy.copy(some)
    dented.vertices = some.vertices[::-1]
    other_map = make_patch(BASE, [some.ident])
    other_map.map_id = 2
    bad = [
        (make_patch(BASE, [some.ident, 99999]), status_t.CONFLICT),
        (make_patch(BASE, [some.ident, some.ident]), status_t.CONFLICT),
        (make_patch(BASE - 1, [some.ident]), status_t.CONFLICT),  # says another thing of the revision held
        (make_patch(BASE + 3, [some.ident]), status_t.REVISION_GAP),
        (make_patch(BASE, [], [some, some]), status_t.MALFORMED),
        (make_patch(BASE, [], [dented]), status_t.MALFORMED),
        (other_map, status_t.MAP_MISMATCH),
    ]
    for i, (patch, cause) in enumerate(bad):
        daemon.bus.publish("LAYOUT_PATCH", patch)
        assert daemon.wait(lambda i=i: daemon.status.num_rejected == i + 1)
        assert daemon.wait(lambda cause=cause: daemon.status.cause == cause)
    whole = make_patch(BASE, [some.ident], [moved(some, 0.1, 0.0)])
    not_a_number = copy.copy(some)
    not_a_number.vertices = some.vertices * (1.0, math.nan)
    broken = [whole.encode()[:n] for n in (9, 40, len(whole.encode()) - 1)]
    broken.append(make_patch(BASE, [], [not_a_number]).encode())
    for i, data in enumerate(broken):
        daemon.bus.lcm.publish(f"{daemon.prefix}_LAYOUT_PATCH", data)
        assert daemon.wait(lambda i=i: daemon.status.num_rejected == len(bad) + i + 1)
    assert (daemon.fresh_status().map_revision, daemon.counter(LAYOUTS)) == (BASE, 1)
    assert ask(daemon, factory, tmp_path / "after.log") == before
    daemon.bus.publish("LAYOUT_PATCH", make_patch(BASE, [some.ident]))
    assert daemon.wait(lambda: daemon.status.map_revision == BASE + 1)
