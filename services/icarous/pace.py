"""The speed at which UxAS flies the announced route; the vehicle accelerates to it as fast as it can."""

from __future__ import annotations

import math

from cratous.core.avoidance.manoeuvre import Pace
from cratous.services.icarous.inbox import Told
from cratous.services.icarous.messages import Sensed


def pace_of(told: Told, sensed: Sensed) -> Pace | None:
    """The commanded speed, limited to what the airframe can fly; None if none was commanded."""
    if not told.speed_m_s:
        return None
    ability = sensed.ability
    speed = min(max(told.speed_m_s, ability.min_speed_m_s), ability.max_speed_m_s)
    return Pace(speed, ability.acceleration_m_s2)


def at_pace(sensed: Sensed, pace: Pace | None) -> Sensed:
    """The same inputs at that speed, with the turn rate of the same bank angle."""
    if pace is None:
        return sensed
    motion, ability = sensed.motion, sensed.ability
    rate = ability.turn_rate_rad_s * motion.speed_m_s / pace.speed_m_s
    return sensed._replace(
        motion=motion._replace(speed_m_s=pace.speed_m_s),
        ability=ability._replace(turn_rate_rad_s=rate),
    )


def change_ms(sensed: Sensed, pace: Pace | None) -> int:
    """Duration of the acceleration to that speed [ms]."""
    if pace is None or not pace.acceleration_m_s2:
        return 0
    gap = abs(pace.speed_m_s - sensed.motion.speed_m_s)
    return math.ceil(1000 * gap / pace.acceleration_m_s2)
