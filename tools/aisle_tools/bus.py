"""Where messages go to and come from: a live LCM bus or an LCM event log."""

from __future__ import annotations

import os
import struct
import sys
import time
from pathlib import Path
from typing import Any, Callable

import lcm
from aisle import path_t, query_t, status_t, vehicle_t

from aisle_tools.errors import UserError

DEFAULT_PREFIX = "AISLE"
PAUSE = 0.002  # s after every BURST messages: receivers' queues are short
BURST = 8


def now_us() -> int:
    return time.time_ns() // 1000


def time_revision() -> int:
    """A number that rises from second to second, for revisions: seconds since 2020."""
    return int(time.time()) - 1_577_836_800


class Bus:
    """One LCM connection and the prefix of a vehicle's channels."""

    def __init__(self, url: str | None, prefix: str) -> None:
        self.url = url or os.environ.get("LCM_DEFAULT_URL", "")
        self.prefix = prefix
        self._published = 0
        try:
            self.lcm = lcm.LCM(self.url) if self.url else lcm.LCM()
        except RuntimeError:
            raise UserError(
                f"cannot open the LCM bus '{self.where}': no such provider, or no multicast route "
                "(tools/netns-lo runs a command on a bus of its own)"
            ) from None

    @property
    def where(self) -> str:
        return self.url or "udpm://239.255.76.67:7667?ttl=0 (LCM's default)"

    def publish(self, name: str, msg: Any) -> None:
        self.lcm.publish(f"{self.prefix}_{name}", msg.encode())
        self._published += 1
        if self._published % BURST == 0:
            time.sleep(PAUSE)

    def subscribe(self, name: str, kind: Any, handler: Callable[[Any], None], capacity: int = 64) -> None:
        def take(_channel: str, data: bytes) -> None:
            try:
                handler(kind.decode(data))
            except (ValueError, TypeError, struct.error) as e:
                print(f"aisle: undecodable message on {self.prefix}_{name}: {e}", file=sys.stderr)

        self.lcm.subscribe(f"{self.prefix}_{name}", take).set_queue_capacity(capacity)

    def spin(self, seconds: float, until: Callable[[], bool] = lambda: False) -> bool:
        """Handles messages for so long, or until the condition holds; says whether it does."""
        end = time.monotonic() + seconds
        while not until():
            left = end - time.monotonic()
            if left <= 0.0:
                return False
            self.lcm.handle_timeout(max(1, int(min(left, 0.1) * 1000)))
        return True

    def no_answer(self, seconds: float) -> UserError:
        return UserError(
            f"no answer from a daemon within {seconds:g} s: is aisled running on {self.where} with prefix {self.prefix}?"
        )


class StatusWatch:
    """Keeps the newest status_t."""

    def __init__(self, bus: Bus) -> None:
        self.bus = bus
        self.last: status_t | None = None
        bus.subscribe("STATUS", status_t, self._take)

    def _take(self, msg: status_t) -> None:
        self.last = msg

    def wait(self, seconds: float) -> status_t:
        if not self.bus.spin(seconds, lambda: self.last is not None):
            raise self.bus.no_answer(seconds)
        assert self.last is not None
        return self.last

    def drain(self) -> None:
        """Takes what has already arrived."""
        while self.bus.lcm.handle_timeout(1) > 0:
            pass


class LogWriter:
    """Appends messages to an LCM event log, 1 ms apart."""

    def __init__(self, path: Path, prefix: str) -> None:
        events = read_events(path) if path.exists() else []
        self.prefix = prefix
        self.utime = max(now_us(), events[-1][0] + 1000 if events else 0)
        try:
            self.log = lcm.EventLog(str(path), "w", overwrite=True)
        except (OSError, RuntimeError, ValueError) as e:
            raise UserError(f"{path}: cannot be written: {e}") from None
        for utime, channel, data in events:
            self.log.write_event(utime, channel, data)

    def publish(self, name: str, msg: Any) -> None:
        self.log.write_event(self.utime, f"{self.prefix}_{name}", msg.encode())
        self.utime += 1000

    def close(self) -> None:
        self.log.close()


Event = tuple  # (utime, channel, data)


def read_events(path: Path) -> list[Event]:
    if not path.is_file():
        raise UserError(f"{path}: no such file")
    try:
        log = lcm.EventLog(str(path), "r")
    except (OSError, RuntimeError, ValueError) as e:
        raise UserError(f"{path}: cannot be read as an LCM log: {e}") from None
    events = [(e.timestamp, e.channel, e.data) for e in log]
    log.close()
    if not events and path.stat().st_size > 0:
        raise UserError(f"{path}: not an LCM log")
    return events


class Recording:
    """What a log holds for one prefix, decoded: layouts, tiles, the last vehicle, queries, replies and driven paths."""

    def __init__(self, path: Path, prefix: str) -> None:
        from aisle import grid_chunk_t, layout_t

        self.path = path
        self.layouts: list[layout_t] = []
        self.tiles: list[grid_chunk_t] = []
        self.vehicle: vehicle_t | None = None
        self.queries: dict[int, query_t] = {}
        self.replies: list[path_t] = []
        self.paths: list[path_t] = []
        takers: dict[str, tuple[Any, Callable[[Any], None]]] = {
            f"{prefix}_LAYOUT": (layout_t, self.layouts.append),
            f"{prefix}_GRID": (grid_chunk_t, self.tiles.append),
            f"{prefix}_VEHICLE": (vehicle_t, self._take_vehicle),
            f"{prefix}_QUERY": (query_t, self._take_query),
            f"{prefix}_REPLY": (path_t, self.replies.append),
            f"{prefix}_PATH": (path_t, self.paths.append),
        }
        for _, channel, data in read_events(path):
            if channel in takers:
                kind, take = takers[channel]
                take(kind.decode(data))

    def _take_vehicle(self, msg: vehicle_t) -> None:
        self.vehicle = msg

    def _take_query(self, msg: query_t) -> None:
        self.queries[msg.query_id] = msg

    def newest_map(self) -> tuple[list, list]:
        """Parts and tiles of the last revision of the log."""
        if not self.layouts:
            return [], []
        key = (self.layouts[-1].map_id, self.layouts[-1].map_revision)
        return (
            [m for m in self.layouts if (m.map_id, m.map_revision) == key],
            [t for t in self.tiles if (t.map_id, t.map_revision) == key],
        )
