"""When a segment of flight is clear of an intruder, and when one tube lies in another.

A *segment* (piece) is a moving disc: while it lasts the vehicle is within rho of a reference that moves straight,
horizontally and in altitude. A *tube* is the same with a growing radius: after t seconds the intruder is within start
+ rate t + gain t^2 of its straight prediction, horizontally (`wide`) and in altitude (`high`). Relative state is the
reference minus the prediction: s [m], v [m/s], sz [m], vz [m/s]. The closed cylinder counts as entered if it is for
some possible positions of vehicle and intruder.
"""

from __future__ import annotations

from typing import NamedTuple

from cratous.spec.well_clear import Plane, cylinder_violation, position, within


class Growth(NamedTuple):
    """A radius that grows: start [m], rate [m/s], gain [m/s2], half of a bound on acceleration."""

    start_m: float
    rate_m_s: float
    gain_m_s2: float


class Off(NamedTuple):
    """The deviation of an aircraft from its assumed position: horizontally x and y, z in altitude [m]."""

    x: float
    y: float
    z: float


class Offs(NamedTuple):
    """The deviations of the vehicle from its reference, and of the intruder from its prediction."""

    own: Off
    other: Off


class Tube(NamedTuple):
    """Bounds on the deviation of an intruder from its straight prediction: horizontally, and in altitude."""

    wide: Growth
    high: Growth


class Margins(NamedTuple):
    """The cylinder about the intruder, radius and half height [m], and the bound on the vehicle's deviation from its
    reference, rho_m [m].
    """

    radius_m: float
    half_m: float
    rho_m: float


def reach(growth: Growth, t: float) -> float:
    """The radius after t seconds [m]."""
    return growth.start_m + growth.rate_m_s * t + growth.gain_m_s2 * t * t


def later(growth: Growth, t: float) -> Growth:
    """The same radius, with time counted from t seconds on: its value and its rate at that time."""
    return Growth(reach(growth, t), growth.rate_m_s + 2 * growth.gain_m_s2 * t, growth.gain_m_s2)


def may_be_off(off: Off, wide: float, high: float) -> bool:
    """The deviation is within its bounds: at most `wide` horizontally and `high` in altitude."""
    beside = wide >= 0 and within(Plane(off.x, off.y), wide)
    return beside and -high <= off.z and off.z <= high


def enters_at(s: Plane, sz: float, offs: Offs, wide: float, high: float, margins: Margins) -> bool:
    """The deviations of vehicle and intruder are within their bounds, and with them the cylinder is entered."""
    radius, half, rho = margins
    own, other = offs
    possible = may_be_off(own, rho, rho) and may_be_off(other, wide, high)
    apart = Plane(s.x + own.x - other.x, s.y + own.y - other.y)
    return possible and cylinder_violation(apart, sz + own.z - other.z, radius, half)


def hit_at(
    s: Plane,
    v: Plane,
    sz: float,
    vz: float,
    offs: Offs,
    tube: Tube,
    margins: Margins,
    t: float,
) -> bool:
    """The cylinder is entered t seconds after the beginning of the segment. THERE ARE t and both deviations."""
    at = position(s, v, t)
    return enters_at(at, sz + t * vz, offs, reach(tube.wide, t), reach(tube.high, t), margins)


def reached_at(s: Plane, v: Plane, growth: Growth, t: float) -> bool:
    """After t seconds the distance of the centres is at most the radius. THERE IS t."""
    return within(position(s, v, t), reach(growth, t))


def levelled_at(sz: float, vz: float, growth: Growth, t: float) -> bool:
    """After t seconds the altitude above the other is at most the radius. THERE IS t."""
    return sz + t * vz <= reach(growth, t)


def in_disc(p: Plane, o: Plane, inner: float, outer: float) -> bool:
    """If the position at offset o from the centre p is within `inner` of p, it is within `outer` of 0: what holds for
    every position if one disc lies in another. FOR ALL o.
    """
    return not (inner >= 0 and within(o, inner)) or within(Plane(p.x + o.x, p.y + o.y), outer)


def in_tube_at(
    s: Plane, v: Plane, o: Plane, new: Growth, old: Growth, age: float, t: float
) -> bool:
    """If the position at offset o from the new prediction is in its tube after t seconds, it is then also in the old
    tube, which is `age` seconds older. s, v: the new prediction minus the old one now. FOR ALL o and t.
    """
    at = position(s, v, t)
    inside = reach(new, t) >= 0 and within(o, reach(new, t))
    return not inside or within(Plane(at.x + o.x, at.y + o.y), reach(old, age + t))


class Way(NamedTuple):
    """The state of a pass over the segments of a trajectory, for a given instant `at`.

    north, east, up: displacement of the reference so far [m]; time: its duration so far [s]; hit: `at` has been
    reached, and the cylinder is entered then.
    """

    hit: bool
    north: float
    east: float
    up: float
    time: float


class Meeting(NamedTuple):
    """The intruder when a trajectory begins: reference minus prediction s [m] and sz [m]; its velocity w [m/s] and wz
    [m/s]; its tube; the cylinder.
    """

    s: Plane
    sz: float
    w: Plane
    wz: float
    wide: Growth
    high: Growth
    radius_m: float
    half_height_m: float


def way_step(
    way: Way,
    v: Plane,
    vz: float,
    duration: float,
    rho: float,
    meeting: Meeting,
    offs: Offs,
    at: float,
) -> Way:
    """Add a segment. The instant `at` [s from the beginning] may lie in it."""
    t = at - way.time
    there = Plane(
        meeting.s.x + way.north + t * v.x - at * meeting.w.x,
        meeting.s.y + way.east + t * v.y - at * meeting.w.y,
    )
    height = meeting.sz + way.up + t * vz - at * meeting.wz
    within_it = t >= 0 and t <= duration
    entered = within_it and enters_at(
        there,
        height,
        offs,
        reach(meeting.wide, at),
        reach(meeting.high, at),
        Margins(meeting.radius_m, meeting.half_height_m, rho),
    )
    return Way(
        way.hit or entered,
        way.north + duration * v.x,
        way.east + duration * v.y,
        way.up + duration * vz,
        way.time + duration,
    )


def way_result(way: Way) -> bool:
    """Whether the cylinder is entered at the instant, on any segment."""
    return way.hit
