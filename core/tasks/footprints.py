"""Which points lie in which footprints, and which points of a line are nearest: loops over arrays.

The kernels of `locate` decide, edge by edge, whether a point lies in a footprint; half planes only preselect
footprints. CPython runs these functions directly; `core.readings.machine.compiled.machine` compiles the same text.
"""

import math

import numpy as np

from cratous.core.geofence.planar import Seen, location_result, location_step
from cratous.core.kernel import Vec2, driver


def in_quad(n: float, e: float, quad: np.ndarray) -> bool:
    """Whether a point lies in a quadrilateral or on its edge. quad: (4, 2), north and east."""
    # half planes first: a convex footprint's corners are in clockwise order
    for j in range(4):
        an, ae = quad[j, 0], quad[j, 1]
        bn, be = quad[(j + 1) % 4, 0], quad[(j + 1) % 4, 1]
        if (bn - an) * (e - ae) - (be - ae) * (n - an) < 0:
            return False
    seen, p = Seen(False, False), Vec2(n, e)
    for j in range(4):
        a = Vec2(quad[j, 0], quad[j, 1])
        b = Vec2(quad[(j + 1) % 4, 0], quad[(j + 1) % 4, 1])
        seen = location_step(seen, a, b, p)
    return location_result(seen) >= 0


@driver(checked_by=("location_step", "location_result"))
def points_in_quads(points: np.ndarray, quads: np.ndarray, found: np.ndarray) -> None:
    """Fill `found` (n, bool): whether each point (n, 2) lies in at least one quadrilateral (m, 4, 2).

    The search begins at the footprint of the previous point; neighbours along a line share footprints.
    """
    last, m = 0, len(quads)
    for i in range(len(points)):
        found[i] = False
        for k in range(m):
            j = (last + k) % m
            if in_quad(points[i, 0], points[i, 1], quads[j]):
                found[i], last = True, j
                break


def nearest_on_line(wanted: np.ndarray, line: np.ndarray, apart: float, found: np.ndarray) -> None:
    """Fill `found` (n, int64): the point of the line (m, 2) that is nearest to each wanted point (n, 2).

    apart: upper bound of the distance between neighbours on the line, so that points that cannot be nearer than the
    nearest so far are skipped.
    """
    m, at = len(line), 0
    for i in range(len(wanted)):
        # the nearest point of the previous one is a good start: more can be skipped
        n, e = line[at, 0] - wanted[i, 0], line[at, 1] - wanted[i, 1]
        best, k = math.sqrt(n * n + e * e), 0
        while k < m:
            n, e = line[k, 0] - wanted[i, 0], line[k, 1] - wanted[i, 1]
            gap = math.sqrt(n * n + e * e)
            if gap < best:
                best, at = gap, k
            k += max(1, math.floor((gap - best) / apart)) if apart > 0 else 1
        found[i] = at
