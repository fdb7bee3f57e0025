"""What follows from a vehicle and its mission for the ICAROUS instance of it: the numbers that nobody gives.

All are for the vehicle at its cruise speed; in flight they are those of the speed that is flown.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from cratous.core.avoidance.drift import drift_of
from cratous.core.avoidance.manoeuvre import Ability, Motion
from cratous.core.avoidance.prediction import buffered
from cratous.core.avoidance.resolution import Scene, turn_back_s
from cratous.core.routing.dubins import turn_radius_m
from cratous.services.icarous.ending import TRACKING_S, TURN_MARGIN, WIDEST, horizon_s
from cratous.services.icarous.foresight import PASSED_S, REACHED_S
from cratous.services.icarous.proposal import STEPS
from cratous.services.icarous.traffic_monitor import PERSIST_MS, nearest
from cratous.spec.mission import Mission, Vehicle, WellClear

QUARTER_RAD = math.pi / 2
"""The turn that takes the own velocity out of the line of an encounter."""
BUFFER_SHARE = 0.5
"""Of what the buffer leaves, so much is for how far the vehicle may be off its prediction."""


class Derived(NamedTuple):
    """Seconds, metres, radians per second. volume: the buffered one; least_lookahead_s: a loss that is seen later
    is seen too late; room_m, room_high_m: how far the vehicle may be off its prediction; drift_m: how far the flown
    quarter turn may be off the predicted one; hold_m, wide_hold_m: the disc that the vehicle keeps to in the hold at
    the end of its way, and where zones are near; hold_high_m: how far off its height it may be there."""

    volume: WellClear
    horizon_s: float
    search_step_s: float
    room_m: float
    room_high_m: float
    turn_rate_rad_s: float
    turn_radius_m: float
    way_back_radius_m: float
    near_waypoint_m: float
    hard_limit_s: float
    last_time_s: float
    least_lookahead_s: float
    turn_back_s: float
    drift_m: float
    hold_m: float
    wide_hold_m: float
    hold_high_m: float
    reached_m: float
    passed_m: float


def derived(mission: Mission, vehicle: Vehicle) -> Derived:
    """The numbers of one vehicle, by the functions that fly it."""
    speed, daa, beat_ms = vehicle.speed_m_s, mission.daa, mission.simulation.heartbeat_ms
    radius_m = turn_radius_m(speed, vehicle.max_bank_rad)
    ability = Ability(
        speed / radius_m, vehicle.min_speed_m_s, vehicle.max_speed_m_s, vehicle.max_climb_m_s,
        0.0, 0.0, mission.simulation.step_ms / 1000,
    )  # fmt: skip
    now = Motion(vehicle.position, 0.0, speed, 0.0)
    volume = buffered(daa.well_clear, daa.buffer)
    limits, left = nearest(ability, volume, beat_ms), BUFFER_SHARE * (daa.buffer - 1)
    wide_m, off_m = TURN_MARGIN * radius_m, TRACKING_S * speed
    return Derived(
        volume=volume,
        horizon_s=horizon_s(Scene((), (), volume, daa.lookahead_s)),
        search_step_s=daa.lookahead_s / STEPS,
        room_m=left * daa.well_clear.dthr_m,
        room_high_m=left * daa.well_clear.zthr_m,
        turn_rate_rad_s=ability.turn_rate_rad_s,
        turn_radius_m=radius_m,
        way_back_radius_m=wide_m,
        near_waypoint_m=3 * radius_m,
        hard_limit_s=limits.hard_s,
        last_time_s=limits.last_s,
        least_lookahead_s=limits.hard_s + PERSIST_MS / 1000,
        turn_back_s=turn_back_s(now, ability),
        drift_m=drift_of(now, ability, QUARTER_RAD, speed, 0.0).aside_m(math.inf),
        hold_m=wide_m + off_m,
        wide_hold_m=2 * WIDEST * wide_m + off_m,
        hold_high_m=TRACKING_S * vehicle.max_climb_m_s,
        reached_m=REACHED_S * speed,
        passed_m=PASSED_S * speed,
    )
