"""Converts latitude and longitude (WGS-84) to the mission frame: distance and azimuth from its
origin.

The geodesic is Vincenty's inverse solution (1975), accurate to a tenth of a millimetre.
"""

from __future__ import annotations

import math

A = 6_378_137.0
F = 1 / 298.257223563
B = A * (1 - F)
ACCURACY_M = 1e-3
"""Accuracy of positions that were degrees in a message [m]."""


def to_local(
    origin_lat: float, origin_lon: float, lat: float, lon: float
) -> tuple[float, float] | None:
    """North and east [m] of a place; None if the iteration fails (the far side of the Earth)."""
    u1 = math.atan((1 - F) * math.tan(math.radians(origin_lat)))
    u2 = math.atan((1 - F) * math.tan(math.radians(lat)))
    apart = math.radians(math.remainder(lon - origin_lon, 360.0))
    sin1, cos1, sin2, cos2 = math.sin(u1), math.cos(u1), math.sin(u2), math.cos(u2)
    lam = apart
    for _ in range(100):
        x, y = cos2 * math.sin(lam), cos1 * sin2 - sin1 * cos2 * math.cos(lam)
        sin_s = math.hypot(x, y)
        cos_s = sin1 * sin2 + cos1 * cos2 * math.cos(lam)
        if sin_s < 1e-15:
            return 0.0, 0.0
        sigma = math.atan2(sin_s, cos_s)
        sin_a = cos1 * cos2 * math.sin(lam) / sin_s
        cos2_a = 1 - sin_a * sin_a
        mid = cos_s - 2 * sin1 * sin2 / cos2_a if cos2_a > 1e-12 else 0.0
        c = F / 16 * cos2_a * (4 + F * (4 - 3 * cos2_a))
        before = lam
        lam = apart + (1 - c) * F * sin_a * (
            sigma + c * sin_s * (mid + c * cos_s * (2 * mid * mid - 1))
        )
        if abs(lam - before) < 1e-14:
            break
    else:
        return None
    uu = cos2_a * (A * A - B * B) / (B * B)
    a = 1 + uu / 16384 * (4096 + uu * (uu * (320 - 175 * uu) - 768))
    b = uu / 1024 * (256 + uu * (uu * (74 - 47 * uu) - 128))
    less = (
        b * sin_s * (mid + b / 4 * (
            cos_s * (2 * mid * mid - 1)
            - b / 6 * mid * (4 * sin_s * sin_s - 3) * (4 * mid * mid - 3)
        ))
    )  # fmt: skip
    distance = B * a * (sigma - less)
    azimuth = math.atan2(cos2 * math.sin(lam), cos1 * sin2 - sin1 * cos2 * math.cos(lam))
    return distance * math.cos(azimuth), distance * math.sin(azimuth)
