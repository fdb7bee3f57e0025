"""Whether a task's vehicle flies its plan: not while ICAROUS has it, nor while it circles or returns without the link."""

from __future__ import annotations

from typing import Any

from cratous.core.authority.link_loss import LINKED, LOITER, OVER, RETURN

AUTHORITY, ALONE = "cratous.AuthorityChange", "cratous.LinkLossState"
WITH_UXAS, WITH_ICAROUS, HANDED_BACK, CIRCLES = 0, 1, 2, 3
ALONE_MODES = (LOITER, RETURN, OVER)
AWAY = {"ICAROUS": WITH_ICAROUS, "UxAS": HANDED_BACK}


def away_after(away: int, topic: str, body: Any) -> int:
    """Where a vehicle is after an AuthorityChange or LinkLossState: no task ends until it flies its plan again."""
    if topic == AUTHORITY:
        return AWAY[body.Owner.name]
    if int(body.Mode) in ALONE_MODES and away != WITH_ICAROUS:
        return CIRCLES
    return HANDED_BACK if int(body.Mode) == LINKED and away == CIRCLES else away


def on_its_way(body: Any) -> bool:
    """Whether a state is of a vehicle that flies waypoints; assumed if it has no mode."""
    return not hasattr(body, "Mode") or bool(body.Mode.name == "Waypoint")
