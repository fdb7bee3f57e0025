"""One step of an aircraft's motion: coordinated turns without sideslip, wind, energy.

Wind is given by the direction from which it blows: north and east components [m/s] of a vector pointing
there.
"""

from __future__ import annotations

from math import atan2, copysign, cos, exp, pi, radians, sin, tan
from typing import NamedTuple

from cratous.services.simulator.earth import POLE_M, bound_pi, prime_vertical_m
from cratous.services.simulator.performance import Airframe, profile_at

GRAVITY_M_S2 = 9.8
BANK_RATE_RAD_S = radians(60)
PITCH_RATE_RAD_S = radians(90)
BANK_GAIN = 8.0
"""Growth of the bank towards its maximum with the error of the course [1 / rad]."""
ACCELERATION_M_S2 = 10.0


class Motion(NamedTuple):
    """Position [rad, m MSL], attitude [rad], airspeed and velocity over ground [m/s], energy [%]; rates of
    heading, pitch and roll in the last step [rad/s].
    """

    lat_rad: float
    lon_rad: float
    alt_m: float
    heading_rad: float
    pitch_rad: float
    roll_rad: float
    airspeed_m_s: float
    north_m_s: float
    east_m_s: float
    climb_m_s: float
    energy_percent: float
    energy_percent_s: float
    turning_rad_s: float = 0.0
    pitching_rad_s: float = 0.0
    rolling_rad_s: float = 0.0


def body_rates(m: Motion) -> tuple[float, float, float]:
    """Rotation rates about the body axes forward, right and down [rad/s], from the Euler angle rates."""
    turn, pitch, roll = m.turning_rad_s, m.pitching_rad_s, m.rolling_rad_s
    level, bank = cos(m.pitch_rad), m.roll_rad
    return (
        roll - turn * sin(m.pitch_rad),
        pitch * cos(bank) + turn * level * sin(bank),
        turn * level * cos(bank) - pitch * sin(bank),
    )


class Command(NamedTuple):
    """Output of the guidance: course [rad], altitude [m MSL], airspeed and climb rate [m/s].

    Climb rate 0: as the difference in altitude requires.
    """

    course_rad: float
    alt_m: float
    speed_m_s: float
    climb_m_s: float


def _towards(value: float, wanted: float, most: float) -> float:
    change = wanted - value
    if change > most:
        return value + most
    return value - most if change < -most else value + change


def asked_climb_m_s(difference_m: float, climb_m_s: float, compatible: bool) -> float:
    """Commanded vertical speed: towards the altitude, no faster than a given climb rate.

    AMASE climbs or descends at a given rate whatever the commanded altitude.
    """
    if climb_m_s == 0:
        return difference_m
    if compatible:
        return climb_m_s
    return copysign(min(abs(difference_m), abs(climb_m_s)), difference_m)


def move(
    m: Motion,
    command: Command,
    airframe: Airframe,
    wind_m_s: tuple[float, float],
    ground_m: float,
    dt_s: float,
) -> tuple[Motion, float]:
    """The motion after a step, and the greatest bank in force [rad].

    Without energy, or on the ground, nothing moves.
    """
    climb = asked_climb_m_s(command.alt_m - m.alt_m, command.climb_m_s, airframe.compatible)
    speed = m.airspeed_m_s
    profile = profile_at(airframe, speed, climb)
    max_bank = radians(profile.max_bank_deg)
    if m.energy_percent <= 0 or m.alt_m <= ground_m:
        if airframe.compatible:
            return m, max_bank
        still = {"turning_rad_s": 0.0, "pitching_rad_s": 0.0, "rolling_rad_s": 0.0}
        m = m._replace(north_m_s=0.0, east_m_s=0.0, climb_m_s=0.0, airspeed_m_s=0.0, **still)
        return m, max_bank
    climb = copysign(min(abs(profile.vertical_m_s), abs(climb)), climb)
    error = bound_pi(command.course_rad - atan2(m.east_m_s, m.north_m_s))
    wanted = copysign(max_bank * (1 - exp(-BANK_GAIN * abs(error))), error)
    roll = _towards(m.roll_rad, wanted, BANK_RATE_RAD_S * dt_s)
    heading, turning = m.heading_rad, 0.0
    if speed > 0:
        turning = GRAVITY_M_S2 * tan(roll) / speed
        heading = bound_pi(heading + turning * dt_s)
    if airframe.compatible:
        # AMASE uses the error of the course as the turn of the step
        turning = error / dt_s
    pitch = _towards(m.pitch_rad, radians(profile.pitch_deg), PITCH_RATE_RAD_S * dt_s)
    change = max(-ACCELERATION_M_S2, min(ACCELERATION_M_S2, command.speed_m_s - speed))
    after = max(airframe.min_speed_m_s, min(airframe.max_speed_m_s, speed + change * dt_s))
    level = speed * cos(pitch)
    north = level * cos(heading) - wind_m_s[0]
    east = level * sin(heading) - wind_m_s[1]
    alt = m.alt_m + climb * dt_s
    lat = m.lat_rad + north * dt_s / (POLE_M + alt)
    lon = m.lon_rad + east * dt_s / ((prime_vertical_m(lat) + alt) * cos(lat))
    if abs(lon) > pi and not airframe.compatible:
        lon = bound_pi(lon)
    use = profile.energy_percent_s
    energy = max(0.0, m.energy_percent - use * dt_s)
    rates = turning, (pitch - m.pitch_rad) / dt_s, (roll - m.roll_rad) / dt_s
    moved = Motion(
        lat, lon, alt, heading, pitch, roll, after, north, east, climb, energy, use, *rates
    )
    return moved, max_bank
