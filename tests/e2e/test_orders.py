"""Goals in any order, over the bus: queries, a mission that goes on by goal id, lists that cannot be told apart."""

import itertools
import json

import pytest
from aisle import goal_list_t, options_t, path_t, status_t, waypoint_t
from aisle_tools import goals, query, vehicle
from aisle_tools.bus import now_us
from aisle_tools.check import Obstacles, check_path
from aisle_tools.scenario import read_scenario

START = (1.0, 1.0)
PLACES = [(13.0, 14.0), (4.0, 4.0), (14.0, 2.0), (1.0, 13.5)]  # about the walls of barrier_2, ids 1 to 4


@pytest.fixture
def ready(daemon, data):
    path = data / "scenarios" / "barrier_2.json"
    daemon.aisle("map", path)
    daemon.aisle("vehicle", "--scenario", path)
    return daemon, read_scenario(path)


def passed(path):
    return [w.goal_id for w in path.waypoints if w.flags & waypoint_t.GOAL]


def words(places):
    return [w for place in places for w in ("--goal", f"{place[0]},{place[1]}")]


def test_a_query_in_any_order_is_as_short_as_the_best_given_one(ready):
    daemon, _ = ready
    ask = ("query", "--start", "1,1", "--objective", "shortest", "--json")
    best = json.loads(daemon.aisle(*ask, "--any-order", *words(PLACES)))
    lengths = [json.loads(daemon.aisle(*ask, *words(order)))["length"] for order in itertools.permutations(PLACES)]
    assert best["length"] == pytest.approx(min(lengths), abs=2e-3)
    assert max(lengths) > 1.5 * best["length"]


def goal_list(revision, ids=(11, 12, 13, 14)):
    msg = goal_list_t()
    msg.utime, msg.goal_list_id, msg.goal_list_revision, msg.map_id = now_us(), 4, revision, 1
    msg.ordering, msg.options = goal_list_t.ANY_ORDER, options_t()
    msg.goals = [query.make_goal(i, p, False) for i, p in zip(ids, PLACES)]
    msg.num_goals = len(msg.goals)
    return msg


class Vehicle:
    """Stands where it is put; its pose at 20 Hz."""

    def __init__(self, daemon):
        self.daemon, self.seq, self.pose = daemon, 0, (*START, 0.0)

    def stand(self, until, seconds=30.0):
        for _ in range(int(seconds / 0.05)):
            self.seq += 1
            self.daemon.bus.publish("POSE", goals.make_pose(self.pose, self.seq, 1))
            self.daemon.bus.spin(0.05)
            if until():
                return True
        return False


def test_a_mission_goes_on_by_goal_id_and_orders_what_is_left_on_a_new_map(ready, data):
    daemon, scenario = ready
    robot = Vehicle(daemon)
    robot.stand(lambda: False, 0.3)
    daemon.bus.publish("GOALS", goal_list(1))
    assert robot.stand(lambda: any(p.status == path_t.OK for _, p in daemon.paths))
    robot.stand(lambda: False, 1.0)  # improvements settle
    path = daemon.paths[-1][1]
    order = passed(path)
    assert sorted(order) == [11, 12, 13, 14]
    asked = query.make_query(query.Leg("1", robot.pose, PLACES), 1, 1, options_t(), True, any_order=True)
    for goal in asked.goals:
        goal.id += 10
    assert check_path(path, Obstacles(scenario.world), vehicle.body(vehicle.make({"radius": 0.3, "margin": -1})), asked).ok
    assert daemon.fresh_status().goal_id == order[0]
    robot.pose = (*PLACES[order[1] - 11], 0.0)
    robot.stand(lambda: False, 0.5)
    assert daemon.fresh_status().goal_id == order[0]  # not its turn
    robot.pose = (*PLACES[order[0] - 11], 0.0)
    assert robot.stand(lambda: daemon.status.goal_id == order[1])
    begin = len(daemon.paths)
    before = path.map_revision
    daemon.aisle("map", data / "scenarios" / "barrier_1.json")
    assert robot.stand(lambda: any(p.status == path_t.OK and p.map_revision > before for _, p in daemon.paths[begin:]))
    path = daemon.paths[-1][1]
    assert sorted(passed(path)) == sorted(order[1:])
    assert robot.stand(lambda: daemon.status.goal_id == passed(path)[0])


def test_a_list_whose_goals_share_an_id_is_refused_and_the_mission_goes_on(ready):
    daemon, _ = ready
    robot = Vehicle(daemon)
    robot.stand(lambda: False, 0.3)
    daemon.bus.publish("GOALS", goal_list(1))
    assert robot.stand(lambda: daemon.status.state == status_t.ACTIVE)
    rejected = daemon.status.num_rejected
    daemon.bus.publish("GOALS", goal_list(2, (11, 12, 13, 11)))
    assert robot.stand(lambda: daemon.status.num_rejected > rejected)
    assert (daemon.status.cause, daemon.status.cause_id) == (status_t.MALFORMED, 11)
    assert (daemon.status.state, daemon.status.goal_list_revision) == (status_t.ACTIVE, 1)
