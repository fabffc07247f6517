"""aisled's own options and settings, and the replay of what was recorded."""

import shutil
import signal
import subprocess
import time
from pathlib import Path

import lcm
import pytest
from harness import AISLE_REPLAY, AISLED, PATIENCE, URL


def aisled(*words):
    return subprocess.run([AISLED, *map(str, words)], capture_output=True, text=True, timeout=PATIENCE)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("[bus]\nprefix = A B\n", 2),
        ("[vehicle]\n\nv_max = fast\n", 3),
        ("[limits]\ncells = 10\n", 2),
        ("[planner]\nwork_units = 5000\nspeed = 3\n", 3),
        ("[nowhere]\n", 1),
    ],
)
def test_bad_settings_are_one_line_with_file_and_line_and_exit_2(tmp_path, text, line):
    config = tmp_path / "a.ini"
    config.write_text(text)
    for words in (["--check-config"], []):
        done = aisled("--config", config, *words)
        assert done.returncode == 2
        assert done.stderr.count("\n") == 1 and f"{config}:{line}: " in done.stderr


def test_missing_settings_and_unknown_options_exit_2(tmp_path):
    assert aisled("--config", tmp_path / "gone.ini").returncode == 2
    assert aisled("--colour").returncode == 2


def test_version_memory_and_check_config_need_no_bus():
    assert aisled("--version").stdout.startswith("aisled ")
    memory = aisled("--memory")
    assert memory.returncode == 0 and "heap" in memory.stdout.lower() and "stack" in memory.stdout.lower()
    assert aisled("--check-config").returncode == 0


def test_settings_take_effect(make_daemon, tmp_path):
    config = tmp_path / "a.ini"
    config.write_text("[daemon]\nstatus_hz = 20\n[vehicle]\nfootprint_radius = 0.3\nvehicle_revision = 9\n")
    daemon = make_daemon("--config", str(config))
    assert daemon.status.vehicle_revision == 9
    daemon.bus.spin(0.5)
    daemon.statuses.clear()
    daemon.bus.spin(2.0)
    assert 34 <= len(daemon.statuses) <= 44


def logger_program():
    bundled = Path(lcm.__file__).resolve().parent.parent / "bin" / "lcm-logger"
    return str(bundled) if bundled.is_file() else shutil.which("lcm-logger")


def test_recording_of_a_run_replays_to_the_same_bytes(make_daemon, data, tmp_path):
    """Map, vehicle, queries and a goal list, recorded by LCM's own logger."""
    daemon = make_daemon(start=False)
    log = tmp_path / "run.log"
    logger = subprocess.Popen([logger_program(), "-q", "-f", "--lcm-url", URL, str(log)])
    try:
        time.sleep(1.0)
        daemon.start()
        path = data / "scenarios" / "field_12_disc.json"
        daemon.aisle("map", path)
        daemon.aisle("vehicle", "--scenario", path)
        daemon.aisle("query", "--scenario", path)
        daemon.aisle("query", "--scenario", path, "--objective", "shortest", "--interpolation", "linear")
        daemon.aisle("query", "--scenario", path)  # from memory
        daemon.aisle("query", "--scenario", path, "--planner", "prm")
        daemon.aisle("query", "--start", "1,1", "--goal", "190,3", expect=1)
        daemon.aisle("goal", "--goal", "19,19", "--pose", "1,1,0", "--for", "4")
        assert daemon.stop() == 0
        time.sleep(0.5)
    finally:
        logger.send_signal(signal.SIGINT)
        logger.wait(PATIENCE)
    done = subprocess.run(
        [AISLE_REPLAY, "--prefix", daemon.prefix, "--check", str(log)], capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_replay_notices_a_changed_path(daemon, data, tmp_path):
    from aisle import path_t
    from aisle_tools.bus import LogWriter

    path = data / "scenarios" / "field_4_disc.json"
    inputs = tmp_path / "in.log"
    daemon.aisle("map", path, "--log", inputs)
    daemon.aisle("vehicle", "--scenario", path, "--log", inputs, "--revision", "3")
    daemon.aisle("query", "--scenario", path, "--log", inputs)
    wrong = path_t()
    wrong.query_id, wrong.map_id = 1, 1
    log = LogWriter(inputs, daemon.prefix)
    log.publish("REPLY", wrong)
    log.close()
    done = subprocess.run(
        [AISLE_REPLAY, "--prefix", daemon.prefix, "--check", str(inputs)], capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 1, done.stdout + done.stderr
