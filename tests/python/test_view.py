"""aisle view: the page itself in headless Chromium, and what is put into it."""

import base64
import json
import math
import re
import zlib
from pathlib import Path

import numpy as np
import pytest
from aisle import (
    command_t,
    goal_list_t,
    goal_t,
    layout_patch_t,
    obstacle_t,
    obstacles_t,
    path_t,
    pose_t,
    query_t,
    status_t,
    vehicle_t,
    waypoint_t,
)
from aisle_tools import cli, layouts, names, view_log, view_paths
from aisle_tools.bus import LogWriter
from aisle_tools.vehicle import body
from aisle_tools.world import Grid, Polygon, World, float32
from browser import Browser, find_chromium

T0 = 1_600_000_000_000_000  # us
V = 0.5  # m/s, along the x axis
SECONDS = 20.0
RADIUS = 0.3


def write(log, t, name, msg):
    log.utime = T0 + round(t * 1e6)
    if hasattr(msg, "utime") and msg.utime == 0:
        msg.utime = log.utime
    log.publish(name, msg)


def make_world():
    occupied = np.zeros((100, 200), dtype=bool)
    occupied[0, :] = occupied[-1, :] = occupied[:, 0] = occupied[:, -1] = True
    square = np.array([[4.0, 3.0], [6.0, 3.0], [6.0, 4.5], [4.0, 4.5]])
    zone = Polygon(2, square + [6.0, 2.0], 2, 0.4)
    grid = Grid(0.0, 0.0, float32(0.1), occupied)
    return World("hall", (0.0, 0.0, 20.0, 10.0), [Polygon(1, square), zone], grid)


def make_pose(t):
    msg = pose_t()
    msg.map_id, msg.localized, msg.cov = 1, True, [0.0] * 6
    msg.x, msg.y, msg.theta, msg.vx = 1.0 + V * t, 2.0, 0.0, V
    return msg


def make_path(t, revision, status=path_t.OK, cause=0, by=0, v=V, goals=1):
    msg = path_t()
    msg.utime = msg.t0_utime = T0 + round(t * 1e6)
    msg.valid_until_utime = msg.utime + 1_000_000
    msg.path_revision, msg.status, msg.cause, msg.cause_id = revision, status, cause, by
    msg.goal_list_id = msg.goal_list_revision = msg.map_id = msg.map_revision = goals
    if status != path_t.NONE:
        for i, x in enumerate((1.0 + V * t, 9.0, 12.0)):
            w = waypoint_t()
            w.x, w.y, w.v, w.t = x, 2.0, v if i < 2 else 0.0, (x - 1.0 - V * t) / v
            msg.waypoints.append(w)
        msg.waypoints[-1].flags, msg.waypoints[-1].goal_id = waypoint_t.GOAL | waypoint_t.STOP, 7
        msg.num_base, msg.length, msg.duration = 2, 11.0 - V * t, (11.0 - V * t) / v
    msg.num_waypoints = len(msg.waypoints)
    return msg


def make_status(state, cause=0, by=0, goal=7):
    msg = status_t()
    msg.state, msg.cause, msg.cause_id, msg.goal_id = state, cause, by, goal
    msg.goal_list_id = msg.goal_list_revision = 1
    msg.distance_remaining, msg.time_remaining = 5.0, 10.0
    return msg


def make_obstacles(t, seq):
    msg = obstacles_t()
    msg.map_id, msg.seq = 1, seq
    person, cart = obstacle_t(), obstacle_t()
    person.id, person.kind, person.radius = 42, obstacle_t.PERSON, 0.25
    person.x, person.y, person.vy = 8.0, 8.0 - 0.2 * t, -0.2
    cart.id, cart.kind, cart.x, cart.y, cart.theta = 43, obstacle_t.VEHICLE, 15.0, 8.0, 0.5
    cart.vertices = [(-0.5, -0.3), (0.5, -0.3), (0.5, 0.3), (-0.5, 0.3)]
    cart.num_vertices = 4
    for o in (person, cart):
        o.cov_xy = [0.0] * 3
    msg.obstacles = [person, cart]
    msg.num_obstacles = 2
    return msg


def make_goals():
    msg = goal_list_t()
    msg.goal_list_id = msg.goal_list_revision = msg.map_id = 1
    goal = goal_t()
    goal.id, goal.x, goal.y, goal.tolerance_theta = 7, 12.0, 2.0, 4.0
    msg.goals, msg.num_goals = [goal], 1
    return msg


def drive(path, prefix="AISLE", layout=True):
    """20 s: drives, yields to 42 from 5 s, is blocked from 8 s, drives on from 12 s, is there at 18 s."""
    log = LogWriter(path, prefix)
    if layout:
        for name, msg in layouts.make_messages(make_world(), 1, 1, T0, 96):
            write(log, 0.0, name, msg)
    vehicle = vehicle_t()
    vehicle.vehicle_revision, vehicle.footprint_radius, vehicle.margin = 1, RADIUS, 0.1
    write(log, 0.0, "VEHICLE", vehicle)
    write(log, 0.2, "GOALS", make_goals())
    events = [(k / 20.0, "POSE", make_pose(k / 20.0)) for k in range(int(SECONDS * 20) + 1)]
    events += [(k / 10.0, "OBSTACLES", make_obstacles(k / 10.0, k + 1)) for k in range(int(SECONDS * 10))]
    slow, none = (path_t.OK, status_t.YIELDING, 42, 0.25), (path_t.NONE, status_t.BLOCKED_BY, 42)
    for t, revision, *more in [(0.5, 1), (1.0, 1), (5.0, 2, *slow), (8.0, 3, *none), (12.0, 4)]:
        events.append((t, "PATH", make_path(t, revision, *more)))
    for t, *more in [(0.0, 3, 0, 0, 0), (0.5, 4), (5.0, 4, 301, 42), (8.0, 5, 204, 42), (12.0, 4), (18.0, 2, 0, 0, 0)]:
        events.append((t, "STATUS", make_status(*more)))
    hold = command_t()
    hold.command = command_t.HOLD
    events.append((3.0, "COMMAND", hold))
    for t, name, msg in sorted(events, key=lambda e: e[0]):
        write(log, t, name, msg)
    log.close()
    return path


def ask(path):
    """Two queries: one answered with a path, one refused."""
    log = LogWriter(path, "AISLE")
    for name, msg in layouts.make_messages(make_world(), 1, 1, T0, 96):
        write(log, 0.0, name, msg)
    for ident, status, cause in ((1, path_t.OK, 0), (2, path_t.NONE, status_t.NO_PATH)):
        query = query_t()
        query.query_id, query.start.x, query.start.y, query.num_goals = ident, 1.0, 2.0, 1
        goal = goal_t()
        goal.id, goal.x, goal.y = 7, 12.0, 2.0
        query.goals = [goal]
        reply = make_path(0.0, 0, status, cause, 7 if cause else 0)
        reply.query_id = ident
        write(log, ident, "QUERY", query)
        write(log, ident + 0.1, "REPLY", reply)
    log.close()
    return path


def data_of(page):
    return json.loads(zlib.decompress(base64.b64decode(re.search(r'id="data">([^<]*)<', page.read_text()).group(1))))


def view(log, *words):
    out = log.with_suffix(".html")
    assert cli.main(["view", str(log), "--out", str(out), *words]) == 0
    return out


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    return view(drive(tmp_path_factory.mktemp("view") / "run.log"))


@pytest.fixture(scope="module")
def browser():
    program = find_chromium()
    assert program is not None, "no Chromium; tools/setup.sh installs it"
    made = Browser(program)
    yield made
    made.close()


@pytest.fixture
def shown(browser, page):
    browser.size(1280, 800)
    browser.scheme("light")
    show(browser, page)
    yield browser
    assert browser.errors == []


def show(browser, page, fragment=""):
    browser.open(page, fragment)
    browser.until("document.getElementById('run').dataset.ready === 'true'")


def state(browser):
    browser.js("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
    return browser.js("({...document.getElementById('run').dataset})")


def move_slider(browser, t):
    # In one go: a frame between the two would put the slider back.
    browser.js(f"((s) => {{ s.value = {t}; s.dispatchEvent(new Event('input')) }})(document.getElementById('slider'))")
    return state(browser)


def box_of(browser, ident):
    """x, y, width, height, pixels."""
    box = f"document.getElementById('{ident}').getBoundingClientRect()"
    return browser.js(f"(({{x, y, width, height}}) => [x, y, width, height])({box})")


def click(browser, ident):
    x, y, width, height = box_of(browser, ident)
    browser.click(x + width / 2, y + height / 2)


# ---- in the browser
def test_the_page_loads_without_an_error_and_asks_nobody(shown):
    assert state(shown)["theme"] == "light"
    assert [r for r in shown.requests if not r.startswith(("file:", "data:"))] == []
    assert len([r for r in shown.requests if r.startswith("file:")]) == 1


def test_the_policy_of_the_page_forbids_requests(shown):
    assert shown.js("fetch('http://127.0.0.1:9/').then(() => 'sent', () => 'refused')") == "refused"
    assert any("Content Security Policy" in e for e in shown.errors)
    shown.errors.clear()


@pytest.mark.parametrize("t", [0.0, 4.37, 13.0, 20.0])
def test_the_slider_moves_the_vehicle_to_its_pose_of_that_time(shown, t):
    now = move_slider(shown, t)
    assert float(now["time"]) == pytest.approx(t, abs=0.01)
    assert float(now["x"]) == pytest.approx(1.0 + V * t, abs=0.01)
    assert float(now["y"]) == pytest.approx(2.0, abs=0.002)


@pytest.mark.parametrize(
    "t, cause, revision, words",
    [
        (0.2, "-", "", "planning"),
        (2.0, "-", "1", "driving"),
        (6.0, "YIELDING", "2", "driving: giving way to mover 42"),
        (9.0, "BLOCKED_BY", "3", "blocked: the way is blocked by mover 42"),
        (15.0, "-", "4", "driving"),
        (19.0, "-", "4", "nothing to do"),
    ],
)
def test_the_cause_and_the_path_of_a_time_are_told(shown, t, cause, revision, words):
    now = move_slider(shown, t)
    assert (now["cause"], now["revision"]) == (cause, revision)
    assert shown.js("document.getElementById('cause').textContent") == words


def test_play_advances_and_pause_stops(shown):
    click(shown, "play")
    shown.until("+document.getElementById('run').dataset.time > 0.3")
    now = state(shown)
    assert now["playing"] == "true" and float(now["x"]) > 1.1
    click(shown, "play")
    held = state(shown)
    assert held["playing"] == "false" and state(shown)["time"] == held["time"]


def test_playing_ends_at_the_end_and_begins_anew(shown):
    shown.js("document.getElementById('rate').value = '16', document.getElementById('rate').onchange()")
    move_slider(shown, 19.5)
    click(shown, "play")
    shown.until("+document.getElementById('run').dataset.time >= 20")
    assert state(shown)["playing"] == "false"
    click(shown, "play")
    shown.until("+document.getElementById('run').dataset.time < 10")
    click(shown, "play")


def test_keys_seek_step_and_play(shown):
    move_slider(shown, 10.0)
    shown.key("ArrowRight")
    assert float(state(shown)["time"]) == pytest.approx(11.0)
    shown.key("ArrowLeft")
    shown.key(".")
    assert float(state(shown)["time"]) == pytest.approx(10.05)
    shown.key("]")
    assert float(state(shown)["time"]) == pytest.approx(12.0)
    shown.key("[")
    assert float(state(shown)["time"]) == pytest.approx(8.0)
    shown.key("End")
    assert float(state(shown)["time"]) == pytest.approx(20.0)
    shown.key("ArrowRight")
    assert float(state(shown)["time"]) == pytest.approx(20.0)
    shown.key("Home")
    assert float(state(shown)["time"]) == 0.0
    shown.key("ArrowLeft")
    assert float(state(shown)["time"]) == 0.0
    shown.key(" ", "Space")
    assert state(shown)["playing"] == "true"
    shown.key(" ", "Space")
    assert state(shown)["playing"] == "false"


def test_revisions_and_events_are_rows_that_lead_to_their_time(shown):
    assert shown.js("document.querySelectorAll('#paths tr').length") == 4
    assert shown.js("document.getElementById('paths-count').textContent") == "(4)"
    shown.js("document.querySelectorAll('#paths tr')[2].click()")
    assert float(state(shown)["time"]) == pytest.approx(8.0)
    assert shown.js("document.querySelector('#paths tr.now').children[1].textContent") == "3"
    texts = shown.js("[...document.querySelectorAll('#events button')].map((b) => b.textContent)")
    assert texts[0] == "0.0 splanning" and "3.0 stold: hold" in texts and "18.0 sgoal 7 done" in texts
    shown.js("document.querySelectorAll('#events button')[3].click()")
    assert float(state(shown)["time"]) == pytest.approx(3.0)


def test_the_wheel_zooms_where_it_points_and_dragging_moves(shown):
    before = state(shown)
    box = box_of(shown, "scene")
    at = (box[0] + 0.25 * box[2], box[1] + 0.3 * box[3])
    shown.mouse("mouseWheel", *at, deltaX=0, deltaY=-200)
    zoomed = state(shown)
    scale, cx, cy = (float(before[k]) for k in ("scale", "cx", "cy"))
    assert float(zoomed["scale"]) > 1.2 * scale
    fixed = cx - 0.25 * box[2] / scale
    assert float(zoomed["cx"]) - 0.25 * box[2] / float(zoomed["scale"]) == pytest.approx(fixed, abs=0.01)
    fixed = cy + 0.2 * box[3] / scale
    assert float(zoomed["cy"]) + 0.2 * box[3] / float(zoomed["scale"]) == pytest.approx(fixed, abs=0.01)
    shown.drag(*at, at[0] + 50, at[1])
    assert float(state(shown)["cx"]) == pytest.approx(float(zoomed["cx"]) - 50 / float(zoomed["scale"]), abs=0.01)
    click(shown, "fit")
    assert state(shown)["scale"] == before["scale"]


def test_following_keeps_the_vehicle_in_the_middle(shown):
    click(shown, "follow")
    now = move_slider(shown, 16.0)
    assert float(now["cx"]) == pytest.approx(9.0, abs=0.01)
    assert shown.js("document.getElementById('follow').getAttribute('aria-pressed')") == "true"


def test_two_fingers_zoom_on_a_phone_and_nothing_is_cut_off(browser, page):
    browser.size(390, 844, touch=True)
    show(browser, page)
    assert browser.js("document.documentElement.scrollWidth") <= 390
    before = state(browser)
    browser.touch("touchStart", [(150, 250), (240, 250)])
    browser.touch("touchMove", [(100, 250), (290, 250)])
    browser.touch("touchEnd", [])
    assert float(state(browser)["scale"]) > 1.5 * float(before["scale"])
    assert browser.errors == []


def test_a_click_on_a_plot_goes_to_that_time(shown):
    click(shown, "gap")
    assert float(state(shown)["time"]) == pytest.approx(10.0, abs=0.1)


def test_a_fragment_opens_at_a_time(browser, page):
    browser.size(1280, 800)
    show(browser, page, "#t=6.5")
    assert float(state(browser)["time"]) == pytest.approx(6.5)


def pixel(browser, x, y):
    """Colour drawn at a place in metres."""
    canvas = "document.getElementById('scene').getContext('2d')"
    return browser.js(f"draw(), [...{canvas}.getImageData(sx({x}), sy({y}), 1, 1).data]")


def test_layout_vehicle_and_movers_are_drawn_where_they_are(shown):
    click(shown, "show-names")
    move_slider(shown, 6.0)
    floor = pixel(shown, 18.5, 2.0)
    assert pixel(shown, 5.0, 3.7) != floor  # polygon
    assert pixel(shown, 11.0, 5.7) != floor  # zone
    assert pixel(shown, 0.05, 5.0) != floor  # scanned wall
    assert pixel(shown, 4.1, 2.15) != floor and pixel(shown, 3.0, 2.15) == floor  # vehicle
    assert pixel(shown, 8.0, 6.9) != floor  # person
    assert pixel(shown, 15.3, 8.1) != floor and pixel(shown, 17.0, 8.1) == floor  # cart
    click(shown, "show-reach")
    along, across = (0.45 * math.cos(0.5), 0.45 * math.sin(0.5)), (-0.45 * math.sin(0.5), 0.45 * math.cos(0.5))
    assert pixel(shown, 15.0 + along[0], 8.0 + along[1]) != floor  # longer than wide, at its heading
    assert pixel(shown, 15.0 + across[0], 8.0 + across[1]) == floor
    assert pixel(shown, 10.0, 2.0) != floor  # path
    move_slider(shown, 9.0)
    assert pixel(shown, 10.0, 2.0) == floor  # revoked


def test_a_click_on_a_mover_tells_of_it(shown):
    move_slider(shown, 6.05)
    box = box_of(shown, "scene")
    x, y = shown.js("[sx(8.0), sy(6.8)]")
    shown.click(box[0] + x, box[1] + y)
    shown.until("document.getElementById('facts').textContent.includes('mover 42person')")
    told = shown.js("document.getElementById('facts').textContent")
    away = math.hypot(8.0 - 1.0 - V * 6.05, 8.0 - 0.2 * 6.05 - 2.0)
    assert f"mover 42person, 0.20 of at most 1.60 m/s, {away:.2f} m away, measured 0.05 s ago, reach 0.48 m" in told


def test_the_lease_is_told_as_it_runs_out(shown):
    move_slider(shown, 5.25)
    assert "0.75 s left" in shown.js("document.getElementById('facts').textContent")
    move_slider(shown, 7.0)
    assert "run out" in shown.js("document.getElementById('facts').textContent")


def test_dark_and_light_follow_the_system_and_the_button(shown):
    light = pixel(shown, 18.5, 2.0)
    shown.scheme("dark")
    shown.until("document.getElementById('run').dataset.theme === 'dark'")
    assert sum(pixel(shown, 18.5, 2.0)[:3]) < 200 < sum(light[:3])
    click(shown, "theme")
    assert state(shown)["theme"] == "light"


def test_every_control_has_a_name(shown):
    names = shown.js(
        "[...document.querySelectorAll('button, input, select, canvas')].filter((e) => !(e.getAttribute('aria-label')"
        " || (e.labels && e.labels.length) || e.textContent.trim())).map((e) => e.outerHTML)"
    )
    assert names == []


def test_replies_of_a_query_log_are_rows_whose_paths_are_played(browser, tmp_path):
    browser.size(1280, 800)
    show(browser, view(ask(tmp_path / "asked.log")))
    assert browser.js("document.querySelectorAll('#replies tr').length") == 2
    assert state(browser)["reply"] == "1"
    now = move_slider(browser, 10.0)
    assert float(now["x"]) == pytest.approx(1.0 + V * 10.0, abs=0.02)
    browser.js("document.querySelectorAll('#replies tr')[1].click()")
    assert state(browser)["reply"] == "2"
    told = browser.js("document.getElementById('cause').textContent")
    assert told.startswith("query 2: nothing to drive: there is no way")
    assert browser.errors == []


def test_a_file_name_cannot_break_the_page(browser, tmp_path):
    show(browser, view(drive(tmp_path / "run.log"), "--title", "</script><b id='bad'>x</b>"))
    assert browser.js("document.getElementById('bad') === null")
    assert browser.js("document.querySelector('h1').textContent") == "</script><b id='bad'>x</b>"


# ---- without a browser
def test_a_part_of_the_run_keeps_what_held_when_it_begins(tmp_path):
    found = data_of(view(drive(tmp_path / "run.log"), "--from", "6", "--to", "9"))
    assert (found["begin"], found["end"]) == (6.0, 9.0)
    assert [p["rev"] for p in found["paths"]] == [2, 3]
    times = np.cumsum(found["poses"]["t"]) / 1e3
    assert times[0] == pytest.approx(6.0) and times[-1] == pytest.approx(9.0)
    seen = np.cumsum(found["movers"]["sources"][0]["t"]) / 1e3
    assert seen[0] == pytest.approx(5.9) and seen[-1] == pytest.approx(9.0)


def test_an_age_is_that_of_the_measurement_unless_the_clocks_differ(tmp_path):
    log = view_log.Log(drive(tmp_path / "run.log"), "AISLE")
    assert log.clock(5.0, T0 + 4_900_000) == pytest.approx(4.9)
    assert log.clock(5.0, 77) == 5.0


def test_the_least_gap_is_that_of_the_bodies(tmp_path):
    found = data_of(view(drive(tmp_path / "run.log")))
    times, gaps = np.cumsum(found["poses"]["t"]) / 1e3, np.cumsum(found["gap"]) / 100
    expected = np.hypot(8.0 - (1.0 + V * times), 6.0 - 0.2 * times) - 0.25 - RADIUS
    assert gaps[5:] == pytest.approx(np.minimum(expected, 10.0)[5:], abs=0.011)  # the cart is farther away, always


@pytest.mark.parametrize(
    "words, says",
    [
        (["--prefix", "OTHER"], "no messages of prefix OTHER; give --prefix AISLE"),
        (["--from", "30"], "the log lasts 20.0 s"),
        (["--from", "5", "--to", "5"], "nothing from 5 to 5 s"),
        (["--to", "nan"], "nothing from"),
    ],
)
def test_wrong_options_end_with_2_and_say_what_helps(tmp_path, capsys, words, says):
    assert cli.main(["view", str(drive(tmp_path / "run.log")), *words]) == 2
    err = capsys.readouterr().err
    assert says in err and len(err.strip().splitlines()) == 1


def test_a_log_without_a_layout_needs_a_map(tmp_path, capsys, data):
    log = drive(tmp_path / "run.log", layout=False)
    assert cli.main(["view", str(log)]) == 2
    assert "no layout of prefix AISLE" in capsys.readouterr().err
    assert data_of(view(log, "--map", str(data / "ros_maps" / "nav2_depot.yaml")))["layouts"][0]["grid"] is not None


def test_what_is_no_log_or_empty_is_named(tmp_path, capsys):
    (tmp_path / "empty.log").write_bytes(b"")
    (tmp_path / "text.log").write_text("no log at all, only some text\n" * 9)
    for name, says in (("empty", "empty"), ("text", "not an LCM log"), ("absent", "no such file")):
        assert cli.main(["view", str(tmp_path / f"{name}.log")]) == 2
        assert says in capsys.readouterr().err


def test_undecodable_messages_are_left_out_and_counted(tmp_path, capsys):
    log = LogWriter(drive(tmp_path / "run.log"), "AISLE")
    log.log.write_event(log.utime, "AISLE_POSE", b"short")
    log.close()
    view(tmp_path / "run.log", "--to", "20")
    assert "1 undecodable messages left out" in capsys.readouterr().out


def test_what_is_no_number_does_no_harm(browser, tmp_path):
    log = LogWriter(drive(tmp_path / "run.log"), "AISLE")
    pose, path, status, seen = make_pose(5.0), make_path(5.0, 9), make_status(4), make_obstacles(5.0, 999)
    pose.x = path.waypoints[1].x = path.length = status.distance_remaining = math.nan
    o = seen.obstacles[0]
    o.x, o.vx, o.radius, o.v_bound = math.nan, math.inf, math.nan, math.inf
    for name, msg in (("POSE", pose), ("PATH", path), ("STATUS", status), ("OBSTACLES", seen)):
        write(log, 21.0, name, msg)
    log.close()
    found = view(tmp_path / "run.log")
    assert "NaN" not in json.dumps(data_of(found))
    show(browser, found, "#t=21")
    assert browser.errors == []


def test_a_number_used_again_belongs_to_the_query_before(tmp_path):
    log = LogWriter(ask(tmp_path / "asked.log"), "AISLE")
    query = query_t()
    query.query_id, query.num_goals, query.goals = 1, 1, [goal_t()]
    query.goals[0].x = 3.0
    write(log, 4.0, "QUERY", query)
    reply = make_path(0.0, 0)
    reply.query_id = 1
    write(log, 4.1, "REPLY", reply)
    log.close()
    found = data_of(view(tmp_path / "asked.log"))["replies"]
    assert [(r["query"], r["stops"][1][0]) for r in found] == [(1, 12.0), (2, 12.0), (1, 3.0)]


def test_a_refusal_tells_place_and_remedy_in_words():
    path = make_path(0.0, 1, path_t.NONE, status_t.GOAL_OCCUPIED, 5)
    path.waypoints, path.num_waypoints, path.cause_value = [waypoint_t(), waypoint_t()], 2, 0.25
    path.waypoints[1].x = 0.25
    told = "no room at the goal, by polygon 5, at (0.00, 0.00), move 0.250 m to (0.250, 0.000)"
    assert names.path_in_words(path) == told
    assert view_paths.hints_of(path) == {"place": [0.0, 0.0], "free": [0.25, 0.0], "gap": [], "without": []}


def test_a_reply_is_shown_on_the_map_it_was_asked_on(browser, tmp_path):
    log = LogWriter(ask(tmp_path / "asked.log"), "AISLE")
    empty = World("second", (0.0, 0.0, 40.0, 10.0))
    for name, msg in layouts.make_messages(empty, 2, 5, T0, 96):
        write(log, 3.0, name, msg)
    reply = make_path(0.0, 0)
    reply.query_id, reply.map_id, reply.map_revision = 3, 2, 5
    write(log, 3.1, "REPLY", reply)
    log.close()
    show(browser, view(tmp_path / "asked.log"))
    assert browser.js("layoutAt(0).bounds[2]") == 20.0
    browser.js("document.querySelectorAll('#replies tr')[2].click()")
    assert browser.js("layoutAt(0).bounds[2]") == 40.0


def test_a_patch_changes_the_layout_from_its_time_on(tmp_path):
    log = LogWriter(drive(tmp_path / "run.log"), "AISLE")
    patch = layout_patch_t()
    patch.map_id, patch.base_revision, patch.map_revision, patch.num_removed, patch.removed = 1, 1, 2, 1, [1]
    write(log, 19.0, "LAYOUT_PATCH", patch)
    log.close()
    found = data_of(view(tmp_path / "run.log"))["layouts"]
    assert [(entry["t"], [p["id"] for p in entry["polygons"]]) for entry in found] == [(0.0, [1, 2]), (19.0, [2])]


def crowd(seconds, movers):
    """Movers that wander, seen 20 times a second."""
    rng = np.random.default_rng(1)
    places, out = rng.uniform(1.0, 9.0, (movers, 2)), []
    for k in range(int(20 * seconds)):
        velocity = rng.normal(0.0, 0.7, places.shape)
        places += velocity / 20.0
        shot = view_log.Snapshot(k / 20.0, k / 20.0, 0, [obstacle_t() for _ in range(movers)])
        for i, o in enumerate(shot.movers):
            o.id, o.radius, o.cov_xy = i, 0.3, [0.0] * 3
            (o.x, o.y), (o.vx, o.vy) = places[i], velocity[i]
        out.append(shot)
    return out


def test_the_largest_run_stays_below_10_megabytes():
    shots = crowd(60.0, 10)
    packed = zlib.compress(json.dumps(view_log.encode_movers(shots)).encode(), 9)
    a_row = len(packed) * 4 / 3 / sum(len(s.movers) for s in shots)
    assert a_row * view_log.MOVER_ROWS_MAX < 9e6


def test_too_many_snapshots_are_thinned_out_evenly(monkeypatch):
    monkeypatch.setattr(view_log, "MOVER_ROWS_MAX", 200)
    shots = view_log.decimated(crowd(20.0, 4))
    gaps = np.diff([s.t for s in shots])
    assert 100 < sum(len(s.movers) for s in shots) <= 200
    assert gaps.min() > 0.0 and gaps[:-1].max() < 1.1 * gaps[:-1].min() and shots[-1].t == pytest.approx(19.95)


def test_reach_takes_the_whole_body_and_the_larger_speed():
    o = make_obstacles(0.0, 1).obstacles[1]
    o.vx, o.cov_xy = 3.0, [0.04, 0.0, 0.01]
    assert view_log.traits(o, 0)[3:7] == (0.0, round(math.hypot(0.5, 0.3), 3), 0.6, 3.0)


def test_speeds_between_waypoints_are_those_of_the_wire_convention():
    path = make_path(0.0, 1)
    rows, at = view_paths.points_of(path.waypoints, body(vehicle_t()).limits)
    assert rows[at[1], 3] == pytest.approx(V)
    half = rows[np.searchsorted(rows[:, 0], 10.5)]
    assert half[3] == pytest.approx(V * math.sqrt((12.0 - half[0]) / 3.0))
    assert view_paths.encode(path, body(vehicle_t()))["base"] == at[1]  # two waypoints of it are the base
    begin, end = path.waypoints[1].t, path.waypoints[2].t
    assert half[4] == pytest.approx(begin + (end - begin) * (1.0 - half[3] / V), abs=0.03 * (end - begin))
    assert (np.diff(rows[:, 4]) > 0.0).all() and rows[-1, 4] == pytest.approx(end)


def test_a_revision_tells_what_changed():
    first = make_path(0.0, 1)
    slower = make_path(1.0, 2, v=0.2)
    around = make_path(1.0, 3)
    around.waypoints[1].y = 3.0
    revoked = make_path(1.0, 4, path_t.NONE, status_t.POSE_STALE)
    assert view_paths.change_of(first, None) == "first path"
    assert view_paths.change_of(slower, first) == "same way, other speeds"
    assert view_paths.change_of(around, first) == "another way"
    assert view_paths.change_of(revoked, first) == "path revoked"
    assert view_paths.change_of(first, revoked) == "goes on"
    assert view_paths.change_of(make_path(1.0, 5, goals=2), first) == "new goals"
    assert names.path_in_words(revoked) == "nothing to drive: the pose is too old"
