"""Decision logic of a vehicle's ICAROUS: in which mode the vehicle is, and why.

The modes are numbered by gravity. At each heartbeat the vehicle is in the gravest mode for which there is a reason.
Each mode is a part of one of the groups below, which says what ICAROUS proposes in it.
"""

from typing import NamedTuple

NOMINAL, DEVIATION, RETURN_TO_PATH, NEXT_WAYPOINT, MERGING = 0, 1, 2, 3, 4
LOST_LINK, FAILED, DITCH, FENCE_CONFLICT, TRAFFIC_CONFLICT = 5, 6, 7, 8, 9
TAKE_OFF, LAND, LANDED = 10, 11, 12
"""Modes: UxAS flies the plan; UxAS flies, off the plan; ICAROUS flies, and the way back is permitted; the same, on
another route than the one that was left; over a merge fix by ICAROUS; by itself, as UxAS is not heard; by itself after a
declared failure; on the way to a landing site; avoiding a zone; avoiding traffic; taking off; in the final descent to
the ground; on the ground.
"""
NONE, TURN, ALTITUDE, SPEED, COMBINED, LEAST_BAD = 0, 1, 2, 3, 4, 5
"""Resolutions: nothing is avoided; by a turn; by a climb or descent; by flying slower or faster; by more than one of
these; no manoeuvre is free of conflict, and the one that keeps well clear longest is flown.
"""


class Conditions(NamedTuple):
    """landed: on the ground after its flight; descends: in the final descent; departs: the take-off is not over; traffic,
    fence: traffic, or a zone, forbids what is flown if nothing is avoided: UxAS's plan, the way back, or what is flown by
    itself; lands: what is flown by itself is the way to a landing site; failed: a failure is declared; alone: it is by
    itself, since UxAS is not heard or a failure is declared; merges: it is on its way to its slot at a merge fix, or
    holds for one; has: ICAROUS has the vehicle; skips: waypoints ahead of it when ICAROUS took it are on its route no
    more; deviates: UxAS has it, off the plan by more than the bound.
    """

    landed: bool
    descends: bool
    departs: bool
    traffic: bool
    fence: bool
    lands: bool
    failed: bool
    alone: bool
    merges: bool
    has: bool
    skips: bool
    deviates: bool


def is_mode(mode: int) -> bool:
    """It is one of the thirteen modes."""
    return not (mode < NOMINAL or mode > LANDED)


def has_reason(mode: int, before: int, seen: Conditions) -> bool:
    """There is a reason for this mode, whatever reasons there are for others. before: the mode until now."""
    return (
        mode == NOMINAL
        or (mode == DEVIATION and seen.deviates)
        or (mode == RETURN_TO_PATH and seen.has)
        or (mode == NEXT_WAYPOINT and seen.has and seen.skips)
        or (mode == MERGING and seen.merges)
        or (mode == LOST_LINK and seen.alone)
        or (mode == FAILED and seen.alone and seen.failed)
        or (mode == DITCH and seen.alone and seen.lands)
        or (mode == FENCE_CONFLICT and seen.fence)
        or (mode == TRAFFIC_CONFLICT and seen.traffic)
        or (mode == TAKE_OFF and seen.departs)
        or (mode == LAND and (seen.descends or before == LAND))
        or (mode == LANDED and (seen.landed or before == LANDED))
    )


def is_decided(before: int, seen: Conditions, after: int, other: int) -> bool:
    """There is a reason for the mode afterwards, and none for any graver one. other: any mode."""
    graver = is_mode(other) and other > after
    none_graver = not (graver and has_reason(other, before, seen))
    return is_mode(after) and has_reason(after, before, seen) and none_graver


def avoids(mode: int) -> bool:
    """Group: a conflict is avoided."""
    return not (mode < FENCE_CONFLICT or mode > TRAFFIC_CONFLICT)


def is_back(mode: int) -> bool:
    """Group: ICAROUS flies, and may offer the vehicle to UxAS."""
    return not (mode < RETURN_TO_PATH or mode > NEXT_WAYPOINT)


def is_uxas(mode: int) -> bool:
    """Group: UxAS flies, and ICAROUS proposes nothing."""
    return not (mode < NOMINAL or mode > DEVIATION)


def is_course(mode: int) -> bool:
    """Group: what is flown is a course that ICAROUS has found and that is permitted."""
    return not (mode < MERGING or mode > DITCH) or not (mode < TAKE_OFF or mode > LANDED)


def must_fly(mode: int) -> bool:
    """ICAROUS has a reason to command the vehicle."""
    return not is_uxas(mode)


def may_go_back(mode: int) -> bool:
    """The vehicle may be offered to UxAS."""
    return is_back(mode)


def is_turn(off: float, least: float) -> bool:
    """The heading of a manoeuvre is farther from the present one than this angle. off: to the right, or left of it."""
    return abs(off) > least


def is_resolution(
    mode: int, turns: bool, climbs: bool, paces: bool, clear: bool, found: int
) -> bool:
    """How a conflict is avoided. turns, climbs, paces: the manoeuvre changes direction, altitude, speed; clear: it is
    free of conflict.
    """
    if not avoids(mode):
        return found == NONE
    if not clear:
        return found == LEAST_BAD
    if (turns and climbs) or (turns and paces) or (climbs and paces):
        return found == COMBINED
    return (
        (found == TURN and not climbs and not paces)
        or (found == ALTITUDE and climbs)
        or (found == SPEED and paces)
    )
