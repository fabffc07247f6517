"""The flight recorder: what a live daemon was given and answered, played back byte for byte."""

import subprocess

from aisle import path_t
from aisle_tools import query
from harness import AISLE_REPLAY
from test_driving import Driver, goal_list, options


def test_a_recording_of_a_live_run_gives_every_path_again(make_daemon, data, tmp_path):
    record = tmp_path / "flight.log"
    daemon = make_daemon("--record", str(record))
    path = data / "scenarios" / "storage_lr.json"
    daemon.aisle("map", path)
    daemon.aisle("vehicle", "--scenario", path)
    driver = Driver(daemon)
    driver.pose = (1.0, 5.0, 0.0)
    driver.spin(0.3)
    daemon.bus.publish("GOALS", goal_list(1, (19.0, 5.0)))
    for ident in range(1, 6):  # queries between poses, so that the work is cut by chance
        leg = query.Leg(str(ident), (1.0, 1.0 + ident, 0.0), [(19.0, 9.0 - ident)])
        daemon.bus.publish("QUERY", query.make_query(leg, ident, 1, options(), True))
        driver.spin(0.1)
    driver.spin(1.2)
    daemon.bus.publish("GOALS", goal_list(2, (10.0, 1.0), (19.0, 9.0)))
    driver.spin(1.2)
    assert len(daemon.replies) == 5 and any(p.status == path_t.OK for _, p in daemon.paths)
    assert daemon.stop() == 0
    done = subprocess.run([AISLE_REPLAY, "--prefix", daemon.prefix, "--check", str(record)], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "differ" not in done.stderr
