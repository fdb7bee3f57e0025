"""What detect and avoid means, in instants: violations, manoeuvres, steps that conflict, histories.

Relative state is ownship minus intruder: s [m], v [m/s], sz and vz up. A manoeuvre is a sequence of
steps; it is flown in straight pieces from step to step, and from any step one may fly straight on.
A step conflicts if a volume is violated at some instant of a piece on the way to it, or at some
instant of the straight flight from it within a horizon. The definitions name the instants.
"""

from cratous.spec.well_clear import (
    Plane,
    violation_taumod_at,
    violation_tcpa_at,
    violation_tep_at,
)
from cratous.spec.well_clear import within as well_within


def violated_at(
    kind: int, s: Plane, v: Plane, sz: float, vz: float, dthr: float, zthr: float, tthr: float,
    tcoa: float, vmod: float, t: float,
) -> bool:  # fmt: skip
    """The volume of that kind is violated after t seconds; kind 3, a cylinder, is tep without times."""
    if kind == 1:
        return violation_tcpa_at(s, v, sz, vz, dthr, zthr, tthr, tcoa, vmod, t)
    if kind == 2 or kind == 3:
        return violation_tep_at(s, v, sz, vz, dthr, zthr, tthr, tcoa, vmod, t)
    return violation_taumod_at(s, v, sz, vz, dthr, zthr, tthr, tcoa, vmod, t)


def counts(at: float, begin: float, end: float) -> bool:
    """A piece that begins at this time is looked at."""
    return begin <= at and at <= end


def lost_on_piece(
    violated: bool, t: float, piece: float, at: float, begin: float, end: float
) -> bool:
    """Lost t seconds after the begin of a piece, while it is flown, and the piece is looked at."""
    return counts(at, begin, end) and t >= 0 and t <= piece and violated


def lost_from_step(violated: bool, t: float, at: float, begin: float, end: float) -> bool:
    """Lost t seconds after the step at time `at`, at an instant from begin to end."""
    return t >= 0 and at + t >= begin and at + t <= end and violated


def step_conflicts(way: bool, piece: bool) -> bool:
    """The way to a step loses a volume: on an earlier piece, or on this one."""
    if way:
        return True
    return piece


def the_way(lost: bool) -> bool:
    """Whether it was lost on the way."""
    return lost


def horizon(until: float, lookahead: float, time: float, manoeuvre: float, counted: bool) -> bool:
    """A volume is looked for until this time: the latest that both limits allow."""
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
    """The phases fit together: accelerated to the rate at t1, held to t2, level at the target at t3."""
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


def shrunk(before: float, after: float, least: float) -> bool:
    """A recovery distance after it was made smaller: less than before, unless it is the least."""
    return after >= least and after <= before and (after < before or after == least)


def reached(count: int, value: int, level: int) -> int:
    """How many values reach a level, with one value more."""
    if value >= level:
        return count + 1
    return count


def enough(count: int, m: int) -> bool:
    """At least m."""
    return not count < m


def may_drop(now: float, raised: float, persistence: float) -> bool:
    """A level raised at that time has been shown for as long as it has to be."""
    return raised + persistence <= now


def goes_on(now: float, before: float, gap: float) -> bool:
    """Time has gone on, and not by more than the gap."""
    return before < now and now <= before + gap


def turned(v: Plane, c: float, s: float) -> Plane:
    """A velocity turned to the right by the angle with cosine c and sine s."""
    return Plane(c * v.x + s * v.y, c * v.y - s * v.x)


def in_area(east: float, north: float, alt: float, radius: float, height: float) -> bool:
    """In a cylinder that stands on the ground: not farther from its axis than radius, not above it."""
    return well_within(Plane(east, north), radius) and not alt > height
