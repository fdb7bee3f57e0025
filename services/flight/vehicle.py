"""One vehicle: airframe, autopilot, actuator gate and surveillance: `handle(state, message) -> (state,
messages)`.

The gate sits here, at the actuators, as do the own state and the traffic picture that the vehicle's ICAROUS
uses: collision avoidance does not depend on the bridge. The gate kernels take all decisions about authority.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
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
from cratous.core.avoidance.manoeuvre import Motion
from cratous.core.avoidance.prediction import Intruder
from cratous.services.flight import holding
from cratous.services.flight.autopilot import (
    Circle,
    Command,
    Fly,
    Follow,
    decide,
    track_progress,
)
from cratous.services.flight.commands import SENDERS, decode
from cratous.services.flight.dynamics import (
    AirState,
    Limits,
    ability_at,
    advance,
    first_state,
    limits_of,
    rolling,
    rolling_up,
    steer,
    touching_down,
    turn_radius_m,
)
from cratous.services.flight.holding import Ground, InHand
from cratous.services.flight.messages import (
    Choose,
    Commanded,
    FromVehicle,
    GateIs,
    Held,
    LimitsAre,
    Look,
    Move,
    OnBoard,
    Say,
    Sense,
    Stands,
    Surveyed,
    ToVehicle,
    Wished,
)
from cratous.services.flight.notices import authority_change, dropped, gate_state, hand_state
from cratous.services.icarous.messages import Offers, Sensed
from cratous.services.mission.frames import Projection, compass
from cratous.services.mission.landing import (
    BRAKING_M_S2,
    ground_m,
    is_down,
    site_under,
)
from cratous.spec.mission import GroundedVehicle, Vehicle
from cratous.spec.mission.link_loss import LandingSite
from cratous.spec.mission.plan import Hold
from cratous.spec.records import replace

OVERRUN_S = 5.0
"""Flying past the end of a path for this long [s] without a new command starts a loiter."""
NOTHING_IN_HAND = InHand()
UNTOUCHED = Gate(UXAS, 0, False)
"""UxAS commands, and always has."""
HANDED_BACK = "the way back is free: handed back"


@dataclass(frozen=True)
class State:
    """State of a vehicle.

    air: its motion until the next step; command: what the autopilot flies, None for nothing yet; roll_rad:
    bank angle of the last turn; takeovers: how often ICAROUS has taken the vehicle; held: the held
    certificate; landed: it is on the ground and stays there; on_ground: it has not taken off yet.
    """

    air: AirState
    limits: Limits
    gate: Gate = UNTOUCHED
    command: Command | None = None
    roll_rad: float = 0.0
    takeovers: int = 0
    held: InHand = NOTHING_IN_HAND
    landed: bool = False
    on_ground: bool = False

    @property
    def stands(self) -> bool:
        """Whether it is on the ground and no intruder of others: it has landed, or does not roll to take off yet."""
        return self.landed or (self.on_ground and not self.air.speed_m_s)


Step = tuple[State, tuple[FromVehicle, ...]]


@dataclass(frozen=True)
class VehicleNode:
    """A simulated vehicle and its fixed configuration.

    dt_s: step [s]; floor_m: lowest altitude [m]; ground: parameters of the held certificate, None where none
    is offered; sites: landing sites; terrain_m: ground altitude elsewhere [m]. It can touch down only if
    there are sites.
    """

    vehicle: Vehicle
    projection: Projection
    dt_s: float
    floor_m: float
    ground: Ground | None = None
    sites: tuple[LandingSite, ...] = ()
    terrain_m: float = 0.0

    def first(self) -> State:
        """The state at mission start."""
        on_ground = isinstance(self.vehicle, GroundedVehicle)
        return State(first_state(self.vehicle), limits_of(self.vehicle), on_ground=on_ground)

    def handle(self, state: State, message: ToVehicle) -> Step:
        """One step: the state that results, and the messages to send, in order."""
        match message:
            case Commanded():
                return self._commanded(state, message)
            case Wished():
                return self._wished(state, message)
            case Held():
                return self._offered(state, message)
            case Surveyed():
                return self._surveyed(state, message)
            case LimitsAre(_, limits):
                return replace(state, limits=limits), ()
            case Look():
                return state, (self._say(self._air_vehicle_state(state, message)),)
            case Sense():
                return state, (self.sensed(state, message),)
            case Choose(now_ms):
                return self._choose(state, now_ms)
            case Move():
                return self._moved(replace(state, air=advance(state.air, self.dt_s)))

    def _moved(self, state: State) -> Step:
        """The state after a step of flight: detects lift-off and touchdown."""
        p = state.air.position
        if isinstance(self.vehicle, GroundedVehicle) and state.on_ground:
            return replace(state, on_ground=is_down(p.alt_m - self.vehicle.ground_m)), ()
        if state.landed or not self.sites:
            return state, ()
        ground = ground_m(p, self.sites, self.terrain_m)
        if not is_down(p.alt_m - ground):
            return state, ()
        return replace(
            state, landed=True, air=state.air._replace(position=p._replace(alt_m=ground))
        ), ()

    def _rolls(self, state: State) -> Step:
        """After landing: roll straight on, braking to rest, which is reported."""
        air, still = rolling(state.air, BRAKING_M_S2, self.dt_s), state.air.speed_m_s == 0
        after = replace(state, air=air, roll_rad=0.0)
        if still or air.speed_m_s != 0:
            return after, ()
        site = site_under(air.position, self.sites)
        return after, (Stands(self.vehicle.id, site.name if site is not None else ""),)

    def _takes_off(self, state: State, now_ms: int) -> Step:
        """On the ground before take-off: roll straight on as ICAROUS commands, otherwise brake."""
        air, command, wanted, climb = state.air, state.command, 0.0, 0.0
        theirs = gate_accepts(state.gate, ICAROUS, state.gate.epoch)
        silent = self.ground is not None and holding.silent(state.held, now_ms, self.ground)
        if theirs and not silent and isinstance(command, Fly):
            v = command.velocity
            wanted, climb = math.hypot(v.north_m_s, v.east_m_s), -v.down_m_s
        lifts_m_s, steepest_m_s = state.limits.min_speed_m_s, state.limits.max_climb_m_s
        # commands are rounded on the wire: only roll or stop is distinguished
        if wanted > lifts_m_s / 2:
            moved = rolling_up(air, lifts_m_s, min(climb, steepest_m_s), self.dt_s)
        else:
            moved = rolling(air, BRAKING_M_S2, self.dt_s)
        return replace(state, air=moved, roll_rad=0.0), ()

    def _say(self, body: Any) -> Say:
        return Say(body, f"vehicle/{self.vehicle.id}")

    def _commanded(self, state: State, message: Commanded) -> Step:
        """Let a GatedCommand through, or report that it was dropped."""
        command, before = message.command, state.gate
        sender = ICAROUS if command.Sender.name == SENDERS[ICAROUS] else UXAS
        if not gate_accepts(before, sender, command.Epoch):
            return state, (self._say(dropped(command, message.now_ms, sender, before)),)
        wanted = decode(self.projection, command.Command, state.air.heading_rad)
        after = commanded(state, sender, command.Epoch, wanted)
        said = self._notices(before, after, message.now_ms, HANDED_BACK, 0)
        if self.ground is None:
            return after, said
        if sender == ICAROUS:
            velocity = wanted.velocity if isinstance(wanted, Fly) else None
            kept = holding.steered(after.held, velocity, message.now_ms, self.ground)
        elif after.gate != before:  # a handback
            kept = holding.left(after.held, message.now_ms, self.ground, HANDED_BACK)
        else:
            return after, said
        after, more = self._kept(after, kept, message.now_ms)
        return after, (*said, *more)

    def _offered(self, state: State, message: Held) -> Step:
        """Record ICAROUS's certificate for its next command, or the reason why it has none."""
        now_ms, offer = message
        if self.ground is None or not gate_accepts(state.gate, ICAROUS, state.gate.epoch):
            return state, ()
        if isinstance(offer, Offers):
            kept = holding.offered(state.held, offer.certificate, now_ms, self.ground)
        else:
            kept = holding.uncertified(state.held, offer.intruder_id, offer.reason)
        return self._kept(state, kept, now_ms)

    def _kept(self, state: State, kept: holding.Kept, now_ms: int) -> Step:
        """The state with the new held certificate, and the reports of its changes."""
        held, changes = kept
        said = (self._say(hand_state(self.vehicle.id, now_ms, change)) for change in changes)
        return replace(state, held=held), tuple(said)

    def _surveyed(self, state: State, message: Surveyed) -> Step:
        """Check the held certificate against the surveillance."""
        if self.ground is None:
            return state, ()
        now_ms, others = message
        kept = holding.seen(state.held, state.air.position, others, now_ms, self.ground)
        return self._kept(state, kept, now_ms)

    def _wished(self, state: State, message: Wished) -> Step:
        """Apply the request of the vehicle's ICAROUS at the gate."""
        now_ms, wish = message
        after = replace(state, gate=gate_wished(state.gate, wish.act))
        if after.gate.owner != state.gate.owner:
            held = holding.taken_over(state.held, now_ms)
            after = replace(after, takeovers=state.takeovers + 1, held=held)
        said = self._notices(state.gate, after, now_ms, wish.reason, wish.intruder_id)
        return after, said

    def _notices(
        self, before: Gate, after: State, now_ms: int, reason: str, intruder_id: int
    ) -> tuple[FromVehicle, ...]:
        """Report the gate if it has changed, and the authority if that has."""
        vid, gate, said = self.vehicle.id, after.gate, list[FromVehicle]()
        if gate != before:
            said += [GateIs(vid, gate), self._say(gate_state(vid, now_ms, gate))]
        if gate.owner != before.owner:
            said.append(self._say(authority_change(vid, now_ms, gate, reason, intruder_id)))
        return tuple(said)

    def _choose(self, state: State, now_ms: int) -> Step:
        """Choose the velocity of the coming step, in the air or on the ground."""
        if state.landed:
            return self._rolls(state)
        if state.on_ground:
            return self._takes_off(state, now_ms)
        state, said = self._alone(state, now_ms)
        dt, air, command = self.dt_s, state.air, state.command
        if isinstance(command, Follow):
            command, progress = track_progress(command, air, dt)
            if progress.after_m > progress.length_m + OVERRUN_S * air.speed_m_s:
                command = _loiter_here(state)
        elif command is None:
            command = _loiter_here(state)
        moved = steer(air, decide(command, air, state.limits, dt), state.limits, dt)
        if self.sites:
            ground = ground_m(air.position, self.sites, self.terrain_m)
            moved = touching_down(moved, ground, dt)
        turn = math.remainder(moved.heading_rad - air.heading_rad, 2 * math.pi)
        roll_rad = math.atan(moved.speed_m_s * turn / dt / 9.80665)
        return replace(state, air=moved, command=command, roll_rad=roll_rad), said

    def _alone(self, state: State, now_ms: int) -> Step:
        """While ICAROUS has the vehicle but is silent: command the held certificate, or a loiter."""
        theirs = gate_accepts(state.gate, ICAROUS, state.gate.epoch)
        if self.ground is None or not theirs or not holding.silent(state.held, now_ms, self.ground):
            return state, ()
        held, command, changes = holding.flown_on(state.held, now_ms, state.air.speed_m_s)
        if command is None:
            command = state.command if isinstance(state.command, Circle) else _loiter_here(state)
        return self._kept(replace(state, command=command), (held, changes), now_ms)

    def sensed(self, state: State, message: Sense) -> OnBoard:
        """Input of the vehicle's ICAROUS: own state, the airframe's ability at its present speed, the other
        aircraft, the gate.
        """
        air, limits = state.air, state.limits
        rolls = state.landed or state.on_ground
        flown_m_s = limits.min_speed_m_s if rolls else air.speed_m_s
        ability = ability_at(flown_m_s, limits, self.floor_m, self.dt_s)
        motion = Motion(air.position, air.heading_rad, air.speed_m_s, air.climb_m_s)
        seen = traffic_picture(self.vehicle.id, message)
        hand = state.held.hand
        sensed = Sensed(message.now_ms, motion, ability, seen, state.gate, hand=hand)
        if isinstance(self.vehicle, GroundedVehicle):
            sensed = sensed._replace(on_ground=state.on_ground, rolling=message.rolling)
        if self.sites:
            under = (site_under(place, self.sites) for place in message.landed)
            taken = frozenset(site.name for site in under if site is not None)
            sensed = sensed._replace(landed=state.landed, taken=taken)
        return OnBoard(self.vehicle.id, sensed)

    def _air_vehicle_state(self, state: State, look: Look) -> Any:
        """The AirVehicleState message: degrees, body axes (u forward, v right, w down) [m/s]."""
        s = state.air
        lat, lon = self.projection.to_geodetic(s.position.north_m, s.position.east_m)
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
            Roll=math.degrees(state.roll_rad),
            Groundspeed=s.speed_m_s,
            Airspeed=s.speed_m_s,
            VerticalSpeed=s.climb_m_s,
            Location=lmcp.new("Location3D", Latitude=lat, Longitude=lon, Altitude=s.position.alt_m),
            EnergyAvailable=100.0,
            PayloadStateList=list(look.payloads),
            Mode=mode.get(type(state.command).__name__, "Waypoint"),
            AssociatedTasks=list(look.tasks),
            Time=look.now_ms,
        )


def commanded(state: State, sender: int, epoch: int, command: Command) -> State:
    """The state after the gate has accepted a command of UXAS or ICAROUS in an epoch."""
    return replace(state, gate=gate_after(state.gate, sender, epoch), command=command)


def _loiter_here(state: State) -> Circle:
    s = state.air
    radius = 1.2 * turn_radius_m(s.speed_m_s, state.limits.max_bank_rad)
    p = s.position
    hold = Hold(
        p.north_m - radius * math.sin(s.heading_rad),
        p.east_m + radius * math.cos(s.heading_rad),
        p.alt_m,
        radius,
        True,
    )
    return Circle(hold, s.speed_m_s)


def traffic_picture(own_id: int, sense: Sense) -> tuple[Intruder, ...]:
    """All other aircraft, as the on-board surveillance sees them, in the order of `sense`."""
    return tuple(
        Intruder(other, air.position, air.velocity, other in sense.cooperating)
        for other, air in sense.aircraft
        if other != own_id
    )
