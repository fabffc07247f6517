"""aisle sim: set-up, options passed on, truth and picture; the drives themselves are tested in tests/sim."""

import argparse
import json
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest
from aisle import goal_list_t, layout_t, pose_t, vehicle_t
from aisle_tools import cli, sim
from aisle_tools.bus import read_events
from aisle_tools.errors import UserError
from PIL import Image

SIM = Path(os.environ.get("AISLE_SIM", "nowhere/aisle-sim"))
needs_program = pytest.mark.skipif(not SIM.is_file(), reason="AISLE_SIM names no program")


def parse(*words):
    parser = argparse.ArgumentParser()
    cli.add_common(parser, "sim")
    sim.configure(parser)
    return parser.parse_args([str(w) for w in words])


@pytest.fixture
def scenario(data):
    return data / "scenarios" / "field_12_disc.json"


def test_setup_holds_layout_vehicle_pose_and_goals(tmp_path, scenario):
    args = parse("--scenario", scenario, "--out", tmp_path, "--goal", "3,4,1", "--goal", "5,6", "--margin", "0.2")
    world, found = sim.read_hall(args)
    msg = vehicle_t()
    sim.write_setup(args, world, found, msg, tmp_path / "setup.log")
    kinds = {"LAYOUT": layout_t, "VEHICLE": vehicle_t, "POSE": pose_t, "GOALS": goal_list_t}
    read = [(c.removeprefix("AISLE_"), d) for _, c, d in read_events(tmp_path / "setup.log")]
    events = {name: kinds[name].decode(data) for name, data in read}
    assert set(events) == set(kinds)
    assert (events["POSE"].x, events["POSE"].y) == (found.start[0], found.start[1])
    goals = events["GOALS"].goals
    assert [(g.x, g.y) for g in goals] == [(3.0, 4.0), (5.0, 6.0)]
    assert goals[0].theta == 1.0 and goals[0].tolerance_theta == 0.0 and goals[1].tolerance_theta > 3.2


def test_setup_is_the_same_bytes_each_time(tmp_path, scenario):
    args = parse("--scenario", scenario, "--out", tmp_path)
    world, found = sim.read_hall(args)
    logs = []
    for name in ("a.log", "b.log"):
        sim.write_setup(args, world, found, vehicle_t(), tmp_path / name)
        logs.append([(c, d) for _, c, d in read_events(tmp_path / name) if not c.endswith("POSE")])
    assert logs[0] == logs[1]


@pytest.mark.parametrize("words", [[], ["--map", "hall.yaml"], ["--map", "x.json"]])
def test_what_is_missing_is_named(tmp_path, data, words):
    words = [str(data / "ros_maps" / "nav2_depot.yaml") if w == "hall.yaml" else w for w in words]
    args = parse(*words, "--out", tmp_path)
    with pytest.raises(UserError):
        world, found = sim.read_hall(args)
        sim.stops_of(args, found)


def test_a_missing_program_is_an_error_of_the_user(tmp_path, scenario):
    assert cli.main(["sim", "--scenario", str(scenario), "--out", str(tmp_path), "--programs", str(tmp_path)]) == 2


@needs_program
def test_a_run_leaves_log_figures_truth_and_picture(tmp_path, scenario):
    out = tmp_path / "run"
    words = ["sim", "--scenario", str(scenario), "--out", str(out), "--programs", str(SIM.parent), "--margin", "0.1"]
    assert cli.main(words) == 0
    figures = json.loads((out / "sim.json").read_text())
    assert figures["arrived"] and figures["collisions"] == 0 and figures["visited"] == figures["goals"]
    track = sim.read_truth(out / "truth.csv")[0].array
    args = parse("--scenario", scenario, "--out", out)
    _, found = sim.read_hall(args)
    assert np.allclose(track[0, 1:3], found.start[:2], atol=0.01)
    assert np.allclose(track[-1, 1:3], found.goals[-1][:2], atol=0.1)
    assert len(Image.open(out / "tracks.png").convert("RGB").getcolors(1 << 24)) > 50
    assert "seed 0: arrived" in (out / "sim.txt").read_text()


@needs_program
def test_the_same_seed_gives_the_same_log_another_one_another(tmp_path, scenario):
    logs = []
    for name, seed in (("a", 5), ("b", 5), ("c", 6)):
        out = tmp_path / name
        words = ["sim", "--scenario", str(scenario), "--out", str(out), "--programs", str(SIM.parent), "--seed", str(seed)]
        cli.main([*words, "--movers", "person:4,jumps:2:0.8", "--time", "10"])
        logs.append((out / "run.log").read_bytes())
    assert logs[0] == logs[1] != logs[2]


@needs_program
def test_recorded_people_walk_where_they_are_put(tmp_path, data):
    out = tmp_path / "run"
    hall = str(data / "ros_maps" / "thor_hall_1.yaml")
    words = ["sim", "--map", hall, "--start", "-4.125,-6.725", "--goal", "-8.625,-1.425", "--radius", "0.3"]
    words += ["--out", str(out)]
    words += ["--programs", str(SIM.parent), "--time", "20", "--tracks", str(data / "tracks" / "thor_exp1_run2.csv")]
    assert cli.main(words) in (0, 1)
    tracks = sim.read_truth(out / "truth.csv")
    people = [t for ident, t in tracks.items() if ident != 0]
    assert len(people) >= 3 and {t.kind for t in people} == {"track"}
    first = people[0].array
    vehicle = tracks[0].array
    assert np.hypot(*(vehicle[-1, 1:3] - vehicle[0, 1:3])) > 1.0
    assert np.hypot(*np.diff(first[:, 1:3], axis=0).T).max() <= 3.0 * 0.1 + 1e-6


@needs_program
@pytest.mark.parametrize(
    "words",
    [["--movers", "persons:3"], ["--movers", "person"], ["--tracks", "none.csv"], ["--sources", "9"], ["--time", "-1"]],
)
def test_wrong_options_end_with_2_and_one_line(tmp_path, scenario, capsys, words):
    base = ["sim", "--scenario", str(scenario), "--out", str(tmp_path / "o"), "--programs", str(SIM.parent)]
    assert cli.main([*base, *words]) == 2
    assert len(capsys.readouterr().err.strip().splitlines()) == 1


def run_program(*words):
    return subprocess.run([str(SIM), *words], capture_output=True, text=True, timeout=100)


@needs_program
def test_a_batch_names_the_seeds_that_show_its_collisions_again(tmp_path):
    done = run_program("--batch", "60", "--kind", "person", "--blind", "--json", str(tmp_path / "b.json"))
    assert done.returncode == 1
    sums = json.loads((tmp_path / "b.json").read_text())
    lines = [line for line in done.stdout.splitlines() if line.startswith("COLLISION")]
    assert sums["encounters"] >= 60 and sums["drives_with_collision"] == len(lines) > 0
    seed, when = lines[0].split("seed ")[1].split(",")[0], lines[0].split("; ")[1].split(" s ")[0]
    again = run_program("--drawn", seed, "--kind", "person", "--blind")
    assert again.returncode == 1 and f"{when} s: collision with" in again.stdout


@needs_program
def test_a_drawn_drive_of_a_slow_planner_leaves_a_record(tmp_path):
    log = tmp_path / "record.log"
    done = run_program("--drawn", "7", "--kind", "agv", "--units-per-ms", "500", "--out", str(log))
    assert done.returncode in (0, 1) and done.stderr == ""
    replay = SIM.parent / "aisle-replay"
    if replay.is_file():
        told = subprocess.run([str(replay), str(log), "--check"], capture_output=True, text=True, timeout=100)
        assert told.returncode == 0, told.stdout


@needs_program
def test_leases_lapse_where_paths_are_long_under_way_and_nobody_is_hit(tmp_path, scenario):
    out = tmp_path / "run"
    cli.main(["sim", "--scenario", str(scenario), "--out", str(out), "--programs", str(SIM.parent), "--margin", "0.1"])
    lapses = []
    for late in ("0", "0.05"):
        words = ("--movers", "person:8", "--seed", "4", "--time", "60", "--late", late, "--json", str(tmp_path / "s.json"))
        done = run_program(str(out / "setup.log"), *words)
        assert done.returncode in (0, 1) and done.stderr == ""
        figures = json.loads((tmp_path / "s.json").read_text())
        assert figures["collisions"] == 0 and figures["way"] > 1.0
        lapses.append(figures["lapses"])
    assert lapses[0] == 0 < lapses[1]


@needs_program
@pytest.mark.parametrize(
    "words",
    [
        [],
        ["x.log", "--drawn", "1"],
        ["--batch", "many"],
        ["--drawn", "1.5"],
        ["--drawn", "1", "--kind", "ghost"],
        ["--drawn", "1", "--count", "400"],
        ["--batch", "1", "--drives", "-1"],
        ["--batch", "1", "--units-per-ms", "x"],
        ["x.log", "--faults", "flood:1:1"],
        ["x.log", "--late", "-0.1"],
        ["x.log", "--nonsense"],
    ],
)
def test_wrong_words_end_the_program_with_2_and_one_line(words):
    done = run_program(*words)
    assert done.returncode == 2 and done.stdout == ""
    assert len(done.stderr.strip().splitlines()) == 1
