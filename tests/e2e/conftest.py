import itertools

import pytest
from harness import AISLE_REPLAY, AISLED, DATA, Daemon, alone_on_loopback

_numbers = itertools.count(1)


def pytest_sessionstart(session):  # noqa: ARG001
    if not alone_on_loopback():
        pytest.exit("only in a network namespace of its own: tools/netns-lo python -m pytest tests/e2e", returncode=77)
    if not AISLED or not AISLE_REPLAY:
        pytest.exit("AISLED and AISLE_REPLAY must name the programs to test", returncode=2)


@pytest.fixture
def data():
    return DATA


@pytest.fixture
def make_daemon(tmp_path):
    """Makes daemons with prefixes of their own; all are gone afterwards."""
    made = []

    def make(*options, start=True):
        daemon = Daemon(f"E2E{next(_numbers)}", tmp_path, *options)
        made.append(daemon)
        if start:
            daemon.start()
        return daemon

    yield make
    for daemon in made:
        daemon.kill()


@pytest.fixture
def daemon(make_daemon, tmp_path):
    """One with a fast heartbeat, to wait less."""
    config = tmp_path / "fast.ini"
    config.write_text("[daemon]\nstatus_hz = 50\ndiag_hz = 10\n")
    return make_daemon("--config", str(config))
