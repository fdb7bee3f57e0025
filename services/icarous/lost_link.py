"""What an instance flies by itself: its parameters, and its state while UxAS is not heard or no longer obeyed."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from cratous.core.authority.failure import Asked
from cratous.core.authority.link_loss import LINKED, LOITER, OVER, Loss
from cratous.services.icarous.course import Course
from cratous.spec.mission import Position, Zone
from cratous.spec.mission.link_loss import LandingSite
from cratous.spec.mission.plan import Pose

FindWay = Callable[[Pose, Pose, float, float, tuple[Zone, ...]], tuple[Position, ...]]
"""(start, end, turn radius [m], steepest slope, zones) -> the points of a route around the zones; () if none
is found.
"""


class LostLink(NamedTuple):
    """choice: FINISH, LOITER, RETURN or LAND of `core.authority.link_loss`; after_ms: tolerated silence of
    UxAS [ms]; words: the choice in words; find: route search; goal: place to return to, else None; site:
    name of the preferred landing site, "" for none; sites: all landing sites; in_hand: only while ICAROUS has the
    vehicle anyway, where the mission sets no procedure.
    """

    choice: int
    after_ms: int
    words: str
    find: FindWay
    goal: Position | None = None
    site: str = ""
    sites: tuple[LandingSite, ...] = ()
    in_hand: bool = False


class OnFailure(NamedTuple):
    """asked: the failures that count; flies: what is flown after one, whatever is heard of UxAS."""

    asked: Asked
    flies: LostLink


class NoLink(NamedTuple):
    """loss: the mode, as the kernels have it; course: what is flown in it, None where nothing is permitted;
    tried_ms: when a course for the choice was last searched for [ms]; linked_ms: when it was last heard, or the
    vehicle in its hand for a procedure that needs that [ms]; aside_ms: when a circle elsewhere was last searched for
    [ms].
    """

    loss: Loss = Loss(LINKED, 0)
    course: Course | None = None
    tried_ms: int = 0
    linked_ms: int = 0
    aside_ms: int = -60_000

    @property
    def circles(self) -> bool:
        """Whether a permitted circle is flown, at its place."""
        there = self.course is not None and self.course.flown_to_its_end
        return there and self.loss.mode in (LOITER, OVER)
