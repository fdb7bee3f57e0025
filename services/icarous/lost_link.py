"""What an instance flies by itself: its parameters, and its state while UxAS is not heard or no longer obeyed."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from cratous.core.authority.failure import Asked
from cratous.core.authority.link_loss import LINKED, Loss
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
    name of the preferred landing site, "" for none; sites: all landing sites.
    """

    choice: int
    after_ms: int
    words: str
    find: FindWay
    goal: Position | None = None
    site: str = ""
    sites: tuple[LandingSite, ...] = ()


class OnFailure(NamedTuple):
    """asked: the failures that count; flies: what is flown after one, whatever is heard of UxAS."""

    asked: Asked
    flies: LostLink


class NoLink(NamedTuple):
    """loss: the mode, as the kernels have it; course: what is flown in it, None where nothing is permitted;
    tried_ms: when a course for the choice was last searched for [ms].
    """

    loss: Loss = Loss(LINKED, 0)
    course: Course | None = None
    tried_ms: int = 0
