"""Definitions of detect and avoid at instants: violations, manoeuvres, conflicting steps, histories.

Relative state is ownship minus intruder: s [m], v [m/s], sz and vz up. A manoeuvre is a sequence of steps, flown in
straight segments from step to step; from any step the aircraft may continue straight. A step conflicts if a volume is
violated at some instant of a segment on the way to it, or at some instant of the straight flight from it within a
horizon. The definitions name the instants.
"""

from typing import NamedTuple

from cratous.spec.well_clear import (
    Plane,
    Thresholds,
    dot,
    horizontal_violation_at,
    in_span,
    layer_violation_at,
    violation_taumod_at,
    violation_tcpa_at,
    violation_tep_at,
    within_at,
)
from cratous.spec.well_clear import within as well_within


class Vertical(NamedTuple):
    """A relative altitude and climb rate, or the errors of both."""

    z: float
    w: float


class Relative(NamedTuple):
    """Ownship minus intruder, or the error of that: horizontal position and velocity, altitude and climb rate [m,
    m/s].
    """

    s: Plane
    v: Plane
    sz: float
    vz: float


class Uncertainty(NamedTuple):
    """Error bounds of a relative state: radii of horizontal position and velocity, es_m and ev_m_s, and bounds up or
    down of altitude and climb rate, ez_m and ew_m_s [m, m/s].
    """

    es_m: float
    ez_m: float
    ev_m_s: float
    ew_m_s: float


class Span(NamedTuple):
    """Instants from the first to the last [s]; empty if the last is before the first."""

    first: float
    last: float


def violated_at(
    kind: int, s: Plane, v: Plane, sz: float, vz: float, thresholds: Thresholds, t: float
) -> bool:
    """The volume of that kind is violated after t seconds; kind 3, a cylinder, is tep with zero times."""
    if kind == 1:
        return violation_tcpa_at(s, v, sz, vz, thresholds, t)
    if kind == 2 or kind == 3:
        return violation_tep_at(s, v, sz, vz, thresholds, t)
    return violation_taumod_at(s, v, sz, vz, thresholds, t)


def counts(at: float, begin: float, end: float) -> bool:
    """A segment that begins at time `at` is checked: it begins within [begin, end]."""
    return begin <= at and at <= end


def lost_on_piece(
    violated: bool, t: float, piece: float, at: float, begin: float, end: float
) -> bool:
    """Lost t seconds after the beginning of a segment, while it is flown, and the segment is checked."""
    return counts(at, begin, end) and t >= 0 and t <= piece and violated


def lost_from_step(violated: bool, t: float, at: float, begin: float, end: float) -> bool:
    """Lost t seconds after the step at time `at`, at an instant within [begin, end]."""
    return t >= 0 and at + t >= begin and at + t <= end and violated


def lost_pieces(lost: int, piece: bool) -> int:
    """The number of segments of a path on which a volume is lost, with one more segment."""
    if piece:
        return lost + 1
    return lost


def lost_somewhere(lost: int) -> bool:
    """A path loses a volume: the number of segments on which it does is positive."""
    return lost > 0


def horizon(until: float, lookahead: float, time: float, manoeuvre: float, counted: bool) -> bool:
    """A violation is searched for up to the time `until`: the latest that both limits allow."""
    limit = time
    if not counted:
        limit = time + manoeuvre
    return until <= lookahead and until <= limit and not (until < lookahead and until < limit)


def accelerated(z: float, vz: float, change: float, t: float) -> float:
    """Altitude after t seconds of constant acceleration."""
    return z + vz * t + change * t * t / 2


def climb_is_flown(
    z: float, vz: float, target: float, accel: float, t1: float, t2: float, t3: float, rate: float
) -> bool:
    """The phases of the climb are consistent: accelerated to `rate` at t1, held to t2, level at the target at t3."""
    up = rate >= vz
    first = accel if up else -accel
    last = -accel if rate > 0 else accel
    there = accelerated(z, vz, first, t1) + rate * (t2 - t1)
    return (
        t1 <= t2
        and t2 <= t3
        and vz + first * t1 == rate
        and rate + last * (t3 - t2) == 0
        and accelerated(there, rate, last, t3 - t2) == target
    )


def shrunk(before: float, after: float, least: float, factor: float) -> bool:
    """A recovery distance after one reduction: by the factor, but not below the least."""
    smaller = before - factor * before
    return after == smaller if smaller >= least else after == least


def reached(count: int, value: int, level: int) -> int:
    """The number of values that reach a level, with one more value."""
    if value >= level:
        return count + 1
    return count


def enough(count: int, m: int) -> bool:
    """The count is at least m."""
    return not count < m


def may_drop(now: float, raised: float, persistence: float) -> bool:
    """A level raised at time `raised` has been shown for at least the persistence time."""
    return raised + persistence <= now


def goes_on(now: float, before: float, gap: float) -> bool:
    """Time has advanced, by at most the gap."""
    return before < now and now <= before + gap


def to_the_right(v: Plane) -> Plane:
    """v turned to the right by 90 degrees, with the same length."""
    return Plane(v.y, -v.x)


def is_turned(v: Plane, w: Plane, c: float, s: float) -> bool:
    """w has the length of v and is turned to the right of it by the angle with cosine c and sine s."""
    angle = dot(v, w) == c * dot(v, v) and dot(to_the_right(v), w) == s * dot(v, v)
    return dot(w, w) == dot(v, v) and angle


def is_arc(v: Plane, d: Plane, c: float, s: float) -> bool:
    """d is the displacement along a right-hand circular arc that begins with velocity v, after a turn by the angle
    with cosine c and sine s, multiplied by the turn rate: radius times s ahead, and radius times (1 - c) to the
    right. The radius times the turn rate is the speed.
    """
    ahead = dot(v, d) == s * dot(v, v)
    return ahead and dot(to_the_right(v), d) == (1 - c) * dot(v, v)


def in_area(east: float, north: float, alt: float, radius: float, height: float) -> bool:
    """In a cylinder on the ground: at most radius from its axis, and not above its height."""
    return well_within(Plane(east, north), radius) and not alt > height


def may_be_violated_at(
    state: Relative, off: Relative, error: Uncertainty, thresholds: Thresholds, t: float
) -> bool:
    """The errors `off` are within their bounds, and with them the volume is violated at t."""
    if not well_within(off.s, error.es_m) or not well_within(off.v, error.ev_m_s):
        return False
    if not layer_may_be_violated_at(
        Vertical(state.sz, state.vz),
        Vertical(off.sz, off.vz),
        Vertical(error.ez_m, error.ew_m_s),
        thresholds.zthr_m,
        thresholds.tcoa_s,
        thresholds.vmod_s,
        t,
    ):
        return False
    p = Plane(state.s.x + off.s.x, state.s.y + off.s.y)
    q = Plane(state.v.x + off.v.x, state.v.y + off.v.y)
    return violation_taumod_at(p, q, state.sz + off.sz, state.vz + off.vz, thresholds, t)


def layer_may_be_violated_at(
    state: Vertical, off: Vertical, error: Vertical, zthr: float, tcoa: float, vmod: float, t: float
) -> bool:
    """The errors of altitude and climb rate are within their bounds, and with them the layer is violated at t."""
    if off.z < -error.z or off.z > error.z or off.w < -error.w or off.w > error.w:
        return False
    return layer_violation_at(state.z + off.z, state.w + off.w, zthr, tcoa, vmod, t)


def level_at(sz: float, vz: float) -> float:
    """The time at which co-altitude is reached from sz >= 0 [s]; 0 if vz >= 0."""
    if vz >= 0:
        return 0
    return sz / (0 - vz)


def share_of(below: float, above: float) -> float:
    """The fraction of the way from `below` to `above` at which 0 lies; 0 if `below` is not less than `above`."""
    if above <= below:
        return 0
    return (0 - below) / (above - below)


def may_be_within_at(s: Plane, v: Plane, es: float, ev: float, radius: float, t: float) -> bool:
    """After t seconds the disc of possible positions comes within the radius."""
    return within_at(s, v, radius + es + ev * t, t)


def straight_at(
    distance: float, speed: float, es: float, ev: float, dthr: float, tthr: float, t: float
) -> bool:
    """An intruder whose distance is reduced by es, and that closes head-on at a speed increased by ev, violates the
    horizontal volume at t.
    """
    return horizontal_violation_at(Plane(distance - es, 0), Plane(-(speed + ev), 0), dthr, tthr, t)


def sighted(s: Plane, v: Plane) -> Plane:
    """A relative velocity in coordinates along and across the line of sight, times the distance; the across component
    is never negative.
    """
    across = s.x * v.y - s.y * v.x
    return Plane(-dot(s, v), across if across >= 0 else -across)


def in_either(first: float, last: float, other_first: float, other_last: float, t: float) -> bool:
    """The instant is in one span or in the other."""
    return in_span(first, last, t) or in_span(other_first, other_last, t)


def speed_error(range_: float, near: float, far: float, distance: float, error: float) -> bool:
    """The error is `far` from the distance on, `near` at 0, and linearly interpolated between."""
    if range_ >= distance:
        return error == far
    if range_ <= 0:
        return error == near
    return (error - near) * distance == (far - near) * range_


def not_positive(a: float, half: float, c: float, t: float) -> bool:
    """The quadratic a t^2 + 2 half t + c is at most 0."""
    return a * t * t + 2 * half * t + c <= 0


def last_root(a: float, half: float, c: float, t: float, last: float) -> bool:
    """If the quadratic is at most 0 at t, then t is not after `last`."""
    return not not_positive(a, half, c, t) or t <= last


def in_own_or_both(own: Span, one: Span, other: Span, begin: float, end: float, t: float) -> bool:
    """The instant is in `own`, or in `one` and `other` at once and within [begin, end]."""
    both = in_span(one.first, one.last, t) and in_span(other.first, other.last, t)
    return in_span(own.first, own.last, t) or (both and begin <= t and t <= end)
