"""What it means that a piece of flight is clear of an intruder, and that one tube lies in another.

A *piece* is a moving disc: while it lasts the vehicle is no farther than rho from a reference that moves
straight, horizontally and in altitude. A *tube* is the same with a radius that grows: the intruder is no
farther from its straight prediction than start + rate t + gain t^2 at t seconds, horizontally (`wide`) and
in altitude (`high`). Relative state is the reference minus the prediction: s [m], v [m/s], sz [m], vz [m/s].
The closed cylinder is entered if there are places that vehicle and intruder may have at which it is.
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
    """How far something is from where it is taken to be: horizontally x and y, z in altitude [m]."""

    x: float
    y: float
    z: float


class Offs(NamedTuple):
    """How far the vehicle is off its reference, and the intruder off its prediction."""

    own: Off
    other: Off


class Tube(NamedTuple):
    """How far an intruder may be from its straight prediction: horizontally, and in altitude."""

    wide: Growth
    high: Growth


class Margins(NamedTuple):
    """The cylinder about the intruder, radius and half height [m], and how far the vehicle may be from its
    reference, rho_m [m]."""

    radius_m: float
    half_m: float
    rho_m: float


def reach(growth: Growth, t: float) -> float:
    """The radius after t seconds [m]."""
    return growth.start_m + growth.rate_m_s * t + growth.gain_m_s2 * t * t


def later(growth: Growth, t: float) -> Growth:
    """The same radius, counted from t seconds on: what it is then, and how fast it grows then."""
    return Growth(reach(growth, t), growth.rate_m_s + 2 * growth.gain_m_s2 * t, growth.gain_m_s2)


def may_be_off(off: Off, wide: float, high: float) -> bool:
    """It may be so far off: no farther than `wide` horizontally and `high` in altitude."""
    beside = wide >= 0 and within(Plane(off.x, off.y), wide)
    return beside and -high <= off.z and off.z <= high


def enters_at(s: Plane, sz: float, offs: Offs, wide: float, high: float, margins: Margins) -> bool:
    """Vehicle and intruder may be off by so much, and then the cylinder is entered."""
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
    """The cylinder is entered t seconds after the piece has begun. THERE ARE t and both offs."""
    at = position(s, v, t)
    return enters_at(at, sz + t * vz, offs, reach(tube.wide, t), reach(tube.high, t), margins)


def reached_at(s: Plane, v: Plane, growth: Growth, t: float) -> bool:
    """After t seconds the centres are no farther apart than the radius. THERE IS t."""
    return within(position(s, v, t), reach(growth, t))


def levelled_at(sz: float, vz: float, growth: Growth, t: float) -> bool:
    """After t seconds the altitude above the other is no more than the radius. THERE IS t."""
    return sz + t * vz <= reach(growth, t)


def in_disc(p: Plane, o: Plane, inner: float, outer: float) -> bool:
    """The place off by o from the centre p, no farther than `inner`, is no farther than `outer` from 0:
    what a disc that lies in another one holds for every place. FOR ALL o."""
    return not (inner >= 0 and within(o, inner)) or within(Plane(p.x + o.x, p.y + o.y), outer)


def in_tube_at(
    s: Plane, v: Plane, o: Plane, new: Growth, old: Growth, age: float, t: float
) -> bool:
    """A place off by o from the new prediction, in its tube after t seconds, is in the old tube then, which
    is `age` seconds older. s, v: the new prediction minus the old one now. FOR ALL o and t."""
    at = position(s, v, t)
    inside = reach(new, t) >= 0 and within(o, reach(new, t))
    return not inside or within(Plane(at.x + o.x, at.y + o.y), reach(old, age + t))


class Way(NamedTuple):
    """What a pass over the pieces of a trajectory has seen up to an instant `at` that is looked for.

    north, east, up: how far the reference has moved [m]; time: how long that took [s]; hit: `at` has
    come, and the cylinder is entered then.
    """

    hit: bool
    north: float
    east: float
    up: float
    time: float


class Meeting(NamedTuple):
    """Where an intruder is when a trajectory begins: reference minus prediction s [m] and sz [m]; its
    velocity w [m/s] and wz [m/s]; its tube; the cylinder."""

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
    """One more piece is flown. The instant `at` [s from the beginning] may lie in it."""
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
    """Whether the cylinder is entered at the instant, on any piece."""
    return way.hit
