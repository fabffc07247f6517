#!/usr/bin/env python3
"""What a layout patch costs, over the size of what changes and over the size of the map, as table and plot.

build/venv/bin/python tools/bench/patches.py [--out patches.png] [--json FILE] [--quick] [--program PROGRAM]

A box comes, moves by half its side and goes in halls of 5 cm cells (tools/bench/patches.c says how): full ones with an
obstacle per 10 m2, at most 4000, and open ones with none. Over the box's size on 16,777,216 cells, and over the map's
size with a box of 1 m2. y ~ x^k is fitted in logarithms.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

import offline
from curves import exponent

MAP = 4096 * 4096  # cells, over the box's size
BOX = 20  # cells a side, over the map's
EDITS = ("came", "moved", "went")
HALLS = ("full", "open")


def main() -> int:
    args = parse()
    rows = run(args.program, args.quick)
    load = os.getloadavg()
    for row in rows:
        row["sum_us"] = row["take_us"] + row["index_us"] + row["field_us"]
    for hall in HALLS:
        print_table(f"{hall} hall of {MAP} cells", by_box(rows, hall), "box")
        print_table(f"{hall} halls, a box of {BOX} x {BOX} cells", by_map(rows, hall), "map_cells")
    print_fits(rows)
    print("load average " + " ".join(f"{v:.2f}" for v in load))
    if args.json is not None:
        args.json.write_text(json.dumps({"load_average": load, "rows": rows}, indent=1) + "\n")
    if args.out is not None:
        draw(args.out, rows)
    return 0


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--out", type=Path, metavar="FILE", help="the plot, PNG")
    parser.add_argument("--json", type=Path, metavar="FILE")
    parser.add_argument("--quick", action="store_true", help="5 places for each size")
    program = offline.ROOT / "build" / "release" / "bench-patches"
    parser.add_argument("--program", type=Path, default=program, metavar="PROGRAM")
    return parser.parse_args()


def run(program: Path, quick: bool) -> list[dict]:
    done = subprocess.run([program, *(["--quick"] if quick else [])], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{program}: exit {done.returncode}\n{done.stderr}")
    return [json.loads(line) for line in done.stdout.splitlines()]


def by_box(rows: list[dict], hall: str) -> list[dict]:
    """The first of each box and edit: the one of BOX is among both series."""
    found = {}
    for row in rows:
        if row["hall"] == hall and row["map_cells"] == MAP:
            found.setdefault((row["box"], row["edit"]), row)
    return list(found.values())


def by_map(rows: list[dict], hall: str) -> list[dict]:
    found = {(r["map_cells"], r["edit"]): r for r in rows if r["hall"] == hall and r["box"] == BOX}
    return sorted(found.values(), key=lambda r: r["map_cells"])


def print_table(title: str, rows: list[dict], over: str) -> None:
    print(title)
    print(f"{over:>10} {'obstacles':>9} {'edit':>6} {'take us':>8} {'index us':>8} {'field us':>9} {'sum us':>9}", end="")
    print(f" {'window':>9} {'ns a cell':>9} {'floor us':>8} {'of floor':>8} {'load us':>8} {'of load':>9}")
    for r in rows:
        cells = max(1.0, r["window_cells"])
        print(f"{r[over]:>10.0f} {r['obstacles']:>9} {r['edit']:>6} {r['take_us']:>8.1f} {r['index_us']:>8.1f}", end="")
        print(f" {r['field_us']:>9.1f} {r['sum_us']:>9.1f} {r['window_cells']:>9.0f}", end="")
        print(f" {1e3 * r['field_us'] / cells:>9.1f} {r['floor_us']:>8.1f} {r['field_us'] / r['floor_us']:>8.1f}", end="")
        print(f" {r['load_us']:>8.0f} 1/{r['load_us'] / r['sum_us']:<7.0f}")


def print_fits(rows: list[dict]) -> None:
    for hall in HALLS:
        for edit in EDITS:
            boxes = [r for r in by_box(rows, hall) if r["edit"] == edit]
            maps = [r for r in by_map(rows, hall) if r["edit"] == edit and r["map_cells"] >= 1e6]
            area = exponent([r["window_cells"] for r in boxes], [r["field_us"] for r in boxes])
            size = exponent([r["map_cells"] for r in maps], [r["field_us"] for r in maps])
            print(f"{hall} hall, {edit:<5}: field over the window's cells k = {area:.2f}, over the map's {size:.2f}")


def draw(path: Path, rows: list[dict]) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(1, 2, figsize=(10.0, 4.5), sharey=True, constrained_layout=True)
    colours = {"came": "#1f77b4", "moved": "#2ca02c", "went": "#d62728"}
    for hall, style in zip(HALLS, ("o-", "s--")):
        for edit in EDITS:
            series = [r for r in by_box(rows, hall) if r["edit"] == edit]
            label = f"{hall} hall, {edit}"
            areas = [r["box"] ** 2 for r in series]
            axes[0].loglog(areas, [r["sum_us"] for r in series], style, color=colours[edit], ms=4, label=label)
            series = [r for r in by_map(rows, hall) if r["edit"] == edit]
            sizes = [r["map_cells"] for r in series]
            axes[1].loglog(sizes, [r["sum_us"] for r in series], style, color=colours[edit], ms=4)
        load = [r for r in by_map(rows, hall) if r["edit"] == "came"]
        axes[1].loglog(
            [r["map_cells"] for r in load],
            [r["load_us"] for r in load],
            style,
            color="#777777",
            ms=4,
            label=f"{hall} hall, loaded whole",
        )
    floor = [r for r in by_box(rows, "full") if r["edit"] == "went"]
    xs = [r["box"] ** 2 for r in floor]
    axes[0].loglog(xs, [r["floor_us"] for r in floor], ":", color="black", label="full hall, went: memory traffic")
    axes[0].set_xlabel("cells of the box, map of 16,777,216 cells")
    axes[1].set_xlabel(f"cells of the map, box of {BOX} x {BOX} cells")
    axes[0].set_ylabel("µs: a patch taken and in force (median)")
    for axis in axes:
        axis.grid(True, which="major", color="#dddddd")
        axis.legend(fontsize=8)
    figure.savefig(path, dpi=90)


if __name__ == "__main__":
    sys.exit(main())
