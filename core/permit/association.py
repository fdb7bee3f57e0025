"""Whether a sensor measurement is associated with a track: within a number of standard deviations of it. No root.

Definitions: `spec.permit.association`.
"""

from cratous.core.kernel import Vec2, kernel


@kernel(implements="permit.association.gated", nonnegative=("wide", "high", "sigmas"))
def in_gate(off: Vec2, up: float, wide: float, high: float, sigmas: float) -> bool:
    """True iff a difference, off in the plane and up, is within `sigmas` standard deviations, each >= 0.

    wide, high: the variances of each component of the one, and of the other; any unit, and its square.
    """
    most = sigmas * sigmas
    return off.x * off.x + off.y * off.y <= most * wide and up * up <= most * high
