"""What an instance knows about the fix where it merges, and remembers of it."""

from __future__ import annotations

from typing import NamedTuple

from cratous.core.kernel import Vec2
from cratous.core.merging.stages import AWAY
from cratous.core.routing.polylines import Track
from cratous.services.icarous.course import Course
from cratous.services.icarous.merger import Merger, Talks
from cratous.spec.mission import Position


class Fix(NamedTuple):
    """What does not change: the fix and its zones [m], who merges there, and how far slots are apart."""

    name: str
    place: Vec2
    coordination_m: float
    schedule_m: float
    entry_m: float
    talks: Talks


class Followed(NamedTuple):
    """The way that was told, and where on it the vehicle is [m of arc length]."""

    points: tuple[Position, ...]
    track: Track
    at_m: float


class Merging(NamedTuple):
    """stage: as the kernels have it; merger: what the members have agreed upon, as far as this one knows; way: of the
    vehicle, None where none was told; course: what is flown, None where nothing is permitted, or UxAS flies; slot: at
    the fix [ms], None for none."""

    stage: int = AWAY
    merger: Merger = Merger()
    way: Followed | None = None
    course: Course | None = None
    slot: int | None = None
