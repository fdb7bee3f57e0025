"""An unmodified UxAS folder or configuration as a `Mission`.

A mission consists of an automation request and of each entity's configuration and state, the tasks and the zones at
the time it is sent: only what the request names takes part, and only the zones of its operating region apply. What
has no counterpart here is refused or noted, never dropped.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from cratous.services.loading import uxas_parts as parts
from cratous.services.loading.assignment_attributes import Settings, plans_live, settings_of
from cratous.services.loading.conditions import kept
from cratous.services.loading.coordinates import Places
from cratous.services.loading.document import item_key
from cratous.services.loading.duplicates import counted_once
from cratous.services.loading.ground import CONFIGURATION, STATE, vehicle_of
from cratous.services.loading.polygons import one_region
from cratous.services.loading.request_kinds import WRAPPED, is_request
from cratous.services.loading.start_distances import close_starts
from cratous.services.loading.uxas_cfg import Configuration, Sent, read_all, scenario_states
from cratous.services.loading.uxas_frame import frame_of
from cratous.services.loading.uxas_icarous import (
    SERVICE,
    WithoutIcarous,
    instances_of,
    without_icarous,
)
from cratous.services.loading.uxas_requests import request_of
from cratous.services.loading.uxas_tasks import Interests, other
from cratous.services.loading.uxas_tasks import task as read_task
from cratous.services.loading.yaml_daa import DEFAULT_WELL_CLEAR
from cratous.services.loading.yaml_mission import finish
from cratous.spec.errors import BadInput
from cratous.spec.mission import (
    Daa,
    Frame,
    LivePlanningMission,
    Mission,
    Simulation,
    Task,
    TimedBridgeMission,
    Vehicle,
    Zone,
    ZoneKind,
)
from cratous.spec.mission.bridge_times import USUAL

LIMIT_MS = 86_400_000
"""UxAS has no end of the simulation: one day [ms]."""


def load_uxas(path: Path, number: int = 1) -> Mission:
    """The mission of a request of a UxAS folder (its only cfg*.xml) or cfg XML file, by number from 1.

    Raises BadInput for errors, missing data, and unsupported content (named).
    """
    asked, count = request_of(read_all(Path(path)), number, str(path))
    mission = mission_of(asked, str(path))
    if count > 1:
        note = (
            f"this is request {number} of {count}, which begins where the messages put the vehicles"
        )
        mission = replace(mission, notes=(note, *mission.notes))
    return mission


def mission_of(
    cfg: Configuration,
    source: str,
    spoken_for: Collection[int] | None = None,
    earlier: Frame | None = None,
) -> Mission:
    """The mission given by a configuration and its messages, from a file or as received.

    spoken_for: tasks that may be of an unsupported kind, since their own services tell how they are flown; None: the
    mission alone is planned, so that ground vehicles are refused. earlier: frame of an earlier mission, kept if it is
    still suitable.
    """
    cast = _Cast(cfg, spoken_for or (), spoken_for is not None)
    request = cast.request()
    cast.keep_conditions(request)
    notes = [*cfg.notes, *cast.notes]
    frame = frame_of(cfg, earlier)
    notes.append(f"terrain is taken as flat at {frame.terrain_m:g} m MSL")
    places = Places(frame)
    sources: dict[str, str] = {"relations": request.where}
    vehicles = _vehicles(cast, request, places, sources, notes)
    tasks = _tasks(cast, request, places, vehicles, sources, notes)
    zones = _bound(cast, request, places, frame, sources, notes)
    instances, guard_notes = instances_of(cfg, vehicles)
    alone = WithoutIcarous()
    if spoken_for is None:  # planning alone does not ask for it
        alone = without_icarous(cfg, places, instances, notes)
        sources["link_loss"] = alone.where
    volume = DEFAULT_WELL_CLEAR
    notes.append(
        f"UxAS names no well-clear volume: DTHR {volume.dthr_m:g} m, ZTHR {volume.zthr_m:g} m, "
        f"TTHR {volume.tthr_s:g} s, TCOA {volume.tcoa_s:g} s (our default)"
    )
    settings = _settings(cfg, notes)
    order = "order" if _compatible(cfg) else "time"
    folder = cfg.path.resolve().parent.name
    live = plans_live(cfg.service(SERVICE))
    kind: Callable[..., Mission] = LivePlanningMission if live else Mission
    if alone.times != USUAL:
        kind = partial(TimedBridgeMission, uxas_route_planner=live, bridge=alone.times)
    mission = kind(
        name=parts.safe_name(folder or cfg.path.stem),
        source=source,
        frame=frame,
        vehicles=vehicles,
        tasks=tasks,
        daa=alone.daa,
        zones=tuple(zones),
        relations=request.body.TaskRelationships.strip(),
        cost=settings.cost or "MINMAX",
        order=settings.semantics or order,
        node_limit=settings.nodes,
        simulation=Simulation(limit_ms=LIMIT_MS),
        instances=instances,
        notes=tuple(dict.fromkeys([*notes, *guard_notes])),
    )

    def where(item: str) -> str:
        key = item_key(item)
        for end in range(len(key), 0, -1):
            name = "".join(f"[{p}]" if isinstance(p, int) else str(p) for p in key[:end])
            if name in sources:
                return sources[name]
        return str(cfg.path)

    mission = finish(mission, where)
    notes = [f"{problem.what}" for problem in close_starts(mission, where)]
    return replace(mission, notes=(*mission.notes, *notes))


def surroundings_of(cfg: Configuration, source: str) -> Mission:
    """A mission without tasks: frame, the request's vehicles, and its operating region's zones."""
    cast = _Cast(cfg, (), True)
    request = cast.request()
    notes: list[str] = []
    frame = frame_of(cfg)
    places = Places(frame)
    return Mission(
        name="surroundings",
        source=source,
        frame=frame,
        vehicles=_vehicles(cast, request, places, {}, notes),
        tasks=(),
        daa=Daa(DEFAULT_WELL_CLEAR),
        zones=tuple(
            parts.zone(sent, places, frame.terrain_m, notes)
            for sent in _zones(cast, request, notes)
        ),
    )


class _Cast:
    """The messages by kind; later ones replace earlier ones with the same id."""

    def __init__(self, cfg: Configuration, spoken_for: Collection[int], may_drive: bool) -> None:
        """may_drive: ground vehicles count as vehicles."""
        self.cfg, self.spoken_for = cfg, spoken_for
        self.notes: list[str] = []
        self.configurations: dict[int, Sent] = {}
        self.states: dict[int, Sent] = {}
        self.tasks: dict[int, Sent] = {}
        self.zones: dict[int, Sent] = {}
        self.regions: dict[int, Sent] = {}
        self.requests: list[Sent] = []
        self._conditions: list[list[Any]] = []  # SpeedAltPairs of each request
        self.interests = Interests()
        self.driving: list[int] = []  # not planned here
        other: list[str] = []
        for sent in cfg.messages:
            body, kind = sent.body, type(sent.body).__name__
            if kind == "AirVehicleConfiguration" or (may_drive and kind == CONFIGURATION):
                self.configurations[body.ID] = sent
            elif kind == "AirVehicleState" or (may_drive and kind == STATE):
                self.states[body.ID] = self.interests.entities[body.ID] = sent
            elif kind in ("KeepInZone", "KeepOutZone"):
                self.zones[body.ZoneID] = sent
            elif self.interests.add(sent):
                continue
            elif kind == "OperatingRegion":
                self.regions[body.ID] = sent
            elif is_request(kind):
                self._add_request(sent, kind)
            elif hasattr(body, "TaskID") and hasattr(body, "EligibleEntities"):
                self.tasks[body.TaskID] = sent
            else:
                if kind == CONFIGURATION:
                    self.driving.append(body.ID)
                other.append(kind)
        if any(number not in self.states for number in self.configurations):
            self._ask_scenario()
        if other:
            self.notes.append(f"messages not used: {', '.join(sorted(set(other)))}")

    def _add_request(self, sent: Sent, kind: str) -> None:
        """Add a request; a wrapped one is planned unchanged, since all vehicles are planned together."""
        self._conditions.append(getattr(sent.body, "OverridePlanningConditions", []))
        if kind in WRAPPED:
            self.notes.append(f"{kind} is planned like an AutomationRequest")
            sent = replace(sent, body=getattr(sent.body, WRAPPED[kind]))
        self.requests.append(sent)

    def _ask_scenario(self) -> None:
        found, notes = scenario_states(self.cfg)
        for sent in found:
            number = sent.body.ID
            if number in self.configurations and number not in self.states:
                self.states[number] = sent
                self.notes.append(f"the state of vehicle {number} is read from {sent.where}")
                self.notes.extend(note for note in notes if note not in self.notes)

    def request(self) -> Sent:
        """The automation request."""
        if not self.requests:
            raise BadInput(
                "there is nothing to do",
                where=str(self.cfg.path),
                item="SendMessagesService",
                expected="an AutomationRequest among the messages",
                got="none",
            )
        sent = self.requests[0]
        body, said = counted_once(sent.body)
        self.notes += said
        return replace(sent, body=body) if said else sent

    def keep_conditions(self, request: Sent) -> None:
        """Apply the request's speeds and altitudes; BadInput if they are infeasible."""
        pairs, tasks = self._conditions[0], request.body.TaskList
        if pairs:
            self.configurations = kept(self.configurations, pairs, tasks, request.where)
            self.notes.append("speeds and altitudes are those of OverridePlanningConditions")


def _vehicles(
    cast: _Cast, request: Sent, places: Places, sources: dict[str, str], notes: list[str]
) -> tuple[Vehicle, ...]:
    wanted = list(request.body.EntityList) or sorted(cast.configurations)
    found = []
    for k, number in enumerate(wanted):
        for kind, known in (("Configuration", cast.configurations), ("State", cast.states)):
            if number not in known:
                why = f"vehicle {number} has no AirVehicle{kind}"
                if number in cast.driving:
                    why = f"vehicle {number} drives, and only `cratous uxas` plans for what drives"
                raise _unknown(why, request.where, f"EntityList[{k}]", known, number)
        sources[f"vehicles[{k}]"] = cast.configurations[number].where
        sources[f"vehicles[{k}]position"] = cast.states[number].where
        found.append(vehicle_of(cast.configurations[number], cast.states[number], places, notes))
    return tuple(found)


def _tasks(
    cast: _Cast,
    request: Sent,
    places: Places,
    vehicles: tuple[Vehicle, ...],
    sources: dict[str, str],
    notes: list[str],
) -> tuple[Task, ...]:
    wanted = list(request.body.TaskList)
    if not wanted:
        raise BadInput(
            "the request names no task",
            where=request.where,
            item="TaskList",
            expected="at least one task",
            got="none",
        )
    found: list[Task] = []
    for k, number in enumerate(wanted):
        if number not in cast.tasks:
            what = f"task {number} does not exist"
            raise _unknown(what, request.where, f"TaskList[{k}]", cast.tasks, number)
        sources[f"tasks[{k}]"] = cast.tasks[number].where
        task = other(cast.tasks[number], cast.interests) if number in cast.spoken_for else None
        if task is None:
            task = read_task(cast.tasks[number], places, vehicles, notes, cast.interests)
        found.append(_eligible(task, cast, vehicles, f"tasks[{k}].eligible", notes))
    return tuple(_named_only(found, request, notes))


def _eligible(
    task: Task, cast: _Cast, vehicles: tuple[Vehicle, ...], item: str, notes: list[str]
) -> Task:
    """Drop eligible vehicles that are not in the request; at least one has to remain."""
    ids = [vehicle.id for vehicle in vehicles]
    kept = tuple(n for n in task.eligible if n in ids or n not in cast.configurations)
    strangers = [n for n in kept if n not in ids]
    if len(strangers) < len(kept):
        for number in strangers:
            notes.append(f"task {task.id}: eligible vehicle {number} does not exist, left out")
        kept = tuple(n for n in kept if n in ids)
    if task.eligible and not kept:
        raise BadInput(
            f"no vehicle of the request may do task {task.id}",
            where=cast.tasks[task.id].where,
            item=item,
            expected="one of " + ", ".join(map(str, ids)),
            got=", ".join(map(str, task.eligible)),
        )
    return replace(task, eligible=kept)


def _named_only(tasks: list[Task], request: Sent, notes: list[str]) -> list[Task]:
    """If there are relations only the tasks named in them are done, as in UxAS; the others are noted."""
    text = request.body.TaskRelationships.strip()
    if not text:
        return tasks
    from cratous.spec.algebra import atoms, parse

    known = frozenset(task.id for task in tasks)
    named = {atom.task for atom in atoms(parse(text, known, where=request.where))}
    left_out = [str(task.id) for task in tasks if task.id not in named]
    if left_out:
        notes.append(f"tasks not named in TaskRelationships, so not done: {', '.join(left_out)}")
    return [task for task in tasks if task.id in named]


def _unknown(what: str, where: str, item: str, known: Iterable[int], got: int) -> BadInput:
    names = ", ".join(map(str, sorted(known))) or "none"
    return BadInput(what, where=where, item=item, expected=f"one of {names}", got=str(got))


def _zones(cast: _Cast, request: Sent, notes: list[str]) -> list[Sent]:
    """The zones of the request's operating region, of region 0 if it names none; the others do not apply."""
    number = request.body.OperatingRegion
    named: list[int] = []
    if number or number in cast.regions:
        if number not in cast.regions:
            what = f"operating region {number} does not exist"
            raise _unknown(what, request.where, "OperatingRegion", cast.regions, number)
        region = cast.regions[number]
        named = [*region.body.KeepInAreas, *region.body.KeepOutAreas]
        if not number:  # region 0 has all existing zones; one may just have been removed
            named = [zone for zone in named if zone in cast.zones]
        for zone in named:
            if zone not in cast.zones:
                what = f"zone {zone} of operating region {number} does not exist"
                item = "KeepInAreas, KeepOutAreas"
                raise _unknown(what, region.where, item, cast.zones, zone)
    idle = [str(zone) for zone in cast.zones if zone not in named]
    if idle:
        notes.append(f"zones outside the operating region, so not binding: {', '.join(idle)}")
    return [cast.zones[zone] for zone in dict.fromkeys(named)]


def _bound(
    cast: _Cast,
    request: Sent,
    places: Places,
    frame: Frame,
    sources: dict[str, str],
    notes: list[str],
) -> list[Zone]:
    """The zones that apply; several keep-in zones of the region are merged into one."""
    found = [
        (parts.zone(sent, places, frame.terrain_m, notes), sent.where)
        for sent in _zones(cast, request, notes)
    ]
    inside = [(zone, where) for zone, where in found if zone.kind == ZoneKind.KEEP_IN]
    if len(inside) > 1:
        zones = [zone for zone, _ in inside]
        whole = one_region(zones, cast.regions[request.body.OperatingRegion].where, "KeepInAreas")
        notes.append(
            f"keep-in zones {', '.join(str(z.id) for z in zones)} make one region, zone {whole.id}: "
            "inside of any of them is inside"
        )
        found = [(whole, inside[0][1]), *(f for f in found if f not in inside)]
    for k, (_, where) in enumerate(found):
        sources[f"zones[{k}]"] = where
    return [zone for zone, _ in found]


def _compatible(cfg: Configuration) -> bool:
    return bool(cfg.root.get("Compatibility") == "uxas")


def _settings(cfg: Configuration, notes: list[str]) -> Settings:
    """The settings of the assignment service; BadInput for an invalid attribute."""
    found = cfg.service("AssignmentTreeBranchBoundService")
    settings = Settings() if found is None else settings_of(*found)
    if settings.nodes == 0 and not _compatible(cfg):
        notes.append("NumberNodesMaximum=0 is not used: the search goes on beyond the first plan")
        settings = replace(settings, nodes=None)
    return settings
