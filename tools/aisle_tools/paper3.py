"""aisle paper 3: joint angles of the 7th degree by a genetic algorithm (Machmudah, Parman, Zainuddin 2012), beside ours."""

from __future__ import annotations

import argparse
import json
from dataclasses import dataclass
from pathlib import Path

import matplotlib
import numpy as np
from aisle import arm_path_t, options_t, path_t

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

from aisle_tools import arm, arms  # noqa: E402
from aisle_tools.errors import UserError  # noqa: E402

CASES = ("arm_4_complex", "arm_2_post", "arm_3_box")  # I, II, III
METHODS = {  # what: planner, objective
    "paper: GA, death penalty": (options_t.GA, options_t.PAPER),
    "GA, graded depth": (options_t.GA, options_t.SHORTEST),
    "PSO, graded depth": (options_t.PSO, options_t.SHORTEST),
    "AUTO": (options_t.AUTO, options_t.SHORTEST),
}


@dataclass
class Outcome:
    case: str
    method: str
    escaped: int
    seeds: int
    travel: float  # rad, medians of those that escaped
    duration: float  # s
    ms: float  # of all
    example: arm_path_t | None


def run(args: argparse.Namespace) -> int:
    folder = args.scenarios.parent / "arms"
    program = args.programs / "bench-arm"
    if not program.is_file():
        raise UserError(f"{program}: no such program; build it with cmake --build --preset release")
    print(f"{'case':<14} {'method':<26} {'escaped':>11} {'travel, rad':>11} {'T, s':>6} {'ms':>7}")
    outcomes = []
    for case in CASES:
        scenario = arms.read_scenario(folder / f"{case}.json")
        for method in METHODS:
            o = ask(program, scenario, case, method, args.seeds)
            outcomes.append(o)
            print(
                f"{o.case:<14} {o.method:<26} {o.escaped:>5}/{o.seeds:<5} {o.travel:>11.3f} {o.duration:>6.2f} {o.ms:>7.1f}",
                flush=True,
            )
    if args.json is not None:
        args.json.write_text(json.dumps([{k: v for k, v in o.__dict__.items() if k != "example"} for o in outcomes], indent=1))
    if args.out is not None:
        draw(args.out / "paper3.png", folder, outcomes)
    return 0


def ask(program: Path, scenario: arms.Scenario, case: str, method: str, seeds: int) -> Outcome:
    asked = []
    for seed in range(seeds):
        options = options_t()
        options.planner, options.objective = METHODS[method]
        options.seed = seed
        asked.append(options)
    answers, times = arms.plan_all(program, scenario, asked)
    found = [a for a in answers.values() if a.status == path_t.OK]
    travel, duration = (float(np.median([getattr(a, k) for a in found])) if found else np.nan for k in ("travel", "duration"))
    best = min(found, key=lambda a: a.travel) if found else None
    return Outcome(case, method, len(found), len(answers), travel, duration, float(np.median(times)), best)


def draw(out: Path, folder: Path, outcomes: list[Outcome]) -> None:
    """A row a case: the motion of the least travel, its joint angles and what limits them; the title tells who escaped."""
    figure, axes = plt.subplots(len(CASES), 6, figsize=(26, 4.4 * len(CASES)), layout="constrained")
    for row, case in zip(axes, CASES):
        mine = [o for o in outcomes if o.case == case]
        shown = min((o for o in mine if o.example is not None), key=lambda o: o.travel, default=None)
        if shown is None:
            continue
        scenario = arms.read_scenario(folder / f"{case}.json")
        one = arms.arm_of(scenario.vehicle)
        arm.draw_strip(row[0], scenario, scenario.vehicle, one, scenario.pose, shown.example)
        arm.draw_curves(row[1:], one, arms.base_of(one, scenario.pose)[2], shown.example)
        row[0].set_title(f"{case}, {shown.method}\n" + "\n".join(f"{o.escaped}/{o.seeds} {o.method}" for o in mine), fontsize=7)
    out.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(out, dpi=60)
    plt.close(figure)
    print(out)
