"""Whether one disc lies in another, and one tube in another from now on. No root.

A tracker's new tube replaces the old one in a certificate only if it lies in it. Definitions: `spec.permit.motion`.
"""

from cratous.core.kernel import Vec2, kernel
from cratous.core.permit.pieces import Growth, growth_after


@kernel(implements="permit.motion.in_disc", nonnegative=("inner_m", "outer_m"))
def disc_within(p: Vec2, inner_m: float, outer_m: float) -> bool:
    """True iff the disc of inner_m about p lies in that of outer_m about 0; any one unit."""
    gap = outer_m - inner_m
    return gap >= 0 and p.x * p.x + p.y * p.y <= gap * gap


@kernel(implements="permit.motion.in_tube_at")
def tube_within(s: Vec2, v: Vec2, new: Growth, old: Growth, age_s: float) -> bool:
    """True only if from now on the new tube lies in the old one.

    s, v: the new prediction minus the old one, now [m], and their velocities' difference [m/s]; old: as
    it was when its prediction was made, age_s seconds ago [s], >= 0.
    """
    now = growth_after(old, age_s)
    steady = new.gain_m_s2 <= now.gain_m_s2
    return (
        steady
        and disc_within(s, new.start_m, now.start_m)
        and disc_within(v, new.rate_m_s, now.rate_m_s)
    )
