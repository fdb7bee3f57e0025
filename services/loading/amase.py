"""An unmodified AMASE scenario as a `Mission`.

A scenario lists the aircraft, and may contain tasks and zones. Without an automation request among
its events it asks for all its tasks, in any order, by all its vehicles, and all its zones apply.
"""

from __future__ import annotations

from dataclasses import replace
from math import cos, radians, sin
from pathlib import Path
from typing import Any

from cratous.bridge import lmcp
from cratous.services.loading import uxas_parts as parts
from cratous.services.loading.coordinates import Places
from cratous.services.loading.request_kinds import is_request
from cratous.services.loading.uxas import mission_of
from cratous.services.loading.uxas_cfg import Configuration, Sent
from cratous.services.loading.uxas_requests import request_of, requests_of
from cratous.services.loading.yaml_mission import finish
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import integer_of
from cratous.spec.mission import Mission, Traffic, Velocity
from cratous.spec.schedule import TIME_LIMIT_MS

TRAFFIC = ("CratousRole", "traffic")
"""Key and value in the Info of an aircraft that is traffic: AMASE itself makes no distinction."""


def is_scenario(path: Path) -> bool:
    """Whether a file is an AMASE scenario; BadInput if it is not XML."""
    from cratous.bridge.lmcp import xml
    from cratous.spec.files.text_file import bytes_of

    root = xml.parse(xml.mended(bytes_of(path), str(path), []), str(path))
    return bool(root.tag == "AMASE")


def count_scenario_requests(path: Path) -> int:
    """The number of automation requests in a scenario; at least 1."""
    return len(requests_of(_read(path)[1]))


def load_amase(path: Path, number: int = 1) -> Mission:
    """The mission of a scenario file, for the automation request with this number if it has any.

    Raises BadInput for errors, missing data, and unsupported content (named).
    """
    scenario, cfg, apart = _read(path)
    mission = mission_of(request_of(cfg, number, str(path))[0], str(path))
    limit_ms = integer_of(str(round(scenario.duration_s * 1000)), 1, TIME_LIMIT_MS - 1)
    if limit_ms is None:
        raise BadInput(
            "not a duration",
            where=str(path),
            item="ScenarioDuration",
            expected=f"1 ms to {TIME_LIMIT_MS / 1000:g} s",
            got=f"{scenario.duration_s:g} s",
        )
    places = Places(mission.frame)
    mission = replace(
        mission,
        name=parts.safe_name(scenario.name),
        traffic=_traffic(apart, places),
        simulation=replace(mission.simulation, limit_ms=limit_ms),
    )
    return finish(mission, lambda _item: str(path)) if mission.traffic else mission


def _read(path: Path) -> tuple[Any, Configuration, list[Sent]]:
    """The scenario; its events as messages with a request; and the events of traffic aircraft."""
    from cratous.services.simulator.scenario import read

    scenario = read(path)
    sent = [Sent(e.body, e.where, round(e.time_s * 1000)) for e in scenario.events]
    alone = {m.body.ID for m in sent if _is_traffic(m.body)}
    apart = [m for m in sent if _about(m.body) and _about(m.body) <= alone]
    messages = [m for m in sent if m not in apart]
    notes = [*scenario.notes]
    if not any(is_request(type(m.body).__name__) for m in messages):
        messages += _request(messages, path)
        notes.append("the scenario has no automation request: all its tasks are to be done")
    late = [m for m in messages if m.time_ms]
    if late:
        kinds = ", ".join(sorted({type(m.body).__name__ for m in late}))
        notes.append(f"events later than 0 s are taken as known from the start: {kinds}")
    messages.sort(key=lambda m: m.time_ms)
    return scenario, Configuration(path, {}, (), tuple(messages), tuple(notes)), apart


def _is_traffic(body: Any) -> bool:
    named = type(body).__name__ == "AirVehicleConfiguration"
    return named and any((pair.Key, pair.Value) == TRAFFIC for pair in body.Info)


def _about(body: Any) -> set[int]:
    """The aircraft that a message concerns; empty if it concerns anything else too."""
    kind = type(body).__name__
    if kind in ("AirVehicleConfiguration", "AirVehicleState"):
        return {body.ID}
    return set(body.EntityList) if kind == "RemoveEntities" else set()


def _request(messages: list[Sent], path: Path) -> list[Sent]:
    """A region of all zones, and a request for all tasks by all vehicles."""
    ids: dict[str, dict[int, None]] = {}
    for body in (m.body for m in messages):
        kind = type(body).__name__
        for name in ("TaskID", "ZoneID"):
            if hasattr(body, name):
                ids.setdefault(name if name == "TaskID" else kind, {})[getattr(body, name)] = None
        if kind in ("AirVehicleConfiguration", "OperatingRegion"):
            ids.setdefault(kind, {})[body.ID] = None
    regions = ids.get("OperatingRegion", {})
    number = next(n for n in range(1, len(regions) + 2) if n not in regions)
    region = lmcp.new(
        "OperatingRegion",
        ID=number,
        KeepInAreas=list(ids.get("KeepInZone", {})),
        KeepOutAreas=list(ids.get("KeepOutZone", {})),
    )
    request = lmcp.new(
        "AutomationRequest",
        EntityList=list(ids.get("AirVehicleConfiguration", {})),
        TaskList=list(ids.get("TaskID", {})),
        OperatingRegion=number,
    )
    return [Sent(region, str(path), 0), Sent(request, str(path), 0)]


def _traffic(apart: list[Sent], places: Places) -> tuple[Traffic, ...]:
    """Each traffic aircraft, from its only state until it is removed; BadInput if it has no state,
    or more than one.
    """
    found: dict[int, Traffic] = {}
    for sent in sorted(apart, key=lambda one: one.time_ms):
        body, kind = sent.body, type(sent.body).__name__
        if kind == "AirVehicleState":
            if body.ID in found:
                raise _not_one_state(sent, "another one")
            heading, speed = radians(body.Heading), float(body.Groundspeed)
            velocity = Velocity(speed * cos(heading), speed * sin(heading), 0.0)
            place = parts.point(body.Location, places, sent, "Location")
            found[body.ID] = Traffic(body.ID, place, velocity, sent.time_ms)
        elif kind == "RemoveEntities":
            for number in body.EntityList:
                if number in found and found[number].vanishes_ms is None:
                    found[number] = replace(found[number], vanishes_ms=sent.time_ms)
    marked = {sent.body.ID: sent for sent in apart if _is_traffic(sent.body)}
    for number, sent in marked.items():
        if number not in found:
            raise _not_one_state(sent, "none")
    return tuple(found[number] for number in marked)


def _not_one_state(sent: Sent, got: str) -> BadInput:
    return BadInput(
        "traffic flies straight on from one state",
        where=sent.where,
        item=f"AirVehicleState of {sent.body.ID}",
        expected="one",
        got=got,
    )
