"""The arm through the daemon: goals in, proved motions or reasons out, judged by the bench's own geometry; the record replays."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from aisle import arm_goal_t, arm_path_t, options_t, path_t, status_t
from aisle_tools import arms
from aisle_tools.goals import make_pose
from harness import AISLE_REPLAY

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools" / "bench"))
from arm_table import CONTACT_SAMPLES, LIMIT_SLACK, Judge  # noqa: E402, F401

SCENARIOS = ["arm_1_open", "arm_2_post", "arm_4_complex", "arm_6_slot"]


class Arm:
    """Asks a daemon for motions."""

    def __init__(self, daemon) -> None:  # noqa: ANN001
        self.daemon, self.answers, self.ident = daemon, [], 0
        daemon.bus.subscribe("ARM_PATH", arm_path_t, self.answers.append)

    def ask(self, scenario, pose=None, **changes):  # noqa: ANN001, ANN003, ANN201
        self.ident += 1
        goal = arms.make_goal(self.ident, scenario.start, scenario.kind, scenario.at, options_t())
        for key, value in changes.items():
            setattr(goal, key, value)
        if pose is None:
            pose = make_pose(scenario.pose, self.ident, 1)
        if pose is not False:
            self.daemon.bus.publish("POSE", pose)
        self.daemon.bus.publish("ARM_GOAL", goal)
        assert self.daemon.wait(lambda: any(a.arm_goal_id == self.ident for a in self.answers))
        return self.answers[-1]

    def set_up(self, scenario):  # noqa: ANN001, ANN201
        for channel, msg in arms.setup_messages(scenario):
            self.daemon.bus.publish(channel, msg)
        assert self.daemon.wait(lambda: self.daemon.status.map_revision == 1 and self.daemon.status.vehicle_revision == 1)


@pytest.mark.parametrize("name", SCENARIOS)
def test_a_motion_keeps_every_limit_and_touches_nothing(daemon, data, name):
    scenario = arms.read_scenario(data / "arms" / f"{name}.json")
    arm, judge = Arm(daemon), Judge(scenario)
    arm.set_up(scenario)
    motion = arm.ask(scenario)
    assert motion.status == path_t.OK, arms.reason(motion)
    use = judge.use(motion)
    assert all(use[k] <= 1.0 + LIMIT_SLACK for k in ("velocity", "acceleration", "jerk", "torque")) and use["joints"] <= 1e-6
    assert judge.clearance(motion) > 0.0
    assert motion.waypoints[0].q[0] == pytest.approx(scenario.start[0], abs=1e-6)


def test_refusals_tell_the_reason(daemon, data):
    scenario = arms.read_scenario(data / "arms" / "arm_3_box.json")
    arm = Arm(daemon)
    assert arm.ask(scenario, pose=False).cause == status_t.NO_LAYOUT
    arm.set_up(scenario)
    assert arm.ask(scenario, pose=False).cause == status_t.NO_POSE
    moving = make_pose(scenario.pose, 50, 1)
    moving.vx = 0.2
    assert arm.ask(scenario, pose=moving).cause == status_t.VEHICLE_MOVES
    far = arm.ask(scenario, kind=arm_goal_t.POINT, x=8.0, y=5.0)
    assert (far.status, far.cause) == (path_t.NONE, status_t.OUT_OF_REACH)
    inside = arm.ask(scenario, kind=arm_goal_t.POINT, x=6.4, y=5.0)
    assert (inside.cause, inside.cause_id) == (status_t.GOAL_OCCUPIED, 1)
    start = arm.ask(scenario, q_start=[0.0, 0.0, 0.0])
    assert (start.cause, start.cause_id) == (status_t.START_OCCUPIED, 1)
    limit = arm.ask(scenario, kind=arm_goal_t.JOINTS, q=[0.0, 3.0, 0.0])
    assert (limit.cause, limit.cause_id) == (status_t.JOINT_LIMIT, 2)
    body = arm.ask(scenario, kind=arm_goal_t.JOINTS, q=[1.0, 2.8, 0.0])
    assert (body.cause, body.cause_id) == (status_t.GOAL_OCCUPIED, -3)
    assert arm.ask(scenario).status == path_t.OK


def test_the_tool_asks_and_draws(daemon, data, tmp_path):
    picture, log = tmp_path / "arm.png", tmp_path / "arm.log"
    path = data / "arms" / "arm_4_complex.json"
    out = json.loads(daemon.aisle("arm", "--scenario", path, "--send", "--json", "--plot", picture, "--save", log))
    assert out["status"] == "OK" and out["duration"] > 0.5
    assert picture.stat().st_size > 20_000 and log.stat().st_size > 1_000
    assert "OUT_OF_REACH" in daemon.aisle("arm", "--scenario", path, "--point", "9,9", expect=1)


def test_a_recorded_run_is_made_again_byte_for_byte(make_daemon, data, tmp_path):
    record = tmp_path / "flight.log"
    daemon = make_daemon("--record", str(record))
    scenario = arms.read_scenario(data / "arms" / "arm_2_post.json")
    arm = Arm(daemon)
    arm.set_up(scenario)
    for _ in range(3):
        assert arm.ask(scenario).status == path_t.OK
    assert arm.ask(scenario, kind=arm_goal_t.POINT, x=8.0, y=5.0).cause == status_t.OUT_OF_REACH
    assert daemon.stop() == 0
    done = subprocess.run([AISLE_REPLAY, "--prefix", daemon.prefix, "--check", str(record)], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "equal 4, different 0, missing 0, not recorded 0" in done.stdout
