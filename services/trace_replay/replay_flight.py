"""The flight on which traces are replayed: one vehicle flying far north, and an intruder on demand."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

from cratous.services.flight.dynamics import AirState
from cratous.spec.mission import (
    Change,
    Daa,
    Frame,
    Mission,
    Position,
    Task,
    TaskKind,
    Vehicle,
    WellClear,
)
from cratous.spec.mission.changes import WIND, WindChange

VEHICLE = 1
INTRUDER = 2
NEAR_M = 400.0
"""Distance ahead of the intruder [m]: within the predicted volume, and too close to wait."""
BREEZE_M_S = 0.1


@cache
def mission() -> Mission:
    """One protected vehicle at its maximum speed, so that any wind matters; its only task is 100 km ahead."""
    start = Position(0.0, 0.0, 300.0)
    bank = math.radians(30)
    vehicle = Vehicle(VEHICLE, "own", start, 0.0, 22.0, 15.0, 22.0, bank, 5.0, True)
    far = Position(100_000.0, 0.0, 300.0)
    task = Task(1, TaskKind.MUST_FLY, "far", (far,), eligible=(VEHICLE,))
    daa = Daa(WellClear(150.0, 30.0, 15.0, 0.0))
    frame = Frame(37.1, -76.4)
    return Mission(
        "trace", "the scene of a trace", frame, (vehicle,), (task,), daa, instances=(VEHICLE,)
    )


def with_breeze(known: Mission, now_ms: int) -> tuple[Mission, Change]:
    """The mission with a new wind from now on, different from the last, so that UxAS replans."""
    strength = BREEZE_M_S * (1 + len(known.changes) % 2)
    change = WindChange(now_ms, WIND, north_m_s=strength)
    return replace(known, changes=(*known.changes, change)), change


def met(air: AirState) -> AirState:
    """An aircraft approaching head-on, at the same altitude and speed."""
    north_m = air.position.north_m + NEAR_M * math.cos(air.heading_rad)
    east_m = air.position.east_m + NEAR_M * math.sin(air.heading_rad)
    return air._replace(
        position=Position(north_m, east_m, air.position.alt_m),
        heading_rad=math.remainder(air.heading_rad + math.pi, 2 * math.pi),
        climb_m_s=0.0,
    )
