"""When a measurement is associated with a track.

Both have normal errors about the true position; the variance of their difference is the sum of their variances. The
measurement is in the gate if the horizontal and vertical differences are within a number of standard deviations.
"""

from __future__ import annotations

from cratous.spec.well_clear import Plane, within


def gated(off: Plane, up: float, wide_sigma: float, high_sigma: float, sigmas: float) -> bool:
    """The horizontal difference is within `sigmas` times wide_sigma, the vertical one within `sigmas` times
    high_sigma.
    """
    reach = sigmas * high_sigma
    return within(off, sigmas * wide_sigma) and -reach <= up and up <= reach
