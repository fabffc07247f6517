"""The real daemon, its bus and its console command, for tests that run in a network namespace of their own."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

from aisle import diag_t, path_t, status_t
from aisle_tools.bus import Bus

URL = "udpm://239.255.76.67:7667?ttl=0"
DATA = Path(__file__).resolve().parent.parent / "data"
AISLED = os.environ.get("AISLED", "")
AISLE_REPLAY = os.environ.get("AISLE_REPLAY", "")
PATIENCE = 30.0  # s, for things that take milliseconds; sanitizers and busy machines are slow
CHANNELS = ["LAYOUT", "LAYOUT_PATCH", "GRID", "VEHICLE", "POSE", "GOALS", "QUERY", "OBSTACLES", "COMMAND", "ARM_GOAL"]  # numbered from 0


def alone_on_loopback() -> bool:
    """True if this network namespace has nothing but lo that is up."""
    names = [line.split(":")[0].strip() for line in Path("/proc/net/dev").read_text().splitlines()[2:]]
    routes = Path("/proc/net/route").read_text().splitlines()[1:]
    return "lo" in names and all(r.split()[0] == "lo" for r in routes)


class Daemon:
    """One aisled of our own: started, heard, ended by its process handle."""

    def __init__(self, prefix: str, folder: Path, *options: str) -> None:
        self.prefix, self.folder, self.options = prefix, folder, options
        self.process: subprocess.Popen | None = None
        self.bus = Bus(URL, prefix)
        self.statuses: list[tuple[float, status_t]] = []
        self.diags: list[tuple[float, diag_t]] = []
        self.paths: list[tuple[float, path_t]] = []
        self.replies: list[path_t] = []
        self.bus.subscribe("STATUS", status_t, lambda m: self.statuses.append((time.monotonic(), m)), 1000)
        self.bus.subscribe("DIAG", diag_t, lambda m: self.diags.append((time.monotonic(), m)))
        self.bus.subscribe("PATH", path_t, lambda m: self.paths.append((time.monotonic(), m)))
        self.bus.subscribe("REPLY", path_t, self.replies.append)

    def start(self) -> status_t:
        words = [AISLED, "--lcm-url", URL, "--prefix", self.prefix, *self.options]
        before = len(self.statuses)
        with (self.folder / f"{self.prefix}.err").open("ab") as errors:
            self.process = subprocess.Popen(words, stderr=errors)
        assert self.bus.spin(PATIENCE, lambda: len(self.statuses) > before), self.stderr()
        return self.status

    def stderr(self) -> str:
        return (self.folder / f"{self.prefix}.err").read_text()

    @property
    def status(self) -> status_t:
        return self.statuses[-1][1]

    def fresh_status(self) -> status_t:
        """One that was sent after now."""
        self.hear_all()
        before = len(self.statuses)
        assert self.bus.spin(PATIENCE, lambda: len(self.statuses) >= before + 2)
        return self.status

    def hear_all(self) -> None:
        """What waits in the queue is older than now."""
        while self.bus.lcm.handle_timeout(0) > 0:
            pass

    def wait(self, condition, seconds: float = PATIENCE) -> bool:  # noqa: ANN001
        return self.bus.spin(seconds, condition)

    def counter(self, ident: int) -> int:
        """From a _DIAG sent after now."""
        self.hear_all()
        before = len(self.diags)
        assert self.bus.spin(PATIENCE, lambda: len(self.diags) > before + 1)
        diag = self.diags[-1][1]
        return dict(zip(diag.counter_id, diag.counter))[ident]

    def is_alive(self) -> bool:
        return self.process is not None and self.process.poll() is None

    def stop(self, with_signal: int = signal.SIGTERM) -> int:
        assert self.process is not None
        if self.process.poll() is None:
            self.process.send_signal(with_signal)
        return self.process.wait(PATIENCE)

    def kill(self) -> None:
        if self.process is not None and self.process.poll() is None:
            self.process.kill()
            self.process.wait()

    def aisle(self, *words: object, expect: int = 0) -> str:
        """Runs the console command on this daemon's bus; its output."""
        command, *rest = [str(w) for w in words]
        line = [sys.executable, "-m", "aisle_tools", command, "--lcm-url", URL, "--prefix", self.prefix]
        done = subprocess.run([*line, "--timeout", str(PATIENCE), *rest], capture_output=True, text=True, timeout=120)
        assert done.returncode == expect, f"{words}: {done.returncode}\n{done.stdout}\n{done.stderr}\n{self.stderr()}"
        return done.stdout + done.stderr
