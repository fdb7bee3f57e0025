"""Take-off of one vehicle that starts on the ground. Transition kernels.

STANDING (0): on the ground, at a standstill or braking. ROLLING (1): accelerating on the ground. CLIMBING (2):
airborne, on the climb path. UP (3): take-off is over, or the vehicle started in the air. At each heartbeat the
instance first determines its mode, then takes the vehicle over or flies it (`core.authority.cycle`). Definitions:
`spec.authority.take_off`.
"""

from typing import NamedTuple

from cratous.core.authority.timeliness import in_time
from cratous.core.kernel import kernel

STANDING, ROLLING, CLIMBING, UP = 0, 1, 2, 3


class Departure(NamedTuple):
    """mode: see above; since_ms: when it began [ms]."""

    mode: int
    since_ms: int


class DepartureStep(NamedTuple):
    """The mode afterwards, and the event: 0 nothing, 1 the roll begins, 2 it is aborted, 3 the vehicle is airborne, 4
    it is at the end of the climb path, 5 that path is left.
    """

    departure: Departure
    act: int


@kernel(implements="authority.take_off.is_after_heartbeat", nonnegative=("bound",))
def departure_step(
    departure: Departure,
    heard: int,
    now: int,
    bound: int,
    permitted: bool,
    airborne: bool,
    ended: bool,
) -> DepartureStep:
    """A heartbeat of the instance.

    heard: when UxAS was last heard [ms]; now: [ms]; bound: how long it may be silent [ms], >= 0; permitted: the climb
    path is permitted from here; airborne: the vehicle is off the ground; ended: it is at the end of the path.
    """
    may = permitted and in_time(heard, now, bound)
    if departure.mode == 3:
        return DepartureStep(departure, 0)
    if departure.mode == 2:
        if ended:
            return DepartureStep(Departure(3, now), 4)
        if may:
            return DepartureStep(departure, 0)
        return DepartureStep(Departure(3, now), 5)
    if airborne:
        return DepartureStep(Departure(2, now), 3)
    if departure.mode == 1:
        if may:
            return DepartureStep(departure, 0)
        return DepartureStep(Departure(0, now), 2)
    if may:
        return DepartureStep(Departure(1, now), 1)
    return DepartureStep(departure, 0)


@kernel(
    implements="authority.take_off.must_fly",
    restates="why ICAROUS has a vehicle; that it has it until it is up is proved of it",
)
def departure_takes(departure: Departure, foreseen: bool) -> bool:
    """True iff ICAROUS has to command the vehicle. foreseen: a conflict is predicted on which it must act."""
    return foreseen or departure.mode != 3


@kernel(
    implements="authority.take_off.may_go_back",
    restates="when a vehicle may go back; that nothing is offered before it is up is proved of it",
)
def departure_lets_go(departure: Departure, free: bool) -> bool:
    """True iff the vehicle may go to UxAS. free: the way back is free of predicted conflict."""
    return free and departure.mode == 3
