"""Definition of well clear. Relative state is ownship minus intruder: s [m], v [m/s].

Horizontal volume (modified tau, Munoz et al., "A Family of Well-Clear Boundary Models for the Integration of UAS in
the NAS", AIAA 2014; DO-365 uses the same): violated when the two are within DTHR, or when they converge, would pass
within DTHR, and tau_mod = (DTHR^2 - |s|^2) / (s.v) is at most TTHR. Vertical volume: within ZTHR, or at most TCOA
before co-altitude. Sets are closed. The definitions divide and refer to positions at instants; the kernels do
neither.
"""

from math import sqrt
from typing import NamedTuple


class Plane(NamedTuple):
    """A horizontal vector."""

    x: float
    y: float


class StandardThresholds(NamedTuple):
    """Thresholds of the standard volume: DTHR, ZTHR [m]; TTHR, TCOA [s]."""

    dthr_m: float
    zthr_m: float
    tthr_s: float
    tcoa_s: float


class Thresholds(NamedTuple):
    """Thresholds of a volume with either vertical lead time: DTHR, ZTHR [m]; TTHR, TCOA, VMOD [s]."""

    dthr_m: float
    zthr_m: float
    tthr_s: float
    tcoa_s: float
    vmod_s: float


def dot(a: Plane, b: Plane) -> float:
    """Scalar product."""
    return a.x * b.x + a.y * b.y


def position(s: Plane, v: Plane, t: float) -> Plane:
    """Relative position after t seconds of straight flight."""
    return Plane(s.x + t * v.x, s.y + t * v.y)


def within(p: Plane, radius: float) -> bool:
    """True iff p is at most radius from the origin (compared in squares: radius >= 0)."""
    return dot(p, p) <= radius * radius


def converging(s: Plane, v: Plane) -> bool:
    """True iff the distance is decreasing."""
    return dot(s, v) < 0


def time_of_closest_approach(s: Plane, v: Plane) -> float:
    """tcpa [s]: the time at which the distance is least; for v not zero."""
    return -dot(s, v) / dot(v, v)


def tau_mod(s: Plane, v: Plane, dthr: float) -> float:
    """Modified tau [s], for a converging pair."""
    return (dthr * dthr - dot(s, s)) / dot(s, v)


def horizontal_violation(s: Plane, v: Plane, dthr: float, tthr: float) -> bool:
    """The horizontal volume is violated now."""
    if within(s, dthr):
        return True
    if not converging(s, v):
        return False
    closest = position(s, v, time_of_closest_approach(s, v))
    time = tau_mod(s, v, dthr)
    return within(closest, dthr) and time >= 0 and time <= tthr


def horizontal_violation_at(s: Plane, v: Plane, dthr: float, tthr: float, t: float) -> bool:
    """The horizontal volume is violated after t seconds of straight flight."""
    return horizontal_violation(position(s, v, t), v, dthr, tthr)


def vertical_violation(sz: float, vz: float, zthr: float, tcoa: float) -> bool:
    """The vertical volume is violated now. sz: relative altitude, vz: relative climb rate."""
    if -zthr <= sz and sz <= zthr:
        return True
    if vz == 0:
        return False
    time = -sz / vz
    return time >= 0 and time <= tcoa


def vertical_violation_at(sz: float, vz: float, zthr: float, tcoa: float, t: float) -> bool:
    """The vertical volume is violated after t seconds of straight flight."""
    return vertical_violation(sz + t * vz, vz, zthr, tcoa)


def violation_at(
    s: Plane, v: Plane, sz: float, vz: float, thresholds: StandardThresholds, t: float
) -> bool:
    """Well clear is lost after t seconds of straight flight: both volumes at once."""
    dthr, zthr, tthr, tcoa = thresholds
    return vertical_violation_at(sz, vz, zthr, tcoa, t) and horizontal_violation_at(
        s, v, dthr, tthr, t
    )


def violation(
    s: Plane,
    v: Plane,
    sz: float,
    vz: float,
    dthr: float,
    zthr: float,
    tthr: float,
    tcoa: float,
) -> bool:
    """Well clear is lost now."""
    return violation_at(s, v, sz, vz, StandardThresholds(dthr, zthr, tthr, tcoa), 0)


def parabola(a: float, b: float, c: float, t: float) -> float:
    """The value of a t^2 + b t + c."""
    return a * t * t + b * t + c


# -- other volumes --------------------------------------------------------------------------
def tau(s: Plane, v: Plane) -> float:
    """Plain tau [s], range over closing rate, written as range^2 over range times closing rate; for a converging
    pair.
    """
    return dot(s, s) / -dot(s, v)


def time_of_entry(s: Plane, v: Plane, dthr: float) -> float:
    """tep [s]: time of the entry into the circle of radius dthr, half a chord before the closest approach.

    For v not zero and a course that comes within dthr.
    """
    tcpa = time_of_closest_approach(s, v)
    closest = position(s, v, tcpa)
    return tcpa - sqrt((dthr * dthr - dot(closest, closest)) / dot(v, v))


def passes_within(s: Plane, v: Plane, dthr: float) -> bool:
    """The two converge, and their closest approach is within dthr."""
    if not converging(s, v):
        return False
    return within(position(s, v, time_of_closest_approach(s, v)), dthr)


def soon(time: float, limit: float) -> bool:
    """A time is not past and at most `limit` ahead."""
    return time >= 0 and time <= limit


def horizontal_violation_tcpa(s: Plane, v: Plane, dthr: float, tthr: float) -> bool:
    """As `horizontal_violation`, with the time of closest approach in place of tau_mod."""
    if within(s, dthr):
        return True
    if not passes_within(s, v, dthr):
        return False
    return soon(time_of_closest_approach(s, v), tthr)


def horizontal_violation_tep(s: Plane, v: Plane, dthr: float, tthr: float) -> bool:
    """As `horizontal_violation`, with the time of entry in place of tau_mod."""
    if within(s, dthr):
        return True
    if not passes_within(s, v, dthr):
        return False
    return soon(time_of_entry(s, v, dthr), tthr)


def horizontal_violation_tau(s: Plane, v: Plane, dthr: float, tthr: float) -> bool:
    """As `horizontal_violation`, with plain tau, which is known not to be convex in time."""
    if within(s, dthr):
        return True
    if not passes_within(s, v, dthr):
        return False
    return soon(tau(s, v), tthr)


def horizontal_violation_tcpa_at(s: Plane, v: Plane, dthr: float, tthr: float, t: float) -> bool:
    """With the time of closest approach, after t seconds of straight flight."""
    return horizontal_violation_tcpa(position(s, v, t), v, dthr, tthr)


def horizontal_violation_tep_at(s: Plane, v: Plane, dthr: float, tthr: float, t: float) -> bool:
    """With the time of entry, after t seconds of straight flight."""
    return horizontal_violation_tep(position(s, v, t), v, dthr, tthr)


def within_at(s: Plane, v: Plane, radius: float, t: float) -> bool:
    """At most radius apart horizontally after t seconds of straight flight."""
    return within(position(s, v, t), radius)


def vertical_violation_vmod(sz: float, vz: float, zthr: float, vmod: float) -> bool:
    """The vertical volume with VMOD: within ZTHR now, or converging and within ZTHR in at most vmod seconds."""
    if -zthr <= sz and sz <= zthr:
        return True
    if vz == 0:
        return False
    # when the nearer face of the layer is reached
    face = zthr
    if sz < 0:
        face = -zthr
    return soon((face - sz) / vz, vmod)


def layer_violation(sz: float, vz: float, zthr: float, tcoa: float, vmod: float) -> bool:
    """The vertical volume with either lead time: TCOA to co-altitude, VMOD to the layer.

    With vmod 0 it is `vertical_violation`, with tcoa 0 `vertical_violation_vmod`.
    """
    return vertical_violation(sz, vz, zthr, tcoa) or vertical_violation_vmod(sz, vz, zthr, vmod)


def layer_violation_at(
    sz: float, vz: float, zthr: float, tcoa: float, vmod: float, t: float
) -> bool:
    """The vertical volume with either lead time after t seconds of straight flight."""
    return layer_violation(sz + t * vz, vz, zthr, tcoa, vmod)


def cylinder_violation(s: Plane, sz: float, radius: float, half_height: float) -> bool:
    """Inside a closed cylinder: at most radius apart, and at most half_height in altitude."""
    return within(s, radius) and -half_height <= sz and sz <= half_height


def cylinder_conflict(s: Plane, sz: float, radius: float, half_height: float) -> bool:
    """Inside an open cylinder, as in DAIDALUS's CD3D: touching it is no conflict."""
    return dot(s, s) < radius * radius and -half_height < sz and sz < half_height


def cylinder_violation_at(
    s: Plane, v: Plane, sz: float, vz: float, radius: float, half_height: float, t: float
) -> bool:
    """Inside the closed cylinder after t seconds of straight flight."""
    return cylinder_violation(position(s, v, t), sz + t * vz, radius, half_height)


def violation_taumod_at(
    s: Plane,
    v: Plane,
    sz: float,
    vz: float,
    thresholds: Thresholds,
    t: float,
) -> bool:
    """Well clear by tau_mod, with either vertical lead time, is lost after t seconds."""
    dthr, zthr, tthr, tcoa, vmod = thresholds
    vertical = layer_violation_at(sz, vz, zthr, tcoa, vmod, t)
    return vertical and horizontal_violation_at(s, v, dthr, tthr, t)


def violation_tcpa_at(
    s: Plane,
    v: Plane,
    sz: float,
    vz: float,
    thresholds: Thresholds,
    t: float,
) -> bool:
    """Well clear by the time of closest approach is lost after t seconds."""
    dthr, zthr, tthr, tcoa, vmod = thresholds
    vertical = layer_violation_at(sz, vz, zthr, tcoa, vmod, t)
    return vertical and horizontal_violation_tcpa_at(s, v, dthr, tthr, t)


def violation_tep_at(
    s: Plane,
    v: Plane,
    sz: float,
    vz: float,
    thresholds: Thresholds,
    t: float,
) -> bool:
    """Well clear by the time of entry is lost after t seconds."""
    dthr, zthr, tthr, tcoa, vmod = thresholds
    vertical = layer_violation_at(sz, vz, zthr, tcoa, vmod, t)
    return vertical and horizontal_violation_tep_at(s, v, dthr, tthr, t)


def in_span(first: float, last: float, t: float) -> bool:
    """An instant between the first and the last one, both included."""
    return first <= t and t <= last
