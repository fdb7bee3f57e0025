"""Motion of ground and surface vehicles: along straight legs, round corners, to a stop at the end of the
route.

It keeps within the vehicle's speeds and accelerations; where the route bends, the speed is low enough to pass
close to the corner. The laws are our own: AMASE turns such entities instantly, and has no ground vehicles.
"""

from __future__ import annotations

from math import atan, atan2, copysign, cos, hypot, inf, pi, radians, sin, sqrt, tan
from typing import Any, NamedTuple

from cratous.services.simulator.earth import POLE_M, bound_pi, prime_vertical_m
from cratous.services.simulator.motion import GRAVITY_M_S2, Motion
from cratous.spec.errors import BadInput

GROUND_BRAKES_M_S2, SEA_BRAKES_M_S2 = 1.0, 0.5
"""Acceleration and braking along the track; on land as in AMASE for entities that follow a path."""
GROUND_SIDE_M_S2, SEA_SIDE_M_S2 = 2.0, 1.0
"""Greatest lateral acceleration; at sea without a MaxBankAngle."""
GROUND_TURN_RAD_S, SEA_TURN_RAD_S = 1.0, radians(20)
GROUND_CUT_M, SEA_CUT_M = 1.0, 10.0
"""Largest distance from a corner of the route when passing it [m]."""
TURN_GAIN_S = 2.0
"""Turn rate per error of the course [1 / s]."""
AHEAD_S, AHEAD_M = 1.0, 3.0
"""It steers for a point this far ahead on the route, in seconds of travel and at least in metres."""

Point = tuple[float, float]
"""Latitude and longitude [rad]."""


class Chassis(NamedTuple):
    """Lowest, usual and highest speed [m/s]; acceleration along and across [m/s²]; turn rate [rad/s]; largest
    distance from a corner [m]; energy use [% / s]; sails: whether it leans into turns, at most at
    leaning_rad_s [rad/s], 0: instantly.
    """

    min_speed_m_s: float
    usual_m_s: float
    max_speed_m_s: float
    along_m_s2: float
    side_m_s2: float
    turn_rad_s: float
    cut_m: float
    energy_percent_s: float
    sails: bool = False
    leaning_rad_s: float = 0.0

    def within(self, speed_m_s: float) -> float:
        """The closest speed within its limits [m/s]."""
        return max(self.min_speed_m_s, min(self.max_speed_m_s, speed_m_s))

    def round(self, radius_m: float) -> float:
        """Highest speed on a curve of a radius [m/s]."""
        return min(self.max_speed_m_s, sqrt(self.side_m_s2 * radius_m), self.turn_rad_s * radius_m)

    def still_from(self, speed_m_s: float, away_m: float) -> float:
        """The highest speed [m/s] at away_m [m] before a point that has to be passed at speed_m_s [m/s]."""
        return sqrt(speed_m_s * speed_m_s + 2 * self.along_m_s2 * max(0.0, away_m))


def chassis_of(body: Any, where: str) -> Chassis:
    """The chassis of a GroundVehicleConfiguration or SurfaceVehicleConfiguration; BadInput for an invalid
    one.
    """
    kind = type(body).__name__
    low, usual, high = body.MinimumSpeed, body.NominalSpeed, body.MaximumSpeed
    sails = kind == "SurfaceVehicleConfiguration"
    bank, leaning = (body.MaxBankAngle, body.MaxBankRate) if sails else (0.0, 0.0)
    # NaN fails every comparison
    if not (0 <= low <= high < inf and high > 0 and 0 <= usual < inf):
        raise BadInput(
            "wrong speeds [m/s]",
            where=where,
            item=f"{kind} {body.ID}",
            expected="0 <= MinimumSpeed <= MaximumSpeed, MaximumSpeed > 0, NominalSpeed >= 0",
            got=f"{low:g}, {high:g}, {usual:g}",
        )
    if not (0 <= bank < 90 and 0 <= leaning < inf and 0 <= body.EnergyRate < inf):
        raise BadInput(
            "wrong bank [deg, deg/s] or use of energy [%/s]",
            where=where,
            item=f"{kind} {body.ID}",
            expected="MaxBankAngle below 90, none below 0",
            got=f"{bank:g}, {leaning:g}, {body.EnergyRate:g}",
        )
    usual = max(low, min(high, usual or high))
    if not sails:
        return Chassis(low, usual, high, GROUND_BRAKES_M_S2, GROUND_SIDE_M_S2, GROUND_TURN_RAD_S,
                       GROUND_CUT_M, body.EnergyRate)  # fmt: skip
    side = GRAVITY_M_S2 * tan(radians(bank)) or SEA_SIDE_M_S2
    return Chassis(low, usual, high, SEA_BRAKES_M_S2, side, SEA_TURN_RAD_S, SEA_CUT_M,
                   body.EnergyRate, True, radians(leaning))  # fmt: skip


class Leg(NamedTuple):
    """A straight leg seen from a vehicle: bearing [rad], remaining distance along it [m], negative beyond its
    end, and the course towards a point some way ahead on it [rad].
    """

    bearing_rad: float
    left_m: float
    course_rad: float


def leg_at(start: Point, end: Point, m: Motion) -> Leg:
    """The leg between two places, seen from a vehicle."""
    scale = (prime_vertical_m(m.lat_rad) + m.alt_m) * cos(m.lat_rad)
    north = POLE_M + m.alt_m
    x, y = bound_pi(start[1] - m.lon_rad) * scale, (start[0] - m.lat_rad) * north
    dx, dy = bound_pi(end[1] - start[1]) * scale, (end[0] - start[0]) * north
    long = hypot(dx, dy)
    if not long:
        return Leg(m.heading_rad, 0.0, m.heading_rad)
    ux, uy = dx / long, dy / long
    along = -(x * ux + y * uy)
    aim = along + _ahead_m(m.airspeed_m_s)
    return Leg(atan2(ux, uy), long - along, atan2(x + ux * aim, y + uy * aim))


def _ahead_m(speed_m_s: float) -> float:
    return max(AHEAD_M, AHEAD_S * speed_m_s)


def corner(chassis: Chassis, turn_rad: float, before_m: float, after_m: float) -> Point:
    """Speed for passing a corner of the route [m/s], and the distance before it at which the turn begins [m].

    turn_rad: change of direction; before_m, after_m: lengths of the adjacent legs [m].
    """
    half = min(abs(bound_pi(turn_rad)), pi - 1e-3) / 2
    if half <= 1e-6:
        return chassis.max_speed_m_s, 0.0
    radius = min(chassis.cut_m / (1 / cos(half) - 1), min(before_m, after_m) / (2 * tan(half)))
    return chassis.round(radius), radius * tan(half)


def bends(chassis: Chassis, m: Motion, course_rad: float) -> float:
    """The highest speed at which it can still turn onto a course [m/s]; 0 if the course lies behind it."""
    error = abs(bound_pi(course_rad - m.heading_rad))
    if error >= pi / 2:
        return 0.0
    bend = 2 * sin(error) / _ahead_m(m.airspeed_m_s)
    return chassis.round(1 / bend) if bend else chassis.max_speed_m_s


def move(m: Motion, course_rad: float, speed_m_s: float, chassis: Chassis, dt_s: float) -> Motion:
    """The motion after a step towards a course and a speed; without energy a vehicle that needs it stops."""
    still = m.energy_percent <= 0 < chassis.energy_percent_s
    change = speed_m_s - m.airspeed_m_s
    most = chassis.along_m_s2 * dt_s
    speed = 0.0 if still else m.airspeed_m_s + copysign(min(abs(change), most), change)
    error = bound_pi(course_rad - m.heading_rad)
    bound = min(chassis.turn_rad_s, chassis.side_m_s2 / speed if speed else inf)
    turning = copysign(min(abs(error) * TURN_GAIN_S, bound), error) if not still else 0.0
    roll, rolling = 0.0, 0.0
    if chassis.sails:
        wanted = atan(speed * turning / GRAVITY_M_S2)
        roll = wanted
        if chassis.leaning_rad_s:
            lean = wanted - m.roll_rad
            roll = m.roll_rad + copysign(min(abs(lean), chassis.leaning_rad_s * dt_s), lean)
        rolling = (roll - m.roll_rad) / dt_s
        # with too little lean yet, it turns less
        if abs(roll) < abs(wanted):
            turning = GRAVITY_M_S2 * tan(roll) / speed
    heading = bound_pi(m.heading_rad + turning * dt_s)
    north, east = speed * cos(heading), speed * sin(heading)
    lat = m.lat_rad + north * dt_s / (POLE_M + m.alt_m)
    lon = m.lon_rad + east * dt_s / ((prime_vertical_m(lat) + m.alt_m) * cos(lat))
    use = chassis.energy_percent_s if speed else 0.0
    energy = max(0.0, m.energy_percent - use * dt_s)
    return Motion(lat, bound_pi(lon), m.alt_m, heading, 0.0, roll, speed, north, east, 0.0, energy,
                  use, turning, 0.0, rolling)  # fmt: skip
