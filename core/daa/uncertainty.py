"""Sensor uncertainty mitigation (SUM): when a volume may be violated, with states known within bounds.

Definitions: `spec.daa.meaning`, `spec.well_clear`. Relative position and velocity are known within discs (horizontal)
and intervals (vertical). A possible violation is computed for the worst-case state: the greatest relative speed, the
least distance, and the course turned towards the intruder as far as both discs allow. It lasts until the position,
whose disc grows with time, has certainly left the circle. Whatever the volume itself reports is always added, so
uncertainty never removes an alert. The volume is the one by tau_mod. Source: RTCA DO-365B, appendix on SUM; the
DAIDALUS v2 manual.
"""

from math import sqrt
from typing import NamedTuple

import numpy as np

from cratous.core.daa.records import Relative
from cratous.core.daa.turn import turned
from cratous.core.daa.volume import conflict_span, in_conflict
from cratous.core.kernel import Vec2, driver, kernel
from cratous.core.well_clear.during import violation_during_taumod
from cratous.core.well_clear.interval import (
    Span,
    horizontal_interval_taumod,
    or_empty,
    vertical_interval,
    violation_interval_taumod,
)
from cratous.core.well_clear.thresholds import Thresholds

SUM_KIND = 4
"""`spec.daa.parameters.TAUMOD_SUM` as a number for compiled drivers."""
LEAST_ERROR = 0.001
"""If any uncertainty is above 0, all are at least this much [m, m/s]."""


class Uncertainty(NamedTuple):
    """The error bounds of a relative state, each >= 0.

    es_m, ev_m_s: radii of the discs of horizontal position and velocity [m, m/s]; ez_m, ew_m_s: half the intervals of
    altitude and climb rate [m, m/s].
    """

    es_m: float
    ez_m: float
    ev_m_s: float
    ew_m_s: float


@kernel(implements="daa.meaning.in_either")
def span_hull(a: Span, b: Span) -> Span:
    """The smallest span that contains both; a span in the wrong order is empty."""
    if a.first_s > a.last_s:
        return b
    if b.first_s > b.last_s:
        return a
    return Span(min(a.first_s, b.first_s), max(a.last_s, b.last_s))


@kernel(supports="layer_span")
def layer_above(
    low_m: float, high_m: float, slow_m_s: float, fast_m_s: float, zthr_m: float, tcoa_s: float,
    vmod_s: float, t_s: float,
) -> Span:  # fmt: skip
    """When the layer may be violated, within [0, t_s]: relative altitude in [low_m, high_m], from 0
    up, climb rate in [slow_m_s, fast_m_s]."""
    if slow_m_s >= 0:
        return vertical_interval(low_m, slow_m_s, zthr_m, tcoa_s, vmod_s, 0, t_s)
    # a descending aircraft enters first from the lowest altitude, and leaves last from the highest
    near = vertical_interval(low_m, slow_m_s, zthr_m, tcoa_s, vmod_s, 0, t_s)
    left = vertical_interval(high_m, min(fast_m_s, 0), zthr_m, tcoa_s, vmod_s, 0, t_s)
    if near.first_s > near.last_s:
        return Span(1, 0)
    if left.first_s > left.last_s:
        return Span(near.first_s, t_s)
    return Span(near.first_s, left.last_s)


@kernel(implements="daa.meaning.layer_may_be_violated_at")
def layer_span(
    sz: float, vz: float, ez_m: float, ew_m_s: float, zthr_m: float, tcoa_s: float, vmod_s: float,
    t_s: float,
) -> Span:  # fmt: skip
    """When the layer may be violated, within [0, t_s]: altitude sz and climb rate vz are known
    within ez_m and ew_m_s, >= 0."""
    low = sz - ez_m
    high = sz + ez_m
    slow = vz - ew_m_s
    fast = vz + ew_m_s
    if low >= 0:
        return layer_above(low, high, slow, fast, zthr_m, tcoa_s, vmod_s, t_s)
    if high < 0:
        return layer_above(0 - high, 0 - low, 0 - fast, 0 - slow, zthr_m, tcoa_s, vmod_s, t_s)
    above = layer_above(0, high, slow, fast, zthr_m, tcoa_s, vmod_s, t_s)
    below = layer_above(0, 0 - low, 0 - fast, 0 - slow, zthr_m, tcoa_s, vmod_s, t_s)
    return span_hull(above, below)


@kernel(implements="daa.meaning.last_root")
def leaves_at(a: float, half: float, c: float) -> float:
    """The last t with a t^2 + 2 half t + c <= 0, if there is one; a > 0."""
    return (sqrt(max(half * half - a * c, 0)) - half) / a


@kernel(implements="daa.meaning.not_positive")
def until_left(a: float, half: float, c: float, t_s: float) -> Span:
    """From now to the last instant of [0, t_s] from which on a t^2 + 2 half t + c > 0; a > 0."""
    if half * half < a * c:
        return Span(1, 0)
    return or_empty(0, min(leaves_at(a, half, c), t_s))


@kernel(implements="daa.meaning.may_be_violated_at")
def circle_straight(
    ss_m2: float, vv_m2_s2: float, es_m: float, ev_m_s: float, dthr_m: float, tthr_s: float,
    t_s: float,
) -> Span:  # fmt: skip
    """When the circle is violated, within [0, t_s], by an intruder that closes head-on: squares of distance and
    speed, known within es_m and ev_m_s.
    """
    far = sqrt(max(ss_m2, 0)) - es_m
    fast = sqrt(max(vv_m2_s2, 0)) + ev_m_s
    return horizontal_interval_taumod(Vec2(far, 0), Vec2(0 - fast, 0), dthr_m, tthr_s, 0, t_s)


@kernel(supports="circle_span")
def circle_first(
    s: Vec2, v: Vec2, es_m: float, ev_m_s: float, dthr_m: float, tthr_s: float, t_s: float
) -> Span:
    """When the worst-case state violates the circle, within [0, t_s]: on a course turned towards the intruder as far
    as the discs of radius es_m < |s| and ev_m_s < |v| allow.
    """
    ss = s.x * s.x + s.y * s.y
    vv = v.x * v.x + v.y * v.y
    # the course relative to the line of sight, turned by the angles of both discs
    course = Vec2(0 - s.x * v.x - s.y * v.y, abs(s.x * v.y - s.y * v.x))
    once = turned(course, sqrt(max(ss - es_m * es_m, 0)), es_m)
    twice = turned(once, sqrt(max(vv - ev_m_s * ev_m_s, 0)), ev_m_s)
    if twice.y <= 0 or ss * vv <= 0:
        return circle_straight(ss, vv, es_m, ev_m_s, dthr_m, tthr_s, t_s)
    far = sqrt(ss) - es_m
    fast = sqrt(vv) + ev_m_s
    share = fast / (ss * vv)
    return horizontal_interval_taumod(
        Vec2(0 - far, 0), Vec2(share * twice.x, share * twice.y), dthr_m, tthr_s, 0, t_s
    )


@kernel(implements="daa.meaning.may_be_within_at")
def circle_span(
    s: Vec2, v: Vec2, es_m: float, ev_m_s: float, dthr_m: float, tthr_s: float, t_s: float
) -> Span:
    """When the circle may be violated, within [0, t_s]: position s and velocity v are known within
    discs of radius es_m and ev_m_s, > 0."""
    ss = s.x * s.x + s.y * s.y
    vv = v.x * v.x + v.y * v.y
    wide = dthr_m + es_m
    inside = ss <= wide * wide
    if vv <= ev_m_s * ev_m_s:
        if inside:
            return Span(0, t_s)
        near = circle_straight(ss, vv, es_m, ev_m_s, dthr_m, tthr_s, t_s)
        if near.first_s > near.last_s:
            return Span(1, 0)
        return Span(near.first_s, t_s)
    half = s.x * v.x + s.y * v.y - ev_m_s * wide
    until = until_left(vv - ev_m_s * ev_m_s, half, ss - wide * wide, t_s)
    if inside or until.first_s > until.last_s:
        return until
    near = circle_first(s, v, es_m, ev_m_s, dthr_m, tthr_s, t_s)
    if near.first_s > near.last_s:
        return Span(1, 0)
    return or_empty(near.first_s, until.last_s)


@kernel(implements="daa.meaning.in_own_or_both")
def uncertain_span(
    s: Vec2, v: Vec2, sz: float, vz: float, error: Uncertainty, thresholds: Thresholds, b_s: float,
    t_s: float,
) -> Span:  # fmt: skip
    """First and last instant of [b_s, t_s], b_s >= 0, at which the volume may be violated.

    error: all > 0. The span of the volume itself is within it.
    """
    nominal = violation_interval_taumod(s, v, sz, vz, thresholds, b_s, t_s)
    dthr_m, zthr_m, tthr_s, tcoa_s, vmod_s = thresholds
    layer = layer_span(sz, vz, error.ez_m, error.ew_m_s, zthr_m, tcoa_s, vmod_s, t_s)
    circle = circle_span(s, v, error.es_m, error.ev_m_s, dthr_m, tthr_s, t_s)
    first = max(max(layer.first_s, circle.first_s), b_s)
    last = min(min(layer.last_s, circle.last_s), t_s)
    return span_hull(nominal, or_empty(first, last))


@kernel(implements="daa.meaning.in_own_or_both")
def uncertain_conflict(
    s: Vec2, v: Vec2, sz: float, vz: float, error: Uncertainty, thresholds: Thresholds, b_s: float,
    t_s: float,
) -> bool:  # fmt: skip
    """True iff the volume may be violated at some instant of [b_s, t_s]; arguments as for
    `uncertain_span`, uncertainties >= 0; with none it is the volume itself."""
    if violation_during_taumod(s, v, sz, vz, thresholds, b_s, t_s):
        return True
    if error.es_m <= 0 or error.ez_m <= 0 or error.ev_m_s <= 0 or error.ew_m_s <= 0:
        return False
    first, last = uncertain_span(s, v, sz, vz, error, thresholds, b_s, t_s)
    return first <= last


@kernel(implements="daa.meaning.speed_error")
def speed_error(range_m: float, near_m_s: float, far_m_s: float, distance_m: float) -> float:
    """Uncertainty of the horizontal velocity [m/s] at a range: near_m_s at 0, far_m_s from
    distance_m on, linear between."""
    if range_m >= distance_m:
        return far_m_s
    if range_m <= 0:
        return near_m_s
    return near_m_s + (far_m_s - near_m_s) * (range_m / distance_m)


def uncertainty_of(
    state: Relative, w: np.ndarray, at_s: float
) -> tuple[bool, Relative, Uncertainty]:
    """(whether there is any, the state at_s seconds before, its uncertainties, > 0). w: as for `lost`."""
    s, v = state.s, state.v
    back = Vec2(s.x - at_s * v.x, s.y - at_s * v.y)
    es, ez, ew = w[5], w[6], w[7]
    distance = sqrt(back.x * back.x + back.y * back.y)
    ev = speed_error(distance - es, w[8], w[9], w[10])
    some = es > 0 or ez > 0 or ew > 0 or ev > 0
    error = Uncertainty(
        max(es, LEAST_ERROR), max(ez, LEAST_ERROR), max(ev, LEAST_ERROR), max(ew, LEAST_ERROR)
    )
    return some, Relative(back, v, state.sz - at_s * state.vz, state.vz), error


@driver(checked_by=("in_conflict", "uncertain_conflict", "speed_error"))
def lost(kind: int, state: Relative, w: np.ndarray, at_s: float, b_s: float, t_s: float):
    """Whether the volume w of that kind is, or may be, violated at some instant of [b_s, t_s].

    w: dthr, zthr, tthr, tcoa, vmod; and for SUM the uncertainties: position, altitude, climb rate,
    velocity near and far, and the distance that is far. They hold at_s seconds before the state.
    """
    s, v, sz, vz = state.s, state.v, state.sz, state.vz
    thresholds = Thresholds(w[0], w[1], w[2], w[3], w[4])
    if kind == SUM_KIND:
        some, back, error = uncertainty_of(state, w, at_s)
        if some:
            return uncertain_conflict(
                back.s, v, back.sz, vz, error, thresholds, at_s + b_s, at_s + t_s
            )
    return in_conflict(kind, s, v, sz, vz, thresholds, b_s, t_s)


@driver(checked_by=("conflict_span", "uncertain_span", "speed_error"))
def lost_span(kind: int, state: Relative, w: np.ndarray, at_s: float, b_s: float, t_s: float):
    """First and last such instant; first > last if there is none. Arguments as for `lost`."""
    s, v, sz, vz = state.s, state.v, state.sz, state.vz
    thresholds = Thresholds(w[0], w[1], w[2], w[3], w[4])
    if kind == SUM_KIND:
        some, back, error = uncertainty_of(state, w, at_s)
        if some:
            first, last = uncertain_span(
                back.s, v, back.sz, vz, error, thresholds, at_s + b_s, at_s + t_s
            )
            return first - at_s, last - at_s
    first, last = conflict_span(kind, s, v, sz, vz, thresholds, b_s, t_s)
    return first, last
