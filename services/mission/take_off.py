"""What of a take-off the mission, its loader, the executive and the monitor share."""

from __future__ import annotations

import math
from typing import NamedTuple

from cratous.spec.mission import GroundedVehicle, Mission, Vehicle

USED = 0.8
"""A way up uses at most this share of the climb rate."""
LONGEST_MS = 1_800_000
"""A vehicle whose take-off would take longer does not take off [ms]."""
BEATS = 4
"""A take-off takes at most so many heartbeats more than its way."""


SILENCE_MS = 2000
"""For so long UxAS may be silent while a vehicle takes off, where the mission does not say [ms]: four heartbeats
of the length that they have if the mission does not say that either."""


class TakeOff(NamedTuple):
    """alt_m: to which altitude [m MSL]; silence_ms: for how long UxAS may be silent while the vehicle is not up [ms];
    turn, many: of so many heartbeats it may begin to roll at this one."""

    alt_m: float
    silence_ms: int
    turn: int = 0
    many: int = 1


def grounded(mission: Mission) -> list[GroundedVehicle]:
    """The vehicles of a mission that start on the ground, by id."""
    found = [one for one in mission.vehicles if isinstance(one, GroundedVehicle)]
    return sorted(found, key=lambda one: one.id)


def silence_ms(mission: Mission) -> int:
    """For how long UxAS may be silent while a vehicle takes off [ms]."""
    return SILENCE_MS if mission.link_loss is None else mission.link_loss.after_ms


def roll_m(from_m_s: float, to_m_s: float, acceleration_m_s2: float) -> float:
    """How long the roll from one speed to a higher one is [m]; 0 from a speed that is as high."""
    return max(to_m_s * to_m_s - from_m_s * from_m_s, 0.0) / (2 * acceleration_m_s2)


def take_off_ms(vehicle: Vehicle, acceleration_m_s2: float, heartbeat_ms: int) -> int:
    """How long a take-off takes that is permitted at once [ms]; 0 of a vehicle that starts in the air."""
    if not isinstance(vehicle, GroundedVehicle):
        return 0
    roll_s = vehicle.min_speed_m_s / acceleration_m_s2
    climb_s = (vehicle.position.alt_m - vehicle.ground_m) / (USED * vehicle.max_climb_m_s)
    return math.ceil(1000 * (roll_s + climb_s)) + BEATS * heartbeat_ms
