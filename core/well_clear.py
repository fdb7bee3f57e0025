"""Well-clear violation with modified tau, now and within a time span.

Definitions: `spec.well_clear`. Source: Munoz et al., "A Family of Well-Clear Boundary Models for
the Integration of UAS in the NAS", AIAA 2014. Relative state is ownship minus intruder. Every
test is multiplied out, so that no kernel divides and the exact reading exists.
"""

from typing import NamedTuple

from cratous.core.kernel import Vec2, kernel


@kernel(implements="well_clear.horizontal_violation")
def horizontal_violation(s: Vec2, v: Vec2, dthr_m: float, tthr_s: float) -> bool:
    """True iff the horizontal well-clear volume is violated now.

    s: relative position [m]; v: relative velocity [m/s]; dthr_m: distance threshold [m], >= 0;
    tthr_s: time threshold on tau_mod [s], >= 0.
    """
    ss = s.x * s.x + s.y * s.y
    vv = v.x * v.x + v.y * v.y
    sv = s.x * v.x + s.y * v.y
    cross = s.x * v.y - s.y * v.x
    dd = dthr_m * dthr_m
    return horizontal_decision(ss, vv, sv, cross, dd, tthr_s)


@kernel(implements="well_clear.horizontal_violation_by_invariants")
def horizontal_decision(
    ss: float, vv: float, sv: float, cross: float, dd: float, tthr_s: float
) -> bool:
    """The same, on invariants: |s|^2, |v|^2, s.v, s x v, DTHR^2 and TTHR."""
    if ss <= dd:
        return True
    if sv >= 0:
        return False
    # dcpa <= DTHR and tau_mod <= TTHR, multiplied out by |v|^2 > 0 and by s.v < 0
    return cross * cross <= dd * vv and dd - ss >= tthr_s * sv


@kernel(implements="well_clear.vertical_violation")
def vertical_violation(sz: float, vz: float, zthr_m: float, tcoa_s: float) -> bool:
    """True iff the vertical well-clear volume is violated now.

    sz: relative altitude [m]; vz: relative climb rate [m/s], up like sz; zthr_m: [m], >= 0;
    tcoa_s: threshold on the time to co-altitude [s], >= 0.
    """
    if abs(sz) <= zthr_m:
        return True
    if sz * vz >= 0:
        return False
    return abs(sz) <= tcoa_s * abs(vz)


@kernel(implements="well_clear.violation")
def violation(
    s: Vec2,
    v: Vec2,
    sz: float,
    vz: float,
    dthr_m: float,
    zthr_m: float,
    tthr_s: float,
    tcoa_s: float,
) -> bool:
    """True iff well clear is lost now: horizontally and vertically at once."""
    return vertical_violation(sz, vz, zthr_m, tcoa_s) and horizontal_violation(s, v, dthr_m, tthr_s)


@kernel(implements="well_clear.quadratic_reaches_zero")
def dips_to_zero(a: float, b: float, c: float, h: float) -> bool:
    """True iff a t^2 + b t + c <= 0 for some t in [0, h]; a >= 0, h >= 0."""
    if c <= 0:
        return True
    if a * h * h + b * h + c <= 0:
        return True
    return b < 0 and 0 - b < 2 * a * h and b * b >= 4 * a * c


@kernel(implements="well_clear.horizontal_violation_within")
def horizontal_violation_within(s: Vec2, v: Vec2, dthr_m: float, tthr_s: float, h_s: float) -> bool:
    """True iff the horizontal volume is violated at some t in [0, h_s] of straight flight."""
    ss = s.x * s.x + s.y * s.y
    vv = v.x * v.x + v.y * v.y
    sv = s.x * v.x + s.y * v.y
    cross = s.x * v.y - s.y * v.x
    dd = dthr_m * dthr_m
    if dips_to_zero(vv, 2 * sv, ss - dd, h_s):
        return True
    # |s(t)|^2 - DTHR^2 + TTHR s(t).v <= 0 is tau_mod <= TTHR wherever the two converge
    return cross * cross <= dd * vv and dips_to_zero(
        vv, 2 * sv + tthr_s * vv, ss + tthr_s * sv - dd, h_s
    )


class Window(NamedTuple):
    """A time window in scaled time: it holds the instants t with first <= t * scale <= last."""

    scale: float
    first: float
    last: float


@kernel(implements="well_clear.vertical_violation_at")
def vertical_window(sz: float, vz: float, zthr_m: float, tcoa_s: float, h_s: float) -> Window:
    """When within [0, h_s] the vertical volume is violated; first > last means never.

    Time is scaled by |vz| where that is not zero, so that nothing is divided.
    """
    if vz == 0:
        if abs(sz) <= zthr_m:
            return Window(1, 0, h_s)
        return Window(1, 1, 0)
    w = abs(vz)
    z = sz
    if vz < 0:
        z = 0 - sz
    # z grows with rate w; violated from -max(ZTHR, w TCOA) to ZTHR
    first = max(0 - max(zthr_m, tcoa_s * w) - z, 0)
    return Window(w, first, min(zthr_m - z, h_s * w))


@kernel(implements="well_clear.violation_at")
def violation_within(
    s: Vec2,
    v: Vec2,
    sz: float,
    vz: float,
    dthr_m: float,
    zthr_m: float,
    tthr_s: float,
    tcoa_s: float,
    h_s: float,
) -> bool:
    """True iff well clear is lost at some t in [0, h_s] if both fly straight on."""
    k, first, last = vertical_window(sz, vz, zthr_m, tcoa_s, h_s)
    if first > last:
        return False
    # in scaled time the relative position is k times as far away, and so are the thresholds
    at = Vec2(s.x * k + first * v.x, s.y * k + first * v.y)
    return horizontal_violation_within(at, v, dthr_m * k, tthr_s * k, last - first)
