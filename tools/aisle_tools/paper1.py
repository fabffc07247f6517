"""aisle paper 1: safety paths by PSO in a factory store (Praserttaweelap, Kaitwanidvilai, Aoyama 2018), beside ours."""

from __future__ import annotations

import argparse
import dataclasses
import json
import math
import subprocess
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import matplotlib
import numpy as np
from aisle import options_t, path_t, query_t, vehicle_t

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

from aisle_tools import geometry, hall, layouts, names, query, risk, vehicle  # noqa: E402
from aisle_tools.bus import LogWriter, Recording  # noqa: E402
from aisle_tools.check import Obstacles, check_path  # noqa: E402
from aisle_tools.errors import UserError  # noqa: E402
from aisle_tools.plot import draw_world, view_box  # noqa: E402
from aisle_tools.scenario import Scenario, read_scenario  # noqa: E402
from aisle_tools.world import World  # noqa: E402

ALPHA, BETA, WALL = 1.05, 2.0, 0.25  # as in src/plan/paper_swarm.h
BETA_SHORTEST = 1e-6  # length alone, feasibility first
WEIGHT = 15.0  # risk_weight of SAFEST, as in src/plan/objective.h
CREEP = 0.5  # m, creep_clearance of the default vehicle
KINDS = {"linear": options_t.LINEAR, "spline": options_t.SPLINE}
PAPER_CONVERGED = {"linear": 25.2801, "spline": 25.8663}
PAPER_PAIRS = [  # (what, shortest L, OA, safety L, OA)
    ("fig. 18, changed layout", 18.81, 0.165, 22.29, 0.007),
    ("fig. 19, new layout, right to left", 21.87, 0.2244, 25.51, 0.0081),
    ("fig. 20, new layout, left to right", 21.75, 0.2062, 28.97, 0.0083),
]
COLUMNS = ((2.4, 5.0), (6.2, 8.8), (11.2, 13.8), (15.0, 17.6))  # m, of the shelves in x
COLOURS = {
    "paper, shortest": "#d9a441",
    "paper, safety": "#d62728",
    "SHORTEST": "#7fb3d9",
    "SAFEST": "#1f4e9c",
    "least exposure (grid)": "#2ca02c",
}


@dataclass
class Case:
    name: str
    scenario: Scenario
    pair: int | None  # of PAPER_PAIRS
    obstacles: Obstacles = field(init=False)

    def __post_init__(self) -> None:
        self.obstacles = Obstacles(self.scenario.world)


@dataclass
class Ask:
    name: str
    planner: int
    objective: int
    kind: str = "spline"
    samples: int = 0
    beta: float = 0.0
    seed: int = 0


def shifted(scenario: Scenario, name: str, by: tuple[float, ...]) -> Scenario:
    """The store with its columns of shelves moved in y: a layout that is not straight any more."""
    polygons = []
    for p in scenario.world.polygons:
        x = float(p.vertices[:, 0].mean())
        move = next((dy for (a, b), dy in zip(COLUMNS, by) if a < x < b and p.vertices[:, 0].min() >= a), 0.0)
        polygons.append(dataclasses.replace(p, vertices=p.vertices + np.array([0.0, move])))
    world = dataclasses.replace(scenario.world, name=name, polygons=polygons)
    return dataclasses.replace(scenario, world=world)


def cases(folder: Path, margin: float) -> list[Case]:
    lr, rl = (read_scenario(folder / f"storage_{way}.json", margin) for way in ("lr", "rl"))
    return [
        Case("storage_lr", lr, None),
        Case("storage_rl", rl, None),
        Case("changed_lr", shifted(lr, "changed_lr", (0.0, 0.6, 0.0, 0.6)), 0),
        Case("new_rl", shifted(rl, "new_rl", (0.0, 0.6, -0.5, 0.0)), 1),
        Case("new_lr", shifted(lr, "new_lr", (0.0, 0.6, -0.5, 0.0)), 2),
    ]


# ---- the paper's measures, on our own terms: independent of src/


def avoidance(world: World, r: float, points: np.ndarray) -> float:
    """OA (eq. 5), the largest of any obstacle at each point, averaged; walls have no circle."""
    x0, y0, x1, y1 = world.bounds
    most = np.zeros(len(points))
    for p in world.obstacles():
        lo, hi = p.vertices.min(axis=0), p.vertices.max(axis=0)
        big_r = 0.5 * float(np.hypot(*(hi - lo)))
        if big_r > WALL * min(x1 - x0, y1 - y0):
            continue
        d = np.hypot(*(points - 0.5 * (lo + hi)).T)
        most = np.maximum(most, 1.0 - ALPHA * d / (big_r + r))
    return float(most.mean())


def line_of(reply: path_t) -> np.ndarray:
    return np.array([(s.x, s.y) for s in geometry.sample(reply.waypoints, 0.01)])


def figures(case: Case, margin: float, points: np.ndarray) -> dict[str, float]:
    radius = case.scenario.radius
    even = risk.resample(points, 0.01)
    return {
        "L": risk.length(points),
        "OA": avoidance(case.scenario.world, radius, even),
        "clearance": float(risk.gaps(case.obstacles, radius, even).min()),
        "exposure": risk.exposure(case.obstacles, radius, CREEP, points),
    }


# ---- runs


def program(args: argparse.Namespace, name: str) -> Path:
    path = args.programs / name
    if not path.is_file():
        raise UserError(f"{path}: not found; build it or give --programs DIR")
    return path


def call(words: list, text: str | None = None) -> str:
    done = subprocess.run([str(w) for w in words], input=text, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise UserError(f"{' '.join(str(w) for w in words)}: exit {done.returncode}: {done.stderr.strip()}")
    return done.stdout


def asks_of(case: Case, seeds: int, all_kinds: bool) -> list[Ask]:
    out = [Ask("SHORTEST", options_t.AUTO, options_t.SHORTEST), Ask("SAFEST", options_t.AUTO, options_t.SAFEST)]
    for samples in (100, 200) if all_kinds else (100,):
        for kind in KINDS:
            for seed in range(1, seeds + 1):
                out.append(Ask("paper, safety", options_t.PSO, options_t.PAPER, kind, samples, 0.0, seed))
    for seed in range(1, seeds + 1):
        out.append(Ask("paper, shortest", options_t.PSO, options_t.PAPER, "spline", 100, BETA_SHORTEST, seed))
    return out


def query_of(scenario: Scenario, ask: Ask, ident: int) -> query_t:
    options = options_t()
    options.planner, options.objective, options.interpolation = ask.planner, ask.objective, KINDS[ask.kind]
    options.num_samples, options.risk_weight, options.seed = ask.samples, ask.beta, ask.seed
    return query.make_query(query.Leg(str(ident), scenario.start, scenario.goals), ident, 1, options, False)


def answers(args: argparse.Namespace, case: Case, asks: list[Ask]) -> list[path_t]:
    """One reply per ask, through aisle-replay, without a bus."""
    replay = program(args, "aisle-replay")
    with tempfile.TemporaryDirectory() as folder:
        log, out = Path(folder) / "in.log", Path(folder) / "out.log"
        writer = LogWriter(log, "AISLE")
        for name, part in layouts.make_messages(case.scenario.world, 1, 1, 0):
            writer.publish(name, part)
        writer.publish("VEHICLE", vehicle_of(case, args.margin))
        for i, ask in enumerate(asks):
            writer.publish("QUERY", query_of(case.scenario, ask, i + 1))
        writer.close()
        call([replay, log, "--out", out])
        replies = {r.query_id: r for r in Recording(out, "AISLE").replies}
    missing = [i for i in range(1, len(asks) + 1) if i not in replies]
    if missing:
        raise UserError(f"{case.name}: queries {missing} were not answered")
    return [replies[i + 1] for i in range(len(asks))]


def vehicle_of(case: Case, margin: float) -> vehicle_t:
    msg = vehicle.make({"radius": case.scenario.radius, "margin": margin if margin > 0.0 else -1.0})
    msg.vehicle_revision = 1
    return msg


def trace(args: argparse.Namespace, case: Case, kind: str, samples: int, seed: int, skip: bool = False) -> dict:
    words = [program(args, "paper-swarm"), KINDS[kind], samples, seed, BETA, int(skip)]
    return json.loads(call(words, hall.text(case.scenario, args.margin)))


# ---- report


def median(values: list[float]) -> float:
    return float(np.median(values)) if values else math.nan


def converge(args: argparse.Namespace, case: Case) -> dict:
    """Traces [iterations, 4] of the first seeds by (kind, samples, skip)."""
    out = {}
    for kind in KINDS:
        for samples in (100, 200):
            out[kind, samples] = [np.array(trace(args, case, kind, samples, s)["trace"]) for s in seeds_traced(args)]
    return out


def seeds_traced(args: argparse.Namespace) -> range:
    return range(1, min(args.seeds, 10) + 1)


def print_convergence(traces: dict, flawed: list[dict]) -> None:
    print("Convergence on storage_lr (median of the seeds traced; the paper's hall and units differ from ours)")
    print(f"{'interpolation':<14} {'samples':>7} {'paper L':>9} {'L':>8} {'OA':>8} {'F':>8} {'F below linear from':>20}")
    for (kind, samples), runs in traces.items():
        f, length, oa = (feasible_median(runs, k)[-1] for k in range(3))
        paper = f"{PAPER_CONVERGED[kind]:.4f}" if samples == 100 else "-"
        since = "-" if kind == "linear" else below_from(traces["linear", samples], runs)
        print(f"{kind:<14} {samples:>7} {paper:>9} {length:>8.4f} {oa:>8.4f} {f:>8.4f} {since:>20}")
    print_flaw(flawed)
    print("the paper: spline F below linear F from iteration 43 of 200 on")


def print_flaw(flawed: list[dict]) -> None:
    """How the paper's sampling, first leg left out, is judged by samples of the whole way."""
    thought = [r for r in flawed if r["points"]]
    unsafe = sum(1 for r in thought if r["whole"][3] > 0.0)
    print(f"first leg left out (spline, 100): {len(thought)}/{len(flawed)} seem feasible, {unsafe} of them are not")


def below_from(linear: list[np.ndarray], spline: list[np.ndarray]) -> str:
    """Iteration from which on the median F of the spline stays below that of the lines."""
    gap = feasible_median(linear, 0) - feasible_median(spline, 0)
    above = np.flatnonzero(~(gap > 0.0))
    if len(above) == 0:
        return "1"
    return str(above[-1] + 2) if above[-1] + 1 < len(gap) else "never"


def judge_case(args: argparse.Namespace, case: Case, all_kinds: bool) -> dict:
    asks = asks_of(case, args.seeds, all_kinds)
    replies = answers(args, case, asks)
    body = vehicle.body(vehicle_of(case, args.margin))
    rows: dict[tuple, list] = {}
    faults = []
    for i, (ask, reply) in enumerate(zip(asks, replies)):
        row = rows.setdefault((ask.name, ask.kind, ask.samples), [])
        if not names.is_path(reply):
            row.append((None, names.reason(reply)))
            continue
        report = check_path(reply, case.obstacles, body, query_of(case.scenario, ask, i + 1))
        faults += [f"{case.name} {ask.name}: {f}" for f in report.faults]
        row.append((line_of(reply), ""))
    s = case.scenario
    start, goal = s.start[:2], s.goals[0][:2]
    least = risk.least_exposure(case.obstacles, s.radius, args.margin, CREEP, start, goal)
    exact = risk.shortest(case.obstacles, s.radius + args.margin, start, goal)
    return {"case": case, "rows": rows, "faults": faults, "least": least, "exact": exact}


def print_case(args: argparse.Namespace, judged: dict) -> dict:
    case, rows = judged["case"], judged["rows"]
    print(f"\n{case.name}: exact shortest for margin {args.margin:g} m is {judged['exact']:.3f} m")
    if case.pair is not None:
        what, l0, oa0, l1, oa1 = PAPER_PAIRS[case.pair]
        print(f"  the paper, {what}: shortest L {l0} OA {oa0}, safety L {l1} OA {oa1}: {l1 / l0 - 1:+.1%}, {oa0 / oa1:.0f} times")
    print(f"  {'method':<34} {'proved':>8} {'L':>8} {'OA':>8} {'clearance':>9} {'exposure':>9} {'over exact':>10}")
    out = {}
    for (name, kind, samples), ways in rows.items():
        label = name if samples == 0 else f"{name}, {kind}, {samples}"
        found = [figures(case, args.margin, w) for w, _ in ways if w is not None]
        out[label] = print_row(label, f"{len(found)}/{len(ways)}", found, judged["exact"])
        causes = sorted({cause.split(",")[0].split(" (")[0] for w, cause in ways if w is None})
        if causes:
            print(f"  {'':<34} refused: {', '.join(causes)}")
    if len(judged["least"]):
        found = [figures(case, args.margin, judged["least"])]
        out["least"] = print_row("least exposure (grid)", "-", found, judged["exact"])
    print_works(args, out, judged["exact"])
    return out


def print_row(label: str, proved: str, found: list[dict], exact: float) -> dict:
    row = {key: median([f[key] for f in found]) for key in ("L", "OA", "clearance", "exposure")}
    print(
        f"  {label:<34} {proved:>8} {row['L']:>8.3f} {row['OA']:>8.4f} {row['clearance']:>9.3f} {row['exposure']:>9.3f} "
        f"{row['L'] / exact - 1.0:>10.1%}"
    )
    return {**row, "proved": proved}


def print_works(args: argparse.Namespace, out: dict, exact: float) -> None:
    safe, least = out["SAFEST"], out.get("least")
    checks = [("clearance >= margin", safe["clearance"] >= args.margin - 1e-6)]
    if least is not None:
        checks.append(("exposure 0 or within 2 % of least", safe["exposure"] <= max(1.02 * least["exposure"], 1e-6)))
    checks.append(("length within 10 % of exact", safe["L"] <= 1.1 * exact))
    if least is not None:
        own, best = (row["L"] + WEIGHT * row["exposure"] for row in (safe, least))
        print(f"  SAFEST by its own measure, L + {WEIGHT:g} exposure: {own:.3f}, the grid's way {best:.3f}, ratio {own / best:.3f}")
    print("  SAFEST: " + ", ".join(f"{what}: {'yes' if ok else 'NO'}" for what, ok in checks))


# ---- pictures


def feasible_median(runs: list[np.ndarray], column: int) -> np.ndarray:
    """Over the runs that have a feasible best; nan while that is less than half of them."""
    stack = np.array([np.where(r[:, 3] > 0.0, math.inf, r[:, column]) for r in runs])
    enough = np.isfinite(stack).sum(axis=0) * 2 >= len(runs)
    return np.array([median(s[np.isfinite(s)].tolist()) if ok else math.nan for s, ok in zip(stack.T, enough)])


def draw_convergence(traces: dict, path: Path) -> None:
    figure, axes = plt.subplots(1, 3, figsize=(13.0, 4.2), layout="constrained")
    for (kind, samples), runs in traces.items():
        colour = {"linear": "#1f4e9c", "spline": "#e07b1a"}[kind]
        style = {100: "-", 200: "--"}[samples]
        for k, axis in enumerate(axes):
            middle = feasible_median(runs, k)
            axis.plot(np.arange(1, len(middle) + 1), middle, style, color=colour, label=f"{kind}, {samples} samples")
    for axis, name in zip(axes, ("fitness F (m)", "length L (m)", "obstacle avoidance OA")):
        axis.set_xlabel("iteration")
        axis.set_title(name)
        axis.grid(alpha=0.3)
    axes[2].legend(fontsize=8)
    figure.suptitle("The paper's swarm on storage_lr: median of the feasible bests, from where half the seeds have one", fontsize=11)
    save(figure, path)


def draw_paths(judged: list[dict], path: Path) -> None:
    figure, axes = plt.subplots(3, 2, figsize=(14.0, 13.5), layout="constrained")
    for axis, one in zip(axes.ravel(), judged):
        draw_case(axis, one)
    spare = axes.ravel()[len(judged)]
    spare.axis("off")
    handles = [plt.Line2D([], [], color=c, lw=2.2, ls=line_style(n), label=n) for n, c in COLOURS.items()]
    spare.legend(handles=handles, loc="center", fontsize=12, title="paths; the paper's: first proved seed, spline, 100 samples")
    save(figure, path)


def line_style(name: str) -> str:
    return ":" if name.startswith("least") else "-"


def draw_case(axis: plt.Axes, one: dict) -> None:
    case = one["case"]
    x0, y0, x1, y1 = view_box(case.scenario.world)
    draw_world(axis, case.scenario.world)
    ways = {"least exposure (grid)": one["least"]}
    for (name, kind, samples), found in one["rows"].items():
        proved = [w for w, _ in found if w is not None]
        if proved and kind == "spline" and samples in (0, 100):
            ways[name] = proved[0]
    for name, colour in COLOURS.items():
        if len(ways.get(name, ())):
            axis.plot(*ways[name].T, color=colour, lw=2.0, ls=line_style(name), zorder=5)
    axis.plot(*case.scenario.start[:2], "o", ms=8, mfc="#2ca02c", mec="white", zorder=6)
    axis.plot(*case.scenario.goals[0][:2], "*", ms=13, mfc="#ff7f0e", mec="white", zorder=6)
    axis.set(xlim=(x0, x1), ylim=(y0, y1), aspect="equal", title=case.name, xlabel="x (m)", ylabel="y (m)")


def save(figure: plt.Figure, path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=100)
    plt.close(figure)
    print(path)


def run(args: argparse.Namespace) -> int:
    made = cases(args.scenarios, args.margin)
    traces = converge(args, made[0])
    flawed = [trace(args, made[0], "spline", 100, s, skip=True) for s in seeds_traced(args)]
    print_convergence(traces, flawed)
    judged, out = [], {}
    for i, case in enumerate(made):
        judged.append(judge_case(args, case, all_kinds=i == 0))
        out[case.name] = print_case(args, judged[-1])
    faults = [f for j in judged for f in j["faults"]]
    print(f"\nindependent checker: {len(faults)} faults")
    for fault in faults[:10]:
        print(f"  {fault}")
    if args.json is not None:
        args.json.write_text(json.dumps(out, indent=1))
    if args.out is not None:
        draw_convergence(traces, args.out / "paper1_convergence.png")
        draw_paths(judged, args.out / "paper1_paths.png")
    return 1 if faults else 0
