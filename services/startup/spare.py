"""What a process that has nothing to do yet does for its first request: reads compiled loops, and plans a little.

Each piece is short, so that a request which comes meanwhile waits for no more than it would have taken itself.
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
from cratous.services.pipeline.contexts import Contexts
from cratous.services.planning.assign_warm import read
from cratous.services.startup.little_missions import TASKS, plan
from cratous.services.uxas.message_source import MessageSource

_LOOPS: tuple[Callable[..., Any], ...] = (
    words, legs, legs_length, route_points, direct_many, route_many, first_bad, grid_squares, mark_seen,
    nearest_on_line, points_in_quads,
)  # fmt: skip


_FEW = {"PointSearchTask", "ImpactPointSearchTask", "MustFlyTask", "LoiterTask", "WatchTask"}
"""Kinds of which one task among no zones needs no machine code."""
_SORTS = ("task", "zone", "region", "configuration", "state", "point", "line", "area")
WITHOUT_TASKS_S = 10.0
"""Where nobody tells a task for so long, everything is read."""


def pieces(contexts: Contexts | None = None) -> Iterator[bool]:
    """Each piece is done when the next one is asked for: True; False where there is nothing to do for now.

    What has been told says what is to be done: options of the tasks that are known, for the vehicles that are known, and
    machine code if they need it, which takes as much memory as all the rest. contexts: who knows; None: nobody does.
    """
    source = None if contexts is None else contexts.source
    if contexts is None or not isinstance(source, MessageSource):
        yield from _read()
        return
    until_s = time.monotonic() + WITHOUT_TASKS_S
    plan(TASKS[:1], zone="")
    yield True
    told = Told(contexts, source)
    while not told.much and (told.any or not is_due(until_s, time.monotonic())):
        yield from told.options()
    for piece in _read():
        yield from told.options(piece)
    while True:
        yield from told.options()


class Told:
    """What the messages have told so far, and what is made of it."""

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
        """Those of the tasks that are known, one task at a time, and ways between them, if more is known than was; `done`."""
        counts = self._counts()
        inputs = None if counts == self._made else self._source.foreseen()
        self._made = counts
        if inputs is not None:
            self._contexts.expect(inputs)
            for task in inputs.mission.tasks:
                inputs.make_options(task.id)
                yield True
            yield from (True for _ in inputs.find_ways())
        yield done


def _read() -> Iterator[bool]:
    """Every compiled loop, and small missions."""
    for loop in _LOOPS:
        swift(loop, SOON + 1)  # as if it had done much: it is read, if it is kept
        yield True
    for chosen in (*((task,) for task in TASKS), TASKS):
        plan(chosen)
        yield True
    read()
    yield True
