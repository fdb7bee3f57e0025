"""Well-clear violation now: tau_mod, tcpa, tep, plain tau, cylinder; vertical TCOA and VMOD.

Definitions: `spec.well_clear`. Source: Munoz et al., "A Family of Well-Clear Boundary Models for
the Integration of UAS in the NAS", AIAA 2014. Relative state is ownship minus intruder. Every
test is multiplied out, so that no kernel divides and the exact reading exists. Sets are closed,
but for `cylinder_conflict`.
"""

from cratous.core.kernel import Vec2, kernel
from cratous.core.well_clear.thresholds import Thresholds


@kernel(implements="well_clear.horizontal_violation", nonnegative=("dthr_m", "tthr_s"))
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


@kernel(implements="well_clear.horizontal_violation", nonnegative=("tthr_s",))
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


@kernel(implements="well_clear.vertical_violation", nonnegative=("zthr_m", "tcoa_s"))
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


@kernel(implements="well_clear.violation", nonnegative=("dthr_m", "zthr_m", "tthr_s", "tcoa_s"))
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


# -- the other time variables ---------------------------------------------------------------
@kernel(implements="well_clear.horizontal_violation_tcpa", nonnegative=("dthr_m", "tthr_s"))
def horizontal_violation_tcpa(s: Vec2, v: Vec2, dthr_m: float, tthr_s: float) -> bool:
    """True iff the horizontal volume with the time of closest approach is violated now.

    Arguments as for `horizontal_violation`.
    """
    ss = s.x * s.x + s.y * s.y
    vv = v.x * v.x + v.y * v.y
    sv = s.x * v.x + s.y * v.y
    cross = s.x * v.y - s.y * v.x
    return tcpa_decision(ss, vv, sv, cross, dthr_m * dthr_m, tthr_s)


@kernel(implements="well_clear.horizontal_violation_tcpa", nonnegative=("tthr_s",))
def tcpa_decision(ss: float, vv: float, sv: float, cross: float, dd: float, tthr_s: float) -> bool:
    """The same, on invariants: |s|^2, |v|^2, s.v, s x v, DTHR^2 and TTHR."""
    if ss <= dd:
        return True
    if sv >= 0:
        return False
    # dcpa <= DTHR and tcpa <= TTHR, multiplied out by |v|^2 > 0
    return cross * cross <= dd * vv and 0 - sv <= tthr_s * vv


@kernel(implements="well_clear.horizontal_violation_tep", nonnegative=("dthr_m", "tthr_s"))
def horizontal_violation_tep(s: Vec2, v: Vec2, dthr_m: float, tthr_s: float) -> bool:
    """True iff the horizontal volume with the time of entry is violated now.

    Arguments as for `horizontal_violation`.
    """
    ss = s.x * s.x + s.y * s.y
    vv = v.x * v.x + v.y * v.y
    sv = s.x * v.x + s.y * v.y
    cross = s.x * v.y - s.y * v.x
    return tep_decision(ss, vv, sv, cross, dthr_m * dthr_m, tthr_s)


@kernel(implements="well_clear.horizontal_violation_tep", nonnegative=("tthr_s",))
def tep_decision(ss: float, vv: float, sv: float, cross: float, dd: float, tthr_s: float) -> bool:
    """The same, on invariants: |s|^2, |v|^2, s.v, s x v, DTHR^2 and TTHR."""
    if ss <= dd:
        return True
    if sv >= 0:
        return False
    disc = dd * vv - cross * cross
    # -s.v - sqrt(disc) <= TTHR |v|^2 without the root
    late = 0 - sv - tthr_s * vv
    return disc >= 0 and (late <= 0 or late * late <= disc)


@kernel(implements="well_clear.horizontal_violation_tau", nonnegative=("dthr_m", "tthr_s"))
def horizontal_violation_tau(s: Vec2, v: Vec2, dthr_m: float, tthr_s: float) -> bool:
    """True iff the horizontal volume with plain tau is violated now; not convex in time.

    Arguments as for `horizontal_violation`. For comparison only: nothing in this project is decided by it.
    """
    ss = s.x * s.x + s.y * s.y
    vv = v.x * v.x + v.y * v.y
    sv = s.x * v.x + s.y * v.y
    cross = s.x * v.y - s.y * v.x
    dd = dthr_m * dthr_m
    if ss <= dd:
        return True
    if sv >= 0:
        return False
    return cross * cross <= dd * vv and ss <= tthr_s * (0 - sv)


@kernel(implements="well_clear.vertical_violation_vmod", nonnegative=("zthr_m", "vmod_s"))
def vertical_violation_vmod(sz: float, vz: float, zthr_m: float, vmod_s: float) -> bool:
    """True iff the vertical volume with VMOD is violated now: ZTHR grows with the closing rate.

    sz: relative altitude [m]; vz: relative climb rate [m/s]; zthr_m: [m], >= 0; vmod_s: time by which the closing
    rate is multiplied [s], >= 0.
    """
    if abs(sz) <= zthr_m:
        return True
    return sz * vz < 0 and abs(sz) <= zthr_m + vmod_s * abs(vz)


@kernel(implements="well_clear.layer_violation", nonnegative=("zthr_m", "tcoa_s", "vmod_s"))
def layer_violation(sz: float, vz: float, zthr_m: float, tcoa_s: float, vmod_s: float) -> bool:
    """True iff the vertical volume is violated now, by TCOA or by VMOD (0 switches one off).

    Arguments as for `vertical_violation` and `vertical_violation_vmod`.
    """
    if abs(sz) <= zthr_m:
        return True
    return sz * vz < 0 and abs(sz) <= max(tcoa_s * abs(vz), zthr_m + vmod_s * abs(vz))


# -- in space -------------------------------------------------------------------------------
@kernel(
    implements="well_clear.violation_taumod_at",
    nonnegative=("thresholds",),
)
def violation_taumod(
    s: Vec2,
    v: Vec2,
    sz: float,
    vz: float,
    thresholds: Thresholds,
) -> bool:
    """True iff well clear by tau_mod is lost now; vertically by TCOA or VMOD."""
    dthr_m, zthr_m, tthr_s, tcoa_s, vmod_s = thresholds
    vertical = layer_violation(sz, vz, zthr_m, tcoa_s, vmod_s)
    return vertical and horizontal_violation(s, v, dthr_m, tthr_s)


@kernel(
    implements="well_clear.violation_tcpa_at",
    nonnegative=("thresholds",),
)
def violation_tcpa(
    s: Vec2,
    v: Vec2,
    sz: float,
    vz: float,
    thresholds: Thresholds,
) -> bool:
    """True iff well clear by the time of closest approach is lost now; vertically by TCOA or VMOD."""
    dthr_m, zthr_m, tthr_s, tcoa_s, vmod_s = thresholds
    vertical = layer_violation(sz, vz, zthr_m, tcoa_s, vmod_s)
    return vertical and horizontal_violation_tcpa(s, v, dthr_m, tthr_s)


@kernel(
    implements="well_clear.violation_tep_at",
    nonnegative=("thresholds",),
)
def violation_tep(
    s: Vec2,
    v: Vec2,
    sz: float,
    vz: float,
    thresholds: Thresholds,
) -> bool:
    """True iff well clear by the time of entry is lost now; vertically by TCOA or VMOD."""
    dthr_m, zthr_m, tthr_s, tcoa_s, vmod_s = thresholds
    vertical = layer_violation(sz, vz, zthr_m, tcoa_s, vmod_s)
    return vertical and horizontal_violation_tep(s, v, dthr_m, tthr_s)


@kernel(implements="well_clear.cylinder_violation", nonnegative=("radius_m", "half_height_m"))
def cylinder_violation(s: Vec2, sz: float, radius_m: float, half_height_m: float) -> bool:
    """True iff the intruder is inside the closed cylinder now.

    s: relative position [m]; sz: relative altitude [m]; radius_m, half_height_m: [m], >= 0.
    """
    return abs(sz) <= half_height_m and s.x * s.x + s.y * s.y <= radius_m * radius_m


@kernel(implements="well_clear.cylinder_conflict", nonnegative=("radius_m", "half_height_m"))
def cylinder_conflict(s: Vec2, sz: float, radius_m: float, half_height_m: float) -> bool:
    """True iff the intruder is inside the open cylinder now: touching it does not count.

    Arguments as for `cylinder_violation`.
    """
    return abs(sz) < half_height_m and s.x * s.x + s.y * s.y < radius_m * radius_m
