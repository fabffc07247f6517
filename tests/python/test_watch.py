"""aisle watch: what its tables tell of driving."""

import pytest
from aisle import obstacle_t, obstacles_t, path_t, pose_t, status_t
from aisle_tools.watch import View
from rich.console import Console


class Bus:
    """Takes what is subscribed and hands messages over."""

    def __init__(self):
        self.handlers = {}

    def subscribe(self, name, _kind, handler, _capacity=64):
        self.handlers[name] = handler


@pytest.fixture
def view():
    bus = Bus()
    made = View(bus)
    made.bus = bus
    return made


def text(view):
    console = Console(width=140, record=True, file=open("/dev/null", "w"))  # noqa: SIM115
    console.print(view.render())
    return " ".join(console.export_text().split())


def blocked_by(ident, state=status_t.ACTIVE, cause=status_t.YIELDING):
    msg = status_t()
    msg.state, msg.cause, msg.cause_id, msg.goal_id = state, cause, ident, 7
    msg.distance_remaining, msg.time_remaining, msg.obstacles_age = 12.5, 20.25, 0.08
    return msg


def seen(source, ident, x):
    o, msg = obstacle_t(), obstacles_t()
    o.id, o.kind, o.x, o.y, o.vx, o.vy = ident, obstacle_t.PERSON, x, 2.0, 0.3, 0.4
    msg.source, msg.num_obstacles, msg.obstacles = source, 1, [o]
    return msg


def test_nothing_known_is_said(view):
    assert "waiting for a status_t" in text(view)


def test_driving_is_told_in_words_with_what_is_left(view):
    view.bus.handlers["STATUS"](blocked_by(0, cause=0))
    told = text(view)
    assert "now driving to go goal 7: 12.50 m, 20.2 s" in told
    assert "in the way" not in told


def test_the_mover_in_the_way_is_told_with_its_distance(view):
    pose = pose_t()
    pose.x, pose.y, pose.vx, pose.localized = 1.0, 2.0, 0.5, True
    view.bus.handlers["POSE"](pose)
    view.bus.handlers["STATUS"](blocked_by(42))
    view.bus.handlers["OBSTACLES"](seen(0, 41, 9.0))
    view.bus.handlers["OBSTACLES"](seen(1, 42, 4.0))
    told = text(view)
    assert "now driving: giving way to mover 42" in told
    assert "in the way person 42 at (4.00, 2.00), 0.50 m/s, 3.00 m away" in told
    assert "speed 0.50 m/s" in told and "movers 2 of 2 source(s), 0.08 s old" in told
    view.bus.handlers["OBSTACLES"](seen(1, 43, 4.0))
    assert "in the way" not in text(view)


def test_a_path_tells_status_and_cause_in_words(view):
    path = path_t()
    path.status, path.cause, path.cause_id = path_t.PARTIAL, status_t.BLOCKED_BY, 42
    view.bus.handlers["PATH"](path)
    assert "status PARTIAL: a safe part that ends at rest: the way is blocked by mover 42" in text(view)
