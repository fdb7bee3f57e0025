"""Suite `trajectory`: recorded flights of AMASE compared with the simulator in compatibility mode.

A case gives `scenario_xml`, `columns` and `rows`: the states that AMASE published. The scenario is
simulated here, and each row is compared with the state at the same time (to the millisecond,
truncated, not rounded, since clocks accumulate 0.01 s). It passes if no position deviates by more
than the bound: 1 m without wind and loiters, 10 m otherwise. States with other modes, waypoints or
commands are listed for each case.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from math import cos, hypot, isfinite, radians
from typing import Any

from cratous.services.conform import Result, failed, not_covered, passed
from cratous.services.simulator.scenario import of_text
from cratous.services.simulator.world import World
from cratous.spec.errors import BadInput

NEAR_M, FAR_M = 1.0, 10.0
DEGREE_M = 111_320.0
NEEDED = {"Time", "Latitude", "Longitude", "Altitude"}
STATES = ("Mode", "CurrentWaypoint", "CurrentCommand")


class Flights:
    """The suite over one file: keeps a summary line for each flight."""

    def __init__(self) -> None:
        self._lines: list[str] = []

    def judge(self, case: dict[str, Any]) -> Result:
        """Fly one case of the suite; the results of its checks."""
        result = judge(case)
        if result.text:
            self._lines.append(f"  {result.case}: {result.text}")
        return result

    def summary(self) -> list[str]:
        """The deviation of each flight, and the fields in which its states differ."""
        return self._lines


def suite() -> Callable[[dict[str, Any]], Result]:
    """The suite for one file."""
    return Flights().judge


def judge(case: dict[str, Any]) -> Result:
    """Fly one case of the suite; the results of its checks."""
    about = case.get("desc")
    name = f"seed {about.get('seed', '?')}" if isinstance(about, dict) else "flight"
    columns, rows, text = case.get("columns"), case.get("rows"), case.get("scenario_xml")
    if not isinstance(text, str) or not isinstance(columns, list) or not set(columns) >= NEEDED:
        return not_covered(name, "no scenario or no states given")
    if not isinstance(rows, list) or not all(
        isinstance(row, list) and len(row) == len(columns) for row in rows
    ):
        raise BadInput("rows that do not fit the columns", where=name, item="rows")
    scenario = of_text(text, f"{name}: scenario_xml")
    kinds = {type(event.body).__name__ for event in scenario.events}
    easy = "WeatherReport" not in kinds and "LoiterAction" not in text
    flown = _fly(
        World(scenario.events, scenario.duration_s, start_s=scenario.start_s, compatible=True)
    )
    return _compare(name, NEAR_M if easy else FAR_M, columns, rows, flown)


def _fly(world: World) -> dict[int, Any]:
    """The published states of the scenario's vehicle, by time [ms]."""
    told: dict[int, Any] = {}
    while not world.over:
        for body in world.tick():
            if type(body).__name__ == "AirVehicleState":
                told[body.Time] = body
    return told


def _compare(
    name: str, bound_m: float, columns: list[str], rows: list[Any], flown: dict[int, Any]
) -> Result:
    worst_m, worst_ms, checks, missing = 0.0, 0, 0, 0
    differ: Counter[str] = Counter()
    for row in rows:
        wanted = dict(zip(columns, row, strict=True))
        at = int(wanted["Time"])
        got = flown.get(at) or flown.get(at + 1) or flown.get(at - 1)
        if got is None:
            missing += 1
            continue
        checks += 1
        place = got.Location
        off_m = hypot(
            (place.Latitude - wanted["Latitude"]) * DEGREE_M,
            (place.Longitude - wanted["Longitude"]) * DEGREE_M * cos(radians(place.Latitude)),
            place.Altitude - wanted["Altitude"],
        )
        if not isfinite(off_m):
            return failed(name, "a place that is no number", f"at {got.Time} ms", checks)
        if off_m > worst_m:
            worst_m, worst_ms = off_m, got.Time
        said = {"Mode": got.Mode.name, "CurrentWaypoint": got.CurrentWaypoint,
                "CurrentCommand": got.CurrentCommand}  # fmt: skip
        differ.update(key for key in STATES if key in wanted and wanted[key] != said[key])
    listed = "".join(f", {key} differs in {count} states" for key, count in sorted(differ.items()))
    text = f"{worst_m:.3f} m off at {worst_ms / 1000:g} s (bound {bound_m:g} m), {checks} states{listed}"
    if missing or not checks:
        return failed(
            name, "states at other times", f"{missing} of {len(rows)} rows: {text}", checks
        )
    if worst_m > bound_m:
        return failed(name, f"farther off than {bound_m:g} m", text, checks)
    return replace(passed(name, checks), text=text)
