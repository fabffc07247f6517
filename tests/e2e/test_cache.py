"""Remembered answers over the bus: the same question again, after a patch far away, after one on the path."""

import numpy as np
import pytest
from aisle import layout_patch_t, options_t, path_t, polygon_t
from aisle_tools import query, vehicle
from aisle_tools.bus import Bus
from aisle_tools.check import Obstacles, check_path
from aisle_tools.scenario import read_scenario
from aisle_tools.world import Polygon
from harness import PATIENCE, URL

HITS, MISSES, KEPT, DROPPED, SPOILED, REPAIRED = 16, 17, 18, 19, 20, 25  # counter_id of _DIAG


class Asker:
    """One question, asked as often as wanted; answers are judged on the polygons as they are by then."""

    def __init__(self, daemon, scenario):
        self.daemon, self.world, self.radius = daemon, scenario.world, scenario.radius
        self.body = vehicle.body(vehicle.make({"radius": scenario.radius, "margin": -1.0}))
        self.leg = query.Leg("1", scenario.start, [scenario.goals[0]])
        self.ident = 0

    def ask(self):
        self.ident += 1
        msg = query.make_query(self.leg, self.ident, 1, options_t(), False)
        before = len(self.daemon.replies)
        self.daemon.bus.publish("QUERY", msg)
        assert self.daemon.wait(lambda: len(self.daemon.replies) > before)
        reply = self.daemon.replies[-1]
        assert reply.status == path_t.OK and reply.query_id == self.ident
        assert reply.map_revision == self.daemon.fresh_status().map_revision
        report = check_path(reply, Obstacles(self.world), self.body, msg)
        assert report.ok, report.faults
        return reply


def box(ident, x, y, half):
    msg = polygon_t()
    msg.id = ident
    msg.vertices = [(x - half, y - half), (x + half, y - half), (x + half, y + half), (x - half, y + half)]
    msg.num_vertices = 4
    return msg


def patch(daemon, world, *polygons):
    msg = layout_patch_t()
    msg.map_id = 1
    msg.base_revision = daemon.fresh_status().map_revision
    msg.map_revision = msg.base_revision + 1
    msg.polygons, msg.num_polygons = list(polygons), len(polygons)
    daemon.bus.publish("LAYOUT_PATCH", msg)
    assert daemon.wait(lambda: daemon.status.map_revision == msg.map_revision)
    world.polygons.extend(Polygon(p.id, np.array(p.vertices)) for p in polygons)


def way(reply):
    return [w.encode() for w in reply.waypoints]


@pytest.fixture
def asker(daemon, data):
    path = data / "scenarios" / "field_12_disc.json"
    daemon.aisle("map", path)
    daemon.aisle("vehicle", "--scenario", path)
    return Asker(daemon, read_scenario(path))


def test_a_question_again_is_answered_from_memory_until_something_stands_in_its_way(asker):
    daemon = asker.daemon
    first = asker.ask()
    again = asker.ask()
    assert (first.cached, again.cached) == (False, True)
    assert way(first) == way(again) and again.work_units < first.work_units / 100
    farthest = max(
        ((x, y) for x in (1.0, 19.0) for y in (1.0, 19.0)),
        key=lambda p: min((w.x - p[0]) ** 2 + (w.y - p[1]) ** 2 for w in first.waypoints),
    )
    patch(daemon, asker.world, box(9001, *farthest, 0.2))
    kept = asker.ask()
    assert kept.cached and way(kept) == way(first) and kept.map_revision == first.map_revision + 1
    middle = first.waypoints[len(first.waypoints) // 2]
    patch(daemon, asker.world, box(9002, middle.x, middle.y, 0.1))
    new = asker.ask()
    assert not new.cached and way(new) != way(first)
    assert asker.ask().cached
    counts = [daemon.counter(i) for i in (HITS, MISSES, KEPT, DROPPED, SPOILED)]
    assert counts == [3, 2, 1, 1, 0]


def test_a_blocked_answer_is_repaired_from_its_free_pieces(asker):
    daemon = asker.daemon
    first = asker.ask()
    at = max(first.waypoints[1:-1], key=lambda w: w.clearance)
    off = asker.radius + 0.45  # within the creep clearance: the path is to go round by a hand's breadth
    patch(daemon, asker.world, box(9001, at.x - off * np.sin(at.theta), at.y + off * np.cos(at.theta), 0.02))
    repaired = asker.ask()
    assert not repaired.cached and way(repaired) != way(first)
    assert first.length < repaired.length <= 1.01 * first.length
    assert [daemon.counter(i) for i in (HITS, MISSES, REPAIRED)] == [0, 2, 1]
    assert asker.ask().cached


def test_clients_at_once_are_answered_in_order_each_with_its_id(daemon, data):
    path = data / "scenarios" / "field_12_disc.json"
    daemon.aisle("map", path)
    daemon.aisle("vehicle", "--scenario", path)
    scenario = read_scenario(path)
    legs = [query.Leg("1", scenario.start, [goal]) for goal in (*scenario.goals, (1.0, 19.0))]
    clients = [Bus(URL, daemon.prefix) for _ in range(4)]
    heard = [[] for _ in clients]
    for client, replies in zip(clients, heard):
        client.subscribe("REPLY", path_t, replies.append, 1000)
    asked = []
    for turn in range(10):
        for number, client in enumerate(clients):
            asked.append(1000 * (number + 1) + turn)
            client.publish("QUERY", query.make_query(legs[(turn + number) % len(legs)], asked[-1], 1, options_t(), False))
    for client, replies in zip(clients, heard):
        assert client.spin(PATIENCE, lambda r=replies: len(r) >= len(asked))
    for replies in heard:  # the bus tells everybody, and the ids whose answer it is
        assert [r.query_id for r in replies] == asked
        assert all(r.status == path_t.OK for r in replies)
    ways = {}
    for number, reply in enumerate(heard[0]):
        ends = (number % 4 + number // 4) % len(legs)
        assert way(reply) == ways.setdefault(ends, way(reply))
    daemon.fresh_status()  # what waited in the queue is heard
    assert daemon.counter(MISSES) == len(legs) and daemon.counter(HITS) == len(asked) - len(legs)


def test_a_daemon_told_to_forget_plans_every_request(make_daemon, data, tmp_path):
    config = tmp_path / "forgetful.ini"
    config.write_text("[daemon]\nstatus_hz = 50\ndiag_hz = 10\n[planner]\nremember = no\n")
    daemon = make_daemon("--config", str(config))
    path = data / "scenarios" / "field_12_disc.json"
    daemon.aisle("map", path)
    daemon.aisle("vehicle", "--scenario", path)
    asker = Asker(daemon, read_scenario(path))
    answers = [asker.ask(), asker.ask()]
    assert not any(a.cached for a in answers)
    assert way(answers[0]) == way(answers[1]) and answers[0].work_units == answers[1].work_units
