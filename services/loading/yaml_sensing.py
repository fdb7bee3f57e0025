"""The section `sensing` of a mission file as `Sensing`; the schema sets the bounds."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from cratous.core.authority.timeliness import lasted
from cratous.services.loading.document import Document
from cratous.services.loading.problems import refuse
from cratous.spec.errors import BadInput
from cratous.spec.mission import Simulation
from cratous.spec.mission.sensing import Sensing, Sensor, SensorKind

Found = tuple[tuple[str | int, ...], str, str, str]
"""Key in the section, fault, expected and actual value."""


def yaml_sensing(document: Document, simulation: Simulation, instances: int) -> Sensing | None:
    """The sensors of a mission, None if it has none; BadMission if they are inconsistent.

    instances: number of vehicles that carry them.
    """
    if "sensing" not in document.data:
        return None
    step = simulation.step_ms, "simulation.step_ms"
    sensing = read(document)
    refuse([_problem(document, *one) for one in _found(sensing, step, instances)])
    return sensing


def sensing_of_file(path: Path, least_period_ms: int) -> Sensing:
    """The section `sensing` of a file, for example a mission file, on its own; BadInput if missing
    or invalid.

    least_period_ms: minimum measurement period of any sensor.
    """
    from cratous.services.loading.document import read_document
    from cratous.services.loading.schema import mission_schema, schema_problems

    document = read_document(path)
    section = {"sensing": mission_schema()["properties"]["sensing"]}
    asked = {"type": "object", "required": ["sensing"], "properties": section}
    refuse(schema_problems(document, asked))
    sensing = read(document)
    step = least_period_ms, "a step of the simulator"
    refuse([_problem(document, *one) for one in _found(sensing, step, 1)])
    return sensing


def read(document: Document) -> Sensing:
    """The section in a document that satisfies the schema, without consistency checks."""
    data = document.data["sensing"]
    rest = {name: value for name, value in data.items() if name not in ("sensors", "coast_s")}
    real = ("sigmas", "manoeuvre_m_s2")
    rest = {name: float(v) if name in real else int(v) for name, v in rest.items()}
    if "coast_s" in data:
        rest["coast_ms"] = _ms(data["coast_s"])
    return Sensing(tuple(map(_sensor, data["sensors"])), **rest)


def _sensor(data: dict[str, Any]) -> Sensor:
    found: dict[str, Any] = {"kind": SensorKind(data["kind"])}
    for name in ("horizontal_m", "vertical_m", "velocity_m_s", "drop_out", "range_m"):
        if name in data:
            found[name] = float(data[name])
    for name in ("latency", "period"):
        if f"{name}_s" in data:
            found[f"{name}_ms"] = _ms(data[f"{name}_s"])
    return Sensor(**found)


def _ms(seconds: Any) -> int:
    return round(float(seconds) * 1000)


def _found(sensing: Sensing, step: tuple[int, str], instances: int) -> Iterator[Found]:
    step_ms, of = step
    if not instances:
        yield (), "nobody carries these sensors", "a vehicle with an ICAROUS instance", "none"
    if not sensing.of_traffic:
        yield ("sensors",), "no sensor sees traffic", "an adsb or a radar", "gps alone"
    own = [k for k, one in enumerate(sensing.sensors) if one.kind is SensorKind.GPS]
    for k in own[1:]:
        yield ("sensors", k, "kind"), "there are two sensors of the own state", "one gps", "another"
    if sensing.confirm_hits not in range(sensing.confirm_of + 1):
        most = f"at most confirm_of, which is {sensing.confirm_of}"
        yield ("confirm_hits",), "no track would ever count", most, str(sensing.confirm_hits)
    for k, one in enumerate(sensing.sensors):
        where, got = ("sensors", k, "period_s"), f"{one.period_ms / 1000:g} s"
        if not lasted(step_ms, one.period_ms, 0):
            expected = f"at least {step_ms / 1000:g} s ({of})"
            yield where, "a sensor measures more often than the simulation steps", expected, got
        if one.kind is SensorKind.GPS and one.range_m is not None:
            what = "the sensor of the own state has no range"
            yield ("sensors", k, "range_m"), what, "none", f"{one.range_m:g} m"
        silent_ms = one.latency_ms + one.period_ms
        if one.kind is not SensorKind.GPS and not lasted(silent_ms, sensing.coast_ms, 0):
            expected = f"at least {silent_ms / 1000:g} s, the latency and period of sensors[{k}]"
            what = "tracks would end between two measurements"
            yield ("coast_s",), what, expected, f"{sensing.coast_ms / 1000:g} s"


def _problem(
    document: Document, key: tuple[str | int, ...], what: str, expected: str, got: str
) -> BadInput:
    from cratous.services.loading.document import item_name

    full = ("sensing", *key)
    return BadInput(
        what, where=document.where(full), item=item_name(full), expected=expected, got=got
    )
