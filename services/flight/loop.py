"""One flight in virtual time: the same inputs give the same messages, byte for byte.

Each step of mission.simulation.step_ms, at its instant: heartbeats over the bridge and the
ICAROUS instances (every heartbeat), the gates, the executive; then the velocities of the coming
step are chosen and published (`TruthState`), and the step is flown. So a TruthState says where an
aircraft is at its Time and with which constant velocity it flies until the next one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from cratous.bridge import lmcp
from cratous.bridge.loopback import Bridge
from cratous.core.authority.gate import ICAROUS, UXAS, Gate
from cratous.core.executive.steps import flight_outcome
from cratous.services.bus import Bus
from cratous.services.flight import link_end
from cratous.services.flight.arrivals import arrivals
from cratous.services.flight.commands import gated, velocity_command
from cratous.services.flight.dynamics import AirState, limits_of, traffic_state
from cratous.services.flight.executive import Executive
from cratous.services.flight.link_end import UxasEnd
from cratous.services.flight.messages import (
    Beat,
    Connected,
    Down,
    Left,
    Say,
    Suspend,
    TakeBack,
    ToLinkEnd,
    Watch,
    ZonesKnown,
)
from cratous.services.flight.notices import authority_change, conflict, gate_state, plan_accepted
from cratous.services.flight.result import FlightResult
from cratous.services.flight.sensing import looks
from cratous.services.flight.touched import handed_over, left_by, nobody_may, touched_by
from cratous.services.flight.vehicle import VehicleNode, traffic_picture, truth
from cratous.services.icarous.instance import Instance
from cratous.services.icarous.messages import Foresees, Line, Sensed, Steer, ToInstance, Up, Wish
from cratous.services.icarous.state import Config
from cratous.services.icarous.state import State as InstanceState
from cratous.services.mission.frames import Projection
from cratous.services.mission.taking_part import absent
from cratous.services.mission.wind import CALM, all_in_wind, in_wind, known_at, told, wind_at
from cratous.services.planning.zones import hard_zones
from cratous.spec.errors import NoPlan
from cratous.spec.executive import COMPLETE, FAILED_FLIGHT, GOES_ON, LIMIT
from cratous.spec.mission import Change, Mission
from cratous.spec.mission.asked import asked
from cratous.spec.mission.changes import TASK_ADDED, VEHICLE_JOINS, WIND, split, words
from cratous.spec.mission.plan import Plan

Segmenter = Callable[[bytes], Iterable[bytes]]
GROUND_MARGIN = 2.0
"""No manoeuvre goes nearer to the ground than this many vertical thresholds."""


def fly(
    mission: Mission,
    plan: Plan,
    bus: Bus,
    *,
    daa: bool = True,
    segmenter: Segmenter | None = None,
    progress: Callable[[int, str], None] | None = None,
) -> FlightResult:
    """Fly a plan to its end, or to mission.simulation.limit_ms; publish everything on the bus.

    daa: with the ICAROUS instances that the mission has; without, nobody avoids anybody.
    segmenter: cuts the bytes on the sockets, for tests. progress(now_ms, text): called now and
    then.
    """
    instances = tuple(sorted(mission.instances)) if daa else ()
    with Bridge(instances, segmenter=segmenter) as bridge:
        return _Flight(mission, plan, bus, bridge, instances).run(progress)


OUTCOMES = {GOES_ON: "", COMPLETE: "complete", FAILED_FLIGHT: "failed", LIMIT: "limit"}
BRINGS_WORK = (TASK_ADDED, VEHICLE_JOINS)
"""The end of the mission waits for changes of these kinds; and for the wind, if a task is left out."""


class _Flight:
    """The state of one flight."""

    def __init__(
        self, mission: Mission, plan: Plan, bus: Bus, bridge: Bridge, instances: tuple[int, ...]
    ) -> None:
        self.mission, self.bus, self.bridge = mission, bus, bridge
        self.plan, self.instances = plan, instances
        self.projection = Projection(mission.frame)
        self.known = known_at(mission, 0)
        self.zones = hard_zones(self.known.zones)
        self.step_ms = mission.simulation.step_ms
        dt_s = self.step_ms / 1000
        well_clear = mission.daa.well_clear
        floor = mission.frame.terrain_m + GROUND_MARGIN * well_clear.zthr_m
        self.nodes = {
            v.id: VehicleNode(v, self.projection, dt_s, floor)
            for v in sorted(mission.vehicles, key=lambda v: v.id)
        }
        self.traffic: dict[int, AirState] = {}
        self.executive = Executive(
            mission, self.zones, plan, self.projection, dt_s, replan=self._replan
        )
        self.link, self.link_state = UxasEnd(self.projection), link_end.State()
        beat_ms = mission.simulation.heartbeat_ms
        self.icarous = {
            vid: Instance(Config(vid, mission.daa, self.projection, beat_ms)) for vid in instances
        }
        self.icarous_states = {vid: InstanceState() for vid in instances}
        self.takeovers = 0
        self.commands = 0
        self.now_ms = 0
        self.wind = CALM
        self.blown = self._blow(0)
        self.no_plan = ""
        self._accepted: tuple[Plan, frozenset[int]] | None = None
        self.begun_with, self.to_come = split(mission.changes, 0)

    # publishing ---------------------------------------------------------------------------

    def _say(self, bodies: Iterable[Any], source: str) -> None:
        """Publish; a GatedCommand also reaches its vehicle's gate, in the order of publishing."""
        for body in bodies:
            self.bus.publish(body, source)
            if isinstance(body, self._gated):
                node = self.nodes[body.VehicleID]
                before = node.gate
                dropped = node.receive(body, self.now_ms)
                self._say(dropped, f"vehicle/{body.VehicleID}")
                self._gate(body.VehicleID, before)
                if node.gate.owner != before.owner:
                    self._authority(body.VehicleID, "the way back is free: handed back", 0)

    def _gate(self, vid: int, before: Gate) -> None:
        """Say how the gate stands, if it has changed."""
        gate = self.nodes[vid].gate
        if gate != before:
            self._say([gate_state(vid, self.now_ms, gate)], f"vehicle/{vid}")

    def _authority(self, vid: int, reason: str, intruder_id: int) -> None:
        """Say who commands a vehicle from now on, and since which epoch."""
        gate = self.nodes[vid].gate
        said = authority_change(vid, self.now_ms, gate, reason, intruder_id)
        self._say([said], f"vehicle/{vid}")

    # the loop -----------------------------------------------------------------------------

    def run(self, progress: Callable[[int, str], None] | None) -> FlightResult:
        """Fly to the end."""
        simulation = self.mission.simulation
        self._gated = lmcp.types["GatedCommand"]
        self.bus.now_ms = 0
        if self.begun_with:
            what = "; ".join(words(change) for change in self.begun_with)
            self._tell_change(what, "; ".join(filter(None, ("planned with it", self.blown))))
        self._accept(self.plan, frozenset())
        states = self._own_states()
        self._say(self.executive.begin(states), "uxas/executive")
        self._link(ZonesKnown(self.zones))
        self._link(Connected(0, self.instances))
        for vid in self.instances:
            self._link(self.executive.route(vid))
        first = (self.executive.command(vid, self.nodes[vid].gate.epoch) for vid in self.nodes)
        self._say(first, "uxas/executive")
        steps = 0
        while True:
            self.bus.now_ms = self.now_ms
            self._step()
            outcome = self._outcome(simulation.limit_ms)
            if outcome:
                end = lmcp.new("MissionEnd", Time=self.now_ms, Outcome=outcome)
                self._say([end], "uxas/executive")
            self.bus.run()
            if progress is not None and (outcome or self.now_ms % 10_000 == 0):
                progress(self.now_ms, outcome or "flying")
            if outcome:
                break
            for node in self.nodes.values():
                node.advance()
            self.now_ms += self.step_ms
            steps += 1
        executive = self.executive
        return FlightResult(
            outcome,
            self.now_ms,
            dict(executive.starts),
            dict(executive.ends),
            {**executive.left_out, **executive.failed},
            self.takeovers,
            executive.replans,
            steps,
        )

    def _accept(self, plan: Plan, done: frozenset[int]) -> None:
        """Say by which plan is flown from now on; `done` are the tasks already flown."""
        self._say([plan_accepted(self.now_ms, plan, done)], "uxas")

    def _accept_anew(self) -> None:
        """The same of a plan that was made since the last time."""
        if self._accepted is not None:
            self._accept(*self._accepted)
            self._accepted = None

    def _outcome(self, limit_ms: int) -> str:
        flying = self.executive.flying()
        away = sum(node.gate.owner != UXAS for node in self.nodes.values())
        kinds = (*BRINGS_WORK, *((WIND,) if self.executive.left_out else ()))
        expected = sum(c.kind in kinds for c in self.to_come)
        left = len(self._left()) if not flying else 0  # while some fly, what is left is no matter
        return OUTCOMES[flight_outcome(flying, away, expected, left, self.now_ms, limit_ms)]

    def _left(self) -> list[int]:
        """The tasks that are asked for and not done."""
        ends = self.executive.ends.keys()
        accepted = ends | {item.task_id for item in self.executive.plan.items}
        return [task for task in asked(self.known, ends, accepted) if task not in ends]

    def _tell_change(self, what: str, answer: str) -> None:
        change = lmcp.new("MissionChange", Time=self.now_ms, What=what, Consequence=answer)
        self._say([change], "uxas")

    def _own_states(self) -> dict[int, AirState]:
        return {vid: node.state for vid, node in self.nodes.items()}

    def _epochs(self) -> dict[int, int]:
        return {vid: node.gate.epoch for vid, node in self.nodes.items()}

    def _everyone(self) -> dict[int, AirState]:
        return {**self._own_states(), **self.traffic}

    def _step(self) -> None:
        now = self.now_ms
        self.traffic = {
            t.id: s for t in self.mission.traffic if (s := traffic_state(t, now)) is not None
        }
        due, self.to_come = split(self.to_come, now)
        if due:
            self._change(due)
        commands = self.executive.step(self._own_states(), self._epochs(), now)
        self._accept_anew()
        self._say(commands, "uxas/executive")
        if now % self.mission.simulation.heartbeat_ms == 0:
            self._heartbeat()
        for node in self.nodes.values():
            node.steer()
        cooperating = frozenset(self.instances)
        for vid, state in sorted(self._everyone().items()):
            self.bus.publish(truth(vid, state, now, vid in cooperating), "simulation")

    def _heartbeat(self) -> None:
        now = self.now_ms
        for vid, node in self.nodes.items():
            chain = self.executive.chains[vid]
            sees = looks(node.vehicle, chain, node.state, self.mission, self.projection)
            state = node.air_vehicle_state(now, sees.payloads, sees.tasks)
            self._say([state], f"vehicle/{vid}")
        if not self.instances:
            return
        for vid in self.instances:
            for report in self.executive.report(vid):
                self._link(report)
        self._link(Beat(now, tuple(sorted(self._everyone().items()))))
        self._exchange()
        for vid in self.instances:
            self._think(vid)
        self._exchange()
        self._link(Watch(now))

    def _exchange(self) -> None:
        """Let the bridge deliver: what came up to UxAS's end, what came down to its ICAROUS."""
        came = arrivals(self.bridge.exchange(), self.now_ms)
        for message in came.up:
            self._link(message)
        for vid, line in came.down:
            self._instance(vid, Line(self.now_ms, line))

    def _link(self, message: ToLinkEnd) -> None:
        """A message to the UxAS end of the bridge, and what follows from it."""
        self.link_state, out = self.link.handle(self.link_state, message)
        for answer in out:
            match answer:
                case Say(body, source):
                    self._say([body], source)
                case Down(vid, lines):
                    for line in lines:
                        self.bridge.to_icarous(vid, line)
                case Suspend(vid, now_ms, act):
                    said, left = self.executive.suspend(vid, now_ms, act)
                    if left is not None:
                        self._link(Left(vid, left))
                    self._say(said, "uxas/ics")
                case TakeBack(vid, now_ms, act, epoch):
                    self.executive.resume(vid, self.nodes[vid].state, now_ms, act)
                    self._link(self.executive.route(vid))
                    self._say([self.executive.command(vid, epoch)], "uxas/ics")

    def _think(self, vid: int) -> None:
        """One heartbeat of a vehicle's ICAROUS, with what is sensed on board."""
        node = self.nodes[vid]
        seen = traffic_picture(vid, self._everyone(), frozenset(self.instances))
        self._instance(vid, Sensed(self.now_ms, node.motion, node.ability, seen, node.gate))

    def _instance(self, vid: int, message: ToInstance) -> None:
        """A message to a vehicle's ICAROUS, and what follows from it, on board and over the bridge."""
        state, out = self.icarous[vid].handle(self.icarous_states[vid], message)
        self.icarous_states[vid] = state
        for answer in out:
            match answer:
                case Wish():
                    self._wish(answer)
                case Foresees():
                    self._say([conflict(answer)], f"icarous/{vid}")
                case Steer(_, epoch, velocity):
                    self.commands += 1
                    command = velocity_command(vid, self.commands, velocity)
                    self._say([gated(vid, epoch, ICAROUS, command)], f"icarous/{vid}")
                case Up(_, line):
                    self.bridge.to_uxas(vid, line)

    def _wish(self, wish: Wish) -> None:
        """What ICAROUS wants of its gate reaches it here, on board."""
        vid = wish.vehicle_id
        node, before = self.nodes[vid], self.nodes[vid].gate
        node.wish(wish.act)
        self._gate(vid, before)
        if node.gate.owner != before.owner:
            self.takeovers += 1
            self._authority(vid, wish.reason, wish.intruder_id)

    def _change(self, due: list[Change]) -> None:
        """What has become known since the last step: told, watched for, and planned for at once."""
        now, states = self.now_ms, self._own_states()
        self.known = known_at(self.mission, now, self.executive.ends)
        blown = self._blow(now)
        zones = hard_zones(tuple(c.zone for c in due if c.zone is not None))
        self.zones = (*self.zones, *zones)
        what = "; ".join(words(change) for change in due)
        self.executive.know(self.zones)
        self._link(ZonesKnown(self.zones))
        touched = touched_by(due, zones, self.executive.chains, self.executive.ends, states)
        why = "; ".join(text for text in (blown, touched) if text)
        before, out = left_by(self.executive.chains), list[Any]()
        if not why:
            answer = "the plan holds as it is"
        elif self.executive.plan_anew(states, now, what, out):
            moved = handed_over(before, self.executive.plan)
            answer = f"planned anew: {'; '.join(filter(None, (why, moved)))}"
            out += self.executive.commands_now(self._epochs())
        else:
            left = self._left()
            none = nobody_may(self.known, left, absent(self.mission, now))
            why = "; ".join(filter(None, (why, none)))
            answer = f"no plan for what is left ({self.no_plan}): {why}"
            self.executive.give_up(now, f"{what}: {self.no_plan}", states, left, out)
            out += self.executive.commands_now(self._epochs())
        # the change is known before anything is done about it
        self._tell_change(what, answer)
        self._accept_anew()
        self._say(out, "uxas/executive")

    def _blow(self, now_ms: int) -> str:
        """Let the wind of this instant bind all vehicles; what it changes, empty if nothing."""
        before, self.wind = self.wind, wind_at(self.mission, now_ms)
        if self.wind == before:
            return ""
        self.executive.mission = all_in_wind(self.mission, self.wind)
        for vehicle in self.mission.vehicles:
            self.nodes[vehicle.id].limits = limits_of(in_wind(vehicle, self.wind) or vehicle)
        return told(self.mission, before, self.wind)

    def _replan(
        self, states: dict[int, AirState], done: frozenset[int], now_ms: int
    ) -> Plan | None:
        from cratous.services.pipeline.plan import make_plan

        flying = self.executive
        flown = [(task, flying.starts[task], flying.ends[task]) for task in sorted(done)]
        here = {v.id for v in self.known.vehicles}
        try:
            plan = make_plan(
                self.known,
                starts={vid: state.pose for vid, state in states.items() if vid in here},
                done=flown,
                now_ms=now_ms,
                absent=absent(self.mission, now_ms),
                undone=flying.failed,
                begun=flying.starts.keys() - done,
            )
        except NoPlan as error:
            self.no_plan = str(error)
            return None
        self._accepted = (plan, done)
        return plan
