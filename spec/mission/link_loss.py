"""What a mission can want of its vehicles while UxAS is not heard."""

from __future__ import annotations

from enum import StrEnum


class WithoutLink(StrEnum):
    """finish: the way that is known is flown to its end; loiter: a circle where the vehicle is; return: to a place."""

    FINISH = "finish"
    LOITER = "loiter"
    RETURN = "return"


def words(choice: WithoutLink, name: str) -> str:
    """A choice in words. name: of the place to return to, "" for the start."""
    if choice is WithoutLink.FINISH:
        return "the known way is flown to its end"
    if choice is WithoutLink.LOITER:
        return "a circle is flown"
    return f"return to {name or 'the start'}"
