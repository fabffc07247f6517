"""Drives drawn from a seed: halls with aisles, crossings and doors, vehicles, stops and movers; for encounters.py."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from aisle import goal_list_t, goal_t
from aisle_tools import goals, layouts, vehicle
from aisle_tools.bus import LogWriter
from aisle_tools.world import Polygon, World

HALLS = ("open", "aisles", "crossings", "doors")
DRAWN = "drawn"  # a hall, vehicle and movers that aisle-sim draws itself
KINDS = ("constant", "jumps", "agv", "person", "adversarial")
STOP_ROOM = 0.2  # m beyond the turning body and its margin
APART = 6.0  # m between stops
MOVERS = (2, 6)  # in a drive, least and most
PERSON_BOUND = 1.6  # m/s

VEHICLES = {
    "disc": {"radius": 0.35, "v_max": 1.2, "a_max": 0.8, "d_max": 1.0},
    "AGV": {"footprint": [[-0.5, -0.35], [0.5, -0.35], [0.5, 0.35], [-0.5, 0.35]]},
    "quick AGV": {
        "footprint": [[-0.6, -0.4], [0.6, -0.4], [0.6, 0.4], [-0.6, 0.4]],
        "v_max": 2.0,
        "a_max": 1.0,
        "d_max": 1.5,
        "reaction_time": 0.2,
    },
    "forklift": {
        "footprint": [[-0.4, -0.4], [1.4, -0.4], [1.4, 0.4], [-0.4, 0.4]],
        "v_max": 1.2,
        "a_max": 0.6,
        "d_max": 0.8,
    },
    "tricycle": {
        "footprint": [[-0.3, -0.3], [0.9, -0.3], [0.9, 0.3], [-0.3, 0.3]],
        "v_max": 1.0,
        "d_max": 0.8,
        "drive": "tricycle",
        "curvature_max": 1.2,
    },
}


@dataclass
class Drive:
    seed: int
    hall: str
    kind: str
    vehicle: str
    width: float  # m
    height: float
    boxes: list  # of (x0, y0, x1, y1)
    start: tuple  # x m, y m, theta rad
    goals: list  # of (x, y, dwell)
    movers: int
    v_bound: float  # m/s

    @property
    def name(self) -> str:
        return f"{self.hall}/{self.kind}/{self.seed}"

    @property
    def world(self) -> World:
        polygons = [
            Polygon(i + 1, np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)]))
            for i, (x0, y0, x1, y1) in enumerate(self.boxes)
        ]
        return World(self.name, (0.0, 0.0, self.width, self.height), polygons)

    @property
    def movers_option(self) -> str:
        return f"{self.kind}:{self.movers}:{self.v_bound:g}"


def draw(hall: str, kind: str, seed: int) -> Drive:
    """The same one for the same three, always."""
    if hall == DRAWN:
        return Drive(seed, hall, kind, DRAWN, 0.0, 0.0, [], (), [], 0, 0.0)
    rng = random.Random(f"{hall} {kind} {seed}")
    name = rng.choice(sorted(VEHICLES))
    while True:
        width, height = round(rng.uniform(16.0, 24.0), 1), round(rng.uniform(14.0, 20.0), 1)
        boxes = BOXES[hall](rng, width, height)
        stops = draw_stops(rng, name, width, height, boxes)
        if stops:
            break
    start = (*stops[0], round(rng.uniform(-3.0, 3.0), 2))
    ends = [(*p, rng.choice((0.0, 0.0, 1.0))) for p in stops[1:]]
    v_bound = PERSON_BOUND if kind == "person" else round(rng.uniform(0.5, 2.0), 2)
    return Drive(seed, hall, kind, name, width, height, boxes, start, ends, rng.randint(*MOVERS), v_bound)


def rounded(*box: float) -> tuple:
    return tuple(round(v, 2) for v in box)


def open_boxes(rng: random.Random, width: float, height: float) -> list:
    boxes = []
    for _ in range(rng.randint(0, 6)):
        x, y = rng.uniform(1.0, width - 3.0), rng.uniform(1.0, height - 3.0)
        boxes.append(rounded(x, y, x + rng.uniform(0.4, 2.0), y + rng.uniform(0.4, 2.0)))
    return boxes


def aisle_boxes(rng: random.Random, width: float, height: float) -> list:
    """Racks along x with aisles of 2.5 to 4 m between them and a way across in the middle."""
    aisle, rack, gap = rng.uniform(2.5, 4.0), rng.uniform(0.8, 1.4), rng.uniform(2.5, 3.5)
    middle, boxes, y = rng.uniform(0.4, 0.6) * width, [], gap
    while y + rack + gap < height:
        boxes.append(rounded(gap, y, middle - 1.5, y + rack))
        boxes.append(rounded(middle + 1.5, y, width - gap, y + rack))
        y += rack + aisle
    return boxes


def crossing_boxes(rng: random.Random, width: float, height: float) -> list:
    """Blocks of 3 to 5 m with lanes of 2.5 to 4 m that cross."""
    lane, block, boxes, x = rng.uniform(2.5, 4.0), rng.uniform(3.0, 5.0), [], 0.0
    while x + lane + 1.0 < width:
        y = 0.0
        while y + lane + 1.0 < height:
            right, top = min(x + lane + block, width - lane), min(y + lane + block, height - lane)
            if right - x - lane > 0.5 and top - y - lane > 0.5:
                boxes.append(rounded(x + lane, y + lane, right, top))
            y += lane + block
        x += lane + block
    return boxes


def door_boxes(rng: random.Random, width: float, height: float) -> list:
    """Walls across with one or two doors of 1.8 to 3 m each."""
    boxes, walls = [], rng.randint(1, 2)
    for i in range(walls):
        x, low = width * (i + 1) / (walls + 1), 0.0
        doors = rng.randint(1, 2)
        for k in range(doors):
            door, lo, hi = rng.uniform(1.8, 3.0), height * k / doors, height * (k + 1) / doors
            y = rng.uniform(lo + 0.5, hi - door - 0.5)
            boxes.append(rounded(x, low, x + 0.2, y))
            low = y + door
        boxes.append(rounded(x, low, x + 0.2, height))
    return boxes


BOXES = {"open": open_boxes, "aisles": aisle_boxes, "crossings": crossing_boxes, "doors": door_boxes}


def outer_radius(name: str) -> float:
    return vehicle.body(message(name)).outer_radius


def message(name: str):
    msg = vehicle.make(VEHICLES[name])
    msg.vehicle_revision = 1
    return msg


def has_room(x: float, y: float, room: float, width: float, height: float, boxes: list) -> bool:
    def gap(box: tuple) -> float:
        return math.hypot(max(box[0] - x, x - box[2], 0.0), max(box[1] - y, y - box[3], 0.0))

    return min(x, y, width - x, height - y) >= room and all(gap(b) >= room for b in boxes)


def draw_stops(rng: random.Random, name: str, width: float, height: float, boxes: list) -> list:
    """Start and one to three goals; empty: the hall has no room for them."""
    room = outer_radius(name) + vehicle.body(message(name)).margin + STOP_ROOM
    stops = []
    for _ in range(1 + rng.randint(1, 3)):
        for _ in range(500):
            p = rounded(rng.uniform(0.0, width), rng.uniform(0.0, height))
            near = stops and math.dist(p, stops[-1]) < APART
            if not near and has_room(*p, room, width, height, boxes):
                stops.append(p)
                break
        else:
            return []
    return stops


def write_log(drive: Drive, path: Path, prefix: str, objective: int = 0) -> None:
    """The set-up as aisle-sim wants it."""
    log = LogWriter(path, prefix)
    for name, part in layouts.make_messages(drive.world, 1, 1, 0):
        log.publish(name, part)
    log.publish("VEHICLE", message(drive.vehicle))
    pose = goals.make_pose(drive.start, 1, 1)
    pose.utime = 0
    log.publish("POSE", pose)
    goal_list = make_goals(drive)
    goal_list.options.objective = objective
    log.publish("GOALS", goal_list)
    log.close()


def make_goals(drive: Drive) -> goal_list_t:
    msg = goal_list_t()
    msg.goal_list_id = msg.goal_list_revision = msg.map_id = 1
    for i, (x, y, dwell) in enumerate(drive.goals):
        goal = goal_t()
        goal.id, goal.x, goal.y, goal.dwell = i + 1, x, y, dwell
        goal.tolerance_xy, goal.tolerance_theta = 0.1, 4.0
        msg.goals.append(goal)
    msg.num_goals = len(msg.goals)
    return msg
