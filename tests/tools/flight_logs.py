"""Message logs of one mission made by hand: states along given paths, and what vehicles say."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import yaml
from ground_tools import Flown

from cratous.bridge import lmcp
from cratous.services.loading import load
from cratous.services.monitor.safe_state import SAFE_STATE
from cratous.spec.mission import Mission

STEP_MS, ALT_M = 250, 300.0
Place = tuple[float, float, float]
Flies = Callable[[int], Place]
"""Position of a vehicle by the time [ms]: north, east, altitude [m]."""


def mission_of(root: Path, folder: Path, *vehicles: dict[str, Any], **sections: Any) -> Mission:
    """The mission with a failure that is declared, with these vehicles in addition; no zone appears."""
    data = yaml.safe_load((root / "tests/missions/on_failure.yaml").read_text())
    first = data["vehicles"][0]
    data["tasks"][0]["eligible"] = [1]
    data["vehicles"] = [first, *({**first, **one} for one in vehicles)]
    found = {k: v for k, v in {**data, "changes": None, **sections}.items() if v is not None}
    path = folder / "mission.yaml"
    path.write_text(yaml.safe_dump(found))
    return load(path)


def sent(time_ms: int, kind: str, **fields: Any) -> Any:
    """A message as a tap gets it."""
    body = lmcp.new(kind, **fields)
    return SimpleNamespace(topic=f"cratous.{kind}", time_ms=time_ms, body=body)


def message(kind: str, time_ms: int, **fields: Any) -> Any:
    """A message with a time."""
    return sent(time_ms, kind, Time=time_ms, **fields)


def says(mode: str, time_ms: int, vehicle: int = 1, **fields: Any) -> Any:
    """What a vehicle says to fly by itself; UxAS was never heard, and the known way is chosen, unless said."""
    said = {"Mode": mode, "Chosen": "Finish", "Heard": 0, "Reason": "", **fields}
    return message("LinkLossState", time_ms, VehicleID=vehicle, **said)


def gate(owner: str, time_ms: int, vehicle: int = 1) -> Any:
    """The state of a gate, of an epoch that begins then."""
    fields = {"Owner": owner, "Epoch": time_ms, "Offered": False}
    return message("GateState", time_ms, VehicleID=vehicle, **fields)


def _states(vehicle: int, path: Flies, times: range) -> Iterator[Any]:
    for now_ms, next_ms in pairwise([*times, times[-1] + STEP_MS]):
        here, there = path(now_ms), path(next_ms)
        north, east, up = ((b - a) * 1000 / STEP_MS for a, b in zip(here, there, strict=True))
        yield message(
            "TruthState", now_ms, VehicleID=vehicle, North=here[0], East=here[1], Altitude=here[2],
            VelocityNorth=north, VelocityEast=east, VelocityDown=-up,
        )  # fmt: skip


def log_of(
    paths: dict[int, Flies],
    *said: Any,
    end_ms: int,
    outcome: str = SAFE_STATE,
    gap: range = range(0),
) -> list[Any]:
    """The messages in the order of time, up to the mission's end. gap: when vehicle 1 was not seen [ms]."""
    times = range(0, end_ms + 1, STEP_MS)
    seen = (one for vehicle, path in paths.items() for one in _states(vehicle, path, times))
    there = [one for one in seen if one.body.VehicleID != 1 or one.time_ms not in gap]
    found = sorted([*there, *said], key=lambda one: one.time_ms)
    return [*found, message("MissionEnd", end_ms, Outcome=outcome)]


def both_of(mission: Mission, log: list[Any], row: str, folder: Path) -> tuple[str, str]:
    """What monitor and judge say in a row; empty where they have none."""
    flight = Flown(mission, log, None)  # type: ignore[arg-type]
    found = flight.verdicts().get(row)
    return "" if found is None else found.outcome.value, flight.judged(folder, log).get(row, "")
