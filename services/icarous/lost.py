"""What an instance knows about acting without UxAS, and remembers of it."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from cratous.core.authority.link_loss import LINKED, Loss
from cratous.services.icarous.course import Course
from cratous.spec.mission import Position, Zone
from cratous.spec.mission.link_loss import LandingSite
from cratous.spec.mission.plan import Pose

FindWay = Callable[[Pose, Pose, float, float, tuple[Zone, ...]], tuple[Position, ...]]
"""From a pose to a pose by turns of a radius [m], climbing at most so steeply, around zones; () if none is found."""


class LostLink(NamedTuple):
    """choice: FINISH, LOITER, RETURN or LAND of `core.authority.link_loss`; after_ms: how long UxAS may be silent [ms];
    words: the choice; find: looks for a way; goal: where to return to, else None; site: the landing site that is named,
    "" for none; sites: all of them."""

    choice: int
    after_ms: int
    words: str
    find: FindWay
    goal: Position | None = None
    site: str = ""
    sites: tuple[LandingSite, ...] = ()


class NoLink(NamedTuple):
    """loss: the mode, as the kernels have it; course: what is flown in it, None where nothing is permitted; tried_ms:
    when a way of what is chosen was last looked for [ms]."""

    loss: Loss = Loss(LINKED, 0)
    course: Course | None = None
    tried_ms: int = 0
