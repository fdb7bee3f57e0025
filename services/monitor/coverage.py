"""How much of a search the sensors saw: from the footprints that the vehicles reported.

A point of a line (sampled at most 10 m apart) or the one point of a point search is seen when it
lies in a reported footprint or on its edge, by the kernel `locate`.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

from cratous.core.kernel import Vec2
from cratous.core.polygon import edges_of, locate
from cratous.services.frames import Projection
from cratous.spec.mission import Mission, Task, TaskKind

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


class CoverageWatch:
    """What has been seen of every search task."""

    def __init__(self, mission: Mission) -> None:
        self._projection = Projection(mission.frame)
        kinds = (TaskKind.LINE_SEARCH, TaskKind.POINT_SEARCH)
        self._unseen = {t.id: sample(t) for t in mission.tasks if t.kind in kinds}
        self._total = {task: len(points) for task, points in self._unseen.items()}

    def state(self, body: Any, active: list[int]) -> None:
        """A vehicle's state with its payloads, while it was doing the `active` tasks."""
        for task in active:
            if not self._unseen.get(task):
                continue
            for payload in body.PayloadStateList:
                corners = getattr(payload, "Footprint", None)
                if corners and len(corners) >= 3:
                    self._look(task, [(c.Latitude, c.Longitude) for c in corners])

    def _look(self, task: int, corners: list[tuple[float, float]]) -> None:
        quad = [self._projection.to_local(*corner) for corner in corners]
        low = [min(p[k] for p in quad) for k in (0, 1)]
        high = [max(p[k] for p in quad) for k in (0, 1)]
        edges = edges_of(quad)

        def seen(point: tuple[float, float]) -> bool:
            inside_box = all(low[k] <= point[k] <= high[k] for k in (0, 1))
            return inside_box and locate(edges, Vec2(*point)) >= 0

        self._unseen[task] = [p for p in self._unseen[task] if not seen(p)]

    def fraction(self, task: int) -> float | None:
        """Fraction seen so far; None for a task that is no search."""
        if task not in self._total:
            return None
        return 1 - len(self._unseen[task]) / self._total[task]
