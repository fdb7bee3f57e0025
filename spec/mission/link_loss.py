"""What a mission can want of its vehicles while UxAS is not heard."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class WithoutLink(StrEnum):
    """finish: the way that is known is flown to its end; loiter: a circle where the vehicle is; return: to a place;
    land: at a landing site."""

    FINISH = "finish"
    LOITER = "loiter"
    RETURN = "return"
    LAND = "land"


@dataclass(frozen=True)
class LandingSite:
    """Where a vehicle may land: the disc of radius_m [m] about a place, whose ground is at ground_m [m MSL].

    ditch: only where no permitted way leads to another."""

    name: str
    north_m: float
    east_m: float
    ground_m: float
    radius_m: float
    ditch: bool = False


def words(choice: WithoutLink, name: str) -> str:
    """A choice in words. name: of the place to return to or to land at, "" for the start or the nearest site."""
    if choice is WithoutLink.FINISH:
        return "the known way is flown to its end"
    if choice is WithoutLink.LOITER:
        return "a circle is flown"
    if choice is WithoutLink.LAND:
        return f"land at {name or 'the nearest site'}"
    return f"return to {name or 'the start'}"
