"""ICAROUS requests a way back from UxAS's route planner where its own is blocked: WPREQ up, RPRSP down.

UxAS permits such requests (COMND UXAS_PLANS) and revokes that (ICAROUS_PLANS). While an instance flies and
the direct way back is not free, e.g. because a zone lies across it, it sends at most one request per second.
The answer is only a proposal: the kernels that check the instance's own way back check it too, at each
heartbeat from the present position, and control is handed back on it only if they permit it. If no answer
arrives in time, or an empty one, the instance continues on its own and reports that.
"""

from __future__ import annotations

from typing import NamedTuple

from cratous.bridge.text_protocol import (
    IcarousPlans,
    Message,
    RouteEnd,
    RoutePoint,
    RouteRequest,
    RouteStart,
    UxasPlans,
)
from cratous.core.authority.timeliness import lasted
from cratous.services.mission.frames import Projection, compass
from cratous.spec.mission import Position
from cratous.spec.mission.plan import Pose

PERIOD_MS = 1000
"""Shortest interval between two requests [ms]."""
ANSWER_MS = 3000
"""An answer must arrive within this time [ms]: six heartbeats."""
PAUSE_MS = 10_000
"""No request is sent for this long after an overdue answer [ms]."""
MOST_POINTS = 256
"""A longer answer is discarded."""
OVERDUE = f"UxAS has not answered within {ANSWER_MS / 1000:g} s: ICAROUS finds its way back itself"
NO_WAY = "UxAS's planner has found no way back: ICAROUS finds its way back itself"
TOO_LONG = f"UxAS's way back has more than {MOST_POINTS} places: ICAROUS finds its way back itself"
NOT_ASKED = "a way has come that nobody asks for"


class Asking(NamedTuple):
    """State of the requests to UxAS for a way back.

    allowed: UxAS plans live; number: of the last request; asked_ms: when the pending request was sent, None
    if none is pending; next_ms: earliest next request; gathered: points of the answer received so far, None
    before its beginning; proposal: the last answer, to request `answered`; said: sentences to log.
    """

    allowed: bool = False
    number: int = 0
    asked_ms: int | None = None
    next_ms: int = 0
    gathered: tuple[Position, ...] | None = None
    proposal: tuple[Position, ...] = ()
    answered: int = 0
    said: tuple[str, ...] = ()

    def tells(self, text: str) -> Asking:
        """The state with a sentence to log, unless it is already there."""
        return self if text in self.said else self._replace(said=(*self.said, text))

    def idle(self) -> Asking:
        """The state without a pending request or proposal: UxAS flies."""
        return Asking(self.allowed, self.number)


def heard(asking: Asking, line: Message, projection: Projection) -> Asking:
    """The state after a line from UxAS."""
    match line:
        case UxasPlans():
            return asking._replace(allowed=True)
        case IcarousPlans():
            return asking.idle()._replace(allowed=False)
        case RouteStart() | RoutePoint() | RouteEnd():
            if asking.asked_ms is None or line.request != asking.number:
                return asking.tells(NOT_ASKED)
            return _answer(asking, line, projection)
    return asking


def _answer(
    asking: Asking, line: RouteStart | RoutePoint | RouteEnd, projection: Projection
) -> Asking:
    if isinstance(line, RouteStart):
        return asking._replace(gathered=())
    if asking.gathered is None:
        return asking.tells(NOT_ASKED)
    places = asking.gathered
    if isinstance(line, RoutePoint):
        if len(places) not in range(MOST_POINTS):
            return asking._replace(asked_ms=None, gathered=None, proposal=()).tells(TOO_LONG)
        north, east = projection.to_local(line.lat_deg, line.long_deg)
        return asking._replace(gathered=(*places, Position(north, east, line.alt_m)))
    after = asking._replace(asked_ms=None, gathered=None, proposal=places, answered=asking.number)
    return after if places else after.tells(NO_WAY)


def waited(asking: Asking, now_ms: int) -> Asking:
    """The state at a heartbeat: an overdue request is given up."""
    if asking.asked_ms is None or not lasted(asking.asked_ms, now_ms, ANSWER_MS):
        return asking
    given_up = asking._replace(asked_ms=None, gathered=None, proposal=())
    return given_up._replace(next_ms=now_ms + PAUSE_MS).tells(OVERDUE)


def asks(
    asking: Asking,
    now_ms: int,
    start: Pose,
    speed_m_s: float,
    end: Position,
    projection: Projection,
) -> tuple[Asking, RouteRequest | None]:
    """The state after requesting a way from a pose to a place, and the line to send; None if no request is
    due.
    """
    if asking.asked_ms is not None or not lasted(asking.next_ms, now_ms, 0):
        return asking, None
    number = asking.number + 1
    line = RouteRequest(
        "ASTAR",
        *projection.to_geodetic(start.north_m, start.east_m),
        start.alt_m,
        *projection.to_geodetic(end.north_m, end.east_m),
        end.alt_m,
        compass(start.heading_rad),
        speed_m_s,
        0.0,
        number,
    )
    return asking._replace(number=number, asked_ms=now_ms, next_ms=now_ms + PERIOD_MS), line
