"""Whether zones together separate two places: every path between them would meet a boundary. Exact.

The boundaries that bar a band of altitudes are cut where they meet each other. A closed curve of such parts that winds
around one place an odd number of times, and around the other an even number, is met by every path between them. Whether
there is one is decided by giving every part its crossings of the rays from both places (`crosses_ray`), and following
all parts from one end: two ways to one point with different parity close such a curve. Rationals throughout.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from fractions import Fraction

from cratous.core.geofence.planar import crosses_ray, edges_of, on_segment, orient, segments_meet
from cratous.core.kernel import Vec2
from cratous.spec.mission import Position, Zone, ZoneKind

MOST_EDGES = 400
"""With more edges than this nothing is decided."""

Edge = tuple[Vec2, Vec2]
Part = tuple[Vec2, bool]
"""The other end of a part of a boundary, and whether it separates: it crosses one of the two rays."""


def separating(
    start: Position, goal: Position, zones: Sequence[Zone], low_m: float, high_m: float
) -> tuple[int, ...]:
    """Ids of zones whose boundaries together separate two places, for flight from low_m to high_m [m MSL]; () if no
    such zones were found. ValueError if a zone has padding.

    A keep-out zone bars the band if its floor is below and its ceiling above it; a keep-in zone's boundary bars every
    altitude. The places must be on no boundary.
    """
    edges = list[tuple[int, Edge]]()
    for zone in zones:
        if zone.padding_m != 0:
            raise ValueError(f"zone {zone.id}: padding must be turned into vertices first")
        bars = zone.floor_m < low_m and high_m < zone.ceiling_m
        if zone.kind is ZoneKind.KEEP_IN or bars:
            corners = [(Fraction(n), Fraction(e)) for n, e in zone.vertices]
            edges += [(zone.id, edge) for edge in edges_of(corners)]  # type: ignore[arg-type]
    ends = _exact(start), _exact(goal)
    if len(edges) > MOST_EDGES or any(on_segment(p, *edge) for p in ends for _, edge in edges):
        return ()
    graph = dict[Vec2, list[Part]]()
    owners = dict[Vec2, set[int]]()
    for (zone_id, edge), cuts in zip(edges, _cuts(edges), strict=True):
        a, b = edge
        along = sorted(
            {a, b, *cuts}, key=lambda x: (x.x - a.x) * (b.x - a.x) + (x.y - a.y) * (b.y - a.y)
        )
        for c, d in itertools.pairwise(along):
            parts = crosses_ray(ends[0], c, d) != crosses_ray(ends[1], c, d)
            graph.setdefault(c, []).append((d, parts))
            graph.setdefault(d, []).append((c, parts))
        for c in along:
            owners.setdefault(c, set()).add(zone_id)
    return _odd(graph, owners)


def _exact(p: Position) -> Vec2:
    return Vec2(Fraction(p.north_m), Fraction(p.east_m))  # type: ignore[arg-type]


def _cuts(edges: Sequence[tuple[int, Edge]]) -> list[list[Vec2]]:
    """For each edge the points where edges of other zones meet it."""
    cuts = [list[Vec2]() for _ in edges]
    boxes = [(min(a.x, b.x), max(a.x, b.x), min(a.y, b.y), max(a.y, b.y)) for _, (a, b) in edges]
    for i, (one, (a, b)) in enumerate(edges):
        low_x, high_x, low_y, high_y = boxes[i]
        for j in range(i + 1, len(edges)):
            other, (c, d) = edges[j]
            box = boxes[j]
            apart = box[0] > high_x or box[1] < low_x or box[2] > high_y or box[3] < low_y
            if one == other or apart or not segments_meet(a, b, c, d):
                continue
            for point in _common(a, b, c, d):
                cuts[i].append(point)
                cuts[j].append(point)
    return cuts


def _common(a: Vec2, b: Vec2, c: Vec2, d: Vec2) -> list[Vec2]:
    """Points common to two edges that meet: the crossing, or the ends that lie on the other edge."""
    across = (b.x - a.x) * (d.y - c.y) - (b.y - a.y) * (d.x - c.x)
    if across == 0:
        return [p for p in (a, b) if on_segment(p, c, d)] + [
            p for p in (c, d) if on_segment(p, a, b)
        ]
    share = orient(c, d, a) / across
    return [Vec2(a.x + share * (b.x - a.x), a.y + share * (b.y - a.y))]


def _odd(graph: dict[Vec2, list[Part]], owners: dict[Vec2, set[int]]) -> tuple[int, ...]:
    """The zones of a connected part of the boundaries with a closed curve that separates; () without one."""
    parity = dict[Vec2, bool]()
    for first in graph:
        if first in parity:
            continue
        parity[first], heap, met, odd = False, [first], set[int](), False
        while heap:
            at = heap.pop()
            met |= owners[at]
            for to, parts in graph[at]:
                reached = parity[at] != parts
                if to not in parity:
                    parity[to] = reached
                    heap.append(to)
                odd = odd or parity[to] != reached
        if odd:
            return tuple(sorted(met))
    return ()
