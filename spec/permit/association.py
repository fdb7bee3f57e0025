"""What it means that a measurement may be of a track.

Both are off the true place by normal errors; their difference has the sum of their variances. It is in the gate where it
is no longer, in the plane and up, than so many standard deviations.
"""

from __future__ import annotations

from cratous.spec.well_clear import Plane, within


def gated(off: Plane, up: float, wide_sigma: float, high_sigma: float, sigmas: float) -> bool:
    """In the plane the difference is within so many times the one deviation, up within so many of the other."""
    reach = sigmas * high_sigma
    return within(off, sigmas * wide_sigma) and -reach <= up and up <= reach
