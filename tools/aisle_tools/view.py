"""aisle view: one HTML page, without a network, that plays a recorded run."""

from __future__ import annotations

import argparse
import base64
import html
import json
import math
import zlib
from pathlib import Path
from typing import Any

import numpy as np
from aisle import vehicle_t

from aisle_tools import maps, names, vehicle, view_log
from aisle_tools.errors import UserError
from aisle_tools.vehicle import Body
from aisle_tools.view_log import Log
from aisle_tools.view_paths import integers, reply_of

HERE = Path(__file__).resolve().parent
PARTS = {"style": "view_page.css", "script": "view_page.js"}
GAP_SHOWN = 10.0  # m, larger ones are drawn as this


def configure(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("log", type=Path, metavar="LOG", help="LCM log of a run or of queries")
    parser.add_argument("--out", type=Path, metavar="FILE", help="default: beside the log, with .html")
    parser.add_argument("--from", dest="begin", type=float, metavar="S", help="s since the log's begin; default: all")
    parser.add_argument("--to", dest="end", type=float, metavar="S")
    parser.add_argument("--title", metavar="TEXT", help="default: the log's name")
    parser.add_argument("--map", type=Path, metavar="FILE", help="map_server .yaml or scenario; default: as in the log")
    maps.add_read_options(parser)
    vehicle.add_options(parser)


def run(args: argparse.Namespace) -> int:
    log = Log(args.log, args.prefix)
    data = collect(log, args)
    out = args.out or args.log.with_suffix(".html")
    text = page(data, args.title or name_of(args.log))
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        out.write_text(text, encoding="utf-8")
    except OSError as e:
        raise UserError(f"{out}: cannot be written: {e.strerror}") from None
    print(f"{out}: {summary(data)}, {len(text.encode()) / 1e6:.1f} MB")
    if log.undecodable:
        print(f"{log.undecodable} undecodable messages left out")
    return 0


def name_of(log: Path) -> str:
    """Many logs are named alike, their directories are not."""
    parent = log.resolve().parent.name
    return f"{parent}/{log.stem}" if parent else log.stem


def summary(data: dict) -> str:
    what = f"{data['end'] - data['begin']:.1f} s, {len(data['paths'])} path revisions"
    return what + (f", {len(data['replies'])} replies" if data["replies"] else "")


def window(args: argparse.Namespace, log: Log) -> tuple[float, float]:
    """Seconds of the log to show."""
    begin = max(args.begin, 0.0) if args.begin is not None else 0.0
    end = min(args.end, log.end) if args.end is not None else log.end
    if not (math.isfinite(begin) and math.isfinite(end) and (begin < end or begin == end == log.end)):
        raise UserError(f"nothing from {begin:g} to {end:g} s: the log lasts {log.end:.1f} s")
    return begin, end


def collect(log: Log, args: argparse.Namespace) -> dict[str, Any]:
    """All that the page shows."""
    begin, end = window(args, log)
    bodies = bodies_of(log, args)
    body = bodies[-1][1]
    poses, localized = view_log.poses_of(log, begin, end)
    snapshots = view_log.snapshots_of(log, begin, end)
    replies = [reply_of(r, asked_by(log, r.query_id, t), body) for t, r in log.of["REPLY"].pairs()]
    paths = view_log.paths_of(log, body, begin, end)
    if len(poses) == 0 and not replies and not paths:
        raise UserError(f"{log.path}: neither poses nor paths nor replies of prefix {args.prefix}: nothing to play")
    return {
        "utime": log.t0,
        "begin": round(begin, 3),
        "end": round(end, 3),
        "layouts": worlds(log, args),
        "bodies": [view_log.encode_body(t, b, rev) for t, b, rev in bodies],
        "poses": view_log.encode_poses(poses, localized),
        "movers": view_log.encode_movers(snapshots),
        "gap": encode_gaps(view_log.gaps_of(poses, snapshots, body)),
        "paths": paths,
        "goals": view_log.goal_lists_of(log),
        "status": view_log.statuses_of(log),
        "remaining": view_log.remaining_of(log),
        "commands": view_log.commands_of(log),
        "replies": replies,
        "kinds": [k.lower().replace("_", " ") for k in names.KINDS],
    }


def encode_gaps(gaps: np.ndarray) -> list[int]:
    """cm, -1 where no mover is known."""
    return integers(np.where(np.isnan(gaps), -0.01, np.minimum(gaps, GAP_SHOWN)), 100)


def asked_by(log: Log, ident: int, t: float) -> Any:
    """The last query of this id before the reply; numbers may come again."""
    asked = [q for asked_at, q in log.of["QUERY"].pairs() if q.query_id == ident and asked_at <= t]
    return asked[-1] if asked else None


def bodies_of(log: Log, args: argparse.Namespace) -> list[tuple[float, Body, int]]:
    """(since, body, revision): as given, else each revision in the log, else the default."""
    given = vehicle.from_options(args)
    if given is not None:
        return [(0.0, vehicle.body(given), given.vehicle_revision)]
    out: list[tuple[float, Body, int]] = []
    for t, msg in log.of["VEHICLE"].pairs():
        if not out or out[-1][2] != msg.vehicle_revision:
            out.append((t, vehicle.body(msg), msg.vehicle_revision))
    return out or [(0.0, vehicle.body(vehicle_t()), 0)]


def worlds(log: Log, args: argparse.Namespace) -> list[dict]:
    if args.map is not None:
        margin = args.margin if args.margin is not None else 0.0
        return [view_log.encode_world(0.0, maps.read_any(args.map, args, margin)[0], (0, 0))]
    found = view_log.worlds_of(log)
    if not found:
        raise UserError(f"{log.path}: no layout of prefix {args.prefix} is in the log; record it, too, or give --map FILE")
    return [view_log.encode_world(*entry) for entry in found]


def page(data: dict, title: str) -> str:
    """The template with style, script and data put in; the data is base64, so it cannot end its element."""
    text = (HERE / "view_page.html").read_text(encoding="utf-8")
    packed = base64.b64encode(zlib.compress(json.dumps(data, separators=(",", ":"), allow_nan=False).encode(), 9)).decode()
    slots = {name: (HERE / file).read_text(encoding="utf-8") for name, file in PARTS.items()}
    slots |= {"title": html.escape(title), "data": packed}
    for name, content in slots.items():
        text = text.replace("{{" + name + "}}", content)
    return text
