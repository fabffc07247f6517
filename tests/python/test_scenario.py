"""Scenario files, vehicles and what to ask."""

import argparse
import json

import pytest
from aisle import query_t, vehicle_t
from aisle_tools import movingai, query, vehicle
from aisle_tools.errors import UserError
from aisle_tools.scenario import read_scenario
from aisle_tools.world import World

SQUARE = [[1, 1], [2, 1], [2, 2], [1, 2]]
GOOD = {"bounds": [0, 0, 9, 6], "robot": {"radius": 0.3}, "start": [0, 0], "goals": [[8, 5]], "obstacles": [SQUARE]}


def write(folder, **changes):
    path = folder / "s.json"
    path.write_text(json.dumps({**GOOD, **changes}))
    return path


def test_bounds_grow_by_radius_and_margin(tmp_path):
    assert read_scenario(write(tmp_path), 0.1).world.bounds == pytest.approx((-0.401, -0.401, 9.401, 6.401))
    assert read_scenario(write(tmp_path), -1.0).world.bounds == pytest.approx((-0.301, -0.301, 9.301, 6.301))


def test_a_point_is_a_disc_of_one_millimetre(tmp_path):
    scenario = read_scenario(write(tmp_path, robot={"radius": 0.0}))
    assert scenario.radius == 0.001 and scenario.world.bounds[0] == -0.002


def test_clockwise_polygons_are_turned(tmp_path):
    polygon = read_scenario(write(tmp_path, obstacles=[SQUARE[::-1]])).world.polygons[0]
    assert polygon.ident == 1 and polygon.vertices.tolist() == SQUARE


@pytest.mark.parametrize(
    ("changes", "needle"),
    [
        ({"bounds": [9, 0, 0, 6]}, "bounds"),
        ({"bounds": [0, 0, 9]}, "bounds"),
        ({"obstacles": [[[0, 0], [4, 0], [1, 1], [0, 4]]]}, "obstacle 1 is not convex"),
        ({"obstacles": [[[0, 0], [4, 0]]]}, "3 to 16 vertices"),
        ({"obstacles": [SQUARE] * 4097}, "limit 'polygons' = 4096"),
        ({"start": "here"}, "start"),
        ({"robot": None}, "robot"),
    ],
)
def test_errors_say_what_is_wrong(tmp_path, changes, needle):
    with pytest.raises(UserError, match=needle):
        read_scenario(write(tmp_path, **changes))


def test_broken_json_names_the_line(tmp_path):
    path = tmp_path / "s.json"
    path.write_text('{"bounds":\n [,]}')
    with pytest.raises(UserError, match="s.json:2: not valid JSON"):
        read_scenario(path)


def test_every_scenario_of_the_test_data_can_be_read(data):
    optimum = json.loads((data / "scenarios" / "optimum.json").read_text())
    for name, best in optimum.items():
        scenario = read_scenario(data / "scenarios" / f"{name}.json")
        assert len(scenario.goals) == len(best["legs"])


def options(**changes):
    base = {"vehicle": None, "radius": None, "footprint": None, "margin": None}
    return argparse.Namespace(**{**base, **changes})


def test_defaults_are_filled_in_and_negative_margin_is_none():
    body = vehicle.body(vehicle_t())
    assert body.vertices[2].tolist() == [0.5, 0.35] and body.margin == pytest.approx(0.1)
    assert body.limits["v_max"] == 1.5
    assert vehicle.body(vehicle.make({"radius": 0.3, "margin": -1})).margin == 0.0
    assert vehicle.body(vehicle.make({"radius": 0.3})).is_disc


def test_file_is_overridden_by_options(tmp_path):
    path = tmp_path / "v.yaml"
    path.write_text("footprint: [[-1, -0.4], [1, -0.4], [1, 0.4], [-1, 0.4]]\nv_max: 1.0\nmargin: 0.2\ndrive: omni\n")
    msg = vehicle.from_options(options(vehicle=path, margin=-1.0, v_max=0.7))
    assert (msg.num_vertices, msg.v_max, msg.margin, msg.drive) == (4, 0.7, -1.0, vehicle_t.OMNI)
    assert vehicle_t.decode(msg.encode()).footprint[1] == (1.0, -0.4)
    assert vehicle.from_options(options(vehicle=path, radius=0.4)).num_vertices == 0
    assert vehicle.from_options(options()) is None


def test_footprint_words():
    assert vehicle.parse_footprint("1.0x0.6")[2] == (0.5, 0.3)
    assert vehicle.parse_footprint("0,0 1,0 0,1") == [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]
    with pytest.raises(UserError, match="LENGTHxWIDTH"):
        vehicle.parse_footprint("wide")


@pytest.mark.parametrize(
    ("values", "needle"),
    [
        ({"v_mx": 1}, "unknown key 'v_mx', is 'v_max' meant"),
        ({"v_max": -1}, "v_max must not be negative"),
        ({"v_max": "fast"}, "must be a number"),
        ({"footprint": [[0, 0], [0, 1], [1, 0]]}, "counter-clockwise"),
        ({"footprint": [[0, 0], [1, 0]]}, "3 to 16 points"),
        ({"footprint": 3}, "list of"),
        ({"drive": "legs"}, "none of: differential"),
    ],
)
def test_vehicle_errors_name_the_key(values, needle):
    with pytest.raises(UserError, match=needle):
        vehicle.make(values)


def test_goals_file_of_a_map(data):
    legs = query.read_goals(data / "ros_maps" / "nav2_warehouse.goals.csv")
    assert len(legs) == 5
    assert legs[0].start == (-14.365, -24.325) and legs[0].goals == [(-12.835, 10.625)] and legs[0].given_length == 93.373


def test_goals_file_with_headings_and_names(tmp_path):
    path = tmp_path / "g.csv"
    path.write_text("name,start_x,start_y,start_theta,goal_x,goal_y,goal_theta\ndock,1,2,0.5,3,4,-0.5\npark,1,2,,3,4,\n")
    dock, park = query.read_goals(path)
    assert dock.name == "dock" and dock.start == (1.0, 2.0, 0.5) and dock.goals == [(3.0, 4.0, -0.5)]
    assert park.start == (1.0, 2.0) and park.goals == [(3.0, 4.0)]


def test_goals_file_errors_name_the_line(tmp_path):
    path = tmp_path / "g.csv"
    path.write_text("start_x,start_y,goal_x,goal_y\n1,2,3,4\n1,2,x,4\n")
    with pytest.raises(UserError, match="g.csv:3: not numbers"):
        query.read_goals(path)
    path.write_text("start_x,start_y,goal_x\n1,2,3\n")
    with pytest.raises(UserError, match="g.csv:1: column 'goal_y' is missing"):
        query.read_goals(path)


def test_heading_is_any_unless_given():
    free = query.make_goal(1, (1.0, 2.0), any_heading=False)
    fixed = query.make_goal(2, (1.0, 2.0, 0.5), any_heading=False)
    asked = query.make_goal(3, (1.0, 2.0, 0.5), any_heading=True)
    assert free.tolerance_theta > 3.15 and fixed.tolerance_theta == 0.0 and asked.tolerance_theta > 3.15


def test_goal_outside_the_map_is_said_before_asking():
    world = World("hall", (0.0, 0.0, 10.0, 5.0))
    query.check_inside([query.Leg("1", (1.0, 1.0), [(9.0, 4.0)])], world)
    with pytest.raises(UserError, match=r"query 1: goal \(11, 4\) is outside the map hall: x 0 to 10, y 0 to 5"):
        query.check_inside([query.Leg("1", (1.0, 1.0), [(11.0, 4.0)])], world)


def test_a_query_can_be_encoded():
    args = argparse.Namespace(planner="astar", objective="shortest", interpolation="linear", seed=3, work_units=1000)
    leg = query.Leg("1", (0.0, 0.0), [(1.0, 1.0), (2.0, 0.0, 1.5)])
    asked = query_t.decode(query.make_query(leg, 7, 1, query.make_options(args), False).encode())
    assert (asked.options.planner, asked.options.objective, asked.options.interpolation) == (9, 1, 1)
    assert asked.num_goals == 2 and asked.goals[1].id == 2 and asked.start.theta == pytest.approx(0.785398)


@pytest.mark.parametrize("text", ["1", "1,2,3,4", "a,b", "nan,1", ""])
def test_bad_poses_are_refused(text):
    with pytest.raises(UserError, match="X,Y"):
        query.parse_pose(text, "--start")


MOVINGAI = "type octile\nheight 2\nwidth 3\nmap\n.GT\n@S.\n"


def test_movingai_maps_have_their_first_row_on_top(tmp_path):
    path = tmp_path / "m.map"
    path.write_text(MOVINGAI)
    world = movingai.read_world(path)
    assert world.grid.occupied.tolist() == [[True, False, False], [False, False, True]]
    assert world.bounds == (0.0, 0.0, 1.5, 1.0)
    assert movingai.read_world(path, 0.25).bounds[2] == 0.75


@pytest.mark.parametrize(
    ("old", "new", "needle"),
    [
        ("octile", "tile", "m.map:1: not a MovingAI map"),
        ("width 3", "width x", "m.map:1: not a MovingAI map"),
        (".GT", ".G", "m.map:5: needs 3 cells, has 2"),
        ("height 2", "height 3", "m.map:7: needs 3 cells, has 0"),
        ("width 3", "width 99999", "65535"),
    ],
)
def test_broken_movingai_maps_are_refused(tmp_path, old, new, needle):
    path = tmp_path / "m.map"
    path.write_text(MOVINGAI.replace(old, new))
    with pytest.raises(UserError, match=needle):
        movingai.read_world(path)
