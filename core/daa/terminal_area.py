"""The terminal area (DTA): a cylinder around a place, in which another alerter is used.

Inside, the alerter of the active aircraft becomes `dta_alerter`; in a conflict more severe than the corrective region
no downward guidance is given there, and with dta_logic -1 no recovery of direction. The active aircraft is the
ownship if alerting is ownship-centric, else the intruder.
"""

from __future__ import annotations

from cratous.core.daa.frame import project
from cratous.core.kernel import kernel
from cratous.spec.daa.parameters import Parameters


@kernel(
    implements="daa.meaning.in_area",
    restates="the area is a cylinder that stands on the ground, by its own definition",
)
def inside_area(
    east_m: float, north_m: float, alt_m: float, radius_m: float, height_m: float
) -> bool:
    """True iff a position relative to the area's centre lies in it, boundary included [m]."""
    return east_m * east_m + north_m * north_m <= radius_m * radius_m and alt_m <= height_m


def in_terminal_area(
    p: Parameters, lat_rad: float | None, lon_rad: float | None, alt_m: float
) -> bool:
    """Whether a geodetic position lies in the terminal area; False without a position."""
    if p.dta_logic == 0 or p.dta_radius_m <= 0 or lat_rad is None or lon_rad is None:
        return False
    place = project(p.dta_latitude_rad, p.dta_longitude_rad, lat_rad, lon_rad, 0.0, 0.0)
    return inside_area(place.east_m, place.north_m, alt_m, p.dta_radius_m, p.dta_height_m)
