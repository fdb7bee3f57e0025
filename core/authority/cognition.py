"""Decision logic of a vehicle's ICAROUS: the mode that the vehicle is in, from the conditions at a heartbeat. Kernels.

NOMINAL (0): UxAS flies the plan. DEVIATION (1): UxAS flies, off the plan. RETURN_TO_PATH (2): ICAROUS flies, and the way
back is permitted. NEXT_WAYPOINT (3): the same, on another route than the one that was left. MERGING (4): over a merge
fix by ICAROUS. LOST_LINK (5): by itself, as UxAS is not heard. FAILED (6): by itself after a declared failure. DITCH
(7): on the way to a landing site. FENCE_CONFLICT (8), TRAFFIC_CONFLICT (9): avoiding. TAKE_OFF (10). LAND (11): in the
final descent. LANDED (12). The gravest mode for which there is a reason is flown. Definitions:
`spec.authority.cognition`.
"""

from typing import NamedTuple

from cratous.core.kernel import kernel

NOMINAL, DEVIATION, RETURN_TO_PATH, NEXT_WAYPOINT, MERGING = 0, 1, 2, 3, 4
LOST_LINK, FAILED, DITCH, FENCE_CONFLICT, TRAFFIC_CONFLICT = 5, 6, 7, 8, 9
TAKE_OFF, LAND, LANDED = 10, 11, 12


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


@kernel(implements="authority.cognition.is_decided")
def decide(mode: int, seen: Conditions) -> int:
    """The mode from this heartbeat on. mode: until now."""
    if mode == 12 or seen.landed:
        return 12
    if mode == 11 or seen.descends:
        return 11
    if seen.departs:
        return 10
    if seen.traffic:
        return 9
    if seen.fence:
        return 8
    if seen.alone:
        if seen.lands:
            return 7
        if seen.failed:
            return 6
        return 5
    if seen.merges:
        return 4
    if seen.has:
        if seen.skips:
            return 3
        return 2
    if seen.deviates:
        return 1
    return 0


@kernel(implements="authority.cognition.must_fly")
def mode_takes(mode: int) -> bool:
    """True iff ICAROUS has to command the vehicle in this mode."""
    return mode != 0 and mode != 1


@kernel(implements="authority.cognition.may_go_back")
def mode_lets_go(mode: int) -> bool:
    """True iff the vehicle may be offered to UxAS in this mode."""
    return mode == 2 or mode == 3


@kernel(implements="authority.cognition.avoids")
def mode_avoids(mode: int) -> bool:
    """True iff a conflict is avoided in this mode."""
    return mode == 8 or mode == 9


@kernel(implements="authority.cognition.is_turn", nonnegative=("least",))
def turns_by(off: float, least: float) -> bool:
    """True iff a manoeuvre is a turn. off: its heading less the present one, in the shorter sense [rad]; least: an angle
    that still counts as straight on [rad], >= 0.
    """
    return off > least or off < -least


@kernel(implements="authority.cognition.is_resolution")
def resolution(mode: int, turns: bool, climbs: bool, paces: bool, clear: bool) -> int:
    """How a conflict is avoided: 0 there is none, 1 by a turn, 2 by a change of altitude, 3 of speed, 4 by more than one
    of these, 5 no manoeuvre is free of conflict, and the least bad one is flown.

    turns, climbs, paces: the manoeuvre changes direction, altitude, speed; clear: it is free of conflict.
    """
    if not mode_avoids(mode):
        return 0
    if not clear:
        return 5
    if climbs:
        if turns or paces:
            return 4
        return 2
    if paces:
        if turns:
            return 4
        return 3
    return 1
