"""One flight in virtual time: the same inputs give the same messages, byte for byte.

Each step of mission.simulation.step_ms runs, at its instant: the executive, the gates, heartbeats over the
bridge and the ICAROUS instances (every heartbeat); then the velocities of the coming step are chosen and
published (`TruthState`), and the step is flown. A TruthState thus gives an aircraft's position at its Time
and its constant velocity until the next one.

The actors are steps over plain values and take all decisions. This module provides order, time and log only:
each message in an actor's answer is delivered at once, with everything that follows from it, before the next
one; a published `GatedCommand` reaches its vehicle's gate.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from cratous.bridge import lmcp
from cratous.bridge.loopback import Bridge
from cratous.core.authority.gate import ICAROUS
from cratous.services.bus import Bus
from cratous.services.flight import executive_state, link_end, link_peers
from cratous.services.flight.arrivals import arrivals
from cratous.services.flight.commands import gated, velocity_command
from cratous.services.flight.dynamics import AirState, planned_state, traffic_state
from cratous.services.flight.executive import Executive
from cratous.services.flight.executive_state import Config
from cratous.services.flight.holding import Ground
from cratous.services.flight.link_end import UxasEnd
from cratous.services.flight.lost_link import after_failure, lost_link
from cratous.services.flight.merging import DirectTalk, merge_fix
from cratous.services.flight.messages import (
    AskPlan,
    Beat,
    Because,
    Begin,
    Choose,
    Closing,
    Commanded,
    Connected,
    Down,
    FromExecutive,
    FromLinkEnd,
    FromVehicle,
    HeardAgain,
    Held,
    LimitsAre,
    Look,
    Move,
    NotHeard,
    OnBoard,
    Over,
    Report,
    RouteAsked,
    Say,
    Sense,
    SetOut,
    Stands,
    Surveyed,
    Suspend,
    TakeBack,
    Tick,
    ToExecutive,
    ToVehicle,
    Watch,
    Wished,
)
from cratous.services.flight.notices import guidance, of_instance, truth
from cratous.services.flight.plan_reply import planned
from cratous.services.flight.result import FlightResult
from cratous.services.flight.take_off import take_off
from cratous.services.flight.vehicle import VehicleNode
from cratous.services.icarous import state as icarous
from cratous.services.icarous.instance import Instance
from cratous.services.icarous.messages import (
    Checks,
    Decides,
    Fails,
    Foresees,
    FromInstance,
    Guides,
    Hears,
    Line,
    Merges,
    Offers,
    Sensed,
    Steer,
    TakesOff,
    Tells,
    ToInstance,
    Uncertified,
    Up,
    Wish,
    WithoutLink,
)
from cratous.services.mission.frames import Projection
from cratous.services.mission.ground import floor_of
from cratous.services.mission.landing import sites_of
from cratous.services.sensing import surveillance
from cratous.services.sensing.filter import Flown
from cratous.services.sensing.surveillance import Surveillance
from cratous.spec.mission import Change, FaultySimulation, Mission
from cratous.spec.mission.plan import Plan
from cratous.spec.records import replace

Segmenter = Callable[[bytes], Iterable[bytes]]
Directed = Callable[[int], tuple[Change, ...]]
"""Returns the operator's commands that are due at a time [ms], as mission changes."""
SIMULATION = "simulation"
"""Sender of the aircraft's true states."""


def fly(
    mission: Mission,
    plan: Plan,
    bus: Bus,
    *,
    daa: bool = True,
    segmenter: Segmenter | None = None,
    progress: Callable[[int, str], None] | None = None,
    directed: Directed | None = None,
) -> FlightResult:
    """Fly a plan to its end, or to mission.simulation.limit_ms; publish everything on the bus.

    daa: with the mission's ICAROUS instances; without, no vehicle avoids others. segmenter: splits the bytes
    on the sockets, for tests. progress(now_ms, text): called at intervals. directed: source of operator
    commands.
    """
    instances = tuple(sorted(mission.instances)) if daa else ()
    with _bridge(mission, instances, segmenter) as bridge:
        return Flight(mission, plan, bus, bridge, instances).run(progress, directed)


def _bridge(mission: Mission, instances: tuple[int, ...], segmenter: Segmenter | None) -> Bridge:
    """The bridge of the flight, with the faults that the mission sets."""
    if not isinstance(mission.simulation, FaultySimulation):
        return Bridge(instances, segmenter=segmenter)
    from cratous.bridge.faults import FaultyBridge

    return FaultyBridge(instances, mission.simulation.bridge_faults, segmenter=segmenter)


Answer = FromExecutive | FromLinkEnd | FromVehicle | FromInstance


class Flight:
    """The actors of one flight, their states, and the present time."""

    def __init__(
        self, mission: Mission, plan: Plan, bus: Bus, bridge: Bridge, instances: tuple[int, ...]
    ) -> None:
        self.mission, self.bus, self.bridge, self.instances = mission, bus, bridge, instances
        projection, simulation = Projection(mission.frame), mission.simulation
        floor, ground = floor_of(mission), Ground(mission.daa, simulation.heartbeat_ms)
        dt_s, sites = simulation.step_ms / 1000, sites_of(mission)
        self.executive = Executive(Config(mission, projection, instances))
        self.executive_state = executive_state.first_state(mission, plan)
        live, alone = mission.live_planning, mission.link_loss is not None
        self.link, self.link_state = (
            UxasEnd(projection, live, alone),
            link_peers.State(),
        )
        self.vehicles = {
            v.id: VehicleNode(v, projection, dt_s, floor, ground, sites, mission.frame.terrain_m)
            for v in sorted(mission.vehicles, key=lambda v: v.id)
        }
        self.vehicle_states = {vid: node.first() for vid, node in self.vehicles.items()}
        configs = {
            vid: icarous.Config(
                vid,
                mission.daa,
                projection,
                simulation.heartbeat_ms,
                certifies=True,
                records=True,
                lost_link=lost_link(mission, vid),
                take_off=take_off(mission, vid),
                merging=merge_fix(mission, vid),
                on_failure=after_failure(mission, vid),
            )
            for vid in instances
        }
        self.icarous = {vid: Instance(config) for vid, config in configs.items()}
        self.icarous_states = {vid: icarous.State() for vid in instances}
        self.waiting: dict[int, list[ToInstance]] = {vid: [] for vid in instances}
        self.carriers = surveillance.carriers(mission, instances)
        self.seen = dict.fromkeys(self.carriers, Surveillance())
        self.direct = DirectTalk(mission, instances)
        self.gated = lmcp.types["GatedCommand"]
        self.commands, self.now_ms, self.outcome = 0, 0, ""

    # the loop -----------------------------------------------------------------------------

    def run(
        self, progress: Callable[[int, str], None] | None, directed: Directed | None = None
    ) -> FlightResult:
        """Fly until the flight has an outcome."""
        self.bus.now_ms, steps = 0, 0
        nodes = self.vehicles.items()
        self._executive(Begin(0, tuple((vid, planned_state(n.vehicle)) for vid, n in nodes)))
        self._link(Connected(0, self.instances))
        self._executive(SetOut())
        while True:
            self.bus.now_ms = self.now_ms
            if directed is not None and (now := directed(self.now_ms)):
                state = self.executive_state
                self.executive_state = replace(state, to_come=(*state.to_come, *now))
            self._step()
            self._executive(Closing(self.now_ms, self._gates(), self._circling()))
            self.bus.run()
            if progress is not None and (self.outcome or self.now_ms % 10_000 == 0):
                progress(self.now_ms, self.outcome or "flying")
            if self.outcome:
                return self._result(steps)
            self._to_all(Move())
            self.now_ms += self.mission.simulation.step_ms
            steps += 1

    def _step(self) -> None:
        now = self.now_ms
        if self.carriers:
            flown = {vid: Flown(s.position, s.velocity) for vid, s in self._everyone()}
            unseen = frozenset(vid for vid, s in self.vehicle_states.items() if s.stands)
            self.seen = surveillance.all_stepped(self.carriers, self.seen, now, flown, unseen)
        self._executive(Tick(now, self._own()))
        if now % self.mission.simulation.heartbeat_ms == 0:
            self._heartbeat()
        self._to_all(Choose(now))
        for vid, air in self._everyone():
            self.bus.publish(truth(vid, air, now, vid in self.instances), SIMULATION)

    def _heartbeat(self) -> None:
        now = self.now_ms
        self._executive(Report(now))
        if not self.instances:
            return
        self.bridge.now_ms = now
        for vid in self.bridge.opened_anew():
            self._link(Connected(now, (vid,)))
        self._link(Beat(now, self._everyone()))
        self._exchange()
        for vid, talk in self.direct.come(now):
            self._instance(vid, talk)
        for vid in self.instances:
            self._vehicle(vid, self._surveillance(vid, now))
        self._exchange()
        self._link(Watch(now))

    def _exchange(self) -> None:
        """Let the bridge deliver: messages to the UxAS end, lines to the ICAROUS instances."""
        came = arrivals(self.bridge.exchange(), self.now_ms)
        for message in came.up:
            self._link(message)
        for vid, line in came.down:
            self._instance(vid, Line(self.now_ms, line))

    def _result(self, steps: int) -> FlightResult:
        end = self.executive_state
        return FlightResult(
            self.outcome,
            self.now_ms,
            dict(end.starts),
            dict(end.ends),
            {**dict(end.left_out), **dict(end.failed)},
            sum(state.takeovers for state in self.vehicle_states.values()),
            end.replans,
            steps,
        )

    # who is where -------------------------------------------------------------------------

    def _own(self) -> tuple[tuple[int, AirState], ...]:
        return tuple((vid, state.air) for vid, state in self.vehicle_states.items())

    def _everyone(self) -> tuple[tuple[int, AirState], ...]:
        """Own aircraft and traffic, by id."""
        now = self.now_ms
        seen = [(t.id, s) for t in self.mission.traffic if (s := traffic_state(t, now)) is not None]
        return tuple(sorted({**dict(self._own()), **dict(seen)}.items()))

    def _surveillance(self, vehicle_id: int, now: int) -> Sense:
        """A vehicle's surveillance input: aircraft in the air or in a take-off run, and positions of others
        on the ground.
        """
        states = self.vehicle_states
        down = {vid: s.air.position for vid, s in states.items() if s.landed or s.on_ground}
        rolling = tuple(v for v, s in states.items() if s.on_ground and s.air.speed_m_s)
        seen = tuple(one for one in self._everyone() if one[0] not in down or one[0] in rolling)
        others = tuple(place for vid, place in down.items() if vid != vehicle_id)
        return Sense(now, seen, self.instances, others, tuple(sorted({*rolling} - {vehicle_id})))

    def _gates(self) -> tuple[tuple[int, Any], ...]:
        return tuple((vid, state.gate) for vid, state in self.vehicle_states.items())

    def _circling(self) -> tuple[int, ...]:
        """The vehicles that fly a permitted circle because UxAS is not heard."""
        return tuple(vid for vid, state in self.icarous_states.items() if state.no_link.circles)

    # messages to the actors, and what they answer ---------------------------------------------

    def _executive(self, message: ToExecutive) -> None:
        self.executive_state, out = self.executive.handle(self.executive_state, message)
        self._deliver(out)

    def _link(self, message: link_end.ToLinkEnd) -> None:
        self.link_state, out = self.link.handle(self.link_state, message)
        self._deliver(out)

    def _vehicle(self, vid: int, message: ToVehicle) -> None:
        state, out = self.vehicles[vid].handle(self.vehicle_states[vid], message)
        self.vehicle_states[vid] = state
        self._deliver(out)

    def _to_all(self, message: ToVehicle) -> None:
        for vid in self.vehicles:
            self._vehicle(vid, message)

    def _given(self, vid: int, true: Sensed) -> Sensed:
        """Input of the vehicle's ICAROUS at a heartbeat: the true states, or what its sensors measure."""
        carrier = self.carriers.get(vid)
        if carrier is None:
            return true
        air = self.vehicle_states[vid].air
        own = Flown(air.position, air.velocity)
        self.seen[vid], shown, given = surveillance.beat(carrier, self.seen[vid], true, own)
        for one in shown:
            self._publish(surveillance.sensed_state(carrier, one), f"vehicle/{vid}")
        return given

    def _instance(self, vid: int, message: ToInstance) -> None:
        if self._stands_still():
            # lines are queued; sensor data are lost
            self.waiting[vid] += [message] if isinstance(message, Line) else []
            return
        waited, self.waiting[vid] = self.waiting[vid], []
        for one in (*waited, message):
            self._handled(vid, one)

    def _stands_still(self) -> bool:
        """Whether an injected fault silences ICAROUS at present."""
        one, now_ms = self.mission.simulation, self.now_ms
        return isinstance(one, FaultySimulation) and one.bridge_faults.icarous_is_silent(now_ms)

    def _handled(self, vid: int, message: ToInstance) -> None:
        state, out = self.icarous[vid].handle(self.icarous_states[vid], message)
        self.icarous_states[vid] = state
        # an instance can only speak for its own vehicle
        self._deliver(answer._replace(vehicle_id=vid) for answer in out)

    def _deliver(self, answers: Iterable[Answer]) -> None:
        """Deliver each answer to its receiver, with all that follows from it, before the next one."""
        for answer in answers:
            match answer:
                case Say(body, source):
                    self._publish(body, source)
                case Suspend() | TakeBack() | RouteAsked() | NotHeard() | HeardAgain() | Stands():
                    self._executive(answer)
                case LimitsAre(vid) | Look(vid):
                    self._vehicle(vid, answer)
                case Wish(vid):
                    self._vehicle(vid, Wished(self.now_ms, answer))
                    self._executive(Because(*answer))
                case OnBoard(vid, sensed):
                    given = self._given(vid, sensed)
                    self._vehicle(vid, Surveyed(self.now_ms, given.intruders))
                    hand = self.vehicle_states[vid].held.hand
                    self._instance(vid, given._replace(hand=hand))
                case Offers(vid) | Uncertified(vid):
                    self._vehicle(vid, Held(self.now_ms, answer))
                case Foresees(v) | Checks(v) | TakesOff(v) | Hears(v) | Merges(v) | Decides(v):
                    self._publish(of_instance(answer), f"icarous/{v}")
                case WithoutLink(vid) | Fails(vid):
                    self._publish(of_instance(answer), f"icarous/{vid}")
                    self._executive(answer)
                case Tells():
                    self.direct.tell(answer)
                case Guides(vid):
                    projection = self.icarous[vid].config.projection
                    self._publish(guidance(answer, projection), f"icarous/{vid}")
                case Steer(vid, epoch, velocity):
                    self.commands += 1
                    command = velocity_command(vid, self.commands, velocity)
                    self._publish(gated(vid, epoch, ICAROUS, command), f"icarous/{vid}")
                case Up(vid, line):
                    self.bridge.to_uxas(vid, line)
                case Down(vid, lines):
                    for line in lines:
                        self.bridge.to_icarous(vid, line)
                case AskPlan():
                    self._executive(planned(answer))
                case Over(outcome):
                    self.outcome = outcome
                case _:
                    self._link(answer)

    def _publish(self, body: Any, source: str) -> None:
        self.bus.publish(body, source)
        if isinstance(body, self.gated):
            self._vehicle(body.VehicleID, Commanded(self.now_ms, body))
