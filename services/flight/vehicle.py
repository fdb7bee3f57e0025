"""One vehicle: airframe, autopilot, actuator gate, and what its own surveillance sees.

The gate sits here, at the actuators, and so do the own state and the traffic picture that its
ICAROUS instance works with: a broken link takes nothing from collision avoidance. All decisions
about authority are those of the gate kernels.
"""

from __future__ import annotations

import math
from typing import Any

from cratous.bridge import lmcp
from cratous.core.authority.cycle import gate_wished
from cratous.core.authority.gate import (
    ICAROUS,
    UXAS,
    Gate,
    gate_accepts,
    gate_after,
)
from cratous.core.avoidance.manoeuvre import Ability, Motion
from cratous.core.avoidance.prediction import Intruder
from cratous.services.flight.autopilot import Circle, Command, Follow, decide, track_progress
from cratous.services.flight.commands import SENDERS, decode
from cratous.services.flight.dynamics import (
    MAX_ACCELERATION_M_S2,
    AirState,
    advance,
    first_state,
    limits_of,
    steer,
    turn_radius_m,
    turn_rate_rad_s,
)
from cratous.services.mission.frames import Projection, compass
from cratous.spec.mission import Vehicle
from cratous.spec.mission.plan import Hold

OVERRUN_S = 5.0
"""Flying on past the end of a path for this long [s] without a new command starts a loiter."""


class VehicleNode:
    """A vehicle in the simulator. Times in ms, steps of dt_s."""

    def __init__(
        self, vehicle: Vehicle, projection: Projection, dt_s: float, floor_m: float
    ) -> None:
        self.vehicle, self.limits = vehicle, limits_of(vehicle)
        self.state: AirState = first_state(vehicle)
        self.gate = Gate(UXAS, 0, False)
        self.command: Command | None = None
        self._projection, self._dt_s, self._floor_m = projection, dt_s, floor_m
        self._roll_rad = 0.0

    def receive(self, command: Any, now_ms: int) -> list[Any]:
        """Let a GatedCommand through, or say that it was dropped."""
        sender = ICAROUS if command.Sender.name == SENDERS[ICAROUS] else UXAS
        if not gate_accepts(self.gate, sender, command.Epoch):
            stale = command.Epoch != self.gate.epoch
            return [
                lmcp.new(
                    "CommandDropped",
                    VehicleID=self.vehicle.id,
                    Time=now_ms,
                    Sender=SENDERS[sender],
                    Epoch=command.Epoch,
                    GateEpoch=self.gate.epoch,
                    Reason="of another epoch" if stale else "sent by one without authority",
                )
            ]
        self.gate = gate_after(self.gate, sender, command.Epoch)
        self.command = decode(self._projection, command.Command, self.state.heading_rad)
        return []

    def wish(self, act: int) -> None:
        """Let the gate do what the vehicle's ICAROUS wants. act: as the cycle's kernels answer."""
        self.gate = gate_wished(self.gate, act)

    def steer(self) -> None:
        """Choose the velocity of the coming step."""
        dt, state = self._dt_s, self.state
        if isinstance(self.command, Follow):
            self.command, progress = track_progress(self.command, state, dt)
            if progress.after_m > progress.length_m + OVERRUN_S * state.speed_m_s:
                self.command = self._loiter_here()
        elif self.command is None:
            self.command = self._loiter_here()
        wanted = decide(self.command, state, self.limits, dt)
        self.state = steer(state, wanted, self.limits, dt)
        turn = math.remainder(self.state.heading_rad - state.heading_rad, 2 * math.pi)
        self._roll_rad = math.atan(self.state.speed_m_s * turn / dt / 9.80665)

    def advance(self) -> None:
        """Fly the step."""
        self.state = advance(self.state, self._dt_s)

    def _loiter_here(self) -> Circle:
        s = self.state
        radius = 1.2 * turn_radius_m(s.speed_m_s, self.limits.max_bank_rad)
        p = s.position
        hold = Hold(
            p.north_m - radius * math.sin(s.heading_rad),
            p.east_m + radius * math.cos(s.heading_rad),
            p.alt_m,
            radius,
            True,
        )
        return Circle(hold, s.speed_m_s)

    @property
    def motion(self) -> Motion:
        """Own state, as the vehicle's ICAROUS instance gets it."""
        s = self.state
        return Motion(s.position, s.heading_rad, s.speed_m_s, s.climb_m_s)

    @property
    def ability(self) -> Ability:
        """What the airframe can do at its present speed."""
        limits = self.limits
        return Ability(
            turn_rate_rad_s(self.state.speed_m_s, limits.max_bank_rad),
            limits.min_speed_m_s,
            limits.max_speed_m_s,
            limits.max_climb_m_s,
            MAX_ACCELERATION_M_S2,
            self._floor_m,
        )

    def air_vehicle_state(self, now_ms: int, payloads: list[Any], tasks: list[int]) -> Any:
        """The state that goes out at 2 Hz: degrees, body axes (u forward, v right, w down)."""
        s = self.state
        lat, lon = self._projection.to_geodetic(s.position.north_m, s.position.east_m)
        heading = compass(s.heading_rad)
        mode = {"Follow": "Waypoint", "Circle": "Loiter", "Fly": "FlightDirector"}
        return lmcp.new(
            "AirVehicleState",
            ID=self.vehicle.id,
            u=s.speed_m_s,
            v=0.0,
            w=-s.climb_m_s,
            Heading=heading,
            Course=heading,
            Roll=math.degrees(self._roll_rad),
            Groundspeed=s.speed_m_s,
            Airspeed=s.speed_m_s,
            VerticalSpeed=s.climb_m_s,
            Location=lmcp.new("Location3D", Latitude=lat, Longitude=lon, Altitude=s.position.alt_m),
            EnergyAvailable=100.0,
            PayloadStateList=payloads,
            Mode=mode.get(type(self.command).__name__, "Waypoint"),
            AssociatedTasks=tasks,
            Time=now_ms,
        )


def truth(vehicle_id: int, s: AirState, now_ms: int, cooperative: bool) -> Any:
    """Where an aircraft is and how it flies until the next step, as the monitor reads it."""
    p, v = s.position, s.velocity
    return lmcp.new(
        "TruthState",
        VehicleID=vehicle_id,
        Time=now_ms,
        North=p.north_m,
        East=p.east_m,
        Altitude=p.alt_m,
        VelocityNorth=v.north_m_s,
        VelocityEast=v.east_m_s,
        VelocityDown=v.down_m_s,
        Heading=compass(s.heading_rad),
        Cooperative=cooperative,
    )


def traffic_picture(
    own_id: int, states: dict[int, AirState], cooperating: frozenset[int]
) -> tuple[Intruder, ...]:
    """Everyone else, as surveillance on board sees them, by id."""
    return tuple(
        Intruder(other, states[other].position, states[other].velocity, other in cooperating)
        for other in sorted(states)
        if other != own_id
    )
