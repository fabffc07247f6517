"""Numbers on the wire to words and back, read from the constants of the message types."""

from __future__ import annotations

import math

from aisle import obstacle_t, path_t, status_t, waypoint_t

from aisle_tools.errors import UserError

PLANNERS = ["AUTO", "PSO", "PSO_LOCAL", "GA", "RRT", "RRT_ADAPTIVE", "RRT_STAR", "RRT_STAR_ADAPTIVE", "PRM", "ASTAR"]
OBJECTIVES = ["SAFEST", "SHORTEST", "FASTEST", "LEAST_ENERGY", "PAPER"]
INTERPOLATIONS = ["SPLINE", "LINEAR"]
STATES = ["STARTING", "WAITING", "IDLE", "PLANNING", "ACTIVE", "BLOCKED", "HELD", "FAULT"]
RESULTS = ["OK", "PARTIAL", "STOP", "NONE"]
DRIVES = ["DIFFERENTIAL", "TRICYCLE", "OMNI"]
KINDS = ["OBSTACLE", "KEEPOUT", "SPEED_LIMIT", "PENALTY", "DIRECTED"]

CAUSES = {getattr(status_t, name): name for name in dir(status_t) if name.isupper() and getattr(status_t, name) >= 100}

HINTS = {
    status_t.NO_LAYOUT: "send one with 'aisle map'",
    status_t.NO_VEHICLE: "send one with 'aisle vehicle' or put it into aisled's settings",
    status_t.NO_ARM: "give the vehicle one: link_length and arm_base, see vehicle_t",
    status_t.VEHICLE_MOVES: "the arm moves while the vehicle rests only",
    status_t.NO_POSE: "publish one with 'aisle goal --pose X,Y,TH'",
    status_t.MAP_MISMATCH: "the map_id of the request is not the map held; see --map-id",
    status_t.OUTDATED: "an equal or newer revision is held; see --map-revision",
    status_t.CONFLICT: "this revision is held with other content; send a higher one",
    status_t.LIMIT: "over a limit of aisled; raise it in its settings",
    status_t.BUDGET: "work budget spent, not a proof; raise --work-units",
}


def cause_name(cause: int) -> str:
    return "-" if cause == 0 else CAUSES.get(cause, f"cause {cause}")


def state_name(state: int) -> str:
    return STATES[state] if 0 <= state < len(STATES) else str(state)


def result_name(status: int) -> str:
    return RESULTS[status] if 0 <= status < len(RESULTS) else str(status)


def option_value(name: str, allowed: list[str]) -> int:
    """SHORTEST, shortest or 1 to 1; the constants of options_t and vehicle_t count from 0 in this order."""
    word = name.strip().upper().replace("-", "_")
    if word in allowed:
        return allowed.index(word)
    if word.isdigit() and int(word) < len(allowed):
        return int(word)
    raise UserError(f"'{name}' is none of: {', '.join(a.lower() for a in allowed)}")


def is_path(path: path_t) -> bool:
    """False for a refusal, whose waypoints, if any, tell its reason."""
    return path.status != path_t.NONE and path.num_waypoints > 0


def place(path: path_t) -> tuple[float, float] | None:
    """Where a refusal has its reason."""
    if path.status != path_t.NONE or path.num_waypoints == 0:
        return None
    return path.waypoints[0].x, path.waypoints[0].y


def gap_sides(path: path_t) -> list[waypoint_t]:
    """The obstacles that form a gap too narrow, each where it is nearest to the other."""
    if path.status != path_t.NONE or path.cause != status_t.TOO_NARROW:
        return []
    return [w for w in path.waypoints[1 : path.num_waypoints] if not w.flags & waypoint_t.GOAL]


def free_place(path: path_t) -> tuple[float, float] | None:
    """Where to an occupied start or goal would have to move."""
    occupied = path.cause in (status_t.START_OCCUPIED, status_t.GOAL_OCCUPIED)
    if path.status != path_t.NONE or not occupied or path.num_waypoints < 2:
        return None
    return path.waypoints[1].x, path.waypoints[1].y


def removals(path: path_t) -> list[waypoint_t]:
    """The polygons whose removal would open the way, each at its centre."""
    if path.status != path_t.NONE:
        return []
    return [w for w in path.waypoints[: path.num_waypoints] if w.flags & waypoint_t.GOAL]


def rounded_up(value: float) -> float:
    """To the millimetre: who moves so far has moved enough."""
    return math.ceil(value * 1e3 - 1e-6) / 1e3


def reason(path: path_t, cause: str = "") -> str:
    """Why there is no path, in words; `cause` in place of the constant's name."""
    text = cause or cause_name(path.cause)
    sides = gap_sides(path)
    if len(sides) == 2:
        text += f", gap of {path.cause_value:.3f} m between {' and '.join(obstacle(w.goal_id) for w in sides)}"
    elif path.cause == status_t.TOO_NARROW:
        text += f", the gap is {path.cause_value:.3f} m"
    if path.cause_id != 0 and len(sides) != 2:
        text += f", {what(path.cause, path.cause_id)}"
    where = place(path)
    if where is not None:
        text += f", at ({where[0]:.2f}, {where[1]:.2f})"
    to = free_place(path)
    if to is not None:
        text += f", move {rounded_up(path.cause_value):.3f} m to ({to[0]:.3f}, {to[1]:.3f})"
    gone = removals(path)
    if gone:
        text += f", removing {' and '.join(obstacle(w.goal_id) for w in gone)} would open the way"
    if path.cause in HINTS:
        text += f" ({HINTS[path.cause]})"
    return text


STATE_WORDS = [
    "starting",
    "waiting for input",
    "nothing to do",
    "planning",
    "driving",
    "blocked",
    "held by command",
    "fault",
]
MOVERS = {obstacle_t.PERSON: "person", obstacle_t.VEHICLE: "vehicle", obstacle_t.STATIC: "standing thing"}
CAUSE_WORDS = {
    status_t.NO_LAYOUT: "no layout yet",
    status_t.NO_VEHICLE: "no vehicle yet",
    status_t.NO_POSE: "no pose yet",
    status_t.POSE_STALE: "the pose is too old",
    status_t.NOT_LOCALIZED: "the vehicle is not localised",
    status_t.POSE_OUTSIDE: "the vehicle is outside the layout",
    status_t.OBSTACLES_STALE: "source {id} of obstacles has fallen silent",
    status_t.MAP_MISMATCH: "the input is for another map",
    status_t.REVISION_GAP: "a revision of the layout is missing",
    status_t.OUTDATED: "a newer revision is held already",
    status_t.CONFLICT: "this revision is held with other content",
    status_t.MALFORMED: "malformed input",
    status_t.CLOCK_JUMP: "the clock jumped",
    status_t.START_OCCUPIED: "no room where the vehicle stands, {what}",
    status_t.GOAL_OCCUPIED: "no room at the goal, {what}",
    status_t.GOAL_OUTSIDE: "goal {id} is outside the layout",
    status_t.NO_PATH: "there is no way, proved",
    status_t.BLOCKED_BY: "the way is blocked by mover {id}",
    status_t.TOO_NARROW: "a gap is too narrow, {what}",
    status_t.KINEMATIC: "the vehicle cannot turn there",
    status_t.BUDGET: "the work units ran out",
    status_t.YIELDING: "giving way to mover {id}",
    status_t.OFF_PATH: "the vehicle is off its path",
    status_t.LIMIT: "over limit {id}",
    status_t.VERIFY_FAILED: "the path could not be proved",
    status_t.WATCHDOG: "planning took too long",
    status_t.INTERNAL: "internal fault",
}


def cause_in_words(cause: int, ident: int) -> str:
    """As a person says it; empty for no cause."""
    if cause == 0:
        return ""
    return CAUSE_WORDS.get(cause, cause_name(cause)).format(id=ident, what=what(cause, ident))


def path_in_words(path: path_t) -> str:
    """Status and cause of a path."""
    why = cause_in_words(path.cause, path.cause_id)
    if path.status == path_t.NONE:
        head = CAUSE_WORDS.get(path.cause, "").replace(", {what}", "").format(id=path.cause_id)
        return reason(path, head) if path.num_waypoints > 0 else f"nothing to drive: {why}" if why else "nothing to drive"
    text = {path_t.PARTIAL: "a safe part that ends at rest", path_t.STOP: "brake along these points"}.get(path.status, "")
    return ": ".join(part for part in (text, why) if part) or "free way"


def in_words(state: int, cause: int, ident: int) -> str:
    """State and cause of a status_t in one line."""
    word = STATE_WORDS[state] if 0 <= state < len(STATE_WORDS) else f"state {state}"
    return f"{word}: {cause_in_words(cause, ident)}" if cause else word


def obstacle(ident: int) -> str:
    return {-1: "the scanned map", -2: "the bounds"}.get(ident, f"polygon {ident}")


def what(cause: int, ident: int) -> str:
    """The thing cause_id means."""
    if cause in (status_t.START_OCCUPIED, status_t.GOAL_OCCUPIED, status_t.TOO_NARROW, status_t.KINEMATIC):
        return f"by {obstacle(ident)}"
    if cause in (status_t.GOAL_OUTSIDE, status_t.NO_PATH):
        return f"goal {ident}"
    if cause == status_t.LIMIT:
        return f"limit {ident}"
    return f"id {ident}"


# timer_id and counter_id of diag_t: of the planner from 0, of the daemon from 100.
TIMERS = dict(enumerate(["slice", "request", "decode", "publish", "cycle", "answer", "answer's work"]))
COUNTERS = dict(
    enumerate(
        [
            "inputs",
            "rejected",
            "duplicates",
            "layouts",
            "queries",
            "goal lists",
            "paths",
            "no paths",
            "verify failed",
            "nodes",
            "swarm evaluations",
            "verify intervals",
            "work units",
            "open nodes max",
            "narrow-phase tests",
            "support calls max",
            "cache hits",
            "cache misses",
            "cache kept",
            "cache dropped",
            "cache spoiled",
            "layout work",
            "ways round",
            "wait ms",
            "way round ms",
            "cache repaired",
            "roadmaps",
            "roadmap repairs",
            "arm goals",
            "arm paths",
            "cycle inputs",
            "cycles",
        ]
    )
)
COUNTERS.update(
    enumerate(
        [
            "received",
            "replaced",
            "oversize",
            "dropped",
            "flooded",
            "malformed",
            "over limit",
            "published",
            "publish failed",
            "clock jumps",
            "queue bytes max",
        ],
        start=100,
    )
)
