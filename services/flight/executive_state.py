"""What the executive remembers, and what does not change about it."""

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
"""What a step has to send so far; it lives for one step."""
Times = tuple[tuple[int, int], ...]
"""Instants by task [ms]."""
V = TypeVar("V")


class Asked(NamedTuple):
    """A plan has been asked for. kind: see `spec.executive`; what: the change, in words; why it, or the
    row that cannot be kept, asks for a plan; late: the tasks that are late, the one of now first, each
    with its row; versions: of the tracks at the beginning of the step, by vehicle."""

    kind: int
    what: str
    why: str
    late: tuple[tuple[int, Row], ...] = ()
    versions: tuple[tuple[int, int], ...] = ()


@dataclass(frozen=True)
class Config:
    """mission: all of it, changes included; instances: the vehicles with an ICAROUS instance."""

    mission: Mission
    projection: Projection
    instances: tuple[int, ...]
    # the routers by zones: what they remember only saves time
    _ways: dict[tuple[Zone, ...], Ways] = field(default_factory=dict, compare=False, repr=False)

    @property
    def dt_s(self) -> float:
        """A step of the flight [s]."""
        return self.mission.simulation.step_ms / 1000

    def ways(self, zones: tuple[Zone, ...]) -> Ways:
        """Tracks around these zones."""
        if zones not in self._ways:
            self._ways.clear()
            self._ways[zones] = Ways(zones, self.dt_s)
        return self._ways[zones]


@dataclass(frozen=True)
class State:
    """known: the mission as it is known now; mission: all of it in the wind of now; zones: those that
    bind, with their padding turned into vertices; to_come: changes that nobody knows of yet; aircraft:
    of the vehicles, as told last; epochs: in which UxAS took a vehicle back (0 for others): what its commands
    name; starts, ends: real ones; failed: tasks with the reason; left_out: those that the plan in force
    leaves out, with the reason; in_part: tasks of which a part was flown, to its end;
    commands, replans, finished: counts; hurry: some deadline is near; asked: for which plan; landed: the vehicles on
    the ground, which stay there, each with when and where in words."""

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

    def find(self, vehicle_id: int) -> Chain | None:
        """The chain of a vehicle, if it has one yet."""
        return next((c for c in self.chains if c.vehicle.id == vehicle_id), None)

    def chain(self, vehicle_id: int) -> Chain:
        """The chain of a vehicle."""
        return next(c for c in self.chains if c.vehicle.id == vehicle_id)

    def air(self, vehicle_id: int) -> AirState:
        """Where a vehicle is."""
        return dict(self.aircraft)[vehicle_id]

    def from_where(self, vehicle_id: int) -> AirState:
        """From where a vehicle is planned to fly on: of one that has not taken off yet, from up there."""
        air, vehicle = self.air(vehicle_id), self.mission.vehicle(vehicle_id)
        if not isinstance(vehicle, GroundedVehicle) or self.epoch(vehicle_id):
            return air
        chain = self.find(vehicle_id)
        climbs = chain is not None and chain.suspended
        return taken_off(vehicle, air) if climbs or on_its_ground(vehicle, air) else air

    def epoch(self, vehicle_id: int) -> int:
        """The epoch that commands to a vehicle name: the one in which UxAS has it, as far as it has heard."""
        return dict(self.epochs).get(vehicle_id, 0)

    def by_vehicle(self) -> dict[int, Chain]:
        """The chains by vehicle."""
        return {chain.vehicle.id: chain for chain in self.chains}

    def put(self, chain: Chain) -> State:
        """From now on this is the chain of its vehicle."""
        vid = chain.vehicle.id
        if self.find(vid) is None:
            return replace(self, chains=(*self.chains, chain))
        chains = tuple(chain if c.vehicle.id == vid else c for c in self.chains)
        return replace(self, chains=chains)

    def begun(self, task_id: int, at_ms: int) -> State:
        """A task has begun."""
        return replace(self, starts=_with(dict(self.starts), task_id, at_ms))

    def counted_starts(self) -> dict[int, int]:
        """The starts of the tasks that have not failed: one that was begun and then failed opens nothing."""
        failed = dict(self.failed)
        return {task: at_ms for task, at_ms in self.starts if task not in failed}

    def ended(self, task_id: int, at_ms: int, whole: bool = True) -> State:
        """A task has ended; whole: not just a part of it was flown."""
        in_part = self.in_part if whole else (*self.in_part, task_id)
        return replace(self, ends=_with(dict(self.ends), task_id, at_ms), in_part=in_part)

    def has_failed(self, task_id: int, why: str) -> State:
        """A task has failed."""
        return replace(self, failed=_with(dict(self.failed), task_id, why))


def first_state(mission: Mission, plan: Plan) -> State:
    """Before the mission begins."""
    known = known_at(mission, 0)
    begun_with, to_come = split(mission.changes, 0)
    direct = (
        change for change in begun_with if change.kind in DIRECT
    )  # they say nothing of the mission
    return State(known, mission, hard_zones(known.zones), plan, (*direct, *to_come))


def _with(table: Mapping[int, V], key: int, value: V) -> tuple[tuple[int, V], ...]:
    return tuple({**table, key: value}.items())
