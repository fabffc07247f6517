"""Sends until the daemon's status says that it holds what was sent, or why it refused it."""

from __future__ import annotations

import sys
from typing import Callable

from aisle import status_t

from aisle_tools.bus import Bus, StatusWatch
from aisle_tools.errors import UserError
from aisle_tools.names import HINTS, cause_name

RESEND = 1.0  # s without acknowledgement until everything is sent again; twice that after the first time
REFUSALS = (
    status_t.MAP_MISMATCH,
    status_t.REVISION_GAP,
    status_t.OUTDATED,
    status_t.CONFLICT,
    status_t.MALFORMED,
    status_t.LIMIT,
)


def send_until_held(
    bus: Bus,
    status: StatusWatch,
    publish: Callable[[], None],
    is_held: Callable[[status_t], bool],
    what: str,
    timeout: float,
) -> None:
    """Returns when held; UserError when refused, or neither within the timeout."""
    status.drain()
    before = status.wait(timeout)
    already = is_held(before)  # by its number; another content under it is refused

    def refused() -> bool:
        s = status.wait(0.0)
        return s.boot_id == before.boot_id and s.num_rejected > before.num_rejected and s.cause in REFUSALS

    def held() -> bool:
        return not already and is_held(status.wait(0.0))

    for attempt in range(max(1, int(timeout / RESEND))):
        if attempt > 0:
            print(f"aisle: {what} not acknowledged yet, sending again", file=sys.stderr)
        publish()
        bus.spin(RESEND if attempt == 0 else 2.0 * RESEND, lambda: held() or refused())
        if refused() and not held():
            raise UserError(refusal_text(what, status.wait(0.0)))
        if is_held(status.wait(0.0)):
            return
    last = status.wait(timeout)
    raise UserError(
        f"{what} was not taken within {timeout:g} s: the daemon holds map {last.map_id} revision {last.map_revision}, "
        f"vehicle revision {last.vehicle_revision}; cause {cause_name(last.cause)}"
    )


def refusal_text(what: str, status: status_t) -> str:
    text = f"{what} refused by the daemon: {cause_name(status.cause)}"
    if status.cause_id != 0:
        text += f", {'limit' if status.cause == status_t.LIMIT else 'id'} {status.cause_id}"
    if status.cause in HINTS:
        text += f" ({HINTS[status.cause]})"
    return text
