"""A mission file (YAML, schema `spec/mission/mission.schema.json`) as a `Mission`.

Stages: the text must be unambiguous, then it must satisfy the schema, then the checks of
`checks.py`, then zones are padded and starts are checked against them. Each stage reports all its
faults, at most ten, each with file, line and item.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from math import radians
from pathlib import Path
from typing import Any

from cratous.services.loading.assignment_attributes import NODES_PER_MS
from cratous.services.loading.checks import (
    change_problems,
    mission_problems,
    start_problems,
    too_many_instances,
    zone_end_problems,
)
from cratous.services.loading.coordinates import Places
from cratous.services.loading.document import Document, item_key, read_document
from cratous.services.loading.fitness import warnings_of
from cratous.services.loading.landing_sites import ground_problems
from cratous.services.loading.moving_zones import (
    as_given,
    movement_of,
    moving_problems,
    with_regions,
)
from cratous.services.loading.polygons import padded
from cratous.services.loading.problems import refuse
from cratous.services.loading.schema import schema_problems
from cratous.services.loading.start_distances import close_starts
from cratous.services.loading.take_off import on_their_ground, take_off_problems
from cratous.services.loading.take_off import words as take_off_words
from cratous.services.loading.yaml_bridge import yaml_bridge_times
from cratous.services.loading.yaml_bridge_faults import yaml_bridge_faults
from cratous.services.loading.yaml_daa import Sections, daa_of
from cratous.services.loading.yaml_guidance import guidance_problems
from cratous.services.loading.yaml_link_loss import place_problems, yaml_link_loss
from cratous.services.loading.yaml_link_loss import words as link_loss_words
from cratous.services.loading.yaml_merging import merging_problems, yaml_merging
from cratous.services.loading.yaml_on_failure import words as on_failure_words
from cratous.services.loading.yaml_on_failure import yaml_on_failure
from cratous.services.loading.yaml_sensing import yaml_sensing
from cratous.services.loading.yaml_task import yaml_task
from cratous.services.mission.landing import on_failure_of
from cratous.services.mission.merging import merging_of
from cratous.services.mission.take_off import grounded
from cratous.spec.errors import BadInput
from cratous.spec.mission import (
    Camera,
    Change,
    FaultySimulation,
    Frame,
    GroundedVehicle,
    LivePlanningMission,
    Mission,
    Simulation,
    TimedBridgeMission,
    Traffic,
    Vehicle,
    Velocity,
    Zone,
    ZoneKind,
    changes,
)
from cratous.spec.mission.bridge_faults import words
from cratous.spec.mission.bridge_times import USUAL
from cratous.spec.mission.bridge_times import words as bridge_words
from cratous.spec.mission.changes import (
    VEHICLE_HOLDS,
    WIND,
    ZONE_ENDS,
    HoldCommand,
    WindChange,
    ZoneEnd,
)
from cratous.spec.mission.merging import words as merging_words
from cratous.spec.mission.sensing import words as sensing_words

MAX_BANK_DEG, MAX_CLIMB_M_S = 30.0, 5.0
"""Defaults of a vehicle."""


def load(path: Path, seed: int = 0) -> Mission:
    """The mission in a YAML file; seed > 0 gives that variant of its `variation` section.

    Raises BadMission (a BadInput) with all faults found.
    """
    return loaded(read_document(path), seed)


def loaded(document: Document, seed: int = 0) -> Mission:
    """The same, from a parsed file. Raises BadMission (a BadInput) likewise."""
    mission = drawn(document, seed)

    def where(item: str) -> str:
        return document.where(item_key(item))

    if seed:
        from cratous.services.loading.variation import vary

        mission = vary(mission, document, seed)
    mission = finish(mission, where)
    refuse(list(close_starts(mission, where)))
    return mission


def drawn(document: Document, seed: int = 0) -> Mission:
    """The mission in a document, checked against the schema only, not for consistency.

    Raises BadMission (a BadInput) where it violates the schema.
    """
    refuse(schema_problems(document))
    return _mission(document, seed)


def finish(mission: Mission, where: Any) -> Mission:
    """Check a mission, pad its zones and check the starts against them."""
    mission = on_their_ground(mission)
    later = tuple(c.zone for c in mission.changes if c.zone is not None)
    refuse(mission_problems(replace(mission, zones=(*mission.zones, *later)), where))
    refuse([*change_problems(mission, where), *zone_end_problems(mission, where)])
    refuse([*moving_problems(mission, where)])
    refuse(list(guidance_problems(mission, where)))
    notes = [] if mission.bridge_times == USUAL else [bridge_words(mission.bridge_times)]
    problems: list[BadInput] = []

    def hard(zone: Zone, item: str) -> Zone:
        try:
            found = padded(zone, where(item), item)
        except BadInput as problem:
            problems.append(problem)
            return zone
        if zone.padding_m:
            change = "widened" if zone.kind == ZoneKind.KEEP_OUT else "narrowed"
            notes.append(f"zone {zone.id} is {change} by its padding of {zone.padding_m:g} m")
        return found

    zones = tuple(hard(z, f"zones[{k}].padding_m") for k, z in enumerate(mission.zones))
    known = tuple(
        c if c.zone is None else replace(c, zone=hard(c.zone, f"changes[{k}].zone.padding_m"))
        for k, c in enumerate(mission.changes)
    )
    refuse(problems)
    if isinstance(mission.simulation, FaultySimulation):
        notes.append(words(mission.simulation.bridge_faults))
    if mission.sensing is not None:
        notes.append(sensing_words(mission.sensing))
    if mission.link_loss is not None:
        notes.append(link_loss_words(mission.link_loss))
    if (merging := merging_of(mission)) is not None:
        notes.append(merging_words(merging))
    if (after := on_failure_of(mission)) is not None:
        notes.append(on_failure_words(after))
    if grounded(mission):
        notes.append(take_off_words(mission))
    mission, moving = with_regions(replace(mission, zones=zones, changes=known))
    notes += moving
    places = (
        *place_problems(mission, where),
        *ground_problems(mission, where),
        *take_off_problems(mission, where),
        *merging_problems(mission, where),
    )
    refuse([*start_problems(mission, where), *places])
    said = [*mission.notes, *notes, *warnings_of(mission)]
    return replace(mission, notes=tuple(dict.fromkeys(said)))


def expectations(path: Path) -> dict[str, Any]:
    """The `expect` section of a mission file, as plain data."""
    found: dict[str, Any] = read_document(path).data.get("expect", {})
    return found


def _mission(document: Document, seed: int) -> Mission:
    data = document.data
    frame = Frame(
        float(data["frame"]["latitude_deg"]),
        float(data["frame"]["longitude_deg"]),
        float(data["frame"].get("terrain_m", 0.0)),
    )
    places = Places(frame)
    vehicles = tuple(_vehicle(entry, places) for entry in data["vehicles"])
    live = bool(data.get("bridge", {}).get("uxas_route_planner", False))
    instances, simulation = _instances(document, vehicles), _simulation(document)
    sensing = yaml_sensing(document, simulation, len(instances))
    sections = Sections(
        sensing,
        yaml_link_loss(document, places, simulation, len(instances)),
        yaml_merging(document, places),
        yaml_on_failure(document, places, len(instances)),
    )
    times = yaml_bridge_times(document, simulation)
    kind: Callable[..., Mission] = LivePlanningMission if live else Mission
    if times != USUAL:
        kind = partial(TimedBridgeMission, uxas_route_planner=live, bridge=times)
    return kind(
        name=data["name"],
        source=document.path,
        frame=frame,
        vehicles=vehicles,
        tasks=tuple(
            yaml_task(entry, places, document.where, k) for k, entry in enumerate(data["tasks"])
        ),
        daa=daa_of(data.get("daa", {}), sections),
        zones=tuple(_zone(entry, places) for entry in data.get("zones", [])),
        traffic=tuple(_traffic(entry, places) for entry in data.get("traffic", [])),
        relations=data.get("relations", "").strip(),
        cost=data.get("cost", "MINMAX"),
        order=data.get("order", "time"),
        instances=instances,
        simulation=simulation,
        changes=tuple(_change(entry, places) for entry in data.get("changes", [])),
        seed=seed,
        node_limit=_nodes(data.get("search", {})),
        gap=float(data.get("search", {}).get("gap", 0.0)),
    )


def _nodes(search: dict[str, Any]) -> int | None:
    """Node limit of the assignment search; a deadline is converted to nodes."""
    nodes = search.get("nodes")
    if "deadline_ms" in search:
        patience = int(search["deadline_ms"]) * NODES_PER_MS
        return patience if nodes is None else min(patience, int(nodes))
    return None if nodes is None else int(nodes)


def _instances(document: Document, vehicles: tuple[Vehicle, ...]) -> tuple[int, ...]:
    guarded = tuple(vehicle.id for vehicle in vehicles if vehicle.protected)
    wanted = document.data.get("bridge", {}).get("instances", len(guarded))
    if wanted > len(guarded):
        key = ("bridge", "instances")
        raise too_many_instances(wanted, len(guarded), document.where(key), "bridge.instances")
    return guarded[: int(wanted)]


def _vehicle(data: dict[str, Any], places: Places) -> Vehicle:
    speed = float(data["speed_m_s"])
    kind = GroundedVehicle if data.get("start") == "ground" else Vehicle
    return kind(
        id=int(data["id"]),
        label=data.get("label", f"vehicle {data['id']}"),
        position=places.position(data["position"]),
        heading_rad=radians(float(data["heading_deg"])),
        speed_m_s=speed,
        min_speed_m_s=float(data.get("min_speed_m_s", speed)),
        max_speed_m_s=float(data.get("max_speed_m_s", speed)),
        max_bank_rad=radians(float(data.get("max_bank_deg", MAX_BANK_DEG))),
        max_climb_m_s=float(data.get("max_climb_m_s", MAX_CLIMB_M_S)),
        protected=data.get("protected", True),
        cameras=tuple(_camera(entry) for entry in data.get("cameras", [])),
        cruise_m=float(data["cruise_m"]) if "cruise_m" in data else None,
        power_w=float(data["power_w"]) if "power_w" in data else None,
    )


def _camera(data: dict[str, Any]) -> Camera:
    found: dict[str, Any] = {
        name: data[name]
        for name in ("payload_id", "aspect", "wavelength", "pixels")
        if name in data
    }
    for name, value in data.items():
        if name.endswith("_deg"):
            found[f"{name.removesuffix('_deg')}_rad"] = radians(float(value))
    return Camera(**found)


def _zone(data: dict[str, Any], places: Places) -> Zone:
    zone = Zone(
        id=int(data["id"]),
        kind=ZoneKind(data["kind"]),
        vertices=tuple(places.vertex(vertex) for vertex in data["vertices"]),
        floor_m=float(data.get("floor_m", -1000.0)),
        ceiling_m=float(data.get("ceiling_m", 100_000.0)),
        padding_m=float(data.get("padding_m", 0.0)),
        label=data.get("label", ""),
    )
    movement = movement_of(data)
    return zone if movement is None else as_given(zone, movement)


def _change(data: dict[str, Any], places: Places) -> Change:
    kind = next(name for name in data if name != "at_s")
    at_ms, value = round(float(data["at_s"]) * 1000), data[kind]
    if kind == changes.ZONE:
        return Change(at_ms, kind, zone=_zone(value, places))
    if kind == ZONE_ENDS:
        return ZoneEnd(at_ms, kind, zone_id=int(value))
    if kind == WIND:
        return WindChange(
            at_ms, kind, north_m_s=float(value["north_m_s"]), east_m_s=float(value["east_m_s"])
        )
    if kind == VEHICLE_HOLDS:
        return HoldCommand(
            at_ms,
            kind,
            vehicle=int(value["vehicle"]),
            place=places.vertex(value["place"]) if "place" in value else None,
            alt_m=float(value["alt_m"]) if "alt_m" in value else None,
        )
    if kind.startswith("vehicle"):
        return Change(at_ms, kind, vehicle=int(value))
    return Change(at_ms, kind, task=int(value))


def _traffic(data: dict[str, Any], places: Places) -> Traffic:
    velocity = data["velocity"]
    vanishes = data.get("vanishes_s")
    return Traffic(
        id=int(data["id"]),
        position=places.position(data["position"]),
        velocity=Velocity(
            float(velocity["north_m_s"]),
            float(velocity["east_m_s"]),
            float(velocity.get("down_m_s", 0.0)),
        ),
        appears_ms=round(float(data.get("appears_s", 0)) * 1000),
        vanishes_ms=None if vanishes is None else round(float(vanishes) * 1000),
    )


def _simulation(document: Document) -> Simulation:
    data = document.data.get("simulation", {})
    found: dict[str, int] = {
        name: int(data[name]) for name in ("step_ms", "heartbeat_ms") if name in data
    }
    if "limit_s" in data:
        found["limit_ms"] = round(float(data["limit_s"]) * 1000)
    if "bridge_faults" not in data:
        return Simulation(**found)
    return FaultySimulation(**found, bridge_faults=yaml_bridge_faults(document))
