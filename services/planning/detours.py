"""Estimate whether many routes lead around zones, before any is searched: it only decides what is compiled.

No verdict and no route depends on it: `core.routing.bulk.route_many` and `direct_many` find the same direct
routes.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from cratous.spec.mission import Mission, Zone, ZoneKind

MANY_SHARE = 0.1
"""If at least this share of straight lines crosses a zone's box, direct routes get no machine code of their
own.
"""


def many_detours(starts: np.ndarray, ends: np.ndarray, zones: Iterable[Zone]) -> bool:
    """Whether many of the straight lines between points (n, 2) of north and east cross the box of a keep-out
    zone.
    """
    crossing = np.zeros(len(starts), np.bool_)
    for zone in zones:
        if zone.kind == ZoneKind.KEEP_OUT:
            corners = np.array(zone.vertices, float)
            crossing |= _across(starts, ends, corners.min(axis=0), corners.max(axis=0))
    return len(crossing) > 0 and bool(crossing.mean() >= MANY_SHARE)


def expected(mission: Mission) -> bool:
    """`many_detours` for the routes from vehicles to tasks and between tasks, each task represented by one of
    its points.
    """
    begins = [(v.position.north_m, v.position.east_m) for v in mission.vehicles]
    to = [(p.north_m, p.east_m) for task in mission.tasks for p in task.points[:1]]
    pairs = [(a, b) for a in (*begins, *to) for b in to if a != b]
    if not pairs:
        return False
    both = np.array(pairs, float)
    return many_detours(both[:, 0], both[:, 1], mission.zones)


def _across(starts: np.ndarray, ends: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Whether each straight line meets a box: its intervals within the box in both axes overlap."""
    with np.errstate(divide="ignore", invalid="ignore"):
        one, other = (low - starts) / (ends - starts), (high - starts) / (ends - starts)
    first = np.fmax(np.fmin(one, other).max(axis=1), 0.0)
    last = np.fmin(np.fmax(one, other).min(axis=1), 1.0)
    return first <= last
