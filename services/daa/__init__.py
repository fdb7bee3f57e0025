"""Detect and avoid for users: files in, alerts, bands, metrics, plots and reasons out.

`run` gives one `Instant` for each step of an encounter file. All in SI; see docs/guides/detect-and-avoid.md.

    from pathlib import Path
    from cratous.services.daa import named_or_file, run

    for step in run(Path("encounter.daa"), named_or_file("do_365b").parameters):
        print(step.instant.time_s, [a.level for a in step.instant.alerts])
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from cratous.core.daa.frame import Local, project
from cratous.core.daa.session import Instant, Session
from cratous.core.daa.state import Aircraft, Sigma
from cratous.core.daa.terminal_area import in_terminal_area
from cratous.core.excuse.judgement import from_state as judge_way_out
from cratous.spec.daa.consistency import check
from cratous.spec.daa.encounter_files import Row, read
from cratous.spec.daa.parameters import Parameters
from cratous.spec.daa.presets import named_or_file, names, preset
from cratous.spec.errors import BadInput

__all__ = [
    "Aircraft", "Instant", "Session", "Sigma", "Step", "judge_way_out", "named_or_file", "names",
    "preset", "run",
]  # fmt: skip


@dataclass(frozen=True)
class Step:
    """One step of a file: its rows, the wind [m/s, blowing to], parameters and result."""

    rows: tuple[Row, ...]
    wind_m_s: tuple[float, float]
    parameters: Parameters
    instant: Instant


def aircraft(rows: tuple[Row, ...]) -> tuple[list[Aircraft], tuple[float, float]]:
    """The states of a step in the plane at the ownship, relative to the air; and the wind.

    The wind is the ownship's ground velocity minus its air velocity, if heading and airspeed are given.
    """
    own = rows[0]
    wind = (0.0, 0.0)
    if "heading" in own.values and "airspeed" in own.values:
        heading, speed = own.values["heading"], own.values["airspeed"]
        wind = (
            own.values["vx"] - speed * math.sin(heading),
            own.values["vy"] - speed * math.cos(heading),
        )
    found = []
    for row in rows:
        if row.geodetic is not own.geodetic:
            raise BadInput("positions of two kinds in one step", item=row.id,
                           expected="all geodetic or all Cartesian")  # fmt: skip
        v = row.values
        place = Local(v.get("x", 0.0), v.get("y", 0.0), v["vx"], v["vy"])
        if row.geodetic:
            place = project(
                own.values["lat"], own.values["lon"], v["lat"], v["lon"], v["vx"], v["vy"]
            )
        sigma = Sigma(
            *(v.get(k, 0.0) for k in ("s_ew", "s_ns", "s_en", "s_z", "v_ew", "v_ns", "v_en", "v_z"))
        )
        found.append(
            Aircraft(
                row.id,
                place.east_m,
                place.north_m,
                v["alt"],
                place.ve_m_s - wind[0],
                place.vn_m_s - wind[1],
                v["vs"],
                int(v.get("alerter", 1)),
                sigma,
            )
        )
    return found, wind


def run(
    file: Path,
    parameters: Parameters,
    ownship: str = "",
    dimensions: tuple[int, ...] = (0, 1, 2, 3),
    changes: Mapping[str, Any] = MappingProxyType({}),
) -> Iterator[Step]:
    """The result for each step of an encounter file; raises BadInput.

    changes: parameter values that override those in the file.
    """
    encounters = read(file, ownship)
    session: Session | None = None
    there = {row.id for _, rows in encounters.steps for row in rows}
    if changes.get("urgency_strategy"):
        every = [
            {**encounters.settings, **rows[0].settings, **changes} for _, rows in encounters.steps
        ]
        criteria = ("conflict_crit", "recovery_crit")
        if not any(own.get(name, getattr(parameters, name)) for own in every for name in criteria):
            raise BadInput("nothing would change: no criterion of coordination is on",
                           where=str(file), item="urgency_strategy",
                           expected="conflict_crit or recovery_crit = true", got="both false")  # fmt: skip
    for time_s, rows in encounters.steps:
        wanted = dataclasses.replace(
            parameters, **{**encounters.settings, **rows[0].settings, **changes}
        )
        if encounters.settings or rows[0].settings or changes:
            check(wanted, str(file))
        urgent = wanted.most_urgent_aircraft
        if urgent and urgent not in there - {rows[0].id}:
            raise BadInput("there is no such intruder", where=str(file), item="most_urgent_aircraft",
                           expected=" or ".join(sorted(there - {rows[0].id})), got=urgent)  # fmt: skip
        if session is None or session.parameters != wanted:
            session = Session(wanted)  # any change of a parameter ends the history
        states, wind = aircraft(rows)
        inside = [
            in_terminal_area(wanted, r.values.get("lat"), r.values.get("lon"), r.values["alt"])
            for r in rows
        ]
        instant = session.step(time_s, states[0], states[1:], dimensions, inside=inside)
        yield Step(rows, wind, wanted, instant)
