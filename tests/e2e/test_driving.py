"""Goal lists with a pose: the path, its lease, the heartbeat."""

import signal

import pytest
from aisle import path_t, status_t
from aisle_tools import goals, query, vehicle
from aisle_tools.bus import now_us
from aisle_tools.check import Obstacles, check_path
from aisle_tools.scenario import read_scenario

LEASE_US = 1_000_000


def options():
    from aisle import options_t

    return options_t()


def goal_list(revision, *poses):
    from aisle import goal_list_t

    msg = goal_list_t()
    msg.utime, msg.goal_list_id, msg.goal_list_revision, msg.map_id, msg.options = now_us(), 4, revision, 1, options()
    msg.goals = [query.make_goal(i + 11, p, False) for i, p in enumerate(poses)]
    msg.num_goals = len(msg.goals)
    return msg


class Driver:
    """Publishes a standing pose at 20 Hz while it waits."""

    def __init__(self, daemon):
        self.daemon, self.seq, self.pose = daemon, 0, (1.0, 1.0, 0.0)

    def spin(self, seconds, until=lambda: False):
        for _ in range(int(seconds / 0.05)):
            self.seq += 1
            self.daemon.bus.publish("POSE", goals.make_pose(self.pose, self.seq, 1))
            self.daemon.bus.spin(0.05)
            if until():
                return True
        return False


@pytest.fixture
def ready(daemon, data):
    path = data / "scenarios" / "field_12_disc.json"
    daemon.aisle("map", path)
    daemon.aisle("vehicle", "--scenario", path)
    return daemon, Driver(daemon), read_scenario(path).world


def has_path(daemon):
    return any(p.status == path_t.OK for _, p in daemon.paths)


def test_goal_list_gets_a_proved_path_whose_lease_is_renewed(ready):
    daemon, driver, world = ready
    driver.spin(0.3)
    daemon.bus.publish("GOALS", goal_list(1, (19.0, 19.0)))
    assert driver.spin(30.0, lambda: has_path(daemon))
    driver.spin(1.5)  # improvements settle
    begin = len(daemon.paths)
    driver.spin(3.2)
    renewals = daemon.paths[begin:]
    assert 5 <= len(renewals) <= 8
    plain = []
    for _, path in renewals:
        assert path.valid_until_utime - path.utime == LEASE_US
        path.utime = path.valid_until_utime = 0
        plain.append(path.encode())
    assert len(set(plain)) == 1
    gaps = [b - a for (a, _), (b, _) in zip(renewals, renewals[1:])]
    assert all(0.2 < gap < 1.0 for gap in gaps) and sum(gaps) / len(gaps) == pytest.approx(0.5, abs=0.1)
    path = renewals[-1][1]
    assert (path.goal_list_id, path.goal_list_revision, path.map_id, path.query_id) == (4, 1, 1, 0)
    assert path.pose_utime > 0 and path.waypoints[-1].goal_id == 11
    body = vehicle.body(vehicle.make({"radius": 0.3, "margin": -1}))
    report = check_path(path, Obstacles(world), body)
    assert report.ok, report.faults
    driver.spin(0.5)
    status = daemon.status
    assert (status.goal_list_id, status.goal_list_revision, status.path_revision) == (4, 1, path.path_revision)
    assert status.state == status_t.ACTIVE


def test_times_of_renewals_go_on(ready):
    daemon, driver, _ = ready
    driver.spin(0.3)
    daemon.bus.publish("GOALS", goal_list(1, (19.0, 19.0)))
    assert driver.spin(30.0, lambda: has_path(daemon))
    driver.spin(2.2)
    times = [p.utime for _, p in daemon.paths]
    assert times == sorted(times) and len(set(times)) == len(times)
    assert abs(times[-1] - now_us()) < 2_000_000


def test_empty_list_revokes_the_path(ready):
    daemon, driver, _ = ready
    driver.spin(0.3)
    daemon.bus.publish("GOALS", goal_list(1, (19.0, 19.0)))
    assert driver.spin(30.0, lambda: has_path(daemon))
    daemon.bus.publish("GOALS", goal_list(2))
    assert driver.spin(10.0, lambda: daemon.paths[-1][1].status == path_t.NONE)
    driver.spin(0.5)
    count = len([p for _, p in daemon.paths if p.status == path_t.OK])
    driver.spin(1.5)
    assert len([p for _, p in daemon.paths if p.status == path_t.OK]) == count


def test_a_vehicle_that_changes_under_way_has_its_path_withdrawn_and_made_anew(ready):
    daemon, driver, world = ready
    driver.spin(0.3)
    daemon.bus.publish("GOALS", goal_list(1, (19.0, 19.0)))
    assert driver.spin(30.0, lambda: has_path(daemon))
    driver.spin(1.0)
    old = daemon.paths[-1][1]
    same = vehicle.make({"radius": 0.3, "margin": -1})
    same.vehicle_revision = old.vehicle_revision + 1  # the same body: its path goes on
    begin = len(daemon.paths)
    daemon.bus.publish("VEHICLE", same)
    assert driver.spin(5.0, lambda: daemon.paths[-1][1].vehicle_revision == same.vehicle_revision)
    assert all(p.status == path_t.OK for _, p in daemon.paths[begin:])
    assert [w.encode() for w in daemon.paths[-1][1].waypoints] == [w.encode() for w in old.waypoints]
    wide = vehicle.make({"radius": 0.45, "margin": -1})
    wide.vehicle_revision = same.vehicle_revision + 1
    begin = len(daemon.paths)
    daemon.bus.publish("VEHICLE", wide)
    assert driver.spin(30.0, lambda: any(p.vehicle_revision == wide.vehicle_revision and p.status == path_t.OK
                                         for _, p in daemon.paths[begin:]))
    later = [p for _, p in daemon.paths[begin:]]
    withdrawn = next(i for i, p in enumerate(later) if p.status == path_t.NONE)
    assert (later[withdrawn].cause, later[withdrawn].cause_id) == (status_t.CONFLICT, wide.vehicle_revision)
    assert all(p.vehicle_revision == wide.vehicle_revision for p in later[withdrawn:])
    asked = query.make_query(query.Leg("1", driver.pose, [(19.0, 19.0)]), 1, 1, options(), False)
    asked.goals[0].id = 11
    report = check_path(later[-1], Obstacles(world), vehicle.body(wide), asked)
    assert report.ok, report.faults


def test_goal_list_out_of_reach_is_answered_with_the_reason(ready):
    daemon, driver, _ = ready
    driver.spin(0.3)
    daemon.bus.publish("GOALS", goal_list(1, (190.0, 19.0)))
    assert driver.spin(30.0, lambda: len(daemon.paths) > 0)
    path = daemon.paths[-1][1]
    assert (path.status, path.cause, path.cause_id) == (path_t.NONE, status_t.GOAL_OUTSIDE, 11)


def test_goal_list_without_a_pose_is_answered_with_that_reason(ready):
    daemon, _, _ = ready
    daemon.bus.publish("GOALS", goal_list(1, (19.0, 19.0)))
    assert daemon.wait(lambda: len(daemon.paths) > 0)
    path = daemon.paths[-1][1]
    assert (path.status, path.cause, path.goal_list_revision) == (path_t.NONE, status_t.NO_POSE, 1)


def test_goal_list_without_a_pose_is_planned_when_the_pose_comes(ready):
    daemon, driver, _ = ready
    goals_first = goal_list(1, (19.0, 19.0))
    daemon.bus.publish("GOALS", goals_first)
    daemon.bus.spin(0.5)
    assert daemon.status.cause == status_t.NO_POSE
    driver.spin(0.5)
    daemon.bus.publish("GOALS", goals_first)  # senders re-send
    assert driver.spin(5.0, lambda: has_path(daemon))


def test_goal_command_prints_the_path_and_its_renewals(ready):
    daemon, _, _ = ready
    out = daemon.aisle("goal", "--goal", "19,19", "--pose", "1,1,0", "--for", "4")
    assert "OK" in out and "lease renewed" in out


def test_watch_shows_state_map_and_counters(ready):
    daemon, _, _ = ready
    out = daemon.aisle("watch", "--once")
    for word in ("IDLE", "vehicle", "layouts", "publish"):
        assert word in out


def test_heartbeat_at_5_hz_and_diagnosis_at_1_hz(make_daemon):
    daemon = make_daemon()
    daemon.bus.spin(0.5)
    daemon.statuses.clear()
    daemon.diags.clear()
    daemon.bus.spin(5.0)
    assert 22 <= len(daemon.statuses) <= 28
    assert 4 <= len(daemon.diags) <= 6
    seqs = [s.seq for _, s in daemon.statuses]
    assert seqs == list(range(seqs[0], seqs[0] + len(seqs)))
    diag = daemon.diags[-1][1]
    assert diag.arena_bytes > 0 and 0 < diag.rss_bytes < 200 * 2**20
    assert diag.boot_id == daemon.status.boot_id


def test_restart_shows_a_new_boot_id_and_needs_the_map_again(ready):
    daemon, driver, _ = ready
    boot = daemon.status.boot_id
    driver.spin(0.3)
    daemon.bus.publish("GOALS", goal_list(1, (19.0, 19.0)))
    assert driver.spin(30.0, lambda: has_path(daemon))
    daemon.process.kill()
    daemon.process.wait()
    daemon.bus.spin(0.3)
    status = daemon.start()
    assert status.boot_id != boot
    assert status.map_revision == 0 and status.goal_list_id == 0 and status.cause == status_t.NO_LAYOUT


def test_after_a_restart_a_vehicle_under_way_goes_on_when_all_is_sent_again(ready, data):
    daemon, driver, _ = ready
    driver.spin(0.3)
    daemon.bus.publish("GOALS", goal_list(1, (19.0, 19.0)))
    assert driver.spin(30.0, lambda: has_path(daemon))
    until = max(p.valid_until_utime for _, p in daemon.paths)
    daemon.process.kill()
    daemon.process.wait()
    driver.pose = (2.0, 2.0, 0.78)  # where it came to rest when the lease ran out
    driver.spin(1.2)
    assert now_us() > until
    boot = daemon.start().boot_id
    path = data / "scenarios" / "field_12_disc.json"
    daemon.aisle("map", path)
    daemon.aisle("vehicle", "--scenario", path)
    driver.spin(0.3)
    daemon.paths.clear()
    daemon.bus.publish("GOALS", goal_list(1, (19.0, 19.0)))
    assert driver.spin(30.0, lambda: has_path(daemon))
    anew = next(p for _, p in daemon.paths if p.status == path_t.OK)
    assert anew.boot_id == boot
    assert (anew.waypoints[0].x, anew.waypoints[0].y) == pytest.approx((2.0, 2.0), abs=1e-6)


@pytest.mark.parametrize("with_signal", [signal.SIGTERM, signal.SIGINT])
def test_ends_clean_on_a_signal(ready, with_signal):
    daemon, driver, _ = ready
    daemon.bus.publish("GOALS", goal_list(1, (19.0, 19.0)))
    driver.spin(0.5)
    assert daemon.stop(with_signal) == 0
