"""aisle sim over the real daemon on a real bus, in real time."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from harness import AISLED, PATIENCE, URL
from aisle_tools import sim
from aisle_tools.bus import read_events

PROGRAMS = Path(AISLED).parent


def simulate(out, *words):
    line = [sys.executable, "-m", "aisle_tools", "sim", "--lcm-url", URL, "--prefix", f"SIM{os.getpid()}", "--daemon"]
    line += ["--programs", PROGRAMS, "--out", out, "--timeout", PATIENCE, *words]
    return subprocess.run([str(w) for w in line], capture_output=True, text=True, timeout=200)


@pytest.fixture
def hall(tmp_path):
    path = tmp_path / "hall.json"
    boxes = [[[4.0, 0.0], [5.0, 0.0], [5.0, 3.0], [4.0, 3.0]]]
    robot, stops = {"radius": 0.3}, {"start": [1.0, 1.0], "goals": [[8.0, 1.0]]}
    path.write_text(json.dumps({"bounds": [0, 0, 9, 6], "obstacles": boxes, "robot": robot, **stops}))
    return path


def test_a_vehicle_is_driven_over_the_bus_and_the_record_replays(tmp_path, hall):
    done = simulate(tmp_path / "out", "--scenario", hall, "--margin", "0.1")
    assert done.returncode == 0, done.stdout + done.stderr
    figures = json.loads((tmp_path / "out" / "sim.json").read_text())
    assert figures["arrived"] and figures["collisions"] == figures["hall_collisions"] == 0
    cycles, answers, work = (figures[k] for k in ("cycle_ms", "answer_ms", "answer_cpu_ms"))
    assert cycles["count"] > 20 and cycles["p50"] <= cycles["p99"] <= cycles["max"] < 1000.0
    assert answers["count"] == work["count"] <= cycles["count"]
    assert 0.95 < figures["time"] / figures["optimum"] < 1.3
    assert "different 0, missing 0, not recorded 0" in done.stdout
    channels = {c.split("_", 1)[1] for _, c, _ in read_events(tmp_path / "out" / "run.log")}
    assert {"LAYOUT", "VEHICLE", "POSE", "OBSTACLES", "GOALS", "QUERY", "PATH", "REPLY", "STATUS", "DIAG"} <= channels


def test_movers_are_told_to_the_daemon_and_none_is_hit(tmp_path, hall):
    words = ("--movers", "person:2", "--time", "12", "--room", "1.5")
    done = simulate(tmp_path / "out", "--scenario", hall, "--margin", "0.1", *words)
    assert done.returncode in (0, 1), done.stdout + done.stderr
    figures = json.loads((tmp_path / "out" / "sim.json").read_text())
    assert figures["collisions"] == figures["hall_collisions"] == 0
    assert len(sim.read_truth(tmp_path / "out" / "truth.csv")) == 3
    assert "different 0, missing 0, not recorded 0" in done.stdout
