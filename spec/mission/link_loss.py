"""The mission's choices for flight while UxAS is not heard."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class WithoutLink(StrEnum):
    """finish: the known path is flown to its end; loiter: a circle where the vehicle is; return: to a place; land: at
    a landing site.
    """

    FINISH = "finish"
    LOITER = "loiter"
    RETURN = "return"
    LAND = "land"


@dataclass(frozen=True)
class LandingSite:
    """A permitted landing site: the disc of radius_m [m] about a place, with its ground at ground_m [m MSL].

    ditch: used only if no permitted path leads to another site.
    """

    name: str
    north_m: float
    east_m: float
    ground_m: float
    radius_m: float
    ditch: bool = False


def words(choice: WithoutLink, name: str) -> str:
    """A choice in words. name: of the place to return to or land at, "" for the start or the nearest site."""
    if choice is WithoutLink.FINISH:
        return "the known way is flown to its end"
    if choice is WithoutLink.LOITER:
        return "a circle is flown"
    if choice is WithoutLink.LAND:
        return f"land at {name or 'the nearest site'}"
    return f"return to {name or 'the start'}"
