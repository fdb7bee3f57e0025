"""The position of a vehicle as a message."""

from __future__ import annotations

from math import degrees
from typing import Any

from cratous.bridge import lmcp
from cratous.services.simulator.motion import Motion


def location_of(m: Motion) -> Any:
    """The place of a moving vehicle as a `Location3D` [deg, m above mean sea level]."""
    return lmcp.new(
        "Location3D",
        Latitude=degrees(m.lat_rad),
        Longitude=degrees(m.lon_rad),
        Altitude=m.alt_m,
        AltitudeType="MSL",
    )
