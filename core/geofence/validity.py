"""Whether vertices form a simple polygon, and if not, why and where.

Definition: `spec.geofence`: at least three different vertices, and no two edges with a point in common but the vertex
that neighbours share. Whether edges intersect is decided exactly by the kernel `edges_clash`. Vertices and edges are
numbered from 1; edge k runs from vertex k to the next one, the last one back to vertex 1.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from cratous.core.geofence.planar import edges_clash, edges_of, segments_meet
from cratous.core.kernel import Vec2, driver
from cratous.core.readings.exact import exact

Corner = tuple[float, float]


@dataclass(frozen=True)
class Fault:
    """Why vertices do not form a polygon.

    kind: `few`, `not finite`, `repeated`, `spike`, `crossing`; text: the same in words; vertices, edges: their
    numbers, from 1.
    """

    kind: str
    text: str
    vertices: tuple[int, ...] = ()
    edges: tuple[int, ...] = ()


def edge_text(k: int, count: int) -> str:
    """Edge number k + 1 of `count`, in words."""
    return f"edge {k + 1} (vertex {k + 1} to {(k + 1) % count + 1})"


def box_of(points: Sequence[tuple[Any, Any]]) -> tuple[Any, Any, Any, Any]:
    """Lowest and highest x, lowest and highest y."""
    xs, ys = [p[0] for p in points], [p[1] for p in points]
    return min(xs), max(xs), min(ys), max(ys)


def _touching(boxes: Sequence[tuple[Any, Any, Any, Any]]) -> Iterator[tuple[int, int]]:
    """Pairs i < j of boxes with a point in common (`geofence_boxes_apart_never_meet`)."""
    order = sorted(range(len(boxes)), key=lambda k: (boxes[k][0], k))
    live: list[int] = []
    for k in order:
        box = boxes[k]
        live = [j for j in live if boxes[j][1] >= box[0]]
        for j in live:
            if boxes[j][2] <= box[3] and box[2] <= boxes[j][3]:
                yield min(j, k), max(j, k)
        live.append(k)


def _verdict(kernel: Any, *args: Any) -> bool:
    """The kernel's exact verdict on doubles or rationals."""
    if any(isinstance(v, Fraction) for arg in args if isinstance(arg, tuple) for v in arg):
        return bool(kernel(*args))
    return bool(exact(kernel, *args))


@driver(checked_by=("edges_clash",))
def fault_of(vertices: Sequence[Corner]) -> Fault | None:
    """The first reason why these vertices do not form a simple polygon; None if they do.

    vertices: (x, y) in order, either orientation, not closed; doubles or rationals, any one unit. Too few vertices
    are reported first, then numbers that are not finite, repeated vertices, spikes, and crossings in the order of the
    edges.
    """
    count = len(vertices)
    if count < 3:
        text = f"{count} vertices, and a polygon has at least 3"
        return Fault("few", text, tuple(range(1, count + 1)))
    first: dict[Corner, int] = {}
    for k, corner in enumerate(vertices):
        if not all(math.isfinite(value) for value in corner):
            return Fault("not finite", "a vertex is not finite", (k + 1,))
    for k, corner in enumerate(vertices):
        if corner in first:
            text = f"vertex {k + 1} repeats vertex {first[corner] + 1}"
            return Fault("repeated", text, (first[corner] + 1, k + 1))
        first[corner] = k
    edges = edges_of(vertices)
    for i, (a, b) in enumerate(edges):
        following = (i + 1) % count
        if _verdict(edges_clash, 1, a, b, *edges[following]):
            at = following + 1
            text = f"a spike at vertex {at}: the outline turns back on itself"
            return Fault("spike", text, (at,), (i + 1, following + 1))
    # neighbours are done; every other pair whose boxes touch is checked by the kernel
    for i, j in sorted(_touching([box_of(edge) for edge in edges])):
        apart = j - i > 1 and (j + 1) % count != i
        if apart and _verdict(segments_meet, *edges[i], *edges[j]):
            text = f"{edge_text(i, count)} meets {edge_text(j, count)}"
            return Fault("crossing", text, (), (i + 1, j + 1))
    return None


__all__ = ["Corner", "Fault", "Vec2", "box_of", "edge_text", "fault_of"]
