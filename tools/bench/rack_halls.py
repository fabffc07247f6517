"""Rack halls drawn from a seed: parallel racks, cross aisles, dead ends, pallets; bodies and queries in them."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass

import numpy as np
from aisle_tools import query
from aisle_tools.world import Polygon, World
from shapely.geometry import Point, box
from shapely.geometry import Polygon as Shape
from shapely.ops import unary_union

WIDTH, HEIGHT = 20.0, 14.0  # m
RACK = 1.1  # m, depth
STEP = 0.05  # m, places of queries lie on the oracle's lattice
MARGIN = 0.05  # m
SPARE = 2e-3  # m, that no stop is nearer to being in contact or free


@dataclass(frozen=True)
class Vehicle:
    name: str
    footprint: tuple  # of (x, y), counter-clockwise
    drive: str
    radius_min: float  # m; 0: turns on the spot
    aisles: tuple  # m, narrowest and widest

    @property
    def values(self) -> dict:
        curvature = 1.0 / self.radius_min if self.radius_min > 0.0 else 0.0
        return {
            "footprint": [list(p) for p in self.footprint],
            "drive": self.drive,
            "curvature_max": curvature,
            "margin": MARGIN,
        }


def rectangle(rear: float, front: float, half: float) -> tuple:
    return ((-rear, -half), (front, -half), (front, half), (-rear, half))


VEHICLES = (
    Vehicle("forklift 2.4 x 1.0, differential", rectangle(0.5, 1.9, 0.5), "differential", 0.0, (1.2, 4.0)),
    Vehicle("forklift 2.4 x 1.0, tricycle 1.5 m", rectangle(0.5, 1.9, 0.5), "tricycle", 1.5, (1.2, 4.0)),
    Vehicle("pallet AGV 1.8 x 0.9", rectangle(0.9, 0.9, 0.45), "differential", 0.0, (1.2, 4.0)),
)


@dataclass
class Hall:
    seed: int
    vehicle: Vehicle
    aisle: float  # m
    boxes: list  # of (x0, y0, x1, y1)

    @property
    def world(self) -> World:
        polygons = [
            Polygon(i + 1, np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)]))
            for i, (x0, y0, x1, y1) in enumerate(self.boxes)
        ]
        return World(f"racks_{self.seed}", (0.0, 0.0, WIDTH, HEIGHT), polygons)


def draw_hall(seed: int, vehicle: Vehicle, share: float) -> Hall:
    """share in [0, 1]: where in the vehicle's range of aisles the hall's width is."""
    rng = random.Random(seed)
    aisle = round(vehicle.aisles[0] + share * (vehicle.aisles[1] - vehicle.aisles[0]), 2)
    cross = round(rng.uniform(2.5, 4.0), 2)
    boxes, x = [], 0.0
    while x + aisle + RACK + 1.2 < WIDTH:
        x = round(x + aisle, 3)
        boxes.append((x, cross, round(x + RACK, 3), HEIGHT - cross))
        x = round(x + RACK, 3)
    closed = [pair for pair in zip(boxes, boxes[1:]) if rng.random() < 0.3]  # dead ends
    boxes += [(a[2], HEIGHT - cross - 0.5, b[0], HEIGHT - cross) for a, b in closed]
    for _ in range(rng.randint(0, 4)):  # pallets in the cross aisles, and beside the racks
        px, low = round(rng.uniform(0.0, WIDTH - 1.2), 2), rng.random() < 0.5
        py = round(rng.uniform(0.0, cross - 0.8) if low else rng.uniform(HEIGHT - cross, HEIGHT - 0.8), 2)
        boxes.append((px, py, round(px + 1.2, 3), round(py + 0.8, 3)))
    for rack in boxes[: len(closed) + 1]:
        py = round(rng.uniform(cross, HEIGHT - cross - 1.2), 2)
        if rng.random() < 0.3 and rack[2] + 0.8 < WIDTH:
            boxes.append((rack[2], py, round(rack[2] + 0.8, 3), round(py + 1.2, 3)))
    return Hall(seed, vehicle, aisle, boxes)


def placed(vehicle: Vehicle, pose: tuple) -> Shape:
    c, s = math.cos(pose[2]), math.sin(pose[2])
    return Shape([(pose[0] + c * x - s * y, pose[1] + s * x + c * y) for x, y in vehicle.footprint])


class Floor:
    """What stands in a hall, for one body."""

    def __init__(self, hall: Hall) -> None:
        self.hall = hall
        self.blocked = unary_union([box(*b) for b in hall.boxes])
        self.walls = box(0.0, 0.0, WIDTH, HEIGHT).exterior

    def gap(self, pose: tuple) -> float:
        """m, from the body to what is nearest; 0: contact."""
        shape = placed(self.hall.vehicle, pose)
        return min(shape.distance(self.blocked), shape.distance(self.walls))

    def is_free(self, pose: tuple) -> bool:
        return self.gap(pose) > MARGIN + SPARE

    def up_to_the_face(self, pose: tuple) -> tuple:
        """As far ahead as the body gets, in steps of the lattice."""
        while True:
            ahead = round(pose[0] + STEP * math.cos(pose[2]), 2), round(pose[1] + STEP * math.sin(pose[2]), 2), pose[2]
            if not self.is_free(ahead):
                return pose
            pose = ahead

    def draw_stop(self, rng: random.Random) -> tuple:
        """Along or across the racks; a third with the front at a rack's face, one in 25 in contact."""
        free = rng.random() > 0.04
        while True:
            x, y = (round(STEP * rng.randint(0, round(side / STEP)), 2) for side in (WIDTH, HEIGHT))
            pose = x, y, 0.5 * math.pi * rng.choice((-1, 0, 1, 2))
            if not free and self.gap(pose) < MARGIN - SPARE:
                return pose
            if free and self.is_free(pose):
                return self.up_to_the_face(pose) if rng.random() < 1.0 / 3.0 else pose


def draw_queries(hall: Hall, count: int) -> list[query.Leg]:
    """A third of the goals take any heading."""
    rng = random.Random(hall.seed + 1)
    floor = Floor(hall)
    legs = []
    for i in range(count):
        start, goal = floor.draw_stop(rng), floor.draw_stop(rng)
        any_heading = rng.random() < 1.0 / 3.0 and floor.is_free(goal)
        legs.append(query.Leg(f"{hall.seed}/{i}", start, [goal[:2] if any_heading else goal]))
    return legs


def disc_passes(hall: Hall, leg: query.Leg) -> bool:
    """Does the disc inside the body, its margin kept, get from one place to the other?"""
    inner = min(min(abs(x), abs(y)) for x, y in hall.vehicle.footprint) + MARGIN
    free = box(inner, inner, WIDTH - inner, HEIGHT - inner).difference(
        unary_union([box(*b).buffer(inner, quad_segs=64) for b in hall.boxes])
    )
    parts = list(free.geoms) if hasattr(free, "geoms") else [free]
    ends = [Point(leg.start[:2]), Point(leg.goals[0][:2])]
    return any(all(part.distance(end) < 1e-4 for end in ends) for part in parts)
