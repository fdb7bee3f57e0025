"""An encounter: a short flight by avoidance and motion alone, without plan, bridge, bus and log.

Each own vehicle flies through its points in order. Those with an ICAROUS instance are monitored and steered
by the same steps as in a whole flight (`Instance.handle`, `VehicleNode.handle`, the kernels of gate and link
end), on what their sensors see where the mission has sensors. What the bridge would carry (zones, route,
progress) arrives at once. When control is offered, UxAS takes it at once and routes back as a whole flight
does in transit.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Mapping
from typing import NamedTuple

from cratous.bridge.text_protocol import SetMode, SetVelocity
from cratous.core.authority.gate import ICAROUS, UXAS, gate_accepts
from cratous.core.authority.link_end import (
    LinkEnd,
    link_mode,
    suspended_after,
    track_is_told,
)
from cratous.core.routing.polylines import Track
from cratous.services.flight import vehicle as vehicles
from cratous.services.flight.autopilot import Fly, Follow
from cratous.services.flight.chain import Chain, Phase
from cratous.services.flight.dynamics import AirState, traffic_state
from cratous.services.flight.executive_outputs import AHEAD_S
from cratous.services.flight.inflight_routes import Ways
from cratous.services.flight.link_lines import Flies
from cratous.services.flight.messages import Choose, Move, Sense, Wished
from cratous.services.flight.remaining_path import points_ahead, points_left
from cratous.services.flight.vehicle import VehicleNode
from cratous.services.icarous import state as icarous
from cratous.services.icarous.inbox import Told
from cratous.services.icarous.instance import Instance
from cratous.services.icarous.messages import Steer, Up, Wish
from cratous.services.mission.frames import Projection
from cratous.services.mission.ground import floor_of
from cratous.services.mission.landing import on_failure_of
from cratous.services.mission.merging import merging_of
from cratous.services.mission.moving_zones import moving_zones
from cratous.services.mission.take_off import grounded
from cratous.services.planning.performance_classes import MOMENT_MS, straight
from cratous.services.sensing import surveillance
from cratous.services.sensing.filter import Flown
from cratous.services.sensing.surveillance import Carrier, Surveillance
from cratous.spec.authority.link_end import TAKE_BACK
from cratous.spec.errors import BadInput
from cratous.spec.mission import FaultySimulation, Mission, Position, TaskKind, Vehicle, Velocity
from cratous.spec.mission.plan import PlanItem, Pose
from cratous.spec.records import replace

COMPLETE, LIMIT = "complete", "limit"
"""Outcomes: an own vehicle has passed the end of its route, or the time limit was reached."""

Aircraft = tuple[tuple[int, AirState], ...]


class Instant(NamedTuple):
    """The states of all aircraft at an instant, with the velocity that each flies until the next one."""

    now_ms: int
    aircraft: Aircraft


class Encounter(NamedTuple):
    """A flown encounter. takeovers: how often ICAROUS took a vehicle; reached: number of route points that
    UxAS counts as passed, by vehicle, without the starting point.
    """

    instants: tuple[Instant, ...]
    outcome: str
    takeovers: int
    reached: dict[int, int]


def fly_encounter(mission: Mission, *, daa: bool = True) -> Encounter:
    """Fly a mission of must_fly points for simulation.limit_ms, or until an own vehicle has flown its route.

    Raises BadInput for what an encounter does not fly: see `ways_of`.
    """
    ways = ways_of(mission)
    routes = Ways(mission.zones, mission.simulation.step_ms / 1000)
    with_daa = set(mission.instances) if daa else set()
    ours = [_Ours(v, ways[v.id], mission, routes, v.id in with_daa) for v in mission.vehicles]
    ours.sort(key=lambda one: one.id)
    carriers = surveillance.carriers(mission, with_daa)
    for one in ours:
        one.carrier = carriers.get(one.id)
    cooperating = tuple(one.id for one in ours if one.instance is not None)
    instants = list[Instant]()
    step_ms, limit_ms = mission.simulation.step_ms, mission.simulation.limit_ms
    for now_ms in range(0, limit_ms + step_ms, step_ms):
        over = [one.settle(now_ms) for one in ours]
        outcome = COMPLETE if any(over) else LIMIT
        if carriers:
            flown = {
                number: Flown(air.position, air.velocity)
                for number, air in _everyone(mission, ours, now_ms)
            }
            for one in ours:
                one.look(now_ms, flown)
        if now_ms % mission.simulation.heartbeat_ms == 0:
            seen = _everyone(mission, ours, now_ms)
            told = tuple((one.id, one.flies) for one in ours if one.instance and one.flies)
            lines = [(one, one.beat(Sense(now_ms, seen, cooperating), told)) for one in ours]
            for one, modes in lines:
                one.hear(modes, now_ms)
        for one in ours:
            one.state, _ = one.node.handle(one.state, Choose(now_ms))
        instants.append(Instant(now_ms, _everyone(mission, ours, now_ms)))
        if outcome == COMPLETE:
            break
        for one in ours:
            one.state, _ = one.node.handle(one.state, Move())
    takeovers = sum(one.state.takeovers for one in ours)
    return Encounter(tuple(instants), outcome, takeovers, {one.id: one.reached for one in ours})


def ways_of(mission: Mission) -> dict[int, tuple[Position, ...]]:
    """The route of each vehicle: its start position and its must_fly points, in the order of the file.

    BadInput for relations, moving zones, changes in flight, bridge faults, `link_loss`, `on_failure`, `merging`, starts on the ground, other
    kinds of task, tasks without exactly one eligible vehicle, vehicles without a task, and missions without a
    protected vehicle, in which there is nothing to judge.
    """
    for item, there in (
        ("relations", mission.relations),
        ("zones.velocity_m_s", moving_zones(mission)),
        ("changes", mission.changes),
        ("simulation.bridge_faults", isinstance(mission.simulation, FaultySimulation)),
        ("link_loss", mission.link_loss is not None),
        ("on_failure", on_failure_of(mission) is not None),
        ("merging", merging_of(mission) is not None),
        ("vehicles.start", bool(grounded(mission))),
    ):
        if there:
            raise _not_flown(mission, item, "none", "some")
    if not any(v.protected for v in mission.vehicles):
        raise _not_flown(mission, "vehicles", "a protected one", "none")
    ways: dict[int, list[Position]] = {v.id: [v.position] for v in mission.vehicles}
    for task in mission.tasks:
        item = f"task {task.id}"
        if task.kind is not TaskKind.MUST_FLY:
            raise _not_flown(mission, item, "a must_fly task", str(task.kind))
        if len(task.eligible) != 1:
            raise _not_flown(mission, item, "one eligible vehicle", f"{len(task.eligible)}")
        ways[task.eligible[0]] += task.points
    for number, way in ways.items():
        if way[1:] == []:
            raise _not_flown(mission, f"vehicle {number}", "a must_fly task of its own", "none")
    return {number: tuple(way) for number, way in ways.items()}


def _not_flown(mission: Mission, item: str, expected: str, got: str) -> BadInput:
    return BadInput(
        "an encounter is flown by protected vehicles, along points alone",
        where=mission.source, item=item, expected=expected, got=got,
    )  # fmt: skip


def _everyone(mission: Mission, ours: list[_Ours], now_ms: int) -> Aircraft:
    seen = {t.id: s for t in mission.traffic if (s := traffic_state(t, now_ms)) is not None}
    return tuple(sorted({**seen, **{one.id: one.state.air for one in ours}}.items()))


class _Ours:
    """One own vehicle: airframe and gate, its ICAROUS instance, and its UxAS side."""

    def __init__(
        self, vehicle: Vehicle, way: tuple[Position, ...], mission: Mission, routes: Ways, daa: bool
    ) -> None:
        projection, simulation = Projection(mission.frame), mission.simulation
        self.id, self._routes = vehicle.id, routes
        self.node = VehicleNode(vehicle, projection, simulation.step_ms / 1000, floor_of(mission))
        self.state, self.instance = self.node.first(), None
        speed, self._lookahead_s = vehicle.speed_m_s, mission.daa.lookahead_s
        here = Track(way[:1], vehicle.heading_rad)
        self._chain = Chain(vehicle, _items(vehicle, way), 0, Phase.TRANSIT, here, speed)
        self._go_on(0)
        self._link, self._told = LinkEnd(False, 0, True), self._chain.track
        self._told_from_m, self._steered = 0.0, Velocity(0.0, 0.0, 0.0)
        if daa:
            config = icarous.Config(vehicle.id, mission.daa, projection, simulation.heartbeat_ms)
            self.instance = Instance(config)
        self._icarous = icarous.State(told=Told(mission.zones, started=True))
        self.carrier: Carrier | None = None
        self._seen = Surveillance()
        self._tell_way()

    def look(self, now_ms: int, flown: Mapping[int, Flown]) -> None:
        """Record what its sensors, if it has any, measure at a step."""
        if self.carrier is not None:
            self._seen = surveillance.stepped(self.carrier, self._seen, now_ms, flown)

    @property
    def reached(self) -> int:
        """Number of route points passed."""
        return self._chain.k

    def settle(self, now_ms: int) -> bool:
        """Advance to the next point if the present one is passed. Returns whether the last point is passed."""
        while not self._chain.suspended and (item := self._chain.item) is not None:
            self._chain, at_ms = self._chain.measure(self.state.air, now_ms, self.node.dt_s)
            if at_ms is None:
                break
            if self._chain.phase is Phase.TRANSIT:
                self._chain = self._chain.enter(Phase.TASK, Track(item.path), at_ms)
                self._command(self.state.gate.epoch)
                continue
            self._chain = replace(self._chain, k=self._chain.k + 1)
            if self._chain.item is not None:
                self._go_on(at_ms)
        return self._chain.item is None

    def _go_on(self, at_ms: int) -> None:
        """Route to the next point around the zones; straight where no route keeps them, which the judges see."""
        track = self._routes.new_transit(self._chain, self.state.air)
        straight = Track((self.state.air.position, *self._chain.items[self._chain.k].path))
        self._chain = self._chain.enter(Phase.TRANSIT, track or straight, at_ms)
        self._command(self.state.gate.epoch)

    @property
    def flies(self) -> Flies:
        """The route on which UxAS flies it, as told, or the velocity to which ICAROUS steers it."""
        return self._steered if self._chain.suspended else self._told.points

    def beat(self, sense: Sense, fly: tuple[tuple[int, Flies], ...]) -> list[SetMode]:
        """One heartbeat of its instance: apply its authority requests and commands. Returns the modes that it
        reports to UxAS. fly: how each vehicle with an instance flies.
        """
        if self.instance is None:
            return []
        ways, steered = list[tuple[int, tuple[Position, ...]]](), list[tuple[int, Velocity]]()
        for vid, flies in fly:
            if vid == self.id:
                continue
            if isinstance(flies, Velocity):
                steered.append((vid, flies))
            else:
                ways.append((vid, flies))
        told = replace(
            self._icarous.told,
            heard_ms=sense.now_ms,
            others=tuple(ways),
            steered=tuple(steered),
        )
        self._icarous = replace(self._icarous, told=told)
        if track_is_told(
            self._chain.suspended, self._chain.route_version != self._chain.told_version
        ):
            self._tell_way()
        if not self._chain.suspended:
            passed = bisect_right(self._told.s_m, self._chain.s_m - self._told_from_m + 1e-6)
            told = replace(self._icarous.told, next_index=passed)
            self._icarous = replace(self._icarous, told=told)
        on_board = self.node.sensed(self.state, sense)
        given = on_board.sensed
        if self.carrier is not None:
            air = Flown(self.state.air.position, self.state.air.velocity)
            self._seen, _, given = surveillance.beat(self.carrier, self._seen, given, air)
        self._icarous, answers = self.instance.handle(self._icarous, given)
        modes = []
        for answer in answers:
            match answer:
                case Wish():
                    self.state, _ = self.node.handle(self.state, Wished(sense.now_ms, answer))
                case Steer(_, epoch, velocity):
                    if gate_accepts(self.state.gate, ICAROUS, epoch):
                        self.state = vehicles.commanded(self.state, ICAROUS, epoch, Fly(velocity))
                case Up(_, SetVelocity(north, east, down)):
                    self._steered = Velocity(north, east, down)
                case Up(_, SetMode() as mode):
                    modes.append(mode)
        return modes

    def hear(self, modes: list[SetMode], now_ms: int) -> None:
        """The UxAS end's reaction to modes: it suspends the vehicle's route, or takes the vehicle back."""
        for mode in modes:
            epoch = self.state.gate.epoch if mode.epoch is None else mode.epoch
            end, act = link_mode(self._link, self.state.gate, mode.mode == "ACTIVE", epoch)
            if act == TAKE_BACK and not self._take_back(epoch, now_ms):
                continue  # offered again at the next heartbeat; ICAROUS flies on until then
            self._link = end
            suspended = suspended_after(self._chain.suspended, act)
            if suspended and not self._chain.suspended:
                self._tell_resume()
            self._chain = replace(self._chain, suspended=suspended)

    def _tell_resume(self) -> None:
        """After a takeover: tell ICAROUS the last point at which the vehicle may rejoin its route."""
        told = replace(self._icarous.told, resume=self._chain.track.points[-1])
        self._icarous = replace(self._icarous, told=told)

    def _take_back(self, epoch: int, now_ms: int) -> bool:
        """Command the way back and the remaining path; False if no way back keeps the zones."""
        back = self._routes.back(self._chain, self.state.air)
        if back is None:
            return False
        self._chain = self._chain.enter(self._chain.phase, back.track, now_ms)
        self._tell_way()
        self._command(epoch)
        return True

    def _tell_way(self) -> None:
        """Tell ICAROUS the route ahead, up to its look-ahead, as the bridge would."""
        chain, vehicle = self._chain, self._chain.vehicle
        ahead_m = vehicle.max_speed_m_s * (self._lookahead_s + AHEAD_S)
        self._told, self._told_from_m = Track(points_ahead(chain, 0, ahead_m)), chain.s_m
        told = replace(
            self._icarous.told,
            waypoints=self._told.points, speed_m_s=chain.speed_m_s, next_index=0, resume=None,
        )  # fmt: skip
        self._icarous = replace(self._icarous, told=told, goal=0)
        self._chain = replace(chain, told_version=chain.route_version)

    def _command(self, epoch: int) -> None:
        """Command the present track on behalf of UxAS."""
        follow = Follow(Track(points_left(self._chain)), self._chain.speed_m_s)
        if gate_accepts(self.state.gate, UXAS, epoch):
            self.state = vehicles.commanded(self.state, UXAS, epoch, follow)


def _items(vehicle: Vehicle, way: tuple[Position, ...]) -> tuple[PlanItem, ...]:
    """Each point of a route as a task: straight through it, in the direction from the previous point to the
    next.
    """
    headings = [
        math.atan2(beyond.east_m - here.east_m, beyond.north_m - here.north_m)
        for here, beyond in zip(way, (*way[2:], way[-1]), strict=False)
    ]
    paths = [
        straight("", Pose(*there, heading), MOMENT_MS, vehicle.speed_m_s).points
        for there, heading in zip(way[1:], headings, strict=False)
    ]
    return tuple(
        PlanItem(0, 0, vehicle.id, (), path, None, vehicle.speed_m_s, 0, 0, 0, 0, 0, heading)
        for path, heading in zip(paths, headings, strict=True)
    )
