"""Take-off data shared by mission, loader, executive and monitor."""

from __future__ import annotations

import math
from typing import NamedTuple

from cratous.spec.mission import GroundedVehicle, Mission, Vehicle

USED = 0.8
"""Largest share of the climb rate used in a climb-out."""
LONGEST_MS = 1_800_000
"""A vehicle whose take-off would take longer does not take off [ms]."""
BEATS = 4
"""Heartbeats allowed for a take-off in addition to its flight time."""


SILENCE_MS = 2000
"""Tolerated silence of UxAS during take-off if the mission sets none [ms]: four heartbeats of the default
length.
"""


class TakeOff(NamedTuple):
    """alt_m: target altitude [m MSL]; silence_ms: tolerated silence of UxAS before completion [ms]; turn,
    many: it may begin to roll at heartbeat number `turn` of every `many`.
    """

    alt_m: float
    silence_ms: int
    turn: int = 0
    many: int = 1


def grounded(mission: Mission) -> list[GroundedVehicle]:
    """The vehicles of a mission that start on the ground, by id."""
    found = [one for one in mission.vehicles if isinstance(one, GroundedVehicle)]
    return sorted(found, key=lambda one: one.id)


def silence_ms(mission: Mission) -> int:
    """Tolerated silence of UxAS during take-off [ms]."""
    return SILENCE_MS if mission.link_loss is None else mission.link_loss.after_ms


def roll_m(from_m_s: float, to_m_s: float, acceleration_m_s2: float) -> float:
    """Length of the roll from one speed to a higher one [m]; 0 if it is not higher."""
    return max(to_m_s * to_m_s - from_m_s * from_m_s, 0.0) / (2 * acceleration_m_s2)


def take_off_ms(vehicle: Vehicle, acceleration_m_s2: float, heartbeat_ms: int) -> int:
    """Duration of a take-off that is permitted at once [ms]; 0 for a vehicle that starts in the air."""
    if not isinstance(vehicle, GroundedVehicle):
        return 0
    roll_s = vehicle.min_speed_m_s / acceleration_m_s2
    climb_s = (vehicle.position.alt_m - vehicle.ground_m) / (USED * vehicle.max_climb_m_s)
    return math.ceil(1000 * (roll_s + climb_s)) + BEATS * heartbeat_ms
