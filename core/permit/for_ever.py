"""Whether a hold is clear of an intruder at every instant from now on, without a time limit. No division, no root.

Only against an intruder that is assumed to fly straight, whose tube grows linearly (no gain), and no faster than the
two separate: every other tube outgrows every hold. Definitions: `spec.permit.motion`.
"""

from cratous.core.kernel import Vec2, kernel
from cratous.core.permit.pieces import Growth, Margins, Tube


@kernel(supports="beside_for_ever")
def ever_dips_to_zero(a: float, b: float, c: float) -> bool:
    """True iff a t^2 + b t + c <= 0 for some t >= 0."""
    if c <= 0 or a < 0:
        return True
    return b < 0 and b * b >= 4 * a * c


@kernel(implements="permit.motion.reached_at")
def beside_for_ever(s: Vec2, v: Vec2, growth: Growth) -> bool:
    """True iff the radius has no gain and is less than the distance of the centres at every instant from now on.

    s, v: relative position [m] and velocity [m/s].
    """
    a = v.x * v.x + v.y * v.y - growth.rate_m_s * growth.rate_m_s
    b = 2 * (s.x * v.x + s.y * v.y - growth.start_m * growth.rate_m_s)
    c = s.x * s.x + s.y * s.y - growth.start_m * growth.start_m
    return growth.gain_m_s2 == 0 and not ever_dips_to_zero(a, b, c)


@kernel(implements="permit.motion.levelled_at")
def above_for_ever(sz: float, vz: float, growth: Growth) -> bool:
    """True iff the radius has no gain and is less than the altitude above the other at every instant from now on.

    sz, vz: relative altitude [m] and climb rate [m/s].
    """
    return growth.gain_m_s2 == 0 and sz > growth.start_m and vz >= growth.rate_m_s


@kernel(implements="permit.motion.hit_at", nonnegative=("margins",))
def hold_clear(
    s: Vec2,
    v: Vec2,
    sz: float,
    vz: float,
    tube: Tube,
    margins: Margins,
) -> bool:
    """True only if the cylinder is not entered at any instant from now on, for every position of the vehicle within
    rho_m and of the intruder in its tube. s, v, sz, vz: own reference minus prediction [m, m/s]; the reference of a
    hold is stationary.
    """
    wide, high = tube
    radius_m, half_m, rho_m = margins
    around = Growth(wide.start_m + radius_m + rho_m, wide.rate_m_s, wide.gain_m_s2)
    layer = Growth(high.start_m + half_m + rho_m, high.rate_m_s, high.gain_m_s2)
    if above_for_ever(sz, vz, layer) or above_for_ever(0 - sz, 0 - vz, layer):
        return True
    return beside_for_ever(s, v, around)
