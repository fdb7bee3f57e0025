"""The intruder that an aircraft coordinates with, and on which sides: the most urgent one.

Urgency strategies: NONE, no intruder; FIXED, the aircraft of that id; DCPA, the intruder that enters the smallest
cylinder with the proportions of an NMAC, or, of those that enter the NMAC cylinder, the earliest.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from cratous.core.daa.coordination import (
    enters_cylinder,
    horizontal_side,
    more_urgent,
    vertical_side,
)
from cratous.core.daa.state import Aircraft, Coordination
from cratous.core.kernel import Vec2, driver
from cratous.spec.daa.parameters import DCPA, FIXED, NMAC_HALF_HEIGHT_M, NMAC_RADIUS_M, Parameters


def _relative(own: Aircraft, other: Aircraft) -> tuple[Vec2, Vec2, float, float]:
    return (
        Vec2(own.east_m - other.east_m, own.north_m - other.north_m),
        Vec2(own.ve_m_s - other.ve_m_s, own.vn_m_s - other.vn_m_s),
        own.alt_m - other.alt_m,
        own.vu_m_s - other.vu_m_s,
    )


def nearest(own: Aircraft, other: Aircraft) -> tuple[float, float]:
    """The closest approach in straight flight: the least size, squared, of the NMAC-shaped cylinder that the intruder
    enters (1: the NMAC cylinder itself), and when [s].

    The size at an instant is the greater of two parabolas; its minimum lies now, at the vertex of one of them, or
    where they cross. Distances and speeds are 0 or above 1e-100, so that squares do not underflow.
    """
    s, v, sz, vz = _relative(own, other)
    dd, hh = NMAC_RADIUS_M**2, NMAC_HALF_HEIGHT_M**2
    level = (
        (v.x * v.x + v.y * v.y) / dd,
        (s.x * v.x + s.y * v.y) / dd,
        (s.x * s.x + s.y * s.y) / dd,
    )
    upright = (vz * vz / hh, sz * vz / hh, sz * sz / hh)
    a, b, c = (x - y for x, y in zip(level, upright, strict=True))
    times = [0.0]
    times += [-half / square for square, half, _ in (level, upright) if square > 0]
    if a != 0 and b * b >= a * c:
        # the root without cancellation, and the other from the product of both
        root = -b - math.copysign(math.sqrt(b * b - a * c), b)
        times += [root / a, c / root if root else 0.0]
    elif a == 0 and b != 0:
        times.append(-c / (2 * b))

    def size(t: float) -> float:
        x, y, z = s.x + t * v.x, s.y + t * v.y, sz + t * vz
        return max((x * x + y * y) / dd, z * z / hh)

    return min((size(t), t) for t in times if t >= 0 and math.isfinite(t))


@driver(checked_by=("more_urgent",))
def most_urgent(p: Parameters, own: Aircraft, others: Sequence[Aircraft]) -> int:
    """The index of the most urgent intruder by the strategy of the parameters; -1: there is none."""
    if p.urgency_strategy == FIXED:
        return next((i for i, o in enumerate(others) if o.id == p.most_urgent_aircraft), -1)
    if p.urgency_strategy != DCPA or not others:
        return -1
    found, best = 0, nearest(own, others[0])
    for i in range(1, len(others)):
        candidate = nearest(own, others[i])
        if more_urgent(*candidate, *best):
            found, best = i, candidate
    return found


@driver(checked_by=("horizontal_side", "vertical_side", "enters_cylinder"))
def coordination(p: Parameters, own: Aircraft, others: Sequence[Aircraft]) -> Coordination | None:
    """The intruder to coordinate with, and the sides; None if a criterion is off or no intruder is urgent."""
    if not (p.conflict_crit or p.recovery_crit):
        return None
    i = most_urgent(p, own, others)
    if i < 0:
        return None
    s, v, sz, vz = _relative(own, others[i])
    enters = enters_cylinder(s, v, sz, vz, NMAC_RADIUS_M, NMAC_HALF_HEIGHT_M)
    vv, sv = v.x * v.x + v.y * v.y, s.x * v.x + s.y * v.y
    together = s.x == 0 and s.y == 0 and sz == 0
    above = vertical_side(sz, vz, vv, sv, together, enters, own.id < others[i].id)
    return Coordination(others[i].id, horizontal_side(s, v), above)


def sides(found: Coordination | None, others: Sequence[Aircraft]) -> np.ndarray:
    """(n, 2) sides to keep to, horizontal and vertical; 0 for all but the most urgent."""
    made = np.zeros((len(others), 2), dtype=np.int64)
    for i, other in enumerate(others):
        if found is not None and other.id == found.id:
            made[i] = found.horizontal, found.vertical
    return made
