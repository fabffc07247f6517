#!/usr/bin/env python3
"""What it costs to order goals, and how far the order is from the best one, on goals drawn in a scenario's hall.

build/venv/bin/python tools/bench/order_table.py [--scenario FILE] [--goals N ...] [--seeds K] [--optimum SECONDS]

Each row sums up `seeds` sets of goals. pairs: searches of the way between two goals, of all there are. ms, units: of the
order alone. over: its length over the optimum's by CP-SAT of OR-tools (`pip install ortools` into the venv; not needed
otherwise), which begins with the order, on the exact lengths of all pairs, and how many of the sets CP-SAT proved;
unproved ones count with the best it found. bound: the worst over a lower bound, CP-SAT's or by 1-trees. beelines: what
the best order by beelines costs by true ways, over the best known, and of how many sets: those where CP-SAT proved it
the best by beelines. --whole: whole queries in any order by an objective, as `aisle-replay --bench` runs them: paths of
the sets, ms and work units in the median. Exits 1 if up to 12 goals an order is not the best.
"""

from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import offline
import numpy as np
from aisle_tools import hall, names, query, vehicle
from aisle_tools.scenario import read_scenario

ROOT = Path(__file__).resolve().parent.parent.parent
COUNTS = (2, 4, 6, 8, 10, 12, 13, 16, 24, 32, 48, 64)
EXACT_MAX = 12
SCALE = 1e4  # integer costs of 0.1 mm
CLOSE = 1e-4  # relative; what rounding may hide


def main() -> int:
    args = parse()
    scene = hall.text(read_scenario(args.scenario, args.margin), args.margin, 0)
    print(f"{args.scenario.stem}: {args.seeds} sets of goals each")
    print(
        f"{'goals':>5} {'pairs':>12} {'rounds':>6} {'units':>8} {'ms':>7} {'max ms':>7} {'over':>8} {'worst':>8} "
        f"{'proved':>6} {'bound':>7} {'beelines':>9}"
    )
    rows, missed = [], 0
    for count in args.goals:
        runs = [run(args, scene, count, seed) for seed in range(1, args.seeds + 1)]
        rows.append(row(count, runs))
        if args.whole:
            print(f"{'':>5} {whole(args, runs)}", flush=True)
        missed += sum(count <= EXACT_MAX and r.get("ratio", 1.0) > 1.0 + CLOSE for r in runs)
    if args.json is not None:
        args.json.write_text(json.dumps(rows, indent=1) + "\n")
    return 1 if missed else 0


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--scenario", type=Path, default=ROOT / "tests" / "data" / "scenarios" / "factory_big.json")
    parser.add_argument("--goals", type=int, nargs="*", default=COUNTS, metavar="N")
    parser.add_argument("--seeds", type=int, default=5, metavar="K", help="sets of goals for each number of them")
    parser.add_argument("--margin", type=float, default=-1.0, help="m; negative = none (default)")
    parser.add_argument("--optimum", type=float, default=20.0, metavar="S", help="seconds for each optimum; 0: none")
    parser.add_argument("--program", type=Path, default=ROOT / "build" / "release" / "bench-order")
    parser.add_argument("--whole", choices=[o.lower() for o in names.OBJECTIVES[:4]], metavar="OBJECTIVE")
    parser.add_argument("--replay", type=Path, default=ROOT / "build" / "release" / "aisle-replay", metavar="PROGRAM")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the rows as JSON too")
    return parser.parse_args()


def run(args: argparse.Namespace, scene: str, count: int, seed: int) -> dict:
    words = [str(args.program), str(count), str(seed)]
    done = subprocess.run(words, input=scene, text=True, capture_output=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{count} goals, seed {seed}: {done.stderr}")
    out = json.loads(done.stdout)
    cost, beeline = ([out[k][i * count : (i + 1) * count] for i in range(count + 1)] for k in ("cost", "beeline"))
    told = length(cost, out["order"])
    if abs(told - out["length"]) > 1e-6:
        sys.exit(f"{count} goals, seed {seed}: told {out['length']}, is {told}")
    if args.optimum > 0.0:
        best, proved, bound = optimum(cost, out["order"], args.optimum)
        blind, blind_proved, _ = optimum(beeline, None, args.optimum)
        least = min(length(cost, best), told)
        bound = max(bound, tree_bound(np.array(cost), told))
        out |= {"ratio": told / least, "proved": proved, "bound": told / bound}
        out |= {"blind": length(cost, blind) / least} if blind_proved else {}
    return out


def whole(args: argparse.Namespace, runs: list[dict]) -> str:
    scenario = read_scenario(args.scenario, args.margin)
    shape = {"footprint": scenario.footprint} if scenario.footprint else {"radius": scenario.radius}
    legs = [query.Leg(str(i), r["places"][-1], r["places"][:-1]) for i, r in enumerate(runs)]
    options = argparse.Namespace(planner="auto", objective=args.whole, interpolation="spline", seed=0, work_units=0)
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "order.log"
        offline.write_log(options, log, scenario.world, vehicle.make({**shape, "margin": args.margin}), legs, any_order=True)
        timed = offline.timed(args.replay, log, 3)
    paths = sum(t["status"] == "OK" for t in timed)
    ms, units = (statistics.median(t[k] for t in timed) for k in ("ms_median", "work_units"))
    return f"whole queries, {args.whole}: {paths} of {len(timed)} paths, {ms:.1f} ms, {units:.0f} units"


def length(cost: list[list[float]], order: list[int]) -> float:
    return sum(cost[a][b] for a, b in zip([len(order), *order], order))


def optimum(cost: list[list[float]], hint: list[int] | None, seconds: float) -> tuple[list[int], bool, float]:
    """The shortest open order from the start: a circuit with free arcs back to it."""
    from ortools.sat.python import cp_model

    n = len(cost[0])
    model = cp_model.CpModel()
    arcs, terms = [], []
    next_of = dict(zip([n, *hint], hint)) if hint else {}
    for i in range(n + 1):
        for j in range(n + 1):
            if i != j:
                var = model.new_bool_var("")
                arcs.append((i, j, var))
                if j < n:
                    terms.append(round(cost[i][j] * SCALE) * var)
                if hint:
                    model.add_hint(var, next_of.get(i, n) == j)
    model.add_circuit(arcs)
    model.minimize(sum(terms))
    solver = cp_model.CpSolver()
    solver.parameters.max_time_in_seconds = seconds
    solver.parameters.num_workers = 2
    status = solver.solve(model)
    if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        return hint or list(range(n)), False, 1e-9
    follow = {i: j for i, j, var in arcs if solver.value(var)}
    order, at = [], n
    while (at := follow[at]) != n:
        order.append(at)
    return order, status == cp_model.OPTIMAL, max(solver.best_objective_bound / SCALE, 1e-9)


def tree_bound(cost: np.ndarray, known: float, rounds: int = 400) -> float:
    """By 1-trees (Held & Karp 1970): a path is a spanning tree of degrees 1 at the start, 1 at its end, 2 elsewhere."""
    n = cost.shape[1]
    even = np.zeros((n + 1, n + 1))
    even[:, :n], even[:n, n] = cost, cost[n]
    penalty, best, pace = np.zeros(n + 1), 0.0, 1.0
    for _ in range(rounds):
        weight = even + penalty[:, None] + penalty[None, :]
        degree, total, inside = np.zeros(n + 1), 0.0, np.zeros(n + 1, bool)
        near, of = weight[n].copy(), np.full(n + 1, n)
        inside[n] = True
        for _ in range(n):
            at = int(np.argmin(np.where(inside, np.inf, near)))
            inside[at] = True
            total += near[at]
            degree[at] += 1
            degree[of[at]] += 1
            closer = weight[at] < near
            near, of = np.where(closer, weight[at], near), np.where(closer, at, of)
        last = int(np.argmin(penalty[:n]))
        least = total - penalty[n] - 2.0 * penalty[:n].sum() + penalty[last]
        best = max(best, least)
        off = degree - 2.0
        off[n] += 1.0
        off[last] += 1.0
        if not off.any():
            break
        pace *= 0.99
        penalty += pace * (known - least) / (off @ off) * off
    return best


def row(count: int, runs: list[dict]) -> dict:
    pairs = count * (count + 1) // 2
    known = [r for r in runs if "ratio" in r]
    blind = [r["blind"] for r in runs if "blind" in r]
    out = {
        "goals": count,
        "pairs": pairs,
        "searches": statistics.mean(r["searches"] for r in runs),
        "rounds": statistics.mean(r["rounds"] for r in runs),
        "units": statistics.mean(r["units"] for r in runs),
        "ms": statistics.median(r["ms"] for r in runs),
        "ms_max": max(r["ms"] for r in runs),
        "over": statistics.mean(r["ratio"] for r in known) if known else None,
        "worst": max(r["ratio"] for r in known) if known else None,
        "proved": sum(r["proved"] for r in known),
        "bound": max(r["bound"] for r in known) if known else None,
        "beelines": statistics.mean(blind) if blind else None,
        "beelines_sets": len(blind),
    }
    ratios = " ".join(f"{out[k]:>8.5f}" if known else f"{'-':>8}" for k in ("over", "worst"))
    bound = f"{out['bound']:>7.4f}" if known else f"{'-':>7}"
    beelines = f"{out['beelines']:>7.4f}/{len(blind)}" if blind else f"{'-':>9}"
    print(
        f"{count:>5} {out['searches']:>6.1f}/{pairs:<5} {out['rounds']:>6.1f} {out['units']:>8.0f} {out['ms']:>7.2f} "
        f"{out['ms_max']:>7.2f} {ratios} {out['proved']:>6} {bound} {beelines}",
        flush=True,
    )
    return out


if __name__ == "__main__":
    sys.exit(main())
