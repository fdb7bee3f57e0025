"""The executive's state, and its fixed configuration."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple, TypeVar

from cratous.services.flight.chain import Chain
from cratous.services.flight.dynamics import AirState, on_its_ground, taken_off
from cratous.services.flight.inflight_routes import Ways
from cratous.services.flight.messages import FromExecutive
from cratous.services.loading.polygons import hard_zones
from cratous.services.mission.frames import Projection
from cratous.services.mission.wind import CALM, Wind, known_at
from cratous.spec.constraint_rows import Row
from cratous.spec.mission import Change, GroundedVehicle, Mission, Zone
from cratous.spec.mission.changes import DIRECT, split
from cratous.spec.mission.plan import Plan
from cratous.spec.records import replace

Out = list[FromExecutive]
"""Messages to send, collected during one step."""
Times = tuple[tuple[int, int], ...]
"""Instants by task [ms]."""
V = TypeVar("V")


class Asked(NamedTuple):
    """A pending plan request. kind: see `spec.executive`; what: the change, in words; why: why it, or the row
    that cannot be met, requires a plan; late: the late tasks, each with its row, the current one first;
    versions: track version by vehicle at the beginning of the step.
    """

    kind: int
    what: str
    why: str
    late: tuple[tuple[int, Row], ...] = ()
    versions: tuple[tuple[int, int], ...] = ()


@dataclass(frozen=True)
class Config:
    """mission: the whole mission, changes included; instances: ids of vehicles with an ICAROUS instance."""

    mission: Mission
    projection: Projection
    instances: tuple[int, ...]
    # routers by zones: a cache
    _ways: dict[tuple[Zone, ...], Ways] = field(default_factory=dict, compare=False, repr=False)

    @property
    def dt_s(self) -> float:
        """Duration of a step of the flight [s]."""
        return self.mission.simulation.step_ms / 1000

    def ways(self, zones: tuple[Zone, ...]) -> Ways:
        """The router around these zones."""
        if zones not in self._ways:
            self._ways.clear()
            self._ways[zones] = Ways(zones, self.dt_s)
        return self._ways[zones]


@dataclass(frozen=True)
class State:
    """State of the executive.

    known: the mission as known now; mission: the whole mission in the present wind; zones: those in force,
    with their padding turned into vertices; to_come: changes not yet known; aircraft: last reported states by
    vehicle; epochs: epoch in which UxAS last took a vehicle back (0 for others), which its commands name;
    starts, ends: actual times; failed: failed tasks with the reason; left_out: tasks that the present plan
    leaves out, with the reason; in_part: tasks of which only a planned part was flown; commands, replans,
    finished: counts; hurry: whether some deadline is tight; asked: the pending plan request; landed: vehicles
    at rest on the ground, or given up after a declared failure, each with when and where in words; stopping: vehicles
    whose mission is stopped, the last of them at stopped_ms; declared: those that have declared a failure, with the
    time after which each has flown what follows [ms];
    circling: since when vehicles fly a permitted circle because UxAS is not heard; under_icarous: since when vehicles
    report that ICAROUS has them.
    """

    known: Mission
    mission: Mission
    zones: tuple[Zone, ...]
    plan: Plan
    to_come: tuple[Change, ...] = ()
    wind: Wind = CALM
    now_ms: int = 0
    aircraft: tuple[tuple[int, AirState], ...] = ()
    epochs: tuple[tuple[int, int], ...] = ()
    chains: tuple[Chain, ...] = ()
    starts: Times = ()
    ends: Times = ()
    failed: tuple[tuple[int, str], ...] = ()
    left_out: tuple[tuple[int, str], ...] = ()
    in_part: tuple[int, ...] = ()
    commands: int = 0
    replans: int = 0
    finished: int = 0
    hurry: bool = False
    asked: Asked | None = None
    landed: tuple[tuple[int, str], ...] = ()
    stopping: tuple[int, ...] = ()
    stopped_ms: int = 0
    declared: tuple[tuple[int, int], ...] = ()
    circling: Times = ()
    under_icarous: Times = ()

    def find(self, vehicle_id: int) -> Chain | None:
        """The chain of a vehicle; None if it has none yet."""
        return next((c for c in self.chains if c.vehicle.id == vehicle_id), None)

    def chain(self, vehicle_id: int) -> Chain:
        """The chain of a vehicle."""
        return next(c for c in self.chains if c.vehicle.id == vehicle_id)

    def air(self, vehicle_id: int) -> AirState:
        """State of a vehicle's motion."""
        return dict(self.aircraft)[vehicle_id]

    def from_where(self, vehicle_id: int) -> AirState:
        """The state from which a vehicle is planned to fly on; before take-off, its expected state after it."""
        air, vehicle = self.air(vehicle_id), self.mission.vehicle(vehicle_id)
        if not isinstance(vehicle, GroundedVehicle) or self.epoch(vehicle_id):
            return air
        chain = self.find(vehicle_id)
        climbs = chain is not None and chain.suspended
        return taken_off(vehicle, air) if climbs or on_its_ground(vehicle, air) else air

    def epoch(self, vehicle_id: int) -> int:
        """The epoch that commands to a vehicle name: that in which UxAS last took it back, 0 if never."""
        return dict(self.epochs).get(vehicle_id, 0)

    def by_vehicle(self) -> dict[int, Chain]:
        """The chains by vehicle id."""
        return {chain.vehicle.id: chain for chain in self.chains}

    def put(self, chain: Chain) -> State:
        """The state with this chain in place of its vehicle's previous one."""
        vid = chain.vehicle.id
        if self.find(vid) is None:
            return replace(self, chains=(*self.chains, chain))
        chains = tuple(chain if c.vehicle.id == vid else c for c in self.chains)
        return replace(self, chains=chains)

    def begun(self, task_id: int, at_ms: int) -> State:
        """The state after a task has begun."""
        return replace(self, starts=_with(dict(self.starts), task_id, at_ms))

    def counted_starts(self) -> dict[int, int]:
        """Starts of the tasks that have not failed: a failed task enables no other."""
        failed = dict(self.failed)
        return {task: at_ms for task, at_ms in self.starts if task not in failed}

    def ended(self, task_id: int, at_ms: int, whole: bool = True) -> State:
        """The state after a task has ended. whole: it was flown completely, not just in part."""
        in_part = self.in_part if whole else (*self.in_part, task_id)
        return replace(self, ends=_with(dict(self.ends), task_id, at_ms), in_part=in_part)

    def has_failed(self, task_id: int, why: str) -> State:
        """The state after a task has failed."""
        return replace(self, failed=_with(dict(self.failed), task_id, why))


def first_state(mission: Mission, plan: Plan) -> State:
    """The executive's state before the mission begins."""
    known = known_at(mission, 0)
    begun_with, to_come = split(mission.changes, 0)
    direct = (
        change for change in begun_with if change.kind in DIRECT
    )  # operator commands do not describe the mission
    return State(known, mission, hard_zones(known.zones), plan, (*direct, *to_come))


def _with(table: Mapping[int, V], key: int, value: V) -> tuple[tuple[int, V], ...]:
    return tuple({**table, key: value}.items())
