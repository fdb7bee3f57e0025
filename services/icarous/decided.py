"""The state of the decision logic: the mode, why the vehicle is in it, and how it avoids a conflict."""

from __future__ import annotations

from typing import NamedTuple

from cratous.core.authority.cognition import NOMINAL, Conditions
from cratous.spec.authority.cognition import NONE
from cratous.spec.mission import Position

NOTHING_SEEN = Conditions(*(False for _ in Conditions._fields))


class Decided(NamedTuple):
    """mode: as the kernel `decide` has it; seen: the conditions for it; intruder_id: an aircraft that forbids what would
    be flown, 0 if none is known; left, next_index: the route, and the waypoint ahead on it, when UxAS last had the vehicle;
    skipped: number of waypoints from there on that are on its route no more; resolution: how a conflict is avoided, as
    the kernel `resolution` has it.
    """

    mode: int = NOMINAL
    seen: Conditions = NOTHING_SEEN
    intruder_id: int = 0
    left: tuple[Position, ...] = ()
    next_index: int = 0
    skipped: int = 0
    resolution: int = NONE
