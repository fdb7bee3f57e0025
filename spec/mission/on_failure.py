"""The mission's choices for flight after a declared failure."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from cratous.spec.mission.link_loss import LandingSite


class AfterFailure(StrEnum):
    """hold: a circle where the vehicle is; return: to a place; land: at a landing site; ditch: at one for ditching."""

    HOLD = "hold"
    RETURN = "return"
    LAND = "land"
    DITCH = "ditch"


class Failed(StrEnum):
    """The declared failures, as in `spec.authority.failure`."""

    BLOCKED = "blocked"
    EXPIRING = "expiring"
    SURPRISED = "surprised"
    ENDED = "ended"


@dataclass(frozen=True)
class OnFailure:
    """What each vehicle with an ICAROUS instance flies once it has declared one of the failures `of`.

    to: north, east [m] and altitude [m MSL] of the place to return to, None: where each vehicle started; name: of that
    place, or of the site to land at, "" for the nearest; sites: all permitted landing sites.
    """

    choice: AfterFailure = AfterFailure.HOLD
    of: tuple[Failed, ...] = tuple(Failed)
    to: tuple[float, float, float] | None = None
    name: str = ""
    sites: tuple[LandingSite, ...] = ()

    @property
    def lands(self) -> bool:
        """Whether the vehicle ends on the ground."""
        return self.choice in (AfterFailure.LAND, AfterFailure.DITCH)

    @property
    def words(self) -> str:
        """The choice in words."""
        if self.choice is AfterFailure.HOLD:
            return "a circle is flown"
        if self.choice is AfterFailure.LAND:
            return f"land at {self.name or 'the nearest site'}"
        if self.choice is AfterFailure.DITCH:
            return f"ditch at {self.name or 'the nearest site for it'}"
        return f"return to {self.name or 'the start'}"
