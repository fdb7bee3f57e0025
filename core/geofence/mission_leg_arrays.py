"""Legs against all zones at once: the zone kernels in loops over arrays, for thousands of paths.

The kernels are those of `core.geofence.planar`, step by step as their folds run them; only edges that change nothing
in the folds are skipped (`core.geofence.mission_legs`). CPython runs these functions directly;
`core.readings.machine.compiled.machine` compiles the same text.
"""

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from cratous.core.geofence.planar import (
    Seen,
    contact_step,
    keep_in_leg_ok,
    keep_out_leg_ok,
    location_result,
    location_step,
)
from cratous.core.kernel import Vec2
from cratous.spec.mission import Zone, ZoneKind


@lru_cache(maxsize=64)
def table(zones: tuple[Zone, ...]) -> tuple[np.ndarray, ...]:
    """Zones as arrays: (keep_out, floor, ceiling, boxes, first, edges).

    boxes (n, 4): south, north, west, east; the edges of zone k are first[k] to first[k + 1], each
    north, east, north, east. ValueError if a zone still has padding.
    """
    boxes, first, edges = np.empty((len(zones), 4)), [0], []
    for k, zone in enumerate(zones):
        if zone.padding_m != 0:
            raise ValueError(f"zone {zone.id}: padding must be turned into vertices first")
        corners = list(zone.vertices)
        edges += [(*p, *q) for p, q in zip(corners, corners[1:] + corners[:1], strict=True)]
        first.append(len(edges))
        array = np.array(corners, float)
        boxes[k] = (
            *(f(array[:, 0]) for f in (np.min, np.max)),
            *(f(array[:, 1]) for f in (np.min, np.max)),
        )
    return (
        np.array([zone.kind is ZoneKind.KEEP_OUT for zone in zones], np.bool_),
        np.array([zone.floor_m for zone in zones], float),
        np.array([zone.ceiling_m for zone in zones], float),
        boxes,
        np.array(first, np.int64),
        np.array(edges, float).reshape(-1, 4),
    )


def leg_zone(
    pn: float, pe: float, pa: float, qn: float, qe: float, qa: float, zones: tuple[np.ndarray, ...]
) -> int:
    """The first zone that the straight leg from p to q breaks, or -1. North, east, altitude [m]."""
    keep_out, floor, ceiling, boxes, first, edges = zones
    # CPython computes with its own numbers twice as fast as with those of arrays
    pn, pe, pa, qn, qe, qa = float(pn), float(pe), float(pa), float(qn), float(qe), float(qa)
    low, high = min(pa, qa), max(pa, qa)
    south, north = min(pn, qn), max(pn, qn)
    west, east = min(pe, qe), max(pe, qe)
    p, q, unseen = Vec2(pn, pe), Vec2(qn, qe), Seen(False, False)
    for z in range(len(keep_out)):
        # not a literal: the compiler would compile `contact_step`, with all that it calls, again
        seen, met = unseen, bool(0)
        apart = north < float(boxes[z, 0]) or south > float(boxes[z, 1])
        if not (apart or east < float(boxes[z, 2]) or west > float(boxes[z, 3])):
            for k in range(first[z], first[z + 1]):
                ae, be = float(edges[k, 1]), float(edges[k, 3])
                first_e, last_e = min(ae, be), max(ae, be)
                if first_e > east or last_e < west:
                    continue
                an, bn = float(edges[k, 0]), float(edges[k, 2])
                a, b = Vec2(an, ae), Vec2(bn, be)
                if first_e <= pe and pe <= last_e:
                    seen = location_step(seen, a, b, p)
                if min(an, bn) <= north and max(an, bn) >= south:
                    met = contact_step(met, a, b, p, q)
        where = location_result(seen)
        if keep_out[z]:
            fine = keep_out_leg_ok(where, met, low, high, float(floor[z]), float(ceiling[z]))
        else:
            fine = keep_in_leg_ok(where, met, low, high, float(floor[z]), float(ceiling[z]))
        if not fine:
            return z
    return -1


def first_bad(points: np.ndarray, zones: tuple[np.ndarray, ...]) -> tuple[int, int]:
    """The first leg of a path that breaks a zone, and the zone; (-1, -1) if none does.

    points: shape (n, 3), n >= 1; one point is a leg from that point to itself.
    """
    if len(zones[0]) == 0:
        return -1, -1
    pn, pe, pa = float(points[0, 0]), float(points[0, 1]), float(points[0, 2])
    for k in range(max(len(points) - 1, 1)):
        j = min(k + 1, len(points) - 1)
        qn, qe, qa = float(points[j, 0]), float(points[j, 1]), float(points[j, 2])
        zone = leg_zone(pn, pe, pa, qn, qe, qa, zones)
        if zone >= 0:
            return k, zone
        pn, pe, pa = qn, qe, qa
    return -1, -1


def as_points(path: Sequence[Any]) -> np.ndarray:
    """Positions or poses as an array of north, east, altitude."""
    return np.array([tuple(p)[:3] for p in path], float)
