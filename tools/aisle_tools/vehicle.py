"""vehicle_t from a file, from options, and with its defaults filled in."""

from __future__ import annotations

import argparse
import difflib
import json
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import yaml
from aisle import vehicle_t

from aisle_tools.errors import UserError
from aisle_tools.names import DRIVES, option_value
from aisle_tools.world import float32

# What a 0 in vehicle_t means.
DEFAULTS = {
    "v_max": 1.5,
    "v_reverse_max": 0.3,
    "a_max": 0.5,
    "d_max": 0.5,
    "omega_max": 1.0,
    "alpha_max": 1.0,
    "lateral_a_max": 0.5,
    "reaction_time": 0.3,
    "margin": 0.10,
    "creep_clearance": 0.5,
    "creep_speed": 0.3,
    "pose_timeout": 0.2,
    "obstacles_timeout": 0.3,
    "mass": 500.0,
    "rolling_resistance": 0.015,
    "idle_power": 50.0,
    "drive_efficiency": 0.8,
}
DEFAULT_FOOTPRINT = ((-0.5, -0.35), (0.5, -0.35), (0.5, 0.35), (-0.5, 0.35))
NUMBERS = (*DEFAULTS, "footprint_radius", "curvature_max")
ARM_LISTS = (  # one number a link
    *("link_length", "link_radius", "link_mass", "joint_min", "joint_max"),
    *("joint_v_max", "joint_a_max", "joint_j_max", "joint_torque_max"),
)
KEYS = (*NUMBERS, "drive", "footprint", "vehicle_revision", "arm_base", *ARM_LISTS)
ALIASES = {"radius": "footprint_radius"}


@dataclass
class Body:
    """The footprint and limits that hold, defaults filled in."""

    vertices: np.ndarray  # [n, 2] m, vehicle frame; [0, 2] for a disc
    radius: float  # of the disc, or rounding the footprint
    margin: float  # >= 0
    drive: int
    curvature_max: float  # 0 = turns on the spot
    limits: dict[str, float]

    @property
    def is_disc(self) -> bool:
        return len(self.vertices) == 0

    @property
    def outer_radius(self) -> float:
        """m, of the least disc about the origin around the footprint."""
        return self.radius + max((math.hypot(x, y) for x, y in self.vertices), default=0.0)


def body(msg: vehicle_t) -> Body:
    # Defaults pass through float32 as they do on the wire.
    limits = {k: float32(getattr(msg, k) or v) for k, v in DEFAULTS.items()}
    vertices = np.array(msg.footprint, dtype=float).reshape(-1, 2)
    if msg.num_vertices == 0 and msg.footprint_radius == 0.0:
        vertices = np.array(DEFAULT_FOOTPRINT)
    margin = limits.pop("margin")
    limits["creep_speed"] = min(limits["creep_speed"], limits["v_max"])
    return Body(vertices, msg.footprint_radius, max(margin, 0.0), msg.drive, msg.curvature_max, limits)


def make(values: dict, where: str = "vehicle") -> vehicle_t:
    """From keys named as in vehicle_t ('radius' for footprint_radius)."""
    msg = vehicle_t()
    for raw, value in values.items():
        key = ALIASES.get(raw, raw)
        if key not in KEYS:
            near = difflib.get_close_matches(str(raw), [*KEYS, *ALIASES], 1)
            hint = f", is '{near[0]}' meant?" if near else f"; known: {', '.join(KEYS)}"
            raise UserError(f"{where}: unknown key '{raw}'{hint}")
        if key == "drive":
            msg.drive = option_value(str(value), DRIVES)
        elif key == "footprint":
            msg.footprint = check_footprint(value, where)
            msg.num_vertices = len(msg.footprint)
        elif key == "arm_base" or key in ARM_LISTS:
            setattr(msg, key, _arm_list(where, key, value))
        else:
            setattr(msg, key, _number(where, raw, value))
    msg.vehicle_revision = int(msg.vehicle_revision)
    _fill_arm(msg, where)
    return msg


def _arm_list(where: str, key: str, value: object) -> list[float]:
    most = 3 if key == "arm_base" else vehicle_t.MAX_LINKS
    ok = isinstance(value, list) and 1 <= len(value) <= most and (key != "arm_base" or len(value) == most)
    if not ok or not all(isinstance(v, (int, float)) and not isinstance(v, bool) and math.isfinite(v) for v in value):
        raise UserError(f"{where}: {key} must be {'3' if key == 'arm_base' else '1 to 3'} numbers, not {value}")
    return [float(v) for v in value]


def _fill_arm(msg: vehicle_t, where: str) -> None:
    """As many links as link_length has; what is not given is 0, the default."""
    msg.num_links = len(msg.link_length)
    for key in ARM_LISTS:
        given = getattr(msg, key)
        if len(given) not in (0, msg.num_links):
            raise UserError(f"{where}: {key} has {len(given)} numbers, link_length {msg.num_links}")
        setattr(msg, key, list(given) or [0.0] * msg.num_links)


def _number(where: str, key: str, value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise UserError(f"{where}: {key} must be a number, not '{value}'")
    if value < 0 and key != "margin":
        raise UserError(f"{where}: {key} must not be negative: {value:g}")
    return float(value)


def check_footprint(value: object, where: str) -> list[tuple[float, float]]:
    try:
        points = [(float(x), float(y)) for x, y in value]  # type: ignore[union-attr]
    except (TypeError, ValueError):
        raise UserError(f"{where}: footprint must be a list of [x, y] points") from None
    if not 3 <= len(points) <= vehicle_t.MAX_VERTICES:
        raise UserError(f"{where}: footprint must have 3 to {vehicle_t.MAX_VERTICES} points, not {len(points)}")
    n = len(points)
    for i in range(n):
        (ax, ay), (bx, by), (cx, cy) = points[i], points[(i + 1) % n], points[(i + 2) % n]
        if (bx - ax) * (cy - by) - (by - ay) * (cx - bx) <= 0.0:
            raise UserError(f"{where}: footprint must be convex and counter-clockwise (point {(i + 1) % n} is not)")
    return points


def parse_footprint(text: str) -> list[tuple[float, float]]:
    """'1.0x0.7' (length x width about the origin) or 'x,y x,y x,y ...'."""
    try:
        if "," not in text:
            length, width = (float(v) for v in text.lower().split("x"))
            a, b = length / 2.0, width / 2.0
            return [(-a, -b), (a, -b), (a, b), (-a, b)]
        return [(float(x), float(y)) for x, y in (p.split(",") for p in text.split())]
    except ValueError:
        raise UserError(f"footprint '{text}' is neither LENGTHxWIDTH nor 'x,y x,y x,y ...'") from None


def read_file(path: Path) -> vehicle_t:
    try:
        text = path.read_text(encoding="utf-8")
        data = json.loads(text) if path.suffix == ".json" else yaml.safe_load(text)
    except OSError as e:
        raise UserError(f"{path}: {e.strerror}") from None
    except (json.JSONDecodeError, yaml.YAMLError) as e:
        raise UserError(f"{path}: cannot be read: {' '.join(str(e).split())}") from None
    if not isinstance(data, dict):
        raise UserError(f"{path}: must hold keys of vehicle_t such as footprint, margin, v_max")
    return make(data, str(path))


def add_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("vehicle")
    group.add_argument("--vehicle", type=Path, metavar="FILE", help="YAML or JSON with keys named as in vehicle_t")
    group.add_argument("--radius", type=float, metavar="M", help="disc of this radius")
    group.add_argument("--footprint", metavar="LxW", help="1.0x0.7, or convex 'x,y x,y x,y ...' counter-clockwise, m")
    group.add_argument("--margin", type=float, metavar="M", help="kept around the footprint; negative = none")


def add_limit_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("limits (0 or absent: the default)")
    group.add_argument("--drive", choices=[d.lower() for d in DRIVES])
    for key in NUMBERS:
        if key not in ("margin", "footprint_radius"):
            group.add_argument("--" + key.replace("_", "-"), type=float, metavar="X", help=argparse.SUPPRESS)
    group.description = "--" + " --".join(k.replace("_", "-") for k in NUMBERS if k not in ("margin", "footprint_radius"))


def from_options(args: argparse.Namespace, scenario: object = None) -> vehicle_t | None:
    """The file's vehicle (or the scenario's), overridden by options; None if neither is given."""
    given = {k: getattr(args, k) for k in (*NUMBERS, "drive") if getattr(args, k, None) is not None}
    msg = read_file(args.vehicle) if args.vehicle is not None else None
    if msg is None and scenario is not None:
        msg = _of_scenario(scenario)
    if msg is None and not given and args.radius is None and args.footprint is None:
        return None
    extra = make(given, "options")
    msg = msg or vehicle_t()
    for key in given:
        setattr(msg, key, getattr(extra, key))
    if args.radius is not None:
        if args.radius <= 0.0:
            raise UserError(f"--radius must be above 0, not {args.radius:g}")
        msg.footprint, msg.num_vertices, msg.footprint_radius = [], 0, args.radius
    if args.footprint is not None:
        msg.footprint = check_footprint(parse_footprint(args.footprint), "--footprint")
        msg.num_vertices = len(msg.footprint)
    return msg


def _of_scenario(scenario: object) -> vehicle_t:
    """Disc or footprint of the scenario's robot; margin none, as its optima are for that."""
    values: dict = {"margin": -1.0}
    if scenario.footprint:  # type: ignore[attr-defined]
        values["footprint"] = scenario.footprint  # type: ignore[attr-defined]
    else:
        values["radius"] = scenario.radius  # type: ignore[attr-defined]
    return make(values, "scenario")


def margin_of(msg: vehicle_t | None) -> float:
    return body(msg or vehicle_t()).margin
