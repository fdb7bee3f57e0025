"""How much of a line or an area lies outside the permitted zones: noted on a search that was not served."""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.core.routing.visibility import name_of
from cratous.core.tasks.coverage import outline
from cratous.core.tasks.outside import area_outside, points_outside
from cratous.services.loading.polygons import hard_zones
from cratous.services.monitor.coverage import sample
from cratous.spec.mission import AREAS, Mission, Task, TaskKind, Zone
from cratous.spec.mission.changes import known_at
from cratous.spec.mission.plan import percent


class Outside(NamedTuple):
    """In words, and as data: for each vehicle eligible for the search, at its altitude."""

    words: tuple[str, ...]
    data: tuple[dict[str, Any], ...]


def outside_zones(mission: Mission, task: Task, end_ms: int) -> Outside:
    """The fractions of a line or an area over which its vehicles may fly, by the zones known at
    end_ms.

    Empty if the zones exclude no part of it, and for tasks of other kinds.
    """
    if task.kind not in (TaskKind.LINE_SEARCH, *AREAS):
        return Outside((), ())
    zones = hard_zones(known_at(mission, end_ms).zones)
    may = [v for v in mission.vehicles if not task.eligible or v.id in task.eligible]
    altitudes = sorted({vehicle.cruise_alt_m for vehicle in may})
    words, data = [], []
    for alt_m in altitudes:
        cutting = [zone for zone in zones if _share(task, alt_m, (zone,)) < 1]
        if not cutting:
            continue
        share, names = _share(task, alt_m, cutting), ", ".join(map(name_of, cutting))
        vehicles = [vehicle.id for vehicle in may if vehicle.cruise_alt_m == alt_m]
        words.append(f"at {alt_m:g} m {percent(share)} of it lies outside of {names}")
        ids = [zone.id for zone in cutting]
        data.append({"vehicles": vehicles, "altitude_m": alt_m, "share": share, "zones": ids})
    return Outside(tuple(words), tuple(data))


def _share(task: Task, alt_m: float, zones: list[Zone] | tuple[Zone, ...]) -> float:
    if task.kind in AREAS:
        return area_outside(outline(task), alt_m, zones)
    return points_outside(sample(task), alt_m, zones)
