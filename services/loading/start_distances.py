"""Vehicles that start without being well clear of each other: nothing can prevent this loss."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from itertools import combinations
from math import cos, hypot, sin
from typing import Any

from cratous.core.kernel import Vec2
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission, Vehicle

Where = Callable[[str], str]


def close_starts(mission: Mission, where: Where) -> Iterator[BadInput]:
    """A fault for each pair of vehicles, one of them protected, that starts without being well clear."""
    if mission.daa.close_starts:
        return
    for (_, a), (k, b) in combinations(enumerate(mission.vehicles), 2):
        if not (a.protected or b.protected) or not lost_at_start(mission, a, b):
            continue
        apart_m = hypot(
            a.position.north_m - b.position.north_m, a.position.east_m - b.position.east_m
        )
        item, volume = f"vehicles[{k}].position", mission.daa.well_clear
        yield BadInput(
            f"vehicles {a.id} and {b.id} start inside each other's well-clear volume",
            where=where(item),
            item=item,
            expected=f"starts that are well clear (DTHR {volume.dthr_m:g} m, ZTHR {volume.zthr_m:g} m, "
            f"TTHR {volume.tthr_s:g} s), or `close_starts: true` under daa",
            got=f"{apart_m:.1f} m apart, {abs(a.position.alt_m - b.position.alt_m):.1f} m in altitude",
        )


def lost_at_start(mission: Mission, a: Vehicle, b: Vehicle) -> bool:
    """Whether two vehicles are not well clear at the start; exact, by the kernel `violation_within`."""
    from cratous.core.well_clear import StandardThresholds, violation_within

    exact: Any = Fraction
    s = [exact(p) - exact(q) for p, q in zip(a.position, b.position, strict=True)]
    v = [exact(p) - exact(q) for p, q in zip(_velocity(a), _velocity(b), strict=True)]
    volume = mission.daa.well_clear
    limits = StandardThresholds(
        exact(volume.dthr_m), exact(volume.zthr_m), exact(volume.tthr_s), exact(volume.tcoa_s)
    )
    apart, moving, zero = Vec2(s[0], s[1]), Vec2(v[0], v[1]), exact(0)
    return bool(violation_within(apart, moving, s[2], zero, limits, zero))


def _velocity(vehicle: Vehicle) -> tuple[float, float]:
    return (
        vehicle.speed_m_s * cos(vehicle.heading_rad),
        vehicle.speed_m_s * sin(vehicle.heading_rad),
    )
