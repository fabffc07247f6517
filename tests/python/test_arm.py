"""aisle arm: motions from messages, their curves and limits in the picture, its log, what it says when asked wrongly."""

import json

import matplotlib
import numpy as np
import pytest
from aisle import arm_goal_t, arm_path_t, arm_waypoint_t, path_t, pose_t, status_t, vehicle_t
from aisle_tools import arm, arms, cli
from aisle_tools.bus import read_events
from aisle_tools.errors import UserError

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

POSE = (5.0, 5.0, 0.3)


def scenario_of(data, name="arm_2_post"):
    return arms.read_scenario(data / "arms" / f"{name}.json")


def waypoint(t, q, v=(0.0, 0.0, 0.0), a=(0.0, 0.0, 0.0)):
    w = arm_waypoint_t()
    w.t, w.q, w.qd, w.qdd = t, list(q), list(v), list(a)
    return w


def path_of(*waypoints):
    path = arm_path_t()
    path.status, path.waypoints, path.num_waypoints = path_t.OK, list(waypoints), len(waypoints)
    path.duration = waypoints[-1].t
    return path


def swing():
    """From rest over a via-point in full motion to rest."""
    return path_of(
        waypoint(0.0, (0.0, 0.2, -0.4)),
        waypoint(1.5, (0.6, 0.9, -0.6), (0.7, 0.5, -0.3), (0.1, -0.2, 0.4)),
        waypoint(2.5, (1.0, 1.1, -0.8)),
    )


# ---- motions


def test_a_motion_meets_its_waypoints_and_its_rates_are_its_slopes():
    path = swing()
    motion = arms.motion_of(path, 3, 25001)
    for w in path.waypoints:
        i = int(round(w.t / 2.5 * 25000))
        assert motion.t[i] == pytest.approx(w.t, abs=1e-9)
        for values, told in ((motion.q, w.q), (motion.v, w.qd), (motion.a, w.qdd)):
            assert values[i] == pytest.approx(told, abs=1e-7)
    assert max(np.abs(np.diff(values, axis=0)).max() for values in (motion.q, motion.v, motion.a)) < 1e-3  # no jumps
    h = motion.t[1] - motion.t[0]
    for values, slopes in ((motion.q, motion.v), (motion.v, motion.a), (motion.a, motion.j)):
        middle = (values[2:] - values[:-2]) / (2.0 * h)
        off = np.abs(middle - slopes[1:-1]).max(axis=1)
        off[14998:15001] = 0.0  # the jerk jumps at the via-point
        assert off.max() < 1e-5


def test_places_are_a_chain_of_links(data):
    one = arms.arm_of(scenario_of(data).vehicle)
    base = arms.base_of(one, POSE)
    assert base == pytest.approx((5.0 + 0.5 * np.cos(0.3), 5.0 + 0.5 * np.sin(0.3), 0.3))
    points = arms.places(one, base, np.array([[0.0, 0.0, 0.0], [np.pi / 2 - 0.3, -np.pi / 2, np.pi]]))
    assert np.linalg.norm(points[0, 3] - points[0, 0]) == pytest.approx(one.length.sum())
    assert points[1, 1] - points[1, 0] == pytest.approx([0.0, one.length[0]], abs=1e-12)
    assert points[1, 2] - points[1, 1] == pytest.approx([one.length[1], 0.0], abs=1e-12)
    assert points[1, 3] - points[1, 2] == pytest.approx([-one.length[2], 0.0], abs=1e-12)


def kinetic(one, base, motion):
    """J, of rods by the speeds of their middles and their turning, places differenced over a time step."""
    h = motion.t[1] - motion.t[0]
    points = arms.places(one, base, motion.q)
    middles = 0.5 * (points[:, 1:] + points[:, :-1])
    speeds = (middles[2:] - middles[:-2]) / (2.0 * h)
    turns = np.cumsum(motion.v, axis=1)[1:-1]
    inertia = one.mass * (one.length**2 / 12.0 + one.radius**2 / 4.0)
    return (0.5 * one.mass * (speeds**2).sum(axis=2) + 0.5 * inertia * turns**2).sum(axis=1)


def test_torques_do_the_work_that_the_links_get(data):
    one = arms.arm_of(scenario_of(data).vehicle)
    base = arms.base_of(one, POSE)
    motion = arms.motion_of(swing(), 3, 20001)
    power = (arms.torques(one, base[2], motion) * motion.v).sum(axis=1)
    energy = kinetic(one, base, motion)
    h = motion.t[1] - motion.t[0]
    assert energy.max() > 0.1
    off = np.abs((energy[2:] - energy[:-2]) / (2.0 * h) - power[2:-2])
    off[11994:12003] = 0.0  # the jerk jumps at the via-point
    assert off.max() < 1e-4


def test_each_limit_is_weighed_by_itself(data):
    one = arms.arm_of(scenario_of(data).vehicle)
    motion = arms.motion_of(swing(), 3, 2001)
    torque = arms.torques(one, 0.0, motion)
    use = arms.worst_use(one, motion, torque)
    rows = (("velocity", motion.v, one.v_max), ("acceleration", motion.a, one.a_max), ("jerk", motion.j, one.j_max))
    for key, values, most in rows:
        assert use[key] == pytest.approx(max(np.abs(values[:, k]).max() / most[k] for k in range(3)))
    one.torque_max = np.abs(torque).max(axis=0) * [2.0, 4.0, 8.0]
    assert arms.worst_use(one, motion, torque)["torque"] == pytest.approx(0.5)
    one.high[1] = 1.0  # the second joint ends at 1.1
    assert arms.worst_use(one, motion, torque)["joints"] == pytest.approx(0.1, abs=0.02)


@pytest.mark.parametrize("tight", ["v_max", "a_max", "j_max", "torque_max"])
def test_the_least_duration_scales_a_motion_to_its_tightest_limit(data, tight):
    one = arms.arm_of(scenario_of(data).vehicle)
    setattr(one, tight, 0.01 * getattr(one, tight))
    path = path_of(waypoint(0.0, (0.0, 0.0, 0.0)), waypoint(4.0, (1.0, 0.5, 0.2)))
    least = arms.least_duration(one, 0.0, path, 10001)
    path.waypoints[1].t = least
    motion = arms.motion_of(path, 3, 10001)
    use = arms.worst_use(one, motion, arms.torques(one, 0.0, motion))
    assert max(use[k] for k in ("velocity", "acceleration", "jerk", "torque")) == pytest.approx(1.0, abs=1e-6)


def test_an_arm_without_links_is_none():
    with pytest.raises(UserError, match="the vehicle has no arm"):
        arms.arm_of(vehicle_t())


# ---- the picture


def test_curves_are_the_motion_and_dashes_its_limits(data):
    one = arms.arm_of(scenario_of(data).vehicle)
    path = swing()
    figure, axes = plt.subplots(1, 5)
    arm.draw_curves(axes, one, 0.3, path)
    motion = arms.motion_of(path, 3, arm.CURVE_SAMPLES)
    rows = (
        ("joint angle", motion.q, one.low, one.high),
        ("velocity", motion.v, -one.v_max, one.v_max),
        ("acceleration", motion.a, -one.a_max, one.a_max),
        ("jerk", motion.j, -one.j_max, one.j_max),
        ("torque", arms.torques(one, 0.3, motion), -one.torque_max, one.torque_max),
    )
    for ax, (title, values, least, most) in zip(axes, rows):
        assert ax.get_title().startswith(title) and ax.get_xlabel() == "s"
        solid = [line for line in ax.lines if line.get_linestyle() == "-"]
        dashed = [line for line in ax.lines if line.get_linestyle() == "--"]
        assert len(solid) == 3 and len(dashed) == 6
        for k, line in enumerate(solid):
            assert line.get_xdata() == pytest.approx(motion.t)
            assert line.get_ydata() == pytest.approx(values[:, k])
            mine = [d.get_ydata()[0] for d in dashed if d.get_color() == line.get_color()]
            assert sorted(mine) == pytest.approx([least[k], most[k]])
    plt.close(figure)


def test_the_strip_shows_the_arm_from_start_to_end(data):
    scenario = scenario_of(data)
    one = arms.arm_of(scenario.vehicle)
    path = swing()
    figure, ax = plt.subplots()
    arm.draw_strip(ax, scenario, scenario.vehicle, one, POSE, path)
    base = arms.base_of(one, POSE)
    *poses, tip = ax.lines
    assert len(poses) == arm.POSES_DRAWN
    for line, w in ((poses[0], path.waypoints[0]), (poses[-1], path.waypoints[-1])):
        assert np.array(line.get_data()).T == pytest.approx(arms.places(one, base, np.array([w.q]))[0], abs=1e-6)
    assert np.array(tip.get_data()).T[-1] == pytest.approx(np.array(poses[-1].get_data()).T[-1])
    assert len(ax.patches) == len(scenario.world.polygons) + 1  # and the body
    for x, y in np.array(tip.get_data()).T:
        assert ax.get_xlim()[0] < x < ax.get_xlim()[1] and ax.get_ylim()[0] < y < ax.get_ylim()[1]
    plt.close(figure)


def test_the_picture_is_written(tmp_path, data):
    scenario = scenario_of(data)
    arm.draw(tmp_path / "a.png", scenario, scenario.vehicle, POSE, swing())
    assert (tmp_path / "a.png").stat().st_size > 20_000


# ---- the command


def test_a_log_holds_vehicle_pose_and_goal(tmp_path, data):
    log, scenario = tmp_path / "a.log", scenario_of(data)
    words = ["arm", "--scenario", str(data / "arms" / "arm_2_post.json"), "--planner", "pso", "--seed", "7"]
    assert cli.main([*words, "--log", str(log)]) == 0
    assert cli.main(["arm", "--joints", "0.1,0.2", "--from", "-1,0.5", "--log", str(log)]) == 0
    events = [(channel, data) for _, channel, data in read_events(log)]
    assert [channel for channel, _ in events] == ["AISLE_VEHICLE", "AISLE_POSE", "AISLE_ARM_GOAL", "AISLE_ARM_GOAL"]
    assert vehicle_t.decode(events[0][1]).num_links == 3
    pose, goal, joints = pose_t.decode(events[1][1]), arm_goal_t.decode(events[2][1]), arm_goal_t.decode(events[3][1])
    assert (pose.x, pose.y, pose.theta) == tuple(scenario.pose)
    assert goal.kind == scenario.kind and goal.q_start == pytest.approx(scenario.start)
    assert (goal.options.planner, goal.options.seed) == (1, 7)
    assert joints.kind == arm_goal_t.JOINTS
    assert joints.q == pytest.approx([0.1, 0.2, 0.0]) and joints.q_start == pytest.approx([-1.0, 0.5, 0.0])


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ([], "where to? give --point, --at, --joints, --stow or --scenario FILE"),
        (["--stow", "--point", "1,2"], "one of --point, --at, --joints, --stow"),
        (["--point", "1,2,3"], "--point '1,2,3' is not 2 numbers"),
        (["--at", "1,2"], "--at '1,2' is not 3 numbers"),
        (["--joints", "1,nan"], "--joints '1,nan' is not 1 to 3 numbers"),
        (["--stow", "--from", "up"], "--from 'up' is not 1 to 3 numbers"),
        (["--stow", "--pose", "1"], "--pose"),
        (["--stow", "--lcm-url", "memq://", "--prefix", "A7", "--timeout", "0.2"], "running on memq:// with prefix A7?"),
    ],
)
def test_what_is_asked_wrongly_is_told(capsys, words, told):
    assert cli.main(["arm", *words]) == 2
    assert told in capsys.readouterr().err


@pytest.mark.parametrize(("text", "told"), [(None, "No such file"), ("{", "not a scenario"), ("{}", "KeyError(")])
def test_a_file_that_is_no_scenario_is_told(tmp_path, capsys, text, told):
    file = tmp_path / "s.json"
    if text is not None:
        file.write_text(text)
    assert cli.main(["arm", "--scenario", str(file)]) == 2
    err = capsys.readouterr().err
    assert told in err and "s.json" in err


def test_a_goal_of_no_kind_is_told(tmp_path, data, capsys):
    scenario = json.loads((data / "arms" / "arm_2_post.json").read_text())
    scenario["goal"]["kind"] = "nowhere"
    (tmp_path / "s.json").write_text(json.dumps(scenario))
    assert cli.main(["arm", "--scenario", str(tmp_path / "s.json")]) == 2
    assert "not a scenario of an arm" in capsys.readouterr().err


def test_reasons_name_what_is_in_the_way():
    path = arm_path_t()
    for cause, ident, told in (
        (status_t.GOAL_OCCUPIED, -3, "GOAL_OCCUPIED, the vehicle's own body"),
        (status_t.START_OCCUPIED, 12, "START_OCCUPIED, 12"),
        (status_t.OUT_OF_REACH, 0, "OUT_OF_REACH"),
    ):
        path.cause, path.cause_id = cause, ident
        assert arms.reason(path) == told
