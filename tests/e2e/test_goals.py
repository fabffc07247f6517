"""Goal lists while driving, over the bus: dwell, progress by id, lists extended under way, goals skipped."""

import pytest
from aisle import command_t, goal_list_t, options_t, path_t, status_t, waypoint_t
from aisle_tools import query
from aisle_tools.bus import now_us
from rider import Rider

START = (1.0, 1.0, 0.0)
NEAR, FAR, SIDE = (2.5, 1.0), (2.5, 3.0), (1.0, 3.0)  # all before the first wall of barrier_2
WALLED = (4.9, 5.0)  # in it
OUTSIDE = (30.0, 1.0)


def goal_list(revision, *places, list_id=4):
    """Ids from 11 on; a place's third number is its dwell in s."""
    msg = goal_list_t()
    msg.utime, msg.goal_list_id, msg.goal_list_revision, msg.map_id = now_us(), list_id, revision, 1
    msg.options = options_t()
    msg.options.objective = options_t.SHORTEST
    msg.goals = [query.make_goal(11 + i, place[:2], True) for i, place in enumerate(places)]
    for goal, place in zip(msg.goals, places):
        goal.dwell = place[2] if len(place) > 2 else 0.0
    msg.num_goals = len(msg.goals)
    return msg


def ready(daemon, data):
    path = data / "scenarios" / "barrier_2.json"
    daemon.aisle("map", path)
    daemon.aisle("vehicle", "--scenario", path)
    rider = Rider(daemon, START)
    rider.ride(0.3)
    return rider


@pytest.fixture
def rider(daemon, data):
    return ready(daemon, data)


@pytest.fixture
def skipping_rider(make_daemon, tmp_path, data):
    config = tmp_path / "skip.ini"
    config.write_text("[daemon]\nstatus_hz = 50\ndiag_hz = 10\n[planner]\nskip_unreachable = yes\n")
    return ready(make_daemon("--config", str(config)), data)


def passed(path):
    return [w.goal_id for w in path.waypoints if w.flags & waypoint_t.GOAL]


def next_is(rider, goal_id):
    return lambda: rider.daemon.status.goal_id == goal_id


def on_the_way(rider, goal_id):
    """A list was taken and a path of it is driven."""
    return lambda: rider.daemon.status.goal_id == goal_id and rider.daemon.paths[-1][1].status == path_t.OK


def is_finished(rider, revision):
    s = rider.daemon.status
    return (s.state, s.goal_list_id, s.goal_list_revision, s.goal_id) == (status_t.IDLE, 4, revision, 0)


def near(rider, place):
    return max(abs(rider.pose[0] - place[0]), abs(rider.pose[1] - place[1])) < 0.06


def skip(rider, goal_id, command_id):
    msg = command_t()
    msg.utime, msg.command, msg.command_id, msg.arg = now_us(), command_t.CANCEL, command_id, goal_id
    rider.daemon.bus.publish("COMMAND", msg)


def test_goals_are_reached_in_turn_with_their_dwell(rider):
    rider.send(goal_list(1, (*NEAR, 1.5), FAR))
    assert rider.ride(30.0, on_the_way(rider, 11))
    assert passed(rider.daemon.paths[-1][1]) == [11, 12]
    assert rider.ride(30.0, lambda: near(rider, NEAR) and rider.speed == 0.0)
    begin = now_us()
    assert rider.ride(30.0, next_is(rider, 12))
    assert 1.3e6 < now_us() - begin < 3e6
    assert rider.ride(30.0, lambda: is_finished(rider, 1))
    assert near(rider, FAR)


def test_a_list_extended_under_way_keeps_its_progress(rider):
    rider.send(goal_list(1, NEAR, FAR))
    assert rider.ride(30.0, next_is(rider, 12))
    longer = goal_list(2, NEAR, FAR, SIDE)
    rider.send(longer)
    assert rider.ride(30.0, lambda: rider.daemon.status.goal_list_revision == 2 and next_is(rider, 12)())
    assert rider.ride(30.0, lambda: passed(rider.daemon.paths[-1][1]) in ([12, 13], [13]))
    rider.send(longer)  # senders re-send
    assert rider.ride(30.0, next_is(rider, 13))
    assert near(rider, FAR)
    assert rider.ride(30.0, lambda: is_finished(rider, 2))
    assert near(rider, SIDE)
    assert rider.daemon.status.num_rejected == 0


def test_a_list_extended_after_its_end_goes_on_with_what_is_new(rider):
    rider.send(goal_list(1, NEAR))
    assert rider.ride(30.0, lambda: is_finished(rider, 1))
    rider.send(goal_list(2, NEAR, FAR))
    assert rider.ride(30.0, lambda: passed(rider.daemon.paths[-1][1]) == [12])
    assert rider.ride(30.0, lambda: is_finished(rider, 2))
    assert near(rider, FAR)


def test_a_goal_out_of_reach_is_named_and_waits_to_be_skipped_on_command(rider):
    rider.send(goal_list(1, NEAR, WALLED, FAR))
    assert rider.ride(30.0, lambda: len(rider.daemon.paths) > 0)
    path = rider.daemon.paths[-1][1]
    assert (path.status, path.cause, path.waypoints[0].goal_id) == (path_t.NONE, status_t.GOAL_OCCUPIED, 12)
    rider.ride(1.0)
    assert len(rider.daemon.paths) == 1
    status = rider.daemon.status
    assert (status.state, status.cause, status.goal_id) == (status_t.BLOCKED, status_t.GOAL_OCCUPIED, 11)
    skip(rider, 99, 6)
    assert rider.ride(30.0, lambda: rider.daemon.status.num_rejected == 1)
    skip(rider, 12, 7)
    assert rider.ride(30.0, lambda: rider.daemon.paths[-1][1].status == path_t.OK)
    assert passed(rider.daemon.paths[-1][1]) == [11, 13]
    assert rider.daemon.fresh_status().command_id == 7
    assert rider.ride(30.0, lambda: is_finished(rider, 1))
    assert near(rider, FAR)


def test_goals_out_of_reach_are_named_and_skipped_if_so_configured(skipping_rider):
    rider = skipping_rider
    rider.send(goal_list(1, OUTSIDE, NEAR, WALLED, FAR))
    assert rider.ride(30.0, on_the_way(rider, 12))
    told = [(p.status, p.cause, p.waypoints[0].goal_id) for _, p in rider.daemon.paths[:2]]
    assert told == [(path_t.NONE, status_t.GOAL_OUTSIDE, 11), (path_t.NONE, status_t.GOAL_OCCUPIED, 13)]
    assert passed(rider.daemon.paths[-1][1]) == [12, 14]
    assert rider.ride(30.0, lambda: is_finished(rider, 1))
    assert near(rider, FAR)


def test_skipping_the_last_goal_ends_the_list(rider):
    rider.send(goal_list(1, FAR))
    assert rider.ride(30.0, on_the_way(rider, 11))
    skip(rider, 11, 5)
    assert rider.ride(30.0, lambda: is_finished(rider, 1))
    assert rider.ride(30.0, lambda: rider.daemon.paths[-1][1].status == path_t.NONE)
    assert rider.daemon.paths[-1][1].cause == 0


def test_a_daemon_killed_under_way_leaves_a_lease_and_the_next_one_begins_where_the_vehicle_stands(rider, data):
    daemon = rider.daemon
    rider.send(goal_list(1, FAR))
    assert rider.ride(20.0, lambda: rider.speed > 0.3)
    boot = daemon.status.boot_id
    daemon.kill()
    rider.ride(1.3)  # the lease is over after a second
    assert rider.speed == 0.0
    here = rider.pose
    assert abs(here[1] - FAR[1]) > 0.1  # on the way
    begin = len(daemon.paths)
    assert daemon.start().boot_id != boot
    rider.ride(0.5)
    assert all(p.status == path_t.NONE for _, p in daemon.paths[begin:]) and rider.pose == here
    assert daemon.status.cause == status_t.NO_LAYOUT
    path = data / "scenarios" / "barrier_2.json"
    daemon.aisle("map", path)
    daemon.aisle("vehicle", "--scenario", path)
    rider.ride(0.3)
    rider.send(goal_list(1, FAR))
    assert rider.ride(20.0, on_the_way(rider, 11))
    first = next(p for _, p in daemon.paths[begin:] if p.status == path_t.OK)
    assert first.boot_id == daemon.status.boot_id and first.waypoints[0].v == 0.0
    assert (first.waypoints[0].x, first.waypoints[0].y) == pytest.approx(here[:2], abs=1e-6)
    assert rider.ride(30.0, lambda: daemon.status.state == status_t.IDLE)
    assert rider.pose[:2] == pytest.approx(FAR, abs=0.05)
