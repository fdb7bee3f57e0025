"""Work of an idle process before its first request: loading compiled loops, and small plans.

Each piece is short, so that a request arriving meanwhile waits no longer than it would otherwise have spent
on that work.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Any

from cratous.bridge.port import is_due
from cratous.core.geofence.mission_leg_arrays import first_bad
from cratous.core.readings.tiered import SOON, swift
from cratous.core.routing.bulk import direct_many, route_many, route_points
from cratous.core.routing.dubins_words import legs, legs_length, words
from cratous.core.tasks.coverage_arrays import grid_squares, mark_seen
from cratous.core.tasks.footprints import nearest_on_line, points_in_quads
from cratous.services.loading.polygons import polygon_problem
from cratous.services.pipeline.contexts import Contexts
from cratous.services.planning.assign_warm import read
from cratous.services.startup.sample_missions import TASKS, plan
from cratous.services.uxas.message_source import MessageSource

_LOOPS: tuple[Callable[..., Any], ...] = (
    words, legs, legs_length, route_points, direct_many, route_many, first_bad, grid_squares, mark_seen,
    nearest_on_line, points_in_quads,
)  # fmt: skip


_FEW = {"PointSearchTask", "ImpactPointSearchTask", "MustFlyTask", "LoiterTask", "WatchTask"}
"""Kinds of which a single task without zones needs no machine code."""
_SORTS = ("task", "zone", "region", "configuration", "state", "point", "line", "area")
_SQUARE = ((0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0))
"""An area with which the check of polygons is made ready."""
WITHOUT_TASKS_S = 10.0
"""Without any task for this long, everything is loaded [s]."""


def pieces(contexts: Contexts | None = None) -> Iterator[bool]:
    """Each piece is executed when the next one is requested. Yields True for a piece, False if there is
    nothing to do.

    What is known so far determines the work: options of the known tasks for the known vehicles, and machine
    code if they need it, which takes as much memory as everything else. contexts: what is known; None:
    nothing.
    """
    source = None if contexts is None else contexts.source
    if contexts is None or not isinstance(source, MessageSource):
        yield from _read()
        return
    until_s = time.monotonic() + WITHOUT_TASKS_S
    plan(TASKS[:1], zone="")
    polygon_problem(_SQUARE)
    yield True
    told = Told(contexts, source)
    while not told.much and (told.any or not is_due(until_s, time.monotonic())):
        yield from told.options()
    yield from told.makes()  # before any loading, which may take longer than there is time
    for piece in _read():
        yield from told.options(piece)
    while True:
        yield from told.options()


class Told:
    """What messages have reported so far, and what was computed from it."""

    def __init__(self, contexts: Contexts, source: MessageSource) -> None:
        self._contexts, self._source = contexts, source
        self._made: list[int] = []

    def _counts(self) -> list[int]:
        return [len(self._source.world.ids(sort)) for sort in _SORTS]

    @property
    def any(self) -> bool:
        """Whether there is a task."""
        return bool(self._source.world.ids("task"))

    @property
    def much(self) -> bool:
        """Whether a plan would use machine code."""
        tasks, zones = self._source.world.of("task"), self._source.world.ids("zone")
        return bool(tasks) and (
            len(tasks) > 1 or bool(zones) or type(tasks[0]).__name__ not in _FEW
        )

    def options(self, done: bool = False) -> Iterator[bool]:
        """As `makes`; finally yields `done`."""
        yield from self.makes()
        yield done

    def makes(self) -> Iterator[bool]:
        """Compute options of the known tasks, one task at a time, and routes between them, if more is known
        than before.
        """
        counts = self._counts()
        inputs = None if counts == self._made else self._source.foreseen()
        self._made = counts
        if inputs is not None:
            self._contexts.expect(inputs)
            for task in inputs.mission.tasks:
                inputs.make_options(task.id)
                yield True
            yield from (True for _ in inputs.find_ways())


def _read() -> Iterator[bool]:
    """Load every compiled loop, and plan small missions."""
    for loop in _LOOPS:
        swift(loop, SOON + 1)  # counted as heavily used: loaded if it is cached
        yield True
    for chosen in (*((task,) for task in TASKS), TASKS):
        plan(chosen)
        yield True
    read()
    yield True
