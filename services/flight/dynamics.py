"""A deterministic point-mass aircraft; its flown path is exactly piecewise linear.

Within one physics step the velocity is constant: `steer` chooses the velocity of the coming step (turn rate
limited by the bank angle, g tan(bank) / v; acceleration and climb limited), `advance` moves by it. A state
with its velocity therefore gives the position at every instant of the step, and the well-clear kernels can
check two of them exactly.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from cratous.core.avoidance.manoeuvre import Ability
from cratous.services.mission.landing import MAX_ACCELERATION_M_S2, is_down
from cratous.spec.mission import GroundedVehicle, Position, Traffic, Vehicle, Velocity
from cratous.spec.mission.plan import Pose

GRAVITY_M_S2 = 9.80665


class Limits(NamedTuple):
    """Airframe limits: speeds [m/s], bank [rad], climb [m/s], acceleration [m/s2]."""

    min_speed_m_s: float
    max_speed_m_s: float
    max_bank_rad: float
    max_climb_m_s: float
    max_acceleration_m_s2: float = MAX_ACCELERATION_M_S2


class AirState(NamedTuple):
    """Position, heading, ground speed and climb rate (positive up) of an aircraft until the next step."""

    position: Position
    heading_rad: float
    speed_m_s: float
    climb_m_s: float

    @property
    def velocity(self) -> Velocity:
        """Velocity in the coming step: north, east, down [m/s]."""
        return Velocity(
            self.speed_m_s * math.cos(self.heading_rad),
            self.speed_m_s * math.sin(self.heading_rad),
            -self.climb_m_s,
        )

    @property
    def pose(self) -> Pose:
        """Position and heading as a pose."""
        return Pose(*self.position, self.heading_rad)


class Steering(NamedTuple):
    """Commanded heading [rad], ground speed [m/s] and climb rate [m/s]."""

    heading_rad: float
    speed_m_s: float
    climb_m_s: float


def limits_of(vehicle: Vehicle) -> Limits:
    """The limits that the mission declares for a vehicle."""
    return Limits(
        vehicle.min_speed_m_s, vehicle.max_speed_m_s, vehicle.max_bank_rad, vehicle.max_climb_m_s
    )


def first_state(vehicle: Vehicle) -> AirState:
    """A vehicle's state at mission start: in the air, or stationary on the ground."""
    if isinstance(vehicle, GroundedVehicle):
        return AirState(vehicle.stands_at, wrap(vehicle.heading_rad), 0.0, 0.0)
    return planned_state(vehicle)


def on_its_ground(vehicle: Vehicle, air: AirState) -> bool:
    """Whether a vehicle that starts on the ground is at the altitude of its ground."""
    return isinstance(vehicle, GroundedVehicle) and is_down(air.position.alt_m - vehicle.ground_m)


def stands_at_start(vehicle: Vehicle, air: AirState) -> bool:
    """Whether a vehicle that starts on the ground is still on it, at rest."""
    return on_its_ground(vehicle, air) and air.speed_m_s == 0


def taken_off(vehicle: Vehicle, air: AirState) -> AirState:
    """The expected state of a vehicle after take-off: its present place, the altitude and speed at which its
    plan begins.
    """
    position = air.position._replace(alt_m=max(air.position.alt_m, vehicle.position.alt_m))
    return AirState(position, air.heading_rad, vehicle.speed_m_s, 0.0)


def planned_state(vehicle: Vehicle) -> AirState:
    """The airborne state in which a vehicle's plan begins."""
    return AirState(vehicle.position, wrap(vehicle.heading_rad), vehicle.speed_m_s, 0.0)


def wrap(angle_rad: float) -> float:
    """The angle normalised to (-pi, pi]."""
    angle = math.fmod(angle_rad, 2 * math.pi)
    if angle > math.pi:
        return angle - 2 * math.pi
    if angle <= -math.pi:
        return angle + 2 * math.pi
    return angle


def clamp(value: float, low: float, high: float) -> float:
    """The value limited to [low, high]."""
    return min(max(value, low), high)


def turn_rate_rad_s(speed_m_s: float, max_bank_rad: float) -> float:
    """Turn rate of a level turn at a bank angle: g tan(bank) / v [rad/s]."""
    return GRAVITY_M_S2 * math.tan(max_bank_rad) / speed_m_s


def ability_at(speed_m_s: float, limits: Limits, floor_m: float, step_s: float) -> Ability:
    """The airframe's `Ability` at a speed [m/s]. floor_m, step_s: as in `Ability`."""
    return Ability(
        turn_rate_rad_s(speed_m_s, limits.max_bank_rad),
        limits.min_speed_m_s,
        limits.max_speed_m_s,
        limits.max_climb_m_s,
        MAX_ACCELERATION_M_S2,
        floor_m,
        step_s,
    )


def turn_radius_m(speed_m_s: float, max_bank_rad: float) -> float:
    """Radius of a level turn at a bank angle: v^2 / (g tan(bank)) [m]."""
    return speed_m_s / turn_rate_rad_s(speed_m_s, max_bank_rad)


def steer(state: AirState, wanted: Steering, limits: Limits, dt_s: float) -> AirState:
    """The state with the velocity of the coming step: as close to `wanted` as the limits allow."""
    most = turn_rate_rad_s(state.speed_m_s, limits.max_bank_rad) * dt_s
    turn = clamp(wrap(wanted.heading_rad - state.heading_rad), -most, most)
    change = limits.max_acceleration_m_s2 * dt_s
    speed = state.speed_m_s + clamp(wanted.speed_m_s - state.speed_m_s, -change, change)
    return AirState(
        state.position,
        wrap(state.heading_rad + turn),
        clamp(speed, limits.min_speed_m_s, limits.max_speed_m_s),
        clamp(wanted.climb_m_s, -limits.max_climb_m_s, limits.max_climb_m_s),
    )


def advance(state: AirState, dt_s: float) -> AirState:
    """The state after dt_s [s] of straight flight."""
    p, v = state.position, state.velocity
    return state._replace(
        position=Position(
            p.north_m + v.north_m_s * dt_s,
            p.east_m + v.east_m_s * dt_s,
            p.alt_m - v.down_m_s * dt_s,
        )
    )


def touching_down(state: AirState, ground_m: float, dt_s: float) -> AirState:
    """The state with its descent limited so that a step of dt_s [s] ends no lower than ground_m [m], and at it if it ends
    so near that it counts as on the ground.
    """
    height_m = state.position.alt_m - ground_m
    if is_down(height_m + state.climb_m_s * dt_s):
        return state._replace(climb_m_s=-height_m / dt_s)
    return state


def rolling(state: AirState, braking_m_s2: float, dt_s: float) -> AirState:
    """The state of a vehicle rolling on the ground for the coming step: straight on, braking to rest."""
    return state._replace(speed_m_s=max(state.speed_m_s - braking_m_s2 * dt_s, 0.0), climb_m_s=0.0)


def rolling_up(state: AirState, speed_m_s: float, climb_m_s: float, dt_s: float) -> AirState:
    """The state of a vehicle in its take-off run for the coming step: straight on, accelerating to speed_m_s
    [m/s]. It climbs only once that speed is reached.
    """
    speed = min(state.speed_m_s + MAX_ACCELERATION_M_S2 * dt_s, speed_m_s)
    slower_by = speed_m_s - speed
    return state._replace(speed_m_s=speed, climb_m_s=0.0 if slower_by else max(climb_m_s, 0.0))


def traffic_state(traffic: Traffic, now_ms: int) -> AirState | None:
    """State of traffic at an instant: straight flight from where it appears; None while it is absent."""
    if now_ms < traffic.appears_ms:
        return None
    if traffic.vanishes_ms is not None and now_ms > traffic.vanishes_ms:
        return None
    v, p = traffic.velocity, traffic.position
    t_s = (now_ms - traffic.appears_ms) / 1000
    return AirState(
        Position(
            p.north_m + v.north_m_s * t_s, p.east_m + v.east_m_s * t_s, p.alt_m - v.down_m_s * t_s
        ),
        math.atan2(v.east_m_s, v.north_m_s),
        math.hypot(v.north_m_s, v.east_m_s),
        -v.down_m_s,
    )
