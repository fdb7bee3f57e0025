"""Parameters of a vehicle's ICAROUS instance that follow from the vehicle and its mission.

They hold at the vehicle's cruise speed; in flight, those for the present speed apply.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from cratous.core.avoidance.drift import drift_of
from cratous.core.avoidance.manoeuvre import Ability, Motion
from cratous.core.avoidance.prediction import buffered
from cratous.core.avoidance.resolution import Scene, turn_back_s
from cratous.core.routing.dubins import turn_radius_m
from cratous.services.icarous.foresight import PASSED_S, REACHED_S
from cratous.services.icarous.proposal import STEPS
from cratous.services.icarous.route_end import TRACKING_S, TURN_MARGIN, WIDEST, horizon_s
from cratous.services.icarous.traffic_monitor import PERSIST_MS, nearest
from cratous.spec.mission import Mission, Vehicle, WellClear

QUARTER_RAD = math.pi / 2
"""The turn that takes the own velocity out of the line of an encounter [rad]."""
BUFFER_SHARE = 0.5
"""Share of the buffer's margin that allows for the vehicle's own deviation from its prediction."""


class Derived(NamedTuple):
    """Units: seconds, metres, radians per second.

    volume: the buffered one; least_lookahead_s: shortest adequate look-ahead; room_m, room_high_m: allowed
    deviation of the vehicle from its prediction; drift_m: deviation of a flown quarter turn from the
    predicted one; hold_m, wide_hold_m: radius of the disc that contains the vehicle in its final hold, and
    near zones; hold_high_m: vertical deviation there.
    """

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
    """The parameters of one vehicle, by the functions used in flight."""
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
