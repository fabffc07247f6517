"""aisle paper 4: sampling planners for Plug & Produce (Ramasamy, Eriksson, Danielsson, Ericsson 2023), beside ours."""

from __future__ import annotations

import argparse
import json
import math
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import matplotlib
import numpy as np
from aisle import options_t, path_t, query_t, vehicle_t, waypoint_t
from rich.console import Console
from rich.progress import Progress

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.collections import LineCollection  # noqa: E402

from aisle_tools import hall, layouts, names, query, vehicle  # noqa: E402
from aisle_tools.bus import LogWriter, Recording  # noqa: E402
from aisle_tools.check import Obstacles, check_path  # noqa: E402
from aisle_tools.errors import UserError  # noqa: E402
from aisle_tools.paper1 import call, line_of, median, program, save  # noqa: E402
from aisle_tools.plot import draw_world  # noqa: E402
from aisle_tools.scenario import Scenario  # noqa: E402
from aisle_tools.world import Polygon, World  # noqa: E402

TOOL = 0.1  # m, radius of the disc that stands for the robot's tool
BOUNDS = (0.0, 0.0, 3.2, 2.4)  # m
START, GOAL = (0.4, 1.2), (2.8, 1.2)
STEP = 0.4  # m, of the paper's trees
SAMPLES, MORE = 20000, 2000  # of a tree until there is a path; of a star after that
NEIGHBOURS = 15  # of PRM
DRIVEN, NAMED = 10, 3  # seeds at most whose paths are driven as found; by name
WIDTH, OFFSET, ARM = 0.26, 0.24, 0.2  # m, of the way between the two middle modules: see crooked()

# The tool's limits and what it takes: mass, friction and idle power chosen so that RRT* with zone 200 mm meets the paper's
# energies at 10, 400 and 1000 mm/s about; all other figures follow. A tool has no heading, so it turns in next to no time.
ACCELERATION = 4.0  # m/s2
TURNING = 1e5  # rad/s2, rad/s
MASS, FRICTION, IDLE, EFFICIENCY = 350.0, 0.052, 0.6, 0.8  # kg, 1, W, 1

ZONES = (0, 50, 100, 150, 200)  # mm; 0: fine
TIME_SPEEDS = (400, 500, 600, 700, 800)  # mm/s
ENERGY_SPEEDS = (10, 50, 100, 200, 400, 800, 1000, 2000, 3000)
SPEEDS = tuple(sorted({*TIME_SPEEDS, *ENERGY_SPEEDS}))

PLANNERS = {  # in the paper's order of table 3
    "RRT": options_t.RRT,
    "adaptive RRT": options_t.RRT_ADAPTIVE,
    "PRM": options_t.PRM,
    "RRT*": options_t.RRT_STAR,
    "adaptive RRT*": options_t.RRT_STAR_ADAPTIVE,
}
FIXED = ("RRT", "RRT*")
PAPER_SECONDS = {  # table 2: computation, s
    "few": {"RRT": 4.4, "RRT*": 4.9, "adaptive RRT": 5.2, "adaptive RRT*": 7.2, "PRM": 11.3},
    "more": {"adaptive RRT": 11.6, "adaptive RRT*": 11.7, "PRM": 25.6},
}
PAPER_TIMES = {  # table 3: moving along, s, at TIME_SPEEDS
    "RRT": (9.9, 7.7, 6.9, 5.8, 4.7),
    "adaptive RRT": (12.8, 10.3, 8.6, 7.6, 6.5),
    "PRM": (6.2, 4.9, 4.2, 3.3, 3.0),
    "RRT*": (5.8, 4.7, 3.9, 3.4, 3.0),
    "adaptive RRT*": (5.8, 4.7, 3.9, 3.5, 3.0),
}
PAPER_ZONES = (0, 100, 150, 200)
PAPER_ENERGY = {  # table 4: J, at ENERGY_SPEEDS and PAPER_ZONES
    "PRM": (
        (1190, 993, 968, 925), (945, 912, 895, 815), (1220, 1201, 1190, 1099), (1424, 1398, 1356, 1208),
        (1539, 1457, 1433, 1386), (1961, 1655, 1620, 1598), (2246, 1820, 1758, 1730), (4206, 3330, 2969, 2880),
        (5213, 4310, 3910, 3714),
    ),
    "adaptive RRT*": (
        (877, 871, 865, 851), (610, 604, 590, 585), (899, 897, 894, 891), (1053, 1050, 1045, 1039),
        (1147, 1145, 1140, 1139), (1392, 1378, 1346, 1323), (1559, 1514, 1489, 1447), (2735, 2675, 2544, 2311),
        (3569, 3415, 3365, 3197),
    ),
    "RRT*": (
        (845, 825, 790, 753), (420, 400, 375, 321), (522, 502, 444, 411), (674, 654, 586, 563),
        (762, 705, 689, 640), (957, 902, 830, 776), (1082, 985, 872, 866), (1804, 1756, 1645, 1434),
        (2478, 2389, 2266, 2247),
    ),
}

COLOURS = dict(zip(PLANNERS, ("#d62728", "#d9a441", "#2ca02c", "#9467bd", "#1f4e9c")))
DRAWN_SPEEDS = (400, 1000)  # mm/s, of the energies drawn


@dataclass
class Scene:
    name: str
    scenario: Scenario
    draws: int  # of PRM
    obstacles: Obstacles = field(init=False)

    def __post_init__(self) -> None:
        self.obstacles = Obstacles(self.scenario.world)


@dataclass
class Taken:
    """Means over the paths of one planner at one speed and zone."""

    length: float = math.nan  # m
    time: float = math.nan  # s
    energy: float = math.nan  # J, without turning on the spot
    stops: float = math.nan
    paths: int = 0


# ---- scenes: cells like the paper's, in the plane; its own are lost


def box(x0: float, y0: float, x1: float, y1: float) -> np.ndarray:
    return np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])


def crooked() -> list[np.ndarray]:
    """Two modules across the cell, between them a way in, a short way up and a way out.

    The tool's centre has less than a step up: no straight motion of a whole step leads round either bend, half a step does.
    """
    x, y, half, rise = 1.6, 1.2, 0.5 * WIDTH, 0.5 * OFFSET
    return [
        box(x - half - ARM, 0.0, x + half, y - rise - half),
        box(x + half, 0.0, x + half + ARM, y + rise - half),
        box(x - half - ARM, y - rise + half, x - half, 2.4),
        box(x - half, y + rise + half, x + half + ARM, 2.4),
    ]


def scene(name: str, boxes: list[np.ndarray], draws: int) -> Scene:
    polygons = [Polygon(i + 1, b) for i, b in enumerate(boxes)]
    return Scene(name, Scenario(World(name, BOUNDS, polygons), TOOL, [], START, [GOAL]), draws)


def scenes() -> list[Scene]:
    sides = [box(0.7, 1.75, 1.1, 2.4), box(2.3, 1.75, 2.7, 2.4), box(0.7, 0.0, 1.1, 0.65), box(2.3, 0.0, 2.7, 0.65)]
    middle = [box(1.5, 1.85, 1.9, 2.4), box(1.5, 0.0, 1.9, 0.55), box(1.15, 0.95, 1.45, 1.35), box(1.85, 1.1, 2.15, 1.5)]
    corners = [box(0.5, 1.75, 0.9, 2.4), box(2.3, 1.75, 2.7, 2.4), box(0.5, 0.0, 0.9, 0.65), box(2.3, 0.0, 2.7, 0.65)]
    return [scene("few", sides + middle, 500), scene("more", corners + crooked(), 6000)]


# ---- runs


def plan(args: argparse.Namespace, one: Scene, planner: str, plain: bool) -> list[dict]:
    """Of each seed; with the tree or roadmap of the first one."""
    draws = one.draws if planner == "PRM" else SAMPLES
    words = [program(args, "paper-sampling"), PLANNERS[planner], int(plain), STEP if plain else 0, 1, args.seeds]
    told = call([*words, draws, MORE, NEIGHBOURS, int(plain)], hall.text(one.scenario, -1.0))
    return [json.loads(line) for line in told.splitlines()]


def drive(args: argparse.Namespace, one: Scene, runs: list[dict]) -> list[dict]:
    """The paths as they were found, at each speed with each zone."""
    lines = [r["path"] for r in runs if r["path"]][:DRIVEN]
    rows = [
        (ACCELERATION, TURNING, MASS, FRICTION, IDLE, EFFICIENCY),
        (len(SPEEDS), *(1e-3 * v for v in SPEEDS)),
        (len(ZONES), *(zone_wish(z) for z in ZONES)),
        (len(lines),),
        *((len(line), *(v for p in line for v in p)) for line in lines),
    ]
    numbers = "\n".join(" ".join(f"{float(v):.17g}" for v in row) for row in rows)
    told = call([program(args, "paper-drive")], hall.text(one.scenario, -1.0) + "\n" + numbers)
    return [json.loads(line) for line in told.splitlines()]


def zone_wish(zone: int) -> float:
    """options_t.zone, m."""
    return 1e-3 * zone if zone > 0 else -1.0


def vehicle_of(speed: int) -> vehicle_t:
    values = {key: ACCELERATION for key in ("a_max", "d_max", "lateral_a_max")}
    values |= {"omega_max": TURNING, "alpha_max": TURNING, "v_max": 1e-3 * speed, "creep_speed": 1e-3 * speed}
    values |= {"radius": TOOL, "margin": -1.0, "creep_clearance": 1e-6, "mass": MASS, "rolling_resistance": FRICTION}
    msg = vehicle.make({**values, "idle_power": IDLE, "drive_efficiency": EFFICIENCY})
    msg.vehicle_revision = 1
    return msg


def query_of(one: Scene, ident: int, planner: str, zone: int, seed: int) -> query_t:
    options = options_t()
    options.planner, options.objective = PLANNERS[planner], options_t.SHORTEST
    options.zone, options.seed = zone_wish(zone), seed
    return query.make_query(query.Leg(str(ident), one.scenario.start, one.scenario.goals), ident, 1, options, False)


def ask(args: argparse.Namespace, one: Scene, speed: int, zones: tuple[int, ...]) -> list[dict]:
    """Every planner by name through aisle-replay: rows of planner, zone, query, reply."""
    rows = []
    for planner in PLANNERS:
        for zone in zones:
            for seed in range(1, min(args.seeds, NAMED) + 1):
                asked = query_of(one, len(rows) + 1, planner, zone, seed)
                rows.append({"planner": planner, "speed": speed, "zone": zone, "query": asked, "reply": None})
    with tempfile.TemporaryDirectory() as folder:
        log, out = Path(folder) / "in.log", Path(folder) / "out.log"
        writer = LogWriter(log, "AISLE")
        for name, part in layouts.make_messages(one.scenario.world, 1, 1, 0):
            writer.publish(name, part)
        writer.publish("VEHICLE", vehicle_of(speed))
        for row in rows:
            writer.publish("QUERY", row["query"])
        writer.close()
        call([program(args, "aisle-replay"), log, "--out", out])
        replies = {r.query_id: r for r in Recording(out, "AISLE").replies}
    for row in rows:
        row["reply"] = replies.get(row["query"].query_id)
    return rows


def judge(one: Scene, row: dict) -> dict:
    """What an answer takes, by the independent checker; "fault": it is none, or not what it says."""
    reply, planner = row["reply"], PLANNERS[row["planner"]]
    out = {key: row[key] for key in ("planner", "speed", "zone")} | {"proved": False, "fault": ""}
    if reply is None or not names.is_path(reply) or reply.status != path_t.OK:
        return out | {"fault": "no answer" if reply is None else names.reason(reply)}
    if reply.planner != planner:
        return out | {"fault": f"answered by {names.PLANNERS[reply.planner]}"}
    report = check_path(reply, one.obstacles, vehicle.body(vehicle_of(row["speed"])), row["query"])
    if report.faults:
        return out | {"fault": report.faults[0]}
    turning = sum(e.turning for e in report.energy)
    stops = sum(1 for w in reply.waypoints[1:-1] if w.flags & waypoint_t.TURN_IN_PLACE)
    sums = {"length": reply.length, "duration": reply.duration, "energy": reply.energy, "turning": turning}
    return out | sums | {"proved": True, "stops": stops}


# ---- figures


def computation(runs: list[dict]) -> dict:
    found = [r for r in runs if r["length"] is not None]
    ms = [r["ms"] for r in runs]
    return {
        "seeds": len(runs),
        "found": len(found),
        "ms": median(ms),
        "ms_p99": float(np.percentile(ms, 99)),
        "first_ms": median([r["first_ms"] for r in found]),
        "query_ms": median([r["query_ms"] for r in runs if "query_ms" in r]),
        "nodes": median([r["nodes"] for r in runs]),
        "first_length": median([r["first_length"] for r in found]),
        "length": median([r["length"] for r in found]),
        "corners": median([len(r["path"]) - 2 for r in found]),
    }


def taken(rows: list[dict]) -> dict[tuple[int, int], Taken]:
    """By speed (mm/s) and zone (mm)."""
    out = {}
    for speed in SPEEDS:
        for zone in ZONES:
            some = [r for r in rows if r["proved"] and (r["speed"], r["zone"]) == (speed, zone)]
            if some:
                length, time, stops = (float(np.mean([r[k] for r in some])) for k in ("length", "duration", "stops"))
                energy = float(np.mean([r["energy"] - r["turning"] for r in some]))
                out[speed, zone] = Taken(length, time, energy, stops, len(some))
            else:
                out[speed, zone] = Taken()
    return out


def in_mm(rows: list[dict]) -> list[dict]:
    return [{**r, "speed": round(1e3 * r["speed"]), "zone": max(round(1e3 * r["zone"]), 0)} for r in rows]


def falls(values: list[float]) -> bool:
    return all(b < a for a, b in zip(values, values[1:]))


def dearer_zones(table: dict[tuple[int, int], Taken]) -> list[int]:
    """Speeds at which zone 200 mm takes no less energy than fine."""
    return [v for v in ENERGY_SPEEDS if not table[v, 200].energy < table[v, 0].energy]


def shortfalls(computed: dict, found: dict[str, list[dict]], named: dict[str, list[dict]]) -> list[str]:
    """What is promised and not kept: who finds a path, and that every answer is proved."""
    out = []
    for (where, planner, plain), row in computed.items():
        fails = where == "more" and plain and planner in FIXED
        if row["found"] != (0 if fails else row["seeds"]):
            what = "the paper's form" if plain else "ours"
            out.append(f"{where}, {planner}, {what}: a path in {row['found']} of {row['seeds']} seeds")
    for how, tables in (("as found", found), ("by name", named)):
        for planner, rows in tables.items():
            bad = [r for r in rows if not r["proved"]]
            if bad:
                out.append(f"{planner} {how}: {len(bad)} of {len(rows)} not proved: {bad[0].get('fault')}")
    return out


def notes(found: dict[str, list[dict]], named: dict[str, list[dict]]) -> list[str]:
    """The paper's trends that ours do not show."""
    out = []
    for how, tables in (("as found", found), ("by name", named)):
        for planner, rows in tables.items():
            table = taken(rows)
            times = [table[v, 200].time for v in TIME_SPEEDS]
            if all(math.isfinite(t) for t in times) and not falls(times):
                out.append(f"{planner} {how}: the time does not fall all the way, s: {', '.join(f'{t:.3f}' for t in times)}")
            dearer = dearer_zones(table)
            if dearer:
                out.append(f"{planner} {how}: zone 200 mm takes no less energy than fine at {', '.join(map(str, dearer))} mm/s")
    return out


# ---- report


def number(value: float, width: int, digits: int) -> str:
    return f"{value:>{width}.{digits}f}" if math.isfinite(value) else f"{'-':>{width}}"


def print_computation(computed: dict) -> None:
    print("Computation (the paper's table 2: s on a laptop, in its robot cell; ours: ms of processor time, cells like it in the")
    print("plane). found: seeds; all: until the planner ends; first: until its first path; query: on a roadmap that is there")
    print(
        f"{'scene':<5} {'planner':<14} {'form':<6} {'paper s':>7} {'found':>11} {'all ms':>8} {'p99':>8} {'first ms':>8} "
        f"{'query ms':>8} {'nodes':>6} {'first m':>8} {'path m':>8} {'corners':>7}"
    )
    for (where, planner, plain), r in computed.items():
        paper = PAPER_SECONDS[where].get(planner)
        told = "fails" if paper is None else f"{paper:.1f}"
        print(
            f"{where:<5} {planner:<14} {'paper' if plain else 'ours':<6} {told if plain else '':>7} "
            f"{r['found']:>5}/{r['seeds']:<5} {r['ms']:>8.3f} {r['ms_p99']:>8.3f} {number(r['first_ms'], 8, 3)} "
            f"{number(r['query_ms'], 8, 3)} {r['nodes']:>6.0f} {number(r['first_length'], 8, 3)} "
            f"{number(r['length'], 8, 3)} {number(r['corners'], 7, 0)}"
        )


def print_times(found: dict[str, list[dict]], named: dict[str, list[dict]]) -> None:
    print("\nMoving along, s, few constraints (table 3; its zone is not told, ours 200 mm). as found: the planner's own line,")
    print("corners blended; by name: what the core answers, the line pulled taut; every path proved")
    print(f"{'planner':<14} {'':<9} {'length m':>8} " + " ".join(f"{f'{v} mm/s':>9}" for v in TIME_SPEEDS))
    for planner in PLANNERS:
        print(f"{planner:<14} {'paper':<9} {'-':>8} " + " ".join(f"{t:>9.1f}" for t in PAPER_TIMES[planner]))
        for how, rows in (("as found", found[planner]), ("by name", named[planner])):
            table = taken(rows)
            values = " ".join(number(table[v, 200].time, 9, 2) for v in TIME_SPEEDS)
            print(f"{'':<14} {how:<9} {number(table[400, 200].length, 8, 3)} {values}")


def print_energy(found: dict[str, list[dict]], named: dict[str, list[dict]]) -> None:
    print("\nEnergy, J, few constraints (table 4), by speed and corner zone, mm; without turning on the spot, which a tool does not")
    heads = [f"{z or 'fine':>5}" for z in ZONES]
    paper_heads = [f"{z or 'fine':>5}" for z in PAPER_ZONES]
    print(f"{'':<14} {'':>5} | {'paper':<23} | {'as found':<29} | {'by name':<29}")
    print(f"{'planner':<14} {'mm/s':>5} | {' '.join(paper_heads)} | {' '.join(heads)} | {' '.join(heads)}")
    for planner in PLANNERS:
        tables = taken(found[planner]), taken(named[planner])
        for i, v in enumerate(ENERGY_SPEEDS):
            told = PAPER_ENERGY.get(planner)
            paper = " ".join(f"{told[i][k]:>5}" if told else f"{'-':>5}" for k in range(len(PAPER_ZONES)))
            ours = " | ".join(" ".join(number(t[v, z].energy, 5, 0) for z in ZONES) for t in tables)
            print(f"{planner if i == 0 else '':<14} {v:>5} | {paper} | {ours}")


def print_trends(found: dict[str, list[dict]], named: dict[str, list[dict]]) -> None:
    print("\nEnergy, zone 200 mm against fine: least of the speeds; stops on the way at 800 mm/s")
    for planner in PLANNERS:
        for how, rows in (("as found", found[planner]), ("by name", named[planner])):
            table = taken(rows)
            ratios = [table[v, 200].energy / table[v, 0].energy for v in ENERGY_SPEEDS]
            if not all(math.isfinite(r) for r in ratios):
                continue
            least = int(np.argmin(ratios))
            print(
                f"{planner:<14} {how:<9} {ratios[least] - 1.0:>+6.0%} at {ENERGY_SPEEDS[least]:>4} mm/s; "
                f"stops {table[800, 0].stops:.1f} fine, {table[800, 200].stops:.1f} with the zone"
            )


def print_list(title: str, lines: list[str]) -> None:
    print(f"\n{title}: {len(lines)}")
    for line in lines:
        print(f"  {line}")


def as_json(computed: dict, found: dict[str, list[dict]], named: dict[str, list[dict]]) -> dict:
    def rows(one: list[dict]) -> list[dict]:
        return [{"speed": v, "zone": z, **vars(t)} for (v, z), t in taken(one).items()]

    return {
        "computation": [
            {"scene": s, "planner": p, "form": "paper" if plain else "ours", **row} for (s, p, plain), row in computed.items()
        ],
        "as_found": {p: rows(r) for p, r in found.items()},
        "by_name": {p: rows(r) for p, r in named.items()},
    }


# ---- pictures


def draw(path: Path, made: list[Scene], runs: dict, asked: dict, found: dict[str, list[dict]]) -> None:
    """A row of trees and roadmaps a scene, below them times and energies."""
    figure = plt.figure(figsize=(20.0, 12.6), layout="constrained")
    upper, lower = figure.subfigures(2, 1, height_ratios=(1.45, 1.0))
    grid = upper.subplots(len(made), len(PLANNERS), sharex=True, sharey=True)
    for axes, one in zip(grid, made):
        for axis, planner in zip(axes, PLANNERS):
            draw_tree(axis, one, planner, runs[one.name, planner, True][0], answer(asked[one.name], planner))
        axes[0].set_ylabel(f"{one.name} constraints\ny (m)")
    for axis in grid[-1]:
        axis.set_xlabel("x (m)")
    upper.legend(*grid[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=3, fontsize=11)
    tables = {planner: taken(rows) for planner, rows in found.items()}
    times, *energies = lower.subplots(1, 1 + len(DRAWN_SPEEDS))
    draw_times(times, tables)
    for axis, speed in zip(energies, DRAWN_SPEEDS):
        draw_energy(axis, tables, speed)
    lower.legend(*times.get_legend_handles_labels(), loc="outside lower center", ncols=2 * len(PLANNERS), fontsize=11)
    save(figure, path)


def answer(rows: list[dict], planner: str) -> path_t | None:
    """By name, of the first seed, at 800 mm/s with zone 200 mm."""
    for row in rows:
        if (row["planner"], row["speed"], row["zone"]) == (planner, 800, 200):
            reply = row["reply"]
            return reply if reply is not None and names.is_path(reply) else None
    return None


def draw_tree(axis: plt.Axes, one: Scene, planner: str, first: dict, reply: path_t | None) -> None:
    draw_world(axis, one.scenario.world)
    edges, line = np.array(first["edges"]).reshape(-1, 2, 2), np.array(first["path"]).reshape(-1, 2)
    thin = len(edges) > 5000
    what = {"color": "#8a8a8a", "linewidths": 0.15 if thin else 0.6, "alpha": 0.6 if thin else 1.0}
    axis.add_collection(LineCollection(edges, label="tree or roadmap, the paper's form, seed 1", zorder=3, **what))
    axis.plot(*line.T, color="#d62728", lw=1.8, marker="o", ms=3, label="its path", zorder=4)
    if reply is not None:
        axis.plot(*line_of(reply).T, color="#1f4e9c", lw=2.0, label="by name, corners blended", zorder=5)
    axis.plot(*START, "o", ms=8, mfc="#2ca02c", mec="white", zorder=6)
    axis.plot(*GOAL, "*", ms=13, mfc="#ff7f0e", mec="white", zorder=6)
    told = "no path" if first["length"] is None else f"{first['length']:.2f} m"
    axis.set(xlim=(-0.05, 3.25), ylim=(-0.05, 2.45), aspect="equal")
    axis.set_title(f"{planner}: {told}, {first['nodes']} nodes, {first['ms']:.2f} ms", fontsize=11)


def draw_times(axis: plt.Axes, tables: dict[str, dict[tuple[int, int], Taken]]) -> None:
    for planner, table in tables.items():
        speeds, colour = [1e-3 * v for v in TIME_SPEEDS], COLOURS[planner]
        axis.plot(speeds, [table[v, 200].time for v in TIME_SPEEDS], "-o", color=colour, label=f"{planner}, ours")
        axis.plot(speeds, PAPER_TIMES[planner], "--s", color=colour, mfc="white", label=f"{planner}, paper")
    axis.set(xlabel="speed (m/s)", ylabel="time to move along (s)", ylim=(0.0, None))
    axis.set_title("few constraints, paths as found; zone 200 mm (the paper tells none)", fontsize=11)
    axis.grid(alpha=0.3)


def draw_energy(axis: plt.Axes, tables: dict[str, dict[tuple[int, int], Taken]], speed: int) -> None:
    for planner, table in tables.items():
        values = [table[speed, z].energy for z in ZONES]
        axis.plot([1e-3 * z for z in ZONES], values, "-o", color=COLOURS[planner])
        if planner in PAPER_ENERGY:
            told = PAPER_ENERGY[planner][ENERGY_SPEEDS.index(speed)]
            axis.plot([1e-3 * z for z in PAPER_ZONES], told, "--s", color=COLOURS[planner], mfc="white")
    axis.set(xlabel="corner zone (m), 0: fine", ylabel="energy (J)", ylim=(0.0, None))
    axis.set_title(f"few constraints, paths as found, {1e-3 * speed:.1f} m/s", fontsize=11)
    axis.grid(alpha=0.3)


def run(args: argparse.Namespace) -> int:
    if args.seeds < 1:
        raise UserError("--seeds must be at least 1")
    few, more = made = scenes()
    runs, found = {}, {}
    named: dict[str, list[dict]] = {p: [] for p in PLANNERS}
    with Progress(console=Console(file=sys.stderr), transient=True, disable=not sys.stderr.isatty()) as progress:
        task = progress.add_task("paper 4", total=4 * len(PLANNERS) + len(PLANNERS) + len(SPEEDS) + 1)
        for one in made:
            for planner in PLANNERS:
                for plain in (True, False):
                    runs[one.name, planner, plain] = plan(args, one, planner, plain)
                    progress.advance(task)
        for planner in PLANNERS:
            found[planner] = in_mm(drive(args, few, runs["few", planner, True]))
            progress.advance(task)
        asked = {"few": [], "more": ask(args, more, 800, (200,))}
        progress.advance(task)
        for speed in SPEEDS:
            asked["few"] += ask(args, few, speed, ZONES)
            progress.advance(task)
    for row in asked["few"]:
        named[row["planner"]].append(judge(few, row))
    return report(args, made, runs, found, named, asked)


def report(args: argparse.Namespace, made: list[Scene], runs: dict, found: dict, named: dict, asked: dict) -> int:
    computed = {key: computation(r) for key, r in runs.items()}
    print_computation(computed)
    print_times(found, named)
    print_energy(found, named)
    print_trends(found, named)
    faults = shortfalls(computed, found, named)
    crooked_ways = [judge(made[1], row) for row in asked["more"]]
    faults += [f"more, {r['planner']} by name: {r['fault']}" for r in crooked_ways if not r["proved"]]
    print_list("trends of the paper not met", notes(found, named))
    print_list("not kept", faults)
    if args.json is not None:
        args.json.write_text(json.dumps(as_json(computed, found, named), indent=1))
    if args.out is not None:
        draw(args.out / "paper4.png", made, runs, asked, found)
    return 1 if faults else 0
