"""An arm on a vehicle and its motions: limits, curves, torques and places, from the messages alone."""

from __future__ import annotations

import json
import math
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from aisle import arm_goal_t, arm_path_t, options_t, pose_t, vehicle_t

from aisle_tools import layouts, names, vehicle
from aisle_tools.bus import LogWriter, read_events
from aisle_tools.errors import UserError
from aisle_tools.world import Polygon, World, float32

KINDS = ["POINT", "POSE", "JOINTS", "STOW"]
DEFAULTS = {  # what a 0 in vehicle_t means
    "link_length": 0.4,
    "link_radius": 0.04,
    "link_mass": 2.0,
    "joint_v_max": 1.5,
    "joint_a_max": 3.0,
    "joint_j_max": 30.0,
    "joint_torque_max": 100.0,
}
CAUSE_IDS = {-1: "the scanned map", -2: "the bounds", -3: "the vehicle's own body", -4: "the arm's first link"}


@dataclass
class Arm:
    """Defaults filled in; arrays of one number a link."""

    base: tuple[float, float, float]
    length: np.ndarray
    radius: np.ndarray
    mass: np.ndarray
    low: np.ndarray
    high: np.ndarray
    v_max: np.ndarray
    a_max: np.ndarray
    j_max: np.ndarray
    torque_max: np.ndarray
    gravity: float = 0.0

    @property
    def links(self) -> int:
        return len(self.length)


def arm_of(msg: vehicle_t) -> Arm:
    if msg.num_links == 0:
        raise UserError("the vehicle has no arm: link_length is missing")
    values = {k: np.array([float32(v or d) for v in getattr(msg, k)]) for k, d in DEFAULTS.items()}
    usual = [lo == 0.0 and hi == 0.0 for lo, hi in zip(msg.joint_min, msg.joint_max)]
    return Arm(
        tuple(msg.arm_base),
        values["link_length"],
        values["link_radius"],
        values["link_mass"],
        np.array([-math.pi if u else float32(v) for u, v in zip(usual, msg.joint_min)]),
        np.array([math.pi if u else float32(v) for u, v in zip(usual, msg.joint_max)]),
        values["joint_v_max"],
        values["joint_a_max"],
        values["joint_j_max"],
        values["joint_torque_max"],
    )


@dataclass
class Motion:
    """A motion at many times: arrays [times, links]."""

    t: np.ndarray
    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    j: np.ndarray


def quintic(q0, v0, a0, q1, v1, a1):  # noqa: ANN001, ANN201
    """Coefficients [6, ...] in u of the piece with these values, rates and accelerations, times in pieces."""
    d = q1 - q0
    return np.array(
        [
            q0,
            v0,
            0.5 * a0,
            10.0 * d - 6.0 * v0 - 4.0 * v1 - 1.5 * a0 + 0.5 * a1,
            -15.0 * d + 8.0 * v0 + 7.0 * v1 + 1.5 * a0 - a1,
            6.0 * d - 3.0 * (v0 + v1) + 0.5 * (a1 - a0),
        ]
    )


def motion_of(path: arm_path_t, links: int, samples: int) -> Motion:
    """Evenly spread over the whole path, as arm_path_t tells it: a quintic between two waypoints."""
    w = path.waypoints
    times = np.array([p.t for p in w])
    q, v, a = (np.array([getattr(p, k)[:links] for p in w]) for k in ("q", "qd", "qdd"))
    if len(w) == 1:
        still = np.zeros((1, links))
        return Motion(times, q, still, still, still)
    t = np.linspace(0.0, times[-1], samples)
    i = np.clip(np.searchsorted(times, t, side="right") - 1, 0, len(w) - 2)
    dt = (times[i + 1] - times[i])[:, None]
    c = quintic(q[i], v[i] * dt, a[i] * dt**2, q[i + 1], v[i + 1] * dt, a[i + 1] * dt**2)
    u = (t - times[i])[:, None] / dt

    def value(order: int) -> np.ndarray:
        total = np.zeros_like(q[i])
        for n in range(order, 6):
            total += c[n] * math.perm(n, order) * u ** (n - order)
        return total / dt**order

    return Motion(t, *(value(order) for order in range(4)))


def torques(arm: Arm, base_theta: float, motion: Motion) -> np.ndarray:
    """Newton and Euler's recursion for all times at once, [times, links]."""
    n = len(motion.t)
    phi = base_theta + np.cumsum(motion.q, axis=1)
    omega, alpha = np.cumsum(motion.v, axis=1), np.cumsum(motion.a, axis=1)
    joint = np.tile([0.0, arm.gravity], (n, 1))
    axis, pull = [], []
    for i in range(arm.links):
        along = arm.length[i] * np.stack([np.cos(phi[:, i]), np.sin(phi[:, i])], axis=1)
        turned = np.stack([-along[:, 1], along[:, 0]], axis=1)
        end = alpha[:, i : i + 1] * turned - omega[:, i : i + 1] ** 2 * along
        axis.append(along)
        pull.append(arm.mass[i] * (joint + 0.5 * end))
        joint = joint + end
    force, moment, out = np.zeros((n, 2)), np.zeros(n), np.zeros((n, arm.links))
    for i in reversed(range(arm.links)):
        inertia = arm.mass[i] * (arm.length[i] ** 2 / 12.0 + arm.radius[i] ** 2 / 4.0)
        moment = moment + inertia * alpha[:, i] + 0.5 * cross(axis[i], pull[i]) + cross(axis[i], force)
        force = force + pull[i]
        out[:, i] = moment
    return out


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def base_of(arm: Arm, pose: tuple[float, float, float]) -> tuple[float, float, float]:
    c, s = math.cos(pose[2]), math.sin(pose[2])
    return pose[0] + c * arm.base[0] - s * arm.base[1], pose[1] + s * arm.base[0] + c * arm.base[1], pose[2] + arm.base[2]


def places(arm: Arm, base: tuple[float, float, float], q: np.ndarray) -> np.ndarray:
    """Joints and tip, [times, links + 1, 2]."""
    phi = base[2] + np.cumsum(q, axis=1)
    steps = arm.length * np.cos(phi), arm.length * np.sin(phi)
    points = np.zeros((len(q), arm.links + 1, 2))
    for k in range(2):
        points[:, 0, k] = base[k]
        points[:, 1:, k] = base[k] + np.cumsum(steps[k], axis=1)
    return points


def worst_use(arm: Arm, motion: Motion, torque: np.ndarray) -> dict[str, float]:
    """Greatest share of each limit over the motion; joints: how far out of their limits, rad."""
    return {
        "velocity": float(np.max(np.abs(motion.v) / arm.v_max)),
        "acceleration": float(np.max(np.abs(motion.a) / arm.a_max)),
        "jerk": float(np.max(np.abs(motion.j) / arm.j_max)),
        "torque": float(np.max(np.abs(torque) / arm.torque_max)),
        "joints": float(max(np.max(motion.q - arm.high), np.max(arm.low - motion.q))),
    }


def least_duration(arm: Arm, base_theta: float, path: arm_path_t, samples: int) -> float:
    """s, of the same path in the plane of joint angles, without gravity: each stretch from rest to rest by the limit it uses
    most."""
    total, first = 0.0, 0
    for i in range(1, len(path.waypoints)):
        if any(path.waypoints[i].qd) or any(path.waypoints[i].qdd):
            continue
        part = arm_path_t()
        part.waypoints = path.waypoints[first : i + 1]
        begin = part.waypoints[0].t
        motion = shifted(part, begin, arm.links, samples)
        use = worst_use(arm, motion, torques(arm, base_theta, motion))
        share = max(use["velocity"], use["acceleration"] ** 0.5, use["jerk"] ** (1.0 / 3.0), use["torque"] ** 0.5)
        total += (part.waypoints[-1].t - begin) * share
        first = i
    return total


def shifted(path: arm_path_t, begin: float, links: int, samples: int) -> Motion:
    """The motion of these waypoints, the first one at time 0."""
    for w in path.waypoints:
        w.t -= begin
    motion = motion_of(path, links, samples)
    for w in path.waypoints:
        w.t += begin
    return motion


# ---- scenarios


@dataclass
class Scenario:
    name: str
    world: World
    vehicle: vehicle_t
    pose: tuple[float, float, float]
    start: list[float]
    kind: int
    at: list[float]  # x, y[, theta], or joints
    gravity: float  # m/s2 along -y; only benches look at it


def read_scenario(path: Path) -> Scenario:
    """JSON: bounds, obstacles (convex polygons), vehicle (keys of vehicle_t), pose, start (joints), and goal: kind and at."""
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
        polygons = [Polygon(i + 1, np.array(p, dtype=float)) for i, p in enumerate(data["obstacles"])]
        world = World(path.stem, tuple(data["bounds"]), polygons, None, 0.0)
        kind = KINDS.index(data["goal"]["kind"].upper())
        return Scenario(
            data["name"],
            world,
            vehicle.make(data["vehicle"], str(path)),
            tuple(data["pose"]),
            list(data["start"]),
            kind,
            list(data["goal"].get("at", [])),
            float(data.get("gravity", 0.0)),
        )
    except OSError as e:
        raise UserError(f"{path}: {e.strerror}") from None
    except (json.JSONDecodeError, KeyError, TypeError, ValueError) as e:
        raise UserError(f"{path}: not a scenario of an arm: {e!r}") from None


def make_goal(ident: int, start: list[float], kind: int, at: list[float], options: options_t) -> arm_goal_t:
    msg = arm_goal_t()
    msg.arm_goal_id, msg.kind, msg.options = ident, kind, options
    msg.q_start = (list(start) + [0.0] * 3)[:3]
    if kind == arm_goal_t.JOINTS:
        msg.q = (list(at) + [0.0] * 3)[:3]
    elif kind != arm_goal_t.STOW:
        msg.x, msg.y = at[0], at[1]
        msg.theta = at[2] if kind == arm_goal_t.POSE else 0.0
    return msg


def make_pose(pose: tuple[float, float, float], seq: int, map_id: int) -> pose_t:
    from aisle_tools.goals import make_pose as make

    return make(pose, seq, map_id)


def setup_messages(scenario: Scenario, map_id: int = 1) -> list[tuple[str, object]]:
    """Layout and vehicle, in the order to send them."""
    scenario.vehicle.vehicle_revision = max(scenario.vehicle.vehicle_revision, 1)
    return [*layouts.make_messages(scenario.world, map_id, 1, 1), ("VEHICLE", scenario.vehicle)]


def plan_all(program: Path, scenario: Scenario, options: list[options_t]) -> tuple[dict[int, arm_path_t], list[float]]:
    """The scenario's goal asked once for each of the options, by bench-arm: answers by goal id, 1 for the first; processor ms."""
    with tempfile.TemporaryDirectory() as folder:
        log, out = Path(folder) / "in.log", Path(folder) / "out.log"
        writer = LogWriter(log, "AISLE")
        for channel, msg in setup_messages(scenario):
            writer.publish(channel, msg)
        writer.publish("POSE", make_pose(scenario.pose, 1, 1))
        for i, option in enumerate(options):
            writer.publish("ARM_GOAL", make_goal(i + 1, scenario.start, scenario.kind, scenario.at, option))
        writer.close()
        done = subprocess.run([str(program), str(log), str(out)], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise UserError(f"{program}: exit {done.returncode}: {done.stderr}")
        answers = [arm_path_t.decode(data) for _, channel, data in read_events(out) if channel == "AISLE_ARM_PATH"]
    return {a.arm_goal_id: a for a in answers}, [float(line.split()[1]) for line in done.stdout.splitlines()]


def reason(path: arm_path_t) -> str:
    text = names.cause_name(path.cause)
    if path.cause_id in CAUSE_IDS:
        return f"{text}, {CAUSE_IDS[path.cause_id]}"
    return f"{text}, {path.cause_id}" if path.cause_id else text
