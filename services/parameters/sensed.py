"""The parameters of ICAROUS's sensors: the section `sensing`, sensor by sensor."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from cratous.spec.mission.sensing import Sensing, Sensor

SECTION = "sensing"


class Row(NamedTuple):
    """name: of the parameter; path: its place in a mission file; value: in the file's unit; facts: of the
    schema.
    """

    name: str
    path: tuple[str | int, ...]
    value: float
    facts: Any


def rows_of(sensing: Sensing, schema: Any) -> Iterator[Row]:
    """All parameters, those of the tracks first. schema: of the section. An unbounded range has no row."""
    of_tracks: dict[str, float] = {
        "seed": sensing.seed,
        "sigmas": sensing.sigmas,
        "confirm_hits": sensing.confirm_hits,
        "confirm_of": sensing.confirm_of,
        "coast_s": sensing.coast_ms / 1000,
        "manoeuvre_m_s2": sensing.manoeuvre_m_s2,
    }
    for name, value in of_tracks.items():
        yield Row(f"{SECTION}.{name}", (SECTION, name), value, schema["properties"][name])
    facts = schema["properties"]["sensors"]["items"]["properties"]
    for k, sensor in enumerate(sensing.sensors):
        for name, told in _values(sensor).items():
            if told is not None:
                path = (SECTION, "sensors", k, name)
                item = f"{SECTION}.sensors[{k}].{name} ({sensor.kind.value})"
                yield Row(item, path, told, facts[name])


def _values(sensor: Sensor) -> dict[str, float | None]:
    return {
        "horizontal_m": sensor.horizontal_m,
        "vertical_m": sensor.vertical_m,
        "velocity_m_s": sensor.velocity_m_s,
        "latency_s": sensor.latency_ms / 1000,
        "period_s": sensor.period_ms / 1000,
        "drop_out": sensor.drop_out,
        "range_m": sensor.range_m,
    }
