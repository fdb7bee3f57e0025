"""The nearest point that is inside or outside of a polygon by a distance: proposed by geometry on doubles, proved by kernels.

A nearest point that is at least the distance from the boundary lies on an edge shifted by it, or on a circle of it about
a vertex: at the foot of the given point there, or where two of these curves cross. All of these are computed, and the
nearest one is taken that the exact kernels accept.
"""

from __future__ import annotations

import numpy as np

from cratous.core.geofence.arrays import boundary_against as against
from cratous.core.geofence.arrays import places_in_polygon
from cratous.core.geofence.distance import boundary_against
from cratous.core.geofence.planar import locate
from cratous.core.geofence.shapes import Place, Polygon
from cratous.core.kernel import Vec2, driver
from cratous.core.readings.exact import exact

GRAIN = 1e-9
"""By this share of the largest coordinate or distance candidates are moved away from the boundary, for rounding."""
AT_ONCE = 512
"""Candidates that are checked at a time."""
Found = tuple[float, float]


@driver(checked_by=("locate", "boundary_against"))
def recovery(x: float, y: float, shape: Polygon, distance_m: float, wanted: Place) -> Found | None:
    """The nearest point with this place (INSIDE, OUTSIDE) that is at least distance_m [m] from the boundary; None if
    no candidate is.
    """
    scale = max(1.0, abs(x), abs(y), distance_m, *(float(np.abs(c).max()) for c in shape.columns))
    widths = [distance_m + GRAIN * scale, distance_m]
    found = np.array([(x, y), *(row for d in widths for row in _candidates(x, y, shape, d))])
    order = np.argsort(np.hypot(found[:, 0] - x, found[:, 1] - y), kind="stable")
    found = found[order]
    for k in range(0, len(found), AT_ONCE):
        block = found[k : k + AT_ONCE]
        block = block[_roughly(block, shape, distance_m - GRAIN * scale)]
        if not len(block):
            continue
        here = places_in_polygon(block[:, 0], block[:, 1], shape) == wanted
        clear = here & (against(block[:, 0], block[:, 1], np.array(distance_m), shape) >= 0)
        for px, py in block[clear].tolist():
            point = Vec2(px, py)
            place = exact(locate, shape.edges, point)
            if place == wanted and exact(boundary_against, shape.edges, point, distance_m) >= 0:
                return px, py
    return None


def _roughly(points: np.ndarray, shape: Polygon, least_m: float) -> np.ndarray:
    """Which points may be that far from the boundary: on doubles, to save the exact checks of the others."""
    kept = np.ones(len(points), np.bool_)
    ax, ay, bx, by = shape.columns
    # few edges refuse most candidates
    for some in (slice(None, None, max(1, len(ax) // 16)), slice(None)):
        left = points[kept]
        dx, dy = (bx - ax)[some], (by - ay)[some]
        px, py = left[:, :1] - ax[some], left[:, 1:] - ay[some]
        t = np.clip((px * dx + py * dy) / (dx * dx + dy * dy), 0.0, 1.0)
        kept[kept] = (np.hypot(px - t * dx, py - t * dy) >= least_m).all(axis=1)
    return kept


def _candidates(x: float, y: float, shape: Polygon, d: float) -> np.ndarray:
    """Points at the distance d from an edge or vertex that may be the nearest one, as rows."""
    ax, ay, bx, by = shape.columns
    length = np.hypot(bx - ax, by - ay)
    ux, uy = (bx - ax) / length, (by - ay) / length
    # both sides of each edge: start, direction, length
    sx = np.concatenate([ax - d * uy, ax + d * uy])
    sy = np.concatenate([ay + d * ux, ay - d * ux])
    ux, uy, length = np.tile(ux, 2), np.tile(uy, 2), np.tile(length, 2)
    t = np.clip((x - sx) * ux + (y - sy) * uy, 0.0, length)
    gone = np.hypot(x - ax, y - ay)
    share = np.divide(d, gone, out=np.zeros_like(gone), where=gone > 0)
    parts = [
        (sx + t * ux, sy + t * uy),
        (ax + share * (x - ax), ay + share * (y - ay)),
        _lines_cross(sx, sy, ux, uy, length),
        _circles_and_lines(ax, ay, d, (sx, sy, ux, uy, length)),
        _circles_cross(ax, ay, d),
    ]
    found = np.concatenate([np.stack(part, axis=1) for part in parts])
    finite: np.ndarray = found[np.isfinite(found).all(axis=1)]
    return finite


def _lines_cross(
    sx: np.ndarray, sy: np.ndarray, ux: np.ndarray, uy: np.ndarray, length: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    turn = ux[:, None] * uy[None] - uy[:, None] * ux[None]
    i, j = np.nonzero(np.triu(turn != 0, 1))
    dx, dy, turn = sx[j] - sx[i], sy[j] - sy[i], turn[i, j]
    t, s = (dx * uy[j] - dy * ux[j]) / turn, (dx * uy[i] - dy * ux[i]) / turn
    # a little beyond the ends too: rounding must not lose a crossing at an end
    on = (np.abs(t - length[i] / 2) <= length[i] * 0.501) & (
        np.abs(s - length[j] / 2) <= length[j] * 0.501
    )
    i, t = i[on], t[on]
    return sx[i] + t * ux[i], sy[i] + t * uy[i]


def _circles_and_lines(
    cx: np.ndarray, cy: np.ndarray, d: float, lines: tuple[np.ndarray, ...]
) -> tuple[np.ndarray, np.ndarray]:
    sx, sy, ux, uy, length = lines
    foot = (cx[:, None] - sx) * ux + (cy[:, None] - sy) * uy
    aside = (cx[:, None] - sx) * uy - (cy[:, None] - sy) * ux
    square = d * d - aside * aside
    near = (square >= 0) & (foot >= -2 * d) & (foot <= length + 2 * d)
    _, j = np.nonzero(near)
    half, foot = np.sqrt(square[near]), foot[near]
    t = np.concatenate([foot - half, foot + half])
    j = np.tile(j, 2)
    return sx[j] + t * ux[j], sy[j] + t * uy[j]


def _circles_cross(cx: np.ndarray, cy: np.ndarray, d: float) -> tuple[np.ndarray, np.ndarray]:
    dx, dy = cx[None] - cx[:, None], cy[None] - cy[:, None]
    apart = np.hypot(dx, dy)
    i, j = np.nonzero(np.triu((apart > 0) & (apart <= 2 * d), 1))
    dx, dy, apart = dx[i, j], dy[i, j], apart[i, j]
    high = np.sqrt(np.maximum(d * d - apart * apart / 4, 0.0))
    mx, my, nx, ny = cx[i] + dx / 2, cy[i] + dy / 2, -dy / apart * high, dx / apart * high
    return np.concatenate([mx + nx, mx - nx]), np.concatenate([my + ny, my - ny])
