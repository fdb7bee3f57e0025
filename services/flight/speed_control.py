"""Flight speed to be on time, within bounds around the planned speed.

These are only requests of the executive; the kernel `row_holds` (`services.flight.timing`) decides whether a
task may start and whether a bound is broken.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping

from cratous.services.flight.timing import broken_by
from cratous.spec.constraint_rows import Row
from cratous.spec.mission import Vehicle
from cratous.spec.mission.plan import PlanItem

SLOWEST, FASTEST = 0.8, 1.06
"""Bounds of the speed adaptation, as factors of the planned speed."""


def trimmed_speed_m_s(
    item: PlanItem, vehicle: Vehicle, left_m: float, spare_ms: float, hurry: bool
) -> float:
    """Speed [m/s] at which the start pose is passed in spare_ms, after whole laps of the hold.

    left_m: remaining way to the start pose [m]; hurry: some deadline is tight. Without a hold, or with no
    time to spare, the planned speed (with hurry the fastest one).
    """
    low = max(vehicle.min_speed_m_s, SLOWEST * item.speed_m_s)
    high = max(low, min(vehicle.max_speed_m_s, FASTEST * item.speed_m_s))
    speed = high if hurry else item.speed_m_s
    if item.hold is not None and spare_ms > 1000 * left_m / item.speed_m_s:
        lap_m = 2 * math.pi * item.hold.radius_m
        laps = max(0, math.ceil((spare_ms * low / 1000 - left_m) / lap_m))
        speed = 1000 * (left_m + laps * lap_m) / spare_ms
    return min(max(speed, low), high)


def broken_rows(
    rows: Iterable[Row],
    starts: Mapping[int, int],
    ends: Mapping[int, int],
    settled: Collection[int],
) -> list[tuple[int, Row]]:
    """Unsettled tasks that would break an upper bound at these times [ms], each with the row."""
    rows, found = tuple(rows), []
    for task_id in sorted(ends):
        if task_id not in settled:
            row = broken_by(task_id, starts.get(task_id, 0), ends[task_id], rows, starts, ends)
            if row is not None:
                found.append((task_id, row))
    return found
