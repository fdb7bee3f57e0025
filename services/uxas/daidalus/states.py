"""Converts AirVehicleStates for detect and avoid: one plane at the ownship, one instant, one wind.

The ground velocity is course, ground speed and vertical speed; the wind is what the ownship reports
(WindDirection is where it comes from), and is subtracted from every velocity. An intruder's state
is extrapolated along its velocity to the ownship's time.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from cratous.core.daa.frame import project
from cratous.core.daa.state import Aircraft


class Wind(NamedTuple):
    """Wind velocity [m/s], in the direction towards which the air moves."""

    east: float = 0.0
    north: float = 0.0


def ground(state: Any) -> tuple[float, float]:
    """Velocity over ground, east and north [m/s]."""
    course = math.radians(state.Course)
    return state.Groundspeed * math.sin(course), state.Groundspeed * math.cos(course)


def wind_of(state: Any) -> Wind:
    """The wind that an aircraft reports."""
    source = math.radians(state.WindDirection)
    return Wind(-state.WindSpeed * math.sin(source), -state.WindSpeed * math.cos(source))


def air_vector(state: Any, wind: Wind) -> tuple[float, float]:
    """Heading in [0, 360) [deg] and airspeed [m/s] of an aircraft from its state."""
    east, north = ground(state)
    east, north = east - wind.east, north - wind.north
    heading = math.degrees(math.atan2(east, north)) % 360.0
    return 0.0 if heading == 360.0 else heading, math.hypot(east, north)


def aircraft(own: Any, state: Any, wind: Wind) -> Aircraft:
    """An aircraft in the ownship's plane at the ownship's time, relative to the air.

    An altitude of another type than the ownship's cannot be compared: it is assumed to be equal, so
    that no conflict is missed.
    """
    here, there = own.Location, state.Location
    place = project(
        math.radians(here.Latitude),
        math.radians(here.Longitude),
        math.radians(there.Latitude),
        math.radians(there.Longitude),
        *ground(state),
    )
    late = (own.Time - state.Time) / 1000
    altitude, climb = there.Altitude + late * state.VerticalSpeed, state.VerticalSpeed
    if not comparable(own, state):
        altitude, climb = here.Altitude, own.VerticalSpeed
    return Aircraft(
        str(state.ID),
        place.east_m + late * place.ve_m_s,
        place.north_m + late * place.vn_m_s,
        altitude,
        place.ve_m_s - wind.east,
        place.vn_m_s - wind.north,
        climb,
    )


def comparable(own: Any, state: Any) -> bool:
    """True if both altitudes have the same reference (AGL or MSL)."""
    return bool(own.Location.AltitudeType.name == state.Location.AltitudeType.name)
