"""Rendezvous of vehicles: the common time, the speed for arriving then, and whether each did. Definitions:
`spec.rendezvous`.
"""

from typing import NamedTuple

from cratous.core.kernel import Vec2, kernel


class Meeting(NamedTuple):
    """The arrival times common to all vehicles so far: from first [ms] until last [ms], -1: without an end."""

    first: int
    last: int


@kernel(implements="rendezvous.in_window")
def meeting_step(meeting: Meeting, soonest: int, latest: int) -> Meeting:
    """Add a vehicle that can arrive from soonest [ms] until latest [ms], -1: that can wait without limit."""
    first = meeting.first
    if soonest > first:
        first = soonest
    last = meeting.last
    if last == -1 or (latest != -1 and latest < last):
        last = latest
    return Meeting(first, last)


class Common(NamedTuple):
    """found: there is a time at which all can arrive; time: the earliest one [ms]."""

    found: bool
    time: int


@kernel(implements="rendezvous.in_window")
def common_time(meeting: Meeting) -> Common:
    """The earliest time at which all can arrive, if there is one."""
    return Common(meeting.last == -1 or meeting.last >= meeting.first, meeting.first)


class Pace(NamedTuple):
    """act: 0 fly at this speed [m/s], 1 too early at any speed, 2 too late at any speed."""

    act: int
    speed_m_s: float


@kernel(
    implements="rendezvous.arrives_within",
    nonnegative=("left_m", "slowest_m_s", "fastest_m_s", "tolerance_s"),
)
def pace(
    left_m: float, left_s: float, slowest_m_s: float, fastest_m_s: float, tolerance_s: float
) -> Pace:
    """The speed at which the remaining distance is flown in the remaining time, to within a tolerance.

    left_m: [m], >= 0; left_s: [s], negative: the time is over; slowest, fastest: [m/s], > 0, of the vehicle;
    tolerance: [s], >= 0.
    """
    if left_m > fastest_m_s * (left_s + tolerance_s):
        return Pace(2, fastest_m_s)
    if left_m < slowest_m_s * (left_s - tolerance_s):
        return Pace(1, slowest_m_s)
    if left_m >= fastest_m_s * left_s:
        return Pace(0, fastest_m_s)
    if left_m <= slowest_m_s * left_s:
        return Pace(0, slowest_m_s)
    return Pace(0, left_m / left_s)


@kernel(
    implements="rendezvous.spread_of",
    nonnegative=("left_m", "lap_s", "slowest_m_s", "fastest_m_s"),
)
def spares_a_lap(left_m: float, lap_s: float, slowest_m_s: float, fastest_m_s: float) -> bool:
    """True iff the flight times of a distance [m] at the slowest and the fastest speed [m/s] differ by at least a lap
    [s].

    Then a vehicle that waits in laps is, at the end of some lap, neither too early nor too late.
    """
    return left_m * (fastest_m_s - slowest_m_s) >= lap_s * slowest_m_s * fastest_m_s


@kernel(
    implements="rendezvous.later_by",
    nonnegative=("left_m", "lap_s", "nominal_m_s"),
    restates="a time, compared by the way that is flown in it",
)
def another_lap(left_m: float, left_s: float, lap_s: float, nominal_m_s: float) -> bool:
    """True iff after one more lap [s] the distance [m] can still be flown at the nominal speed [m/s] in the remaining
    time [s].
    """
    return left_m <= nominal_m_s * (left_s - lap_s)


@kernel(
    implements="rendezvous.near_to",
    nonnegative=("tolerance",),
    restates="two bounds of a time",
)
def in_company(at: int, common: int, tolerance: int) -> bool:
    """True iff the arrival at `at` [ms] was within the tolerance [ms], >= 0, of the common time [ms]."""
    return common - tolerance <= at and at <= common + tolerance


@kernel(implements="rendezvous.beyond_line")
def beyond(here: Vec2, place: Vec2, ahead: Vec2) -> bool:
    """True iff `here` is not behind the line through a place perpendicular to the direction `ahead` (any length)."""
    return (here.x - place.x) * ahead.x + (here.y - place.y) * ahead.y >= 0
