"""Whether flown legs obey the zones: the proved polygon kernels, applied to mission data.

A zone comes here with its padding already turned into vertices; one that still carries padding
is refused, because a check without it would mean less than it says.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

from cratous.core.kernel import Vec2, driver
from cratous.core.polygon import edges_of, keep_in_leg_ok, keep_out_leg_ok, locate, meets_boundary
from cratous.spec.mission import Position, Zone, ZoneKind

Edges = tuple[tuple[Vec2, Vec2], ...]


@lru_cache(maxsize=512)
def _shape(
    vertices: tuple[tuple[float, float], ...], number: type
) -> tuple[Edges, float, float, float, float]:
    """Edges and bounding box (lowest and highest north, lowest and highest east).

    number: type of the coordinates, so that floats and equal rationals are remembered apart.
    """
    norths, easts = [v[0] for v in vertices], [v[1] for v in vertices]
    return edges_of(vertices), min(norths), max(norths), min(easts), max(easts)


@driver(checked_by=("keep_out_leg_ok", "keep_in_leg_ok", "locate", "meets_boundary"))
def leg_ok(p: Position, q: Position, zone: Zone) -> bool:
    """True iff the straight leg from p to q obeys the zone. ValueError if the zone has padding.

    The bounding box spares the polygon only where the answer is plain: a keep-out whose box the
    leg's box does not touch.
    """
    if zone.padding_m != 0:
        raise ValueError(f"zone {zone.id}: padding must be turned into vertices first")
    edges, low_n, high_n, low_e, high_e = _shape(zone.vertices, type(zone.vertices[0][0]))
    low, high = min(p.alt_m, q.alt_m), max(p.alt_m, q.alt_m)
    keep_out = zone.kind is ZoneKind.KEEP_OUT
    apart = (
        max(p.north_m, q.north_m) < low_n
        or min(p.north_m, q.north_m) > high_n
        or max(p.east_m, q.east_m) < low_e
        or min(p.east_m, q.east_m) > high_e
    )
    if keep_out and apart:
        return keep_out_leg_ok(-1, False, low, high, zone.floor_m, zone.ceiling_m)
    a, b = Vec2(p.north_m, p.east_m), Vec2(q.north_m, q.east_m)
    where, meets = locate(edges, a), meets_boundary(edges, a, b)
    holds = keep_out_leg_ok if keep_out else keep_in_leg_ok
    return holds(where, meets, low, high, zone.floor_m, zone.ceiling_m)


def first_bad_leg(path: Sequence[Position], zones: Sequence[Zone]) -> tuple[int, Zone] | None:
    """Index of the first leg (path[i], path[i + 1]) that breaks a zone, and the zone; else None.

    A path of one point is a leg from that point to itself.
    """
    legs = [(path[0], path[0])] if len(path) == 1 else list(zip(path, path[1:], strict=False))
    for index, (p, q) in enumerate(legs):
        for zone in zones:
            if not leg_ok(p, q, zone):
                return index, zone
    return None
