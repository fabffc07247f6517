"""The main job: a map in, proved paths or reasons out, judged by the independent checker."""

import json
import math

import pytest
from aisle import path_t, status_t
from aisle_tools import query, vehicle
from aisle_tools.bottleneck import ClearanceField, narrowest
from aisle_tools.bus import Recording
from aisle_tools.check import Obstacles, check_path
from aisle_tools.rosmap import read_world
from aisle_tools.scenario import read_scenario

MAP = "aws_small_warehouse"
SHORTEST_WORST = 1.05  # of the exact optimum, disc robots, margin none


def judge(log, prefix, world):
    """Every reply of the log through the independent checker; how many paths there were."""
    recording = Recording(log, prefix)
    body = vehicle.body(recording.vehicle)
    obstacles = Obstacles(world)
    count = 0
    for reply in recording.replies:
        if reply.status == path_t.OK:
            report = check_path(reply, obstacles, body, recording.queries[reply.query_id])
            assert report.ok, f"query {reply.query_id}: {report.faults}"
            assert report.clearance >= body.margin - 1e-6
            count += 1
    return count


@pytest.mark.parametrize(
    "shape",
    [["--radius", "0.3", "--margin", "-1"], ["--radius", "0.3"], ["--footprint", "0.7x0.4", "--margin", "0.05"]],
)
def test_every_pair_of_a_real_map_gets_a_path_that_keeps_the_margin(daemon, data, tmp_path, shape):
    yaml, goals = data / "ros_maps" / f"{MAP}.yaml", data / "ros_maps" / f"{MAP}.goals.csv"
    daemon.aisle("map", yaml)
    daemon.aisle("vehicle", *shape)
    for objective in ("safest", "shortest"):
        log = tmp_path / f"{objective}.log"
        out = daemon.aisle("query", "--goals", goals, "--map", yaml, "--objective", objective, "--save", log, *shape)
        assert out.count(" OK ") == 5
        assert judge(log, daemon.prefix, read_world(yaml)) == 5
        for reply in Recording(log, daemon.prefix).replies:
            straight = reply.waypoints[0], reply.waypoints[-1]
            beeline = math.hypot(straight[1].x - straight[0].x, straight[1].y - straight[0].y)
            bound = reply.length_bound
            assert beeline * (1.0 - 1e-6) - 0.06 <= bound * (1.0 + 1e-6) + 0.06 or bound == 0.0
            assert bound <= reply.length
    assert "0 at fault" in daemon.aisle("check", log, "--map", yaml)  # the command, of what judge() has seen


@pytest.mark.parametrize("name", ["barrier_1", "barrier_2", "field_12_disc", "storage_lr", "field_8_two"])
def test_shortest_paths_of_scenarios_are_close_to_the_optimum(daemon, data, tmp_path, name):
    path = data / "scenarios" / f"{name}.json"
    daemon.aisle("map", path)
    daemon.aisle("vehicle", "--scenario", path)
    log = tmp_path / "replies.log"
    daemon.aisle("query", "--scenario", path, "--objective", "shortest", "--save", log)
    scenario = read_scenario(path)
    legs = json.loads((data / "scenarios" / "optimum.json").read_text())[name]["legs"]
    assert judge(log, daemon.prefix, scenario.world) == len(legs)
    for reply, leg in zip(Recording(log, daemon.prefix).replies, legs):
        assert leg["lower"] * (1.0 - 1e-5) - 0.06 <= reply.length <= leg["upper"] * SHORTEST_WORST
        assert reply.length_bound <= leg["upper"] * (1.0 + 1e-5)


def test_refusals_tell_the_reason(daemon, data):
    yaml = data / "ros_maps" / f"{MAP}.yaml"
    goals = query.read_goals(yaml.with_suffix(".goals.csv"))
    good = ",".join(str(v) for v in goals[0].start)
    assert "NO_LAYOUT" in daemon.aisle("query", "--start", good, "--goal", good, expect=1)
    daemon.aisle("map", yaml)
    daemon.aisle("vehicle", "--radius", "0.3")
    wall = find_wall(read_world(yaml))
    assert "START_OCCUPIED" in daemon.aisle("query", "--start", wall, "--goal", good, expect=1)
    occupied = json.loads(daemon.aisle("query", "--start", good, "--goal", wall, "--json", expect=1))
    assert occupied["cause"] == "GOAL_OCCUPIED" and "move 0." in occupied["reason"]
    moved = ",".join(f"{v:.3f}" for v in occupied["move_to"])
    assert "OCCUPIED" not in daemon.aisle("query", "--start", moved, "--goal", moved)
    assert "GOAL_OUTSIDE" in daemon.aisle("query", "--start", good, "--goal", "500,500", expect=1)
    assert "MAP_MISMATCH" in daemon.aisle("query", "--start", good, "--goal", good, "--map-id", "77", expect=1)
    assert "outside the map" in daemon.aisle("query", "--start", good, "--goal", "500,500", "--map", yaml, expect=2)


def find_wall(world):
    row, column = world.grid.height // 2, int(world.grid.occupied[world.grid.height // 2].argmax())
    x = world.grid.origin_x + (column + 0.5) * world.grid.resolution
    y = world.grid.origin_y + (row + 0.5) * world.grid.resolution
    return f"{x},{y}"


def test_a_gap_too_narrow_is_named_with_its_width(daemon, data):
    path = data / "scenarios" / "barrier_1.json"  # the opening is 1.2 m
    daemon.aisle("map", path, "--margin", "0.5")
    daemon.aisle("vehicle", "--radius", "0.75", "--margin", "-1")
    line = daemon.aisle("query", "--start", "2,2", "--goal", "12,4", "--json", expect=1)
    answer = json.loads(line)
    assert answer["status"] == "NONE" and answer["cause"] == "TOO_NARROW"
    assert answer["cause_value"] == pytest.approx(1.2, abs=1e-3)
    assert len(answer["gap_between"]) == 2 and "gap of 1.200 m between" in answer["reason"]
    assert math.hypot(answer["place"][0] - 7.5, answer["place"][1] - 11.8) < 0.5  # the opening


def test_the_gap_named_on_a_real_map_is_where_the_way_is_narrow(daemon, data):
    yaml = data / "ros_maps" / "nav2_warehouse.yaml"
    daemon.aisle("map", yaml)
    daemon.aisle("vehicle", "--radius", "1.1")
    words = ["--start", "2,-15", "--goal", "-12.8,10.6", "--work-units", "100000000"]
    answer = json.loads(daemon.aisle("query", *words, "--json", expect=1))
    assert answer["cause"] == "TOO_NARROW" and answer["cause_value"] == pytest.approx(2.1, abs=1e-3)
    field = ClearanceField(Obstacles(read_world(yaml)))
    place = narrowest(field, (2.0, -15.0), (-12.8, 10.6))
    assert answer["cause_value"] == pytest.approx(2.0 * place.clearance, abs=4.0 * field.step)
    x, y = answer["place"]
    assert y > 19.2 and x < 0.0  # between the stands along the upper wall, the only way in


def test_budget_too_small_is_not_called_a_proof(daemon, data):
    path = data / "scenarios" / "clutter_50.json"
    daemon.aisle("map", path)
    daemon.aisle("vehicle", "--scenario", path)
    answer = json.loads(daemon.aisle("query", "--scenario", path, "--work-units", "50", "--json", expect=1))
    assert answer["cause"] == "BUDGET"


def test_same_question_same_bytes(daemon, data, tmp_path):
    path = data / "scenarios" / "field_12_disc.json"
    daemon.aisle("map", path)
    daemon.aisle("vehicle", "--scenario", path)
    answers = []
    for i in range(2):
        log = tmp_path / f"{i}.log"
        daemon.aisle("query", "--scenario", path, "--save", log)
        answers.append(Recording(log, daemon.prefix).replies[0])
    assert [w.encode() for w in answers[0].waypoints] == [w.encode() for w in answers[1].waypoints]
    assert answers[0].query_id != answers[1].query_id
    assert (answers[0].cached, answers[1].cached) == (False, True)
    assert 0 < answers[1].work_units < answers[0].work_units


def test_several_goals_are_visited_in_order(daemon, data, tmp_path):
    path = data / "scenarios" / "field_8_two.json"
    daemon.aisle("map", path)
    daemon.aisle("vehicle", "--scenario", path)
    log = tmp_path / "r.log"
    daemon.aisle("query", "--start", "1,1", "--goal", "9,8", "--goal", "19,19", "--save", log, "--scenario", path)
    daemon.aisle(
        "query", "--start", "1,1", "--goal", "9,8", "--goal", "19,19", "--save", log, "--radius", "0.3", "--margin", "-1"
    )
    assert judge(log, daemon.prefix, read_scenario(path).world) == 1
    reply = Recording(log, daemon.prefix).replies[0]
    assert [w.goal_id for w in reply.waypoints if w.flags & 8] == [1, 2]


def test_newer_map_takes_the_place_of_the_older_one(daemon, data):
    first = data / "scenarios" / "field_4_disc.json"
    second = data / "scenarios" / "barrier_1.json"
    daemon.aisle("map", first, "--map-revision", "5")
    assert (daemon.fresh_status().map_id, daemon.status.map_revision) == (1, 5)
    assert "OUTDATED" in daemon.aisle("map", second, "--map-revision", "4", "--timeout", "4", expect=2)
    assert "CONFLICT" in daemon.aisle("map", second, "--map-revision", "5", "--timeout", "4", expect=2)
    daemon.aisle("map", first, "--map-revision", "5")  # the same again
    daemon.aisle("vehicle", "--radius", "0.3", "--revision", "7")
    assert "CONFLICT" in daemon.aisle("vehicle", "--radius", "0.4", "--revision", "7", "--timeout", "4", expect=2)
    assert "OUTDATED" in daemon.aisle("vehicle", "--radius", "0.4", "--revision", "6", "--timeout", "4", expect=2)
    daemon.aisle("map", second)
    assert daemon.fresh_status().map_revision > 5
    assert daemon.status.cause != status_t.NO_LAYOUT
