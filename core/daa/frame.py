"""The local plane of detect and avoid: an orthographic projection at the ownship.

A sphere of radius 6,366,707.0194937 m, on which one minute of arc is one nautical mile. Positions are projected onto
the plane tangent to it below the ownship; altitudes are unchanged. A ground velocity is projected too, expressed in
the ownship's directions. Distances beyond five minutes of flight are increasingly foreshortened.
"""

from __future__ import annotations

import math
from typing import NamedTuple

RADIUS_M = 6366707.0194937


class Local(NamedTuple):
    """East and north [m] and velocity [m/s] in the plane."""

    east_m: float
    north_m: float
    ve_m_s: float
    vn_m_s: float


def project(
    lat0_rad: float, lon0_rad: float, lat_rad: float, lon_rad: float, ve_m_s: float, vn_m_s: float
) -> Local:
    """The state at (lat, lon) as seen in the plane at (lat0, lon0)."""
    turn = lon_rad - lon0_rad
    sin0, cos0 = math.sin(lat0_rad), math.cos(lat0_rad)
    sin1, cos1 = math.sin(lat_rad), math.cos(lat_rad)
    sin_t, cos_t = math.sin(turn), math.cos(turn)
    east = RADIUS_M * cos1 * sin_t
    north = RADIUS_M * (sin1 * cos0 - cos1 * sin0 * cos_t)
    # the local east and north directions, in the axes of the plane
    ve = ve_m_s * cos_t - vn_m_s * sin1 * sin_t
    vn = ve_m_s * sin0 * sin_t + vn_m_s * (cos1 * cos0 + sin1 * sin0 * cos_t)
    return Local(east, north, ve, vn)
