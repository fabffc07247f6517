#!/usr/bin/env python3
"""Layout loads (rasterise, index, distance field) beside a bare distance transform of the same grid, in one run.

build/venv/bin/python tools/bench/load_table.py [--only NAME] [--program build/release/bench-parts]
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

import offline
from aisle_tools import layouts, rosmap
from aisle_tools.bus import LogWriter
from aisle_tools.scenario import read_scenario
from aisle_tools.world import World

SCENARIOS = offline.ROOT / "tests" / "data" / "scenarios"
MAPS = offline.ROOT / "tests" / "data" / "ros_maps"
NAMES = ["clutter_50", "factory_big", "isaac_iw_hub_warehouse", "willow_garage", "nav2_warehouse"]
LIMIT = 3.0  # times the bare transform


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--only", metavar="NAME", action="append", help="only these scenarios and maps")
    parser.add_argument("--program", type=Path, default=offline.ROOT / "build" / "release" / "bench-parts")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        logs = [write_layout(Path(folder) / name, read_world(name)) for name in args.only or NAMES]
        loads = load_lines(args.program, logs)
    ratios = [float(line.split("ratio ")[1].split(";")[0]) for line in loads]
    print("\n".join(loads))
    print(f"worst ratio {max(ratios):.2f} (target {LIMIT:g})")
    return 0 if max(ratios) <= LIMIT else 1


def load_lines(program: Path, logs: list[Path]) -> list[str]:
    """Of bench-parts' own layout and of each log."""
    done = subprocess.run([program, *logs], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{program}: exit {done.returncode}\n{done.stderr}")
    return [line for line in done.stdout.splitlines() if line.startswith("load ")]


def load_ms(program: Path, logs: list[Path]) -> list[float]:
    """Of each log's layout."""
    lines = load_lines(program, logs)[1:]  # the first is its own
    return [float(line.split(" ms, ")[0].split()[-1]) for line in lines]


def read_world(name: str) -> World:
    scenario = SCENARIOS / f"{name}.json"
    if scenario.exists():
        return read_scenario(scenario, -1.0).world
    return rosmap.read_world(MAPS / f"{name}.yaml", True, rosmap.CELLS_MAX)


def write_layout(path: Path, world: World) -> Path:
    log = LogWriter(path, offline.PREFIX)
    for name, part in layouts.make_messages(world, 2, 1, 0):
        log.publish(name, part)
    log.close()
    return path


if __name__ == "__main__":
    sys.exit(main())
