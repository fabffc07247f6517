"""PRM by name over the bus: one roadmap for several clients, repaired by a patch between them; from the command line."""

import subprocess

import pytest
from aisle import options_t, path_t
from aisle_tools import query, vehicle
from aisle_tools.bus import Bus, Recording
from aisle_tools.check import Obstacles, check_path
from aisle_tools.scenario import read_scenario
from harness import AISLE_REPLAY, PATIENCE, URL
from test_cache import box, patch
from test_driving import Driver, goal_list

HITS, ROADMAPS, REPAIRS = 16, 26, 27  # counter_id of _DIAG
SIDE = (2.0, 6.0, 10.0, 14.0, 18.0)


def prm() -> options_t:
    options = options_t()
    options.planner, options.objective = options_t.PRM, options_t.SHORTEST
    return options


@pytest.fixture
def field(data):
    return data / "scenarios" / "field_8_disc.json"


@pytest.fixture
def recorded(make_daemon, field, tmp_path):
    config = tmp_path / "aisled.ini"
    config.write_text("[daemon]\nstatus_hz = 50\ndiag_hz = 10\n")
    daemon = make_daemon("--config", str(config), "--record", str(tmp_path / "flight.log"))
    daemon.aisle("map", field)
    daemon.aisle("vehicle", "--scenario", field)
    return daemon


class Clients:
    """Three of them, whose questions come in turn."""

    def __init__(self, daemon, scenario):
        self.daemon, self.world = daemon, scenario.world
        self.body = vehicle.body(vehicle.make({"radius": scenario.radius, "margin": -1.0}))
        self.buses = [Bus(URL, daemon.prefix) for _ in range(3)]
        self.asked = {}

    def ask(self, pairs):
        """Answers in the order of the questions, judged on the polygons as they are by now."""
        before = len(self.daemon.replies)
        for i, (start, goal) in enumerate(pairs):
            ident = len(self.asked) + 1
            msg = query.make_query(query.Leg(str(ident), start, [goal]), ident, 1, prm(), False)
            self.asked[ident] = msg
            self.buses[i % len(self.buses)].publish("QUERY", msg)
        assert self.daemon.bus.spin(PATIENCE, lambda: len(self.daemon.replies) >= before + len(pairs))
        replies = self.daemon.replies[before:]
        for reply in replies:
            assert reply.status == path_t.OK and reply.planner == options_t.PRM
            report = check_path(reply, Obstacles(self.world), self.body, self.asked[reply.query_id])
            assert report.ok, report.faults
        return replies


def test_clients_share_one_roadmap_that_a_patch_repairs_and_a_replay_repeats(recorded, field, tmp_path):
    daemon, clients = recorded, Clients(recorded, read_scenario(field))
    pairs = [((0.5, y), (19.5, 20.0 - y)) for y in SIDE]
    first = clients.ask(pairs)
    assert [r.query_id for r in first] == [1, 2, 3, 4, 5] and not any(r.cached for r in first)
    driver = Driver(daemon)  # lists, the second before the first one can be planned, leave nothing
    driver.pose = (0.5, 10.0, 0.0)
    driver.spin(0.2)
    for revision in (1, 2):
        daemon.bus.publish("GOALS", with_prm(goal_list(revision, (19.5, 10.0 + revision))))
    driver.spin(0.5)
    at = first[2].waypoints[len(first[2].waypoints) // 2]
    patch(daemon, clients.world, box(9001, at.x, at.y, 0.1))
    again = clients.ask(pairs)
    assert not again[2].cached
    assert all(r.cached for r in clients.ask(pairs))
    assert daemon.counter(ROADMAPS) == 1 and daemon.counter(REPAIRS) >= 1  # the mission's copy is repaired, too
    assert daemon.counter(HITS) >= len(pairs)
    assert daemon.stop() == 0
    words = [AISLE_REPLAY, "--prefix", daemon.prefix, "--check", str(tmp_path / "flight.log")]
    done = subprocess.run(words, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "differ" not in done.stderr


def with_prm(goals):
    goals.options = prm()
    return goals


def test_a_query_from_the_command_line_names_it(daemon, field, tmp_path):
    daemon.aisle("map", field)
    daemon.aisle("vehicle", "--scenario", field)
    log = tmp_path / "replies.log"
    words = ["query", "--scenario", field, "--planner", "PRM", "--objective", "shortest"]
    for more in (["--save", log], []):
        assert " OK " in daemon.aisle(*words, *more)
    assert "0 at fault" in daemon.aisle("check", log, "--map", field)
    assert [r.planner for r in Recording(log, daemon.prefix).replies] == [options_t.PRM]
    assert " OK " in daemon.aisle(*words, "--seed", "7")
    daemon.fresh_status()  # what waited in the queue is heard
    assert daemon.counter(HITS) == 1 and daemon.counter(ROADMAPS) == 2  # another seed is another roadmap
