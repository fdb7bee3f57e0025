"""When well clear is lost: first and last instant within a span of straight flight.

Definitions: `spec.well_clear`. Relative state is ownship minus intruder, in any horizontal frame:
s [m], v [m/s]; sz, vz up. Every volume is violated during one closed interval of time at most, so
two instants tell all. An interval kernel gives `Span(first_s, last_s)` for [b_s, t_s]; where no
instant violates, or b_s > t_s, it gives Span(1, 0), always: ask `first_s <= last_s`.

Kernels in space take (s, v, sz, vz, thresholds, b_s, t_s); all `Thresholds` are >= 0, and tcoa_s or
vmod_s is switched off by 0. They are called one state at a time, or over arrays: `compiled(kernel)(sx, sy, vx, vy, sz, vz, dthr_m, ..., t_s)` broadcasts its
columns and gives a Span of arrays. They divide and take roots: whether there is an instant at all
is decided exactly by `core.well_clear.during`; the `times_` kernels give the instants where there
is one, without asking, so that their enclosures stay narrow.
"""

from math import sqrt
from typing import NamedTuple

from cratous.core.kernel import Vec2, kernel
from cratous.core.well_clear.thresholds import Thresholds


class Span(NamedTuple):
    """The instants first_s <= t <= last_s [s]; Span(1, 0) is empty."""

    first_s: float
    last_s: float


@kernel(implements="well_clear.in_span")
def or_empty(first_s: float, last_s: float) -> Span:
    """The span from first_s to last_s [s], the one empty span if they are in the wrong order."""
    if first_s > last_s:
        return Span(1, 0)
    return Span(first_s, last_s)


# -- vertical -------------------------------------------------------------------------------
@kernel(supports="vertical_interval", nonnegative=("zthr_m", "tcoa_s", "vmod_s"))
def times_vertical(
    sz: float, vz: float, zthr_m: float, tcoa_s: float, vmod_s: float, b_s: float, t_s: float
) -> Span:
    """First and last instant of [b_s, t_s] at which the vertical volume is violated, if any is.

    sz: relative altitude [m]; vz: relative climb rate [m/s]; zthr_m: [m], >= 0; tcoa_s, vmod_s:
    leads of `layer_violation` [s], >= 0; b_s, t_s: [s].
    """
    if vz == 0:
        return Span(b_s, t_s)
    w = abs(vz)
    z = sz
    if vz < 0:
        z = 0 - sz
    # z grows with rate w; violated from the greater lead below the layer to its upper face
    first = (0 - z - max(zthr_m + vmod_s * w, tcoa_s * w)) / w
    return Span(max(first, b_s), min((zthr_m - z) / w, t_s))


@kernel(implements="well_clear.layer_violation_at", nonnegative=("zthr_m", "tcoa_s", "vmod_s"))
def vertical_interval(
    sz: float, vz: float, zthr_m: float, tcoa_s: float, vmod_s: float, b_s: float, t_s: float
) -> Span:
    """The instants of [b_s, t_s] at which the vertical volume is violated.

    Arguments as for `times_vertical`.
    """
    if vz == 0 and abs(sz) > zthr_m:
        return Span(1, 0)
    first, last = times_vertical(sz, vz, zthr_m, tcoa_s, vmod_s, b_s, t_s)
    return or_empty(first, last)


# -- horizontal -----------------------------------------------------------------------------
@kernel(implements="well_clear.within_at", nonnegative=("dthr_m",))
def course_reaches(s: Vec2, v: Vec2, dthr_m: float) -> bool:
    """True iff the straight course comes within dthr_m at some time, past or future."""
    vv = v.x * v.x + v.y * v.y
    cross = s.x * v.y - s.y * v.x
    if vv == 0:
        return s.x * s.x + s.y * s.y <= dthr_m * dthr_m
    return cross * cross <= dthr_m * dthr_m * vv


@kernel(supports="horizontal_interval_taumod", nonnegative=("dthr_m", "tthr_s"))
def times_taumod(s: Vec2, v: Vec2, dthr_m: float, tthr_s: float, b_s: float, t_s: float) -> Span:
    """First and last instant of [b_s, t_s] at which the volume with tau_mod is violated, if any is.

    s: relative position [m]; v: relative velocity [m/s]; dthr_m: [m], >= 0; tthr_s: [s], >= 0.
    """
    vv = v.x * v.x + v.y * v.y
    sv = s.x * v.x + s.y * v.y
    cross = s.x * v.y - s.y * v.x
    # v itself is tested as well: the square of a small speed may round to 0
    if (v.x == 0 and v.y == 0) or vv == 0:
        return Span(b_s, t_s)
    disc = max(dthr_m * dthr_m * vv - cross * cross, 0)
    # the smaller root of |s(t)|^2 + TTHR s(t).v = DTHR^2; it is not after the entry to the circle
    lead = tthr_s * vv
    first = (0 - sv - (lead + sqrt(max(4 * disc + lead * lead, 0))) / 2) / vv
    return Span(max(first, b_s), min((sqrt(disc) - sv) / vv, t_s))


@kernel(implements="well_clear.horizontal_violation_at", nonnegative=("dthr_m", "tthr_s"))
def horizontal_interval_taumod(
    s: Vec2, v: Vec2, dthr_m: float, tthr_s: float, b_s: float, t_s: float
) -> Span:
    """The instants of [b_s, t_s] at which the volume with tau_mod is violated.

    Arguments as for `times_taumod`.
    """
    if not course_reaches(s, v, dthr_m):
        return Span(1, 0)
    first, last = times_taumod(s, v, dthr_m, tthr_s, b_s, t_s)
    return or_empty(first, last)


@kernel(supports="horizontal_interval_tcpa", nonnegative=("dthr_m", "tthr_s"))
def times_tcpa(s: Vec2, v: Vec2, dthr_m: float, tthr_s: float, b_s: float, t_s: float) -> Span:
    """First and last instant of [b_s, t_s] at which the volume with tcpa is violated, if any is.

    s: relative position [m]; v: relative velocity [m/s]; dthr_m: [m], >= 0; tthr_s: [s], >= 0.
    """
    vv = v.x * v.x + v.y * v.y
    sv = s.x * v.x + s.y * v.y
    cross = s.x * v.y - s.y * v.x
    # v itself is tested as well: the square of a small speed may round to 0
    if (v.x == 0 and v.y == 0) or vv == 0:
        return Span(b_s, t_s)
    disc = max(dthr_m * dthr_m * vv - cross * cross, 0)
    root = sqrt(disc)
    first = (0 - sv - max(root, tthr_s * vv)) / vv
    return Span(max(first, b_s), min((root - sv) / vv, t_s))


@kernel(implements="well_clear.horizontal_violation_tcpa_at", nonnegative=("dthr_m", "tthr_s"))
def horizontal_interval_tcpa(
    s: Vec2, v: Vec2, dthr_m: float, tthr_s: float, b_s: float, t_s: float
) -> Span:
    """The instants of [b_s, t_s] at which the volume with tcpa is violated.

    Arguments as for `times_tcpa`.
    """
    if not course_reaches(s, v, dthr_m):
        return Span(1, 0)
    first, last = times_tcpa(s, v, dthr_m, tthr_s, b_s, t_s)
    return or_empty(first, last)


@kernel(supports="horizontal_interval_tep", nonnegative=("dthr_m", "tthr_s"))
def times_tep(s: Vec2, v: Vec2, dthr_m: float, tthr_s: float, b_s: float, t_s: float) -> Span:
    """First and last instant of [b_s, t_s] at which the volume with tep is violated, if any is.

    s: relative position [m]; v: relative velocity [m/s]; dthr_m: [m], >= 0; tthr_s: [s], >= 0.
    """
    vv = v.x * v.x + v.y * v.y
    sv = s.x * v.x + s.y * v.y
    cross = s.x * v.y - s.y * v.x
    # v itself is tested as well: the square of a small speed may round to 0
    if (v.x == 0 and v.y == 0) or vv == 0:
        return Span(b_s, t_s)
    disc = max(dthr_m * dthr_m * vv - cross * cross, 0)
    root = sqrt(disc)
    first = (0 - sv - root) / vv - tthr_s
    return Span(max(first, b_s), min((root - sv) / vv, t_s))


@kernel(implements="well_clear.horizontal_violation_tep_at", nonnegative=("dthr_m", "tthr_s"))
def horizontal_interval_tep(
    s: Vec2, v: Vec2, dthr_m: float, tthr_s: float, b_s: float, t_s: float
) -> Span:
    """The instants of [b_s, t_s] at which the volume with tep is violated.

    Arguments as for `times_tep`.
    """
    if not course_reaches(s, v, dthr_m):
        return Span(1, 0)
    first, last = times_tep(s, v, dthr_m, tthr_s, b_s, t_s)
    return or_empty(first, last)


# -- in space -------------------------------------------------------------------------------
@kernel(
    implements="well_clear.violation_taumod_at",
    nonnegative=("thresholds",),
)
def violation_interval_taumod(
    s: Vec2,
    v: Vec2,
    sz: float,
    vz: float,
    thresholds: Thresholds,
    b_s: float,
    t_s: float,
) -> Span:
    """The instants of [b_s, t_s] at which well clear by tau_mod is lost; Span(1, 0) if none."""
    dthr_m, zthr_m, tthr_s, tcoa_s, vmod_s = thresholds
    begin, end = vertical_interval(sz, vz, zthr_m, tcoa_s, vmod_s, b_s, t_s)
    return horizontal_interval_taumod(s, v, dthr_m, tthr_s, begin, end)


@kernel(
    implements="well_clear.violation_taumod_at",
    nonnegative=("thresholds",),
)
def violation_times_taumod(
    s: Vec2,
    v: Vec2,
    sz: float,
    vz: float,
    thresholds: Thresholds,
    b_s: float,
    t_s: float,
) -> Span:
    """First and last instant of [b_s, t_s] at which well clear by tau_mod is lost, if any is."""
    dthr_m, zthr_m, tthr_s, tcoa_s, vmod_s = thresholds
    begin, end = times_vertical(sz, vz, zthr_m, tcoa_s, vmod_s, b_s, t_s)
    first, last = times_taumod(s, v, dthr_m, tthr_s, begin, end)
    # within [b_s, t_s] in every reading, however wide the enclosure of a tiny speed
    return Span(min(first, t_s), max(last, b_s))


@kernel(
    implements="well_clear.violation_tcpa_at",
    nonnegative=("thresholds",),
)
def violation_interval_tcpa(
    s: Vec2,
    v: Vec2,
    sz: float,
    vz: float,
    thresholds: Thresholds,
    b_s: float,
    t_s: float,
) -> Span:
    """The instants of [b_s, t_s] at which well clear by tcpa is lost; Span(1, 0) if none."""
    dthr_m, zthr_m, tthr_s, tcoa_s, vmod_s = thresholds
    begin, end = vertical_interval(sz, vz, zthr_m, tcoa_s, vmod_s, b_s, t_s)
    return horizontal_interval_tcpa(s, v, dthr_m, tthr_s, begin, end)


@kernel(
    implements="well_clear.violation_tcpa_at",
    nonnegative=("thresholds",),
)
def violation_times_tcpa(
    s: Vec2,
    v: Vec2,
    sz: float,
    vz: float,
    thresholds: Thresholds,
    b_s: float,
    t_s: float,
) -> Span:
    """First and last instant of [b_s, t_s] at which well clear by tcpa is lost, if any is."""
    dthr_m, zthr_m, tthr_s, tcoa_s, vmod_s = thresholds
    begin, end = times_vertical(sz, vz, zthr_m, tcoa_s, vmod_s, b_s, t_s)
    first, last = times_tcpa(s, v, dthr_m, tthr_s, begin, end)
    # within [b_s, t_s] in every reading, however wide the enclosure of a tiny speed
    return Span(min(first, t_s), max(last, b_s))


@kernel(
    implements="well_clear.violation_tep_at",
    nonnegative=("thresholds",),
)
def violation_interval_tep(
    s: Vec2,
    v: Vec2,
    sz: float,
    vz: float,
    thresholds: Thresholds,
    b_s: float,
    t_s: float,
) -> Span:
    """The instants of [b_s, t_s] at which well clear by tep is lost; Span(1, 0) if none."""
    dthr_m, zthr_m, tthr_s, tcoa_s, vmod_s = thresholds
    begin, end = vertical_interval(sz, vz, zthr_m, tcoa_s, vmod_s, b_s, t_s)
    return horizontal_interval_tep(s, v, dthr_m, tthr_s, begin, end)


@kernel(
    implements="well_clear.violation_tep_at",
    nonnegative=("thresholds",),
)
def violation_times_tep(
    s: Vec2,
    v: Vec2,
    sz: float,
    vz: float,
    thresholds: Thresholds,
    b_s: float,
    t_s: float,
) -> Span:
    """First and last instant of [b_s, t_s] at which well clear by tep is lost, if any is."""
    dthr_m, zthr_m, tthr_s, tcoa_s, vmod_s = thresholds
    begin, end = times_vertical(sz, vz, zthr_m, tcoa_s, vmod_s, b_s, t_s)
    first, last = times_tep(s, v, dthr_m, tthr_s, begin, end)
    # within [b_s, t_s] in every reading, however wide the enclosure of a tiny speed
    return Span(min(first, t_s), max(last, b_s))


@kernel(implements="well_clear.cylinder_violation_at", nonnegative=("radius_m", "half_height_m"))
def cylinder_interval(
    s: Vec2,
    v: Vec2,
    sz: float,
    vz: float,
    radius_m: float,
    half_height_m: float,
    b_s: float,
    t_s: float,
) -> Span:
    """The instants of [b_s, t_s] inside the closed cylinder; Span(1, 0) if none."""
    # entering within 0 s is being within
    return violation_interval_tep(
        s, v, sz, vz, Thresholds(radius_m, half_height_m, 0, 0, 0), b_s, t_s
    )


@kernel(implements="well_clear.cylinder_violation_at", nonnegative=("radius_m", "half_height_m"))
def cylinder_times(
    s: Vec2,
    v: Vec2,
    sz: float,
    vz: float,
    radius_m: float,
    half_height_m: float,
    b_s: float,
    t_s: float,
) -> Span:
    """First and last instant of [b_s, t_s] inside the closed cylinder, if any is."""
    # entering within 0 s is being within
    return violation_times_tep(s, v, sz, vz, Thresholds(radius_m, half_height_m, 0, 0, 0), b_s, t_s)
