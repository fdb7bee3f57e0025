"""Containment with exact verdicts compared with shapely's `contains_xy`: one core, one run.

Star polygons of 1 km, with points in their bounding box; and points at a vertex's height or on an edge, where a
filter decides nothing. Verdicts are checked against rationals on a sample before anything is measured. Times are the
least CPU times of several rounds in which both contenders take turns, so load on the machine has little effect.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import shapely
from table import alone, least

from cratous.core import geofence
from cratous.core.geofence.planar import locate
from cratous.core.kernel import Vec2

N = 1_000_000
BOUNDARY = 20_000
ROUNDS = 9
CORNERS = (4, 10, 20, 40)


def star(rng: np.random.Generator, n: int) -> np.ndarray:
    """Corners of a random star polygon of 1 km."""
    angles, radii = np.sort(rng.random(n)) * 2 * np.pi, rng.uniform(300, 1000, n)
    return np.c_[radii * np.cos(angles), radii * np.sin(angles)]


def check(points: np.ndarray, shape: geofence.Polygon, sample: int = 100) -> None:
    """Compare the verdicts on a sample with rationals."""
    found = geofence.places(points, shape)
    edges = [
        tuple(Vec2(Fraction(v.x), Fraction(v.y)) for v in edge)  # type: ignore[arg-type]
        for edge in shape.edges
    ]
    for k in range(0, len(points), max(1, len(points) // sample)):
        x, y = map(Fraction, points[k].tolist())
        if found[k] != locate(edges, Vec2(x, y)):  # type: ignore[arg-type]
            raise SystemExit(f"point {k}: the exact reading is wrong")


def rows() -> list[tuple[str, float, str, float]]:
    """(what, ns per point, peer, ns per point of the peer)."""
    rng = np.random.default_rng(1)
    found = []
    points = rng.uniform(-1000, 1000, (N, 2))
    x, y = np.ascontiguousarray(points.T)
    peer = "shapely contains_xy, doubles"
    for n in CORNERS:
        corners = star(rng, n)
        shape, other = geofence.polygon(corners.tolist()), shapely.Polygon(corners)
        check(points, shape)
        ours, theirs = least(
            [
                lambda s=shape: geofence.places(points, s),
                lambda o=other: shapely.contains_xy(o, x, y),
            ],  # type: ignore[misc]
            ROUNDS,
            N,
        )
        found.append((f"points in a {n}-gon, exact", ours, peer, theirs))
    along = rng.random((BOUNDARY, 1))
    first = rng.integers(0, 40, BOUNDARY)
    on = corners[first] + along * (corners[(first + 1) % 40] - corners[first])
    check(on, shape)
    u, v = np.ascontiguousarray(on.T)
    ours, theirs = least(
        [lambda: geofence.places(on, shape), lambda: shapely.contains_xy(other, u, v)], 3, BOUNDARY
    )
    found.append(("points on the edges of a 40-gon, exact", ours, peer, theirs))
    return found


if __name__ == "__main__":
    raise SystemExit(alone(rows))
