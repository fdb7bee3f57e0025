"""Whether well clear is lost during a span of straight flight, without division and root.

Definitions: `spec.well_clear`. Relative state is ownship minus intruder; time is scaled by the relative climb rate
instead of divided by it, so every verdict has an exact reading. The violation interval is computed by
`core.well_clear.interval`.
"""

from typing import NamedTuple

from cratous.core.kernel import Vec2, kernel
from cratous.core.well_clear.thresholds import StandardThresholds, Thresholds


@kernel(implements="well_clear.parabola")
def dips_to_zero(a: float, b: float, c: float, h: float) -> bool:
    """True iff a t^2 + b t + c <= 0 for some t in [0, h]; a >= 0, h >= 0."""
    if c <= 0:
        return True
    if a * h * h + b * h + c <= 0:
        return True
    return b < 0 and 0 - b < 2 * a * h and b * b >= 4 * a * c


@kernel(implements="well_clear.horizontal_violation_at", nonnegative=("dthr_m", "tthr_s"))
def horizontal_violation_within(s: Vec2, v: Vec2, dthr_m: float, tthr_s: float, h_s: float) -> bool:
    """True iff the horizontal volume is violated at some t in [0, h_s] of straight flight."""
    ss = s.x * s.x + s.y * s.y
    vv = v.x * v.x + v.y * v.y
    sv = s.x * v.x + s.y * v.y
    cross = s.x * v.y - s.y * v.x
    dd = dthr_m * dthr_m
    if ss - dd <= 0:
        return True
    # |s(t)|^2 - DTHR^2 + TTHR s(t).v <= 0 is tau_mod <= TTHR wherever the two converge, and so no
    # later than any entry into the circle
    return cross * cross <= dd * vv and dips_to_zero(
        vv, 2 * sv + tthr_s * vv, ss + tthr_s * sv - dd, h_s
    )


class Window(NamedTuple):
    """A time window in scaled time: it contains the instants t with first <= t * scale <= last."""

    scale: float
    first: float
    last: float


@kernel(implements="well_clear.vertical_violation_at", nonnegative=("zthr_m", "tcoa_s"))
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


@kernel(implements="well_clear.violation_at", nonnegative=("thresholds",))
def violation_within(
    s: Vec2,
    v: Vec2,
    sz: float,
    vz: float,
    thresholds: StandardThresholds,
    h_s: float,
) -> bool:
    """True iff well clear is lost at some t in [0, h_s] if both fly straight."""
    dthr_m, zthr_m, tthr_s, tcoa_s = thresholds
    k, first, last = vertical_window(sz, vz, zthr_m, tcoa_s, h_s)
    if first > last:
        return False
    # in scaled time the relative position is k times as far away, and so are the thresholds
    at = Vec2(s.x * k + first * v.x, s.y * k + first * v.y)
    return horizontal_violation_within(at, v, dthr_m * k, tthr_s * k, last - first)


# -- the other volumes ----------------------------------------------------------------------
@kernel(implements="well_clear.within_at", nonnegative=("radius_m",))
def within_during(s: Vec2, v: Vec2, radius_m: float, h_s: float) -> bool:
    """True iff the two are at most radius_m apart horizontally at some t in [0, h_s]."""
    vv = v.x * v.x + v.y * v.y
    sv = s.x * v.x + s.y * v.y
    return dips_to_zero(vv, 2 * sv, s.x * s.x + s.y * s.y - radius_m * radius_m, h_s)


@kernel(supports="violation_during_tcpa", nonnegative=("dthr_m", "tthr_s"))
def horizontal_violation_within_tcpa(
    s: Vec2, v: Vec2, dthr_m: float, tthr_s: float, h_s: float
) -> bool:
    """True iff the volume with tcpa is violated at some t in [0, h_s] of straight flight."""
    ss = s.x * s.x + s.y * s.y
    vv = v.x * v.x + v.y * v.y
    sv = s.x * v.x + s.y * v.y
    cross = s.x * v.y - s.y * v.x
    dd = dthr_m * dthr_m
    if dips_to_zero(vv, 2 * sv, ss - dd, h_s):
        return True
    # from tcpa - TTHR to tcpa, where the closest approach is within DTHR
    return cross * cross <= dd * vv and sv < 0 and 0 - sv <= (h_s + tthr_s) * vv


@kernel(supports="violation_during_tep", nonnegative=("dthr_m", "tthr_s"))
def horizontal_violation_within_tep(
    s: Vec2, v: Vec2, dthr_m: float, tthr_s: float, h_s: float
) -> bool:
    """True iff the volume with tep is violated at some t in [0, h_s] of straight flight."""
    # entering within TTHR means being within DTHR at most that much later
    return within_during(s, v, dthr_m, h_s + tthr_s)


@kernel(implements="well_clear.layer_violation_at", nonnegative=("zthr_m", "tcoa_s", "vmod_s"))
def layer_window(
    sz: float, vz: float, zthr_m: float, tcoa_s: float, vmod_s: float, h_s: float
) -> Window:
    """When within [0, h_s] the vertical volume by TCOA or VMOD is violated.

    As `vertical_window`: time is scaled by |vz| where that is not zero; first > last means never.
    """
    if vz == 0:
        if abs(sz) <= zthr_m:
            return Window(1, 0, h_s)
        return Window(1, 1, 0)
    w = abs(vz)
    z = sz
    if vz < 0:
        z = 0 - sz
    first = max(0 - max(zthr_m + vmod_s * w, tcoa_s * w) - z, 0)
    return Window(w, first, min(zthr_m - z, h_s * w))


@kernel(
    implements="well_clear.violation_taumod_at",
    nonnegative=("thresholds",),
)
def violation_during_taumod(
    s: Vec2,
    v: Vec2,
    sz: float,
    vz: float,
    thresholds: Thresholds,
    b_s: float,
    t_s: float,
) -> bool:
    """True iff well clear by tau_mod is lost at some t in [b_s, t_s] of straight flight."""
    if b_s > t_s:
        return False
    dthr_m, zthr_m, tthr_s, tcoa_s, vmod_s = thresholds
    k, first, last = layer_window(sz + b_s * vz, vz, zthr_m, tcoa_s, vmod_s, t_s - b_s)
    if first > last:
        return False
    at = Vec2((s.x + b_s * v.x) * k + first * v.x, (s.y + b_s * v.y) * k + first * v.y)
    return horizontal_violation_within(at, v, dthr_m * k, tthr_s * k, last - first)


@kernel(
    implements="well_clear.violation_tcpa_at",
    nonnegative=("thresholds",),
)
def violation_during_tcpa(
    s: Vec2,
    v: Vec2,
    sz: float,
    vz: float,
    thresholds: Thresholds,
    b_s: float,
    t_s: float,
) -> bool:
    """True iff well clear by the time of closest approach is lost at some t in [b_s, t_s] of straight flight."""
    if b_s > t_s:
        return False
    dthr_m, zthr_m, tthr_s, tcoa_s, vmod_s = thresholds
    k, first, last = layer_window(sz + b_s * vz, vz, zthr_m, tcoa_s, vmod_s, t_s - b_s)
    if first > last:
        return False
    at = Vec2((s.x + b_s * v.x) * k + first * v.x, (s.y + b_s * v.y) * k + first * v.y)
    return horizontal_violation_within_tcpa(at, v, dthr_m * k, tthr_s * k, last - first)


@kernel(
    implements="well_clear.violation_tep_at",
    nonnegative=("thresholds",),
)
def violation_during_tep(
    s: Vec2,
    v: Vec2,
    sz: float,
    vz: float,
    thresholds: Thresholds,
    b_s: float,
    t_s: float,
) -> bool:
    """True iff well clear by the time of entry is lost at some t in [b_s, t_s] of straight flight."""
    if b_s > t_s:
        return False
    dthr_m, zthr_m, tthr_s, tcoa_s, vmod_s = thresholds
    k, first, last = layer_window(sz + b_s * vz, vz, zthr_m, tcoa_s, vmod_s, t_s - b_s)
    if first > last:
        return False
    at = Vec2((s.x + b_s * v.x) * k + first * v.x, (s.y + b_s * v.y) * k + first * v.y)
    return horizontal_violation_within_tep(at, v, dthr_m * k, tthr_s * k, last - first)


@kernel(implements="well_clear.cylinder_violation_at", nonnegative=("radius_m", "half_height_m"))
def cylinder_during(
    s: Vec2,
    v: Vec2,
    sz: float,
    vz: float,
    radius_m: float,
    half_height_m: float,
    b_s: float,
    t_s: float,
) -> bool:
    """True iff the intruder is inside the closed cylinder at some t in [b_s, t_s]."""
    return violation_during_tep(
        s, v, sz, vz, Thresholds(radius_m, half_height_m, 0, 0, 0), b_s, t_s
    )
