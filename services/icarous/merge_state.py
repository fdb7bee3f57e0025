"""The merge fix of an instance, and the instance's state of the merge."""

from __future__ import annotations

from typing import NamedTuple

from cratous.core.kernel import Vec2
from cratous.core.merging.stages import AWAY
from cratous.core.routing.polylines import Track
from cratous.services.icarous.course import Course
from cratous.services.icarous.merger import Merger, Talks
from cratous.spec.mission import Position


class Fix(NamedTuple):
    """Fixed configuration: the fix, the radii of its zones [m], and the configuration of the agreement on slots."""

    name: str
    place: Vec2
    coordination_m: float
    schedule_m: float
    entry_m: float
    talks: Talks


class Followed(NamedTuple):
    """The announced route, and the vehicle's position on it [m of arc length]."""

    points: tuple[Position, ...]
    track: Track
    at_m: float


class Merging(NamedTuple):
    """State of a merge.

    stage: numbered as in `core.merging.stages`; merger: this member's state of the agreement on slots; way: the
    vehicle's route, None if none was announced; course: the course being flown, None if none is permitted or UxAS
    flies; slot: at the fix [ms], None for none; told: stage, term, leader, request and slot as recorded last; tried: the
    courses that were tried, if none is permitted.
    """

    stage: int = AWAY
    merger: Merger = Merger()
    way: Followed | None = None
    course: Course | None = None
    slot: int | None = None
    told: tuple[int, int, int, int, int] = (AWAY, 0, 0, 0, -1)
    tried: tuple[Course, ...] = ()
