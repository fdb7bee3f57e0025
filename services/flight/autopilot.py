"""The autopilot: follows a polyline, loiters on a circle, or flies a velocity.

Path following aims at the point of the track that lies max(v dt, sqrt(e R)) ahead of the nearest one: e is
the distance from the track, R is 1.5 times the radius of the tightest turn. On the track, the aim point is
where the coming step ends (no steady-state error, also on arcs); off the track, it is the distance in which
two arcs of radius R lead back, so the aircraft joins the track tangentially instead of crossing it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from cratous.core.routing.polylines import Track
from cratous.services.flight.dynamics import (
    AirState,
    Limits,
    Steering,
    clamp,
    turn_radius_m,
    wrap,
)
from cratous.spec.mission import Velocity
from cratous.spec.mission.plan import Hold
from cratous.spec.records import replace


@dataclass(frozen=True)
class Follow:
    """Fly along a track at a speed [m/s]. s_m: arc length flown; offset_m: distance from the track."""

    track: Track
    speed_m_s: float
    s_m: float = 0.0
    offset_m: float = 0.0


@dataclass(frozen=True)
class Circle:
    """Loiter on a circle at a speed [m/s] until the next command."""

    hold: Hold
    speed_m_s: float


@dataclass(frozen=True)
class Fly:
    """Fly a constant velocity."""

    velocity: Velocity


Command = Follow | Circle | Fly


@dataclass(frozen=True)
class Progress:
    """Arc length flown on a track at the start and at the end of a step, and the track's length [m]."""

    before_m: float
    after_m: float
    length_m: float

    @property
    def passed(self) -> bool:
        """Whether the end of the track has been passed."""
        return self.after_m >= self.length_m

    def passing_ms(self, before_ms: int, after_ms: int) -> int:
        """When the end was passed [ms], interpolated between the two instants and rounded up."""
        moved = self.after_m - self.before_m
        if moved <= 0 or self.before_m >= self.length_m:
            return before_ms
        share = (self.length_m - self.before_m) / moved
        return min(after_ms, before_ms + math.ceil(share * (after_ms - before_ms) - 1e-6))


def track_progress(command: Follow, state: AirState, dt_s: float) -> tuple[Follow, Progress]:
    """The command with its progress updated to the present position, and the progress of this step."""
    window = 2 * state.speed_m_s * dt_s + abs(command.offset_m)
    near = command.track.nearest(state.position, command.s_m, window)
    moved = replace(command, s_m=near.s_m, offset_m=near.offset_m)
    return moved, Progress(command.s_m, near.s_m, command.track.length_m)


def decide(command: Command, state: AirState, limits: Limits, dt_s: float) -> Steering:
    """The heading, speed and climb rate to steer in the coming step of dt_s [s]."""
    if isinstance(command, Fly):
        v = command.velocity
        speed = math.hypot(v.north_m_s, v.east_m_s)
        heading = math.atan2(v.east_m_s, v.north_m_s) if speed > 0 else state.heading_rad
        return Steering(heading, speed, -v.down_m_s)
    if isinstance(command, Circle):
        return _on_circle(command, state, limits, dt_s)
    return _along(command, state, limits, dt_s)


def _along(command: Follow, state: AirState, limits: Limits, dt_s: float) -> Steering:
    step = state.speed_m_s * dt_s
    e = abs(command.offset_m)
    radius = 1.5 * turn_radius_m(state.speed_m_s, limits.max_bank_rad)
    ahead = max(step, math.sqrt(e * radius))
    p, aim = state.position, command.track.at(command.s_m + ahead)
    heading = math.atan2(aim.east_m - p.east_m, aim.north_m - p.north_m)
    height = command.track.at(command.s_m + step).alt_m
    return Steering(heading, command.speed_m_s, (height - p.alt_m) / dt_s)


def _on_circle(command: Circle, state: AirState, limits: Limits, dt_s: float) -> Steering:
    """Aim at the step's end on the circle; from farther away, approach at a steeper angle."""
    hold, p = command.hold, state.position
    north, east = p.north_m - hold.north_m, p.east_m - hold.east_m
    sign = 1.0 if hold.clockwise else -1.0
    e = math.hypot(north, east) - hold.radius_m
    radius = 1.5 * turn_radius_m(state.speed_m_s, limits.max_bank_rad)
    ahead = max(state.speed_m_s * dt_s, min(math.sqrt(abs(e) * radius), hold.radius_m))
    angle = math.atan2(east, north) + sign * ahead / hold.radius_m
    heading = math.atan2(
        hold.east_m + hold.radius_m * math.sin(angle) - p.east_m,
        hold.north_m + hold.radius_m * math.cos(angle) - p.north_m,
    )
    climb = clamp((hold.alt_m - p.alt_m) / dt_s, -limits.max_climb_m_s, limits.max_climb_m_s)
    return Steering(wrap(heading), command.speed_m_s, climb)
