"""What well clear means. Relative state is ownship minus intruder: s [m], v [m/s].

Horizontal volume (modified tau, Munoz et al., "A Family of Well-Clear Boundary Models for the
Integration of UAS in the NAS", AIAA 2014; DO-365 uses the same): violated when the two are within
DTHR, or when they converge, would pass within DTHR, and tau_mod = (DTHR^2 - |s|^2) / (s.v) is at
most TTHR. Vertical volume: within ZTHR, or co-altitude is at most TCOA away. Sets are closed.
The definitions divide and speak of positions at instants; the kernels do neither.
"""

from typing import NamedTuple


class Plane(NamedTuple):
    """A horizontal vector."""

    x: float
    y: float


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
    """tcpa [s]: when the distance is least; for v not zero."""
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
    s: Plane,
    v: Plane,
    sz: float,
    vz: float,
    dthr: float,
    zthr: float,
    tthr: float,
    tcoa: float,
    t: float,
) -> bool:
    """Well clear is lost after t seconds of straight flight: both volumes at once."""
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
    return violation_at(s, v, sz, vz, dthr, zthr, tthr, tcoa, 0)


def parabola(a: float, b: float, c: float, t: float) -> float:
    """The value of a t^2 + b t + c."""
    return a * t * t + b * t + c
