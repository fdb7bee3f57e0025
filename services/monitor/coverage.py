"""How much of a search the sensors saw: from the footprints that the vehicles reported.

A point of a line (sampled at most 10 m apart) or the one point of a point search is seen when it
lies in a reported footprint or on its edge, by the kernel `locate`. An area is divided into
squares; one is seen when it lies entirely in one footprint, by the kernel `square_within`, and
squares not seen count in full against the search: the fraction given is a lower bound.
`monitor.counted_footprints` states which footprints count for a task.
"""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import pairwise
from typing import Any

from cratous.core.geofence.planar import edges_of, locate
from cratous.core.kernel import Vec2, qualified
from cratous.core.tasks.coverage import (
    area_m2,
    look,
    outline,
    share_covered,
    square_array,
    square_side_m,
)
from cratous.core.tasks.coverage_arrays import mark_seen
from cratous.core.tasks.coverage_steps import enough_seen
from cratous.services.mission.frames import Projection
from cratous.services.monitor.counted_footprints import Look, counts, looks_of
from cratous.spec.mission import AREAS, SEARCHES, Mission, Task

SAMPLE_M = 10.0


def sample(task: Task) -> list[tuple[float, float]]:
    """Points (north, east) of the task's line, or its one point."""
    corners = [(p.north_m, p.east_m) for p in task.points]
    if len(corners) == 1:
        return corners
    found = []
    for a, b in pairwise(corners):
        count = max(1, math.ceil(math.dist(a, b) / SAMPLE_M))
        found += [
            (a[0] + (b[0] - a[0]) * k / count, a[1] + (b[1] - a[1]) * k / count)
            for k in range(count)
        ]
    return [*found, corners[-1]]


class _Area:
    """The cells of one area that have not been observed yet."""

    def __init__(self, task: Task) -> None:
        import numpy as np

        vertices = outline(task)
        self._area_m2, self._side_m = area_m2(vertices), square_side_m(vertices)
        self._centres = square_array(vertices, self._side_m)
        self._seen = np.zeros(len(self._centres), np.bool_)

    def look(self, corners: list[tuple[float, float]]) -> None:
        """Remove the squares that lie within a footprint (north, east)."""
        look(self._centres, self._side_m, [corners], self._seen)

    def fraction(self) -> float:
        """Lower bound of the fraction that has been seen."""
        return share_covered(self._unseen(), self._side_m, self._area_m2)

    def sizes(self) -> tuple[Fraction, Fraction]:
        """(upper bound of the unseen area, total area) [m2]."""
        side, whole = Fraction(self._side_m), Fraction(self._area_m2)
        return self._unseen() * side * side, whole

    def _unseen(self) -> int:
        return int((~self._seen).sum())


class CoverageWatch:
    """Coverage of every search task."""

    def __init__(self, mission: Mission) -> None:
        self._projection = Projection(mission.frame)
        self._cameras = {vehicle.id: vehicle.cameras for vehicle in mission.vehicles}
        searches = [t for t in mission.tasks if t.kind in SEARCHES]
        self._tasks = {t.id: t for t in searches}
        self._areas = {t.id: _Area(t) for t in searches if t.kind in AREAS}
        self._unseen = {t.id: sample(t) for t in searches if t.kind not in AREAS}
        self.looked: set[int] = set()
        """Tasks for which some footprint has been checked."""
        self.kernels: dict[int, str] = {}
        """Kernel that decided the coverage of each task of which anything may have been seen."""
        self._total = {task: len(points) for task, points in self._unseen.items()}

    def state(self, body: Any, active: list[int]) -> None:
        """Process a vehicle state with its payloads while the vehicle performs the `active` tasks."""
        open_ = [t for t in active if t in self._areas or self._unseen.get(t)]
        if not open_:
            return
        for one in looks_of(body, self._cameras.get(body.ID, ()), self._projection):
            self.looked |= set(open_)
            for task in open_:
                if counts(one, self._tasks[task]):
                    self._look(task, one)

    def _look(self, task: int, one: Look) -> None:
        quad = list(one.corners)
        if task in self._areas:
            self.kernels[task] = qualified(mark_seen)
            self._areas[task].look(quad)
            return
        (south, west), (north, east) = (
            [pick(p[k] for p in quad) for k in (0, 1)] for pick in (min, max)
        )
        near = [p for p in self._unseen[task] if south <= p[0] <= north and west <= p[1] <= east]
        if near:
            edges, self.kernels[task] = edges_of(quad), qualified(locate)
            seen = {p for p in near if locate(edges, Vec2(*p)) >= 0}
            self._unseen[task] = [p for p in self._unseen[task] if p not in seen]

    def served(self, task: int) -> bool:
        """Whether enough of a search has been seen (kernel `enough_seen`)."""
        unseen: Any
        whole: Any
        if task in self._areas:
            unseen, whole = self._areas[task].sizes()
        else:
            unseen, whole = len(self._unseen[task]), self._total[task]
        return enough_seen(unseen, whole)

    def fraction(self, task: int) -> float | None:
        """Fraction of a search task covered so far, 0 to 1; None for other tasks."""
        if task in self._areas:
            return self._areas[task].fraction()
        if task not in self._total:
            return None
        return 1 - len(self._unseen[task]) / self._total[task]
