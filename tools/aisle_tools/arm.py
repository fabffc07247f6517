"""aisle arm: asks for a motion of the arm, prints it, draws it."""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path

import numpy as np
from aisle import arm_goal_t, arm_path_t, path_t, vehicle_t

from aisle_tools import arms, names, query, vehicle
from aisle_tools.bus import Bus, LogWriter, StatusWatch, now_us, time_revision
from aisle_tools.errors import UserError
from aisle_tools.goals import make_pose

PASSES = 3  # a goal is asked so often within the time limit
CURVE_SAMPLES = 2000
POSES_DRAWN = 12


def configure(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("where to")
    group.add_argument("--point", metavar="X,Y", help="the tip, in any direction")
    group.add_argument("--at", metavar="X,Y,TH", help="the tip, pointing to TH")
    group.add_argument("--joints", metavar="Q,Q,Q", help="each joint, rad")
    group.add_argument("--stow", action="store_true", help="every joint to 0")
    group.add_argument("--from", dest="start", metavar="Q,Q,Q", help="where the joints are, rad; default 0,0,0")
    group.add_argument("--pose", metavar="X,Y,TH", help="publish this pose of the vehicle first")
    group.add_argument("--scenario", type=Path, metavar="FILE", help="vehicle, pose, start and goal of an arm's scenario")
    query.add_plan_options(parser)
    vehicle.add_options(parser)
    parser.add_argument("--send", action="store_true", help="with --scenario: send its layout and vehicle first")
    parser.add_argument("--json", action="store_true", help="a JSON object instead of the line")
    parser.add_argument("--save", type=Path, metavar="FILE", help="LCM log of vehicle, pose, goal and motion")
    parser.add_argument("--plot", type=Path, metavar="FILE", help="strip of poses, joint angles and what limits them")


def numbers(text: str, option: str, least: int, most: int) -> list[float]:
    try:
        values = [float(v) for v in text.split(",")]
    except ValueError:
        values = []
    if not least <= len(values) <= most or not all(np.isfinite(values)):
        raise UserError(f"{option} '{text}' is not {least if least == most else f'{least} to {most}'} numbers")
    return values


def goal_of(args: argparse.Namespace, scenario: arms.Scenario | None) -> tuple[int, list[float], list[float]]:
    """Kind, where to, where the joints are."""
    start = numbers(args.start, "--from", 1, 3) if args.start else (scenario.start if scenario else [0.0] * 3)
    given = [args.point, args.at, args.joints, args.stow or None]
    if sum(g is not None for g in given) > 1:
        raise UserError("one of --point, --at, --joints, --stow")
    if args.point:
        return arm_goal_t.POINT, numbers(args.point, "--point", 2, 2), start
    if args.at:
        return arm_goal_t.POSE, numbers(args.at, "--at", 3, 3), start
    if args.joints:
        return arm_goal_t.JOINTS, numbers(args.joints, "--joints", 1, 3), start
    if args.stow:
        return arm_goal_t.STOW, [], start
    if scenario is None:
        raise UserError("where to? give --point, --at, --joints, --stow or --scenario FILE")
    return scenario.kind, scenario.at, start


def run(args: argparse.Namespace) -> int:
    scenario = arms.read_scenario(args.scenario) if args.scenario else None
    msg = scenario.vehicle if scenario and args.vehicle is None else vehicle.from_options(args)
    pose = query.parse_pose(args.pose, "--pose") if args.pose else (scenario.pose if scenario else None)
    kind, at, start = goal_of(args, scenario)
    ident = (time.time_ns() // 1_000_000) % 1_000_000_000 + 1
    goal = arms.make_goal(ident, start, kind, at, query.make_options(args))
    goal.utime = now_us()
    if args.log is not None:
        return write_log(args, msg, pose, goal)
    path, seconds = Asker(args, scenario).ask(goal, pose)
    show(args, path, seconds)
    if args.save is not None:
        save(args, msg, pose, goal, path)
    if args.plot is not None and path.status == path_t.OK:
        draw(args.plot, scenario, msg or vehicle_t(), pose or (0.0, 0.0, 0.0), path)
    return 0 if path.status == path_t.OK else 1


def write_log(args: argparse.Namespace, msg: vehicle_t | None, pose: tuple | None, goal: arm_goal_t) -> int:
    log = LogWriter(args.log, args.prefix)
    if msg is not None:
        log.publish("VEHICLE", msg)
    if pose is not None:
        log.publish("POSE", make_pose(pose, 1, 1))
    log.publish("ARM_GOAL", goal)
    log.close()
    return 0


class Asker:
    """Sends a pose and a goal and waits for the motion."""

    def __init__(self, args: argparse.Namespace, scenario: arms.Scenario | None) -> None:
        self.args = args
        self.bus = Bus(args.lcm_url, args.prefix)
        self.status = StatusWatch(self.bus)
        self.map_id = self.status.wait(args.timeout).map_id
        self.answers: dict[int, arm_path_t] = {}
        self.bus.subscribe("ARM_PATH", arm_path_t, self._take)
        if args.send and scenario is not None:
            self._send(scenario)

    def _take(self, msg: arm_path_t) -> None:
        self.answers[msg.arm_goal_id] = msg

    def _send(self, scenario: arms.Scenario) -> None:
        """Layout and vehicle with revisions of their own, until both are in force."""
        revision = time_revision()
        for channel, msg in arms.setup_messages(scenario):
            if channel == "LAYOUT":
                msg.map_revision = revision
            else:
                msg.vehicle_revision = revision
            self.bus.publish(channel, msg)
        self.map_id = 1

        def is_held() -> bool:
            held = self.status.last
            return held is not None and (held.map_revision, held.vehicle_revision) == (revision, revision)

        if not self.bus.spin(self.args.timeout, is_held):
            raise UserError("layout and vehicle are not taken: see 'aisle watch'")

    def ask(self, goal: arm_goal_t, pose: tuple | None) -> tuple[arm_path_t, float]:
        begin = time.monotonic()
        for seq in range(PASSES):
            if pose is not None:
                self.bus.publish("POSE", make_pose(pose, seq + 1, self.map_id))
            self.bus.publish("ARM_GOAL", goal)
            if self.bus.spin(self.args.timeout / PASSES, lambda: goal.arm_goal_id in self.answers):
                return self.answers.pop(goal.arm_goal_id), time.monotonic() - begin
        raise self.bus.no_answer(self.args.timeout)


def show(args: argparse.Namespace, path: arm_path_t, seconds: float) -> None:
    if args.json:
        print(
            json.dumps(
                {
                    "status": names.result_name(path.status),
                    "cause": names.cause_name(path.cause) if path.cause else None,
                    "cause_id": path.cause_id,
                    "planner": names.PLANNERS[path.planner],
                    "duration": path.duration,
                    "travel": path.travel,
                    "clearance": path.clearance_min,
                    "work_units": path.work_units,
                    "waypoints": path.num_waypoints,
                    "ms": 1000.0 * seconds,
                }
            )
        )
    elif path.status == path_t.OK:
        print(
            f"{names.PLANNERS[path.planner]}: {path.duration:.3f} s, {path.travel:.3f} rad, clearance "
            f"{path.clearance_min:.4f} m, {path.num_waypoints} waypoints, {path.work_units} units, {1000.0 * seconds:.1f} ms"
        )
    else:
        hint = names.HINTS.get(path.cause)
        print(f"{names.result_name(path.status)}: {arms.reason(path)}" + (f" ({hint})" if hint else ""))


def save(args: argparse.Namespace, msg: vehicle_t | None, pose: tuple | None, goal: arm_goal_t, path: arm_path_t) -> None:
    args.save.unlink(missing_ok=True)
    log = LogWriter(args.save, args.prefix)
    if msg is not None:
        log.publish("VEHICLE", msg)
    if pose is not None:
        log.publish("POSE", make_pose(pose, 1, path.map_id))
    log.publish("ARM_GOAL", goal)
    log.publish("ARM_PATH", path)
    log.close()


def draw(out: Path, scenario: arms.Scenario | None, msg: vehicle_t, pose: tuple, path: arm_path_t) -> None:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    arm = arms.arm_of(msg)
    figure, axes = plt.subplots(2, 3, figsize=(15, 8.5), layout="constrained")
    draw_strip(axes[0, 0], scenario, msg, arm, pose, path)
    draw_curves(axes.ravel()[1:], arm, arms.base_of(arm, pose)[2], path)
    figure.savefig(out, dpi=110)
    plt.close(figure)


def draw_strip(axes, scenario, msg, arm, pose, path) -> None:  # noqa: ANN001
    """The arm at even times over the obstacles and the vehicle's body."""
    from matplotlib.patches import Circle
    from matplotlib.patches import Polygon as Patch

    base = arms.base_of(arm, pose)
    motion = arms.motion_of(path, arm.links, POSES_DRAWN)
    tips = arms.places(arm, base, arms.motion_of(path, arm.links, CURVE_SAMPLES).q)[:, -1]
    for polygon in scenario.world.polygons if scenario else []:
        axes.add_patch(Patch(polygon.vertices, color="#4a4a4a"))
    body = vehicle.body(msg)
    c, s = np.cos(pose[2]), np.sin(pose[2])
    if body.is_disc:
        axes.add_patch(Circle(pose[:2], body.radius, color="#bcd8f0"))
    else:
        axes.add_patch(Patch(body.vertices @ np.array([[c, s], [-s, c]]) + np.array(pose[:2]), color="#bcd8f0"))
    for i, points in enumerate(arms.places(arm, base, motion.q)):
        shade = i / max(len(motion.t) - 1, 1)
        colour = (0.12 + 0.7 * shade, 0.45 - 0.25 * shade, 0.75 - 0.55 * shade)
        axes.plot(points[:, 0], points[:, 1], color=colour, linewidth=2.5, marker="o", markersize=3, alpha=0.8)
    axes.plot(tips[:, 0], tips[:, 1], color="#2ca02c", linewidth=1.0)
    reach = float(arm.length.sum()) * 1.15
    axes.set(xlim=(base[0] - reach, base[0] + reach), ylim=(base[1] - reach, base[1] + reach), aspect="equal", title="motion")


def draw_curves(axes, arm, base_theta, path) -> None:  # noqa: ANN001
    motion = arms.motion_of(path, arm.links, CURVE_SAMPLES)
    rows = [
        ("joint angle, rad", motion.q, arm.low, arm.high),
        ("velocity, rad/s", motion.v, -arm.v_max, arm.v_max),
        ("acceleration, rad/s2", motion.a, -arm.a_max, arm.a_max),
        ("jerk, rad/s3", motion.j, -arm.j_max, arm.j_max),
        ("torque, N m", arms.torques(arm, base_theta, motion), -arm.torque_max, arm.torque_max),
    ]
    for ax, (title, values, least, most) in zip(axes, rows):
        for k in range(arm.links):
            (line,) = ax.plot(motion.t, values[:, k], label=f"joint {k + 1}")
            for limit in (least[k], most[k]):
                ax.axhline(limit, color=line.get_color(), linewidth=0.7, linestyle="--")
        ax.set(title=title, xlabel="s")
    axes[0].legend()
