"""Tasks of kinds without a service in this process: another process's service may answer for them.

A task's service sends TaskInitialized at once. For a task whose kind has no service here, another process has
`OTHERS_MS` to do so; after that, a request with this task is answered with the name of its kind instead of
waiting for its time limit. A later TaskInitialized still counts for the next request.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import NamedTuple

from cratous.services.bus import Wake

OTHERS_MS = 1000
MOST = 10_000
"""Most tasks remembered; beyond that the oldest is dropped, and a request with it waits as for any task."""

Alien = tuple[int, int]
"""A task's id and the number of the message that announced it."""


class Unserved(NamedTuple):
    """Task kinds without a service here. waiting: those that others may still answer for; named: those
    reported as unhandled.
    """

    waiting: Mapping[Alien, str] = MappingProxyType({})
    named: Mapping[int, str] = MappingProxyType({})

    def arrived(self, task: Alien, kind: str) -> tuple[Unserved, Wake]:
        """A task of an unhandled kind has arrived. Returns when to check whether another service has
        answered.
        """
        waiting = {**self.without([task[0]]).waiting, task: kind}
        kept = dict(list(waiting.items())[-MOST:])
        return self.without([task[0]])._replace(waiting=kept), Wake(OTHERS_MS, task)

    def without(self, tasks: Iterable[int]) -> Unserved:
        """The state without these tasks: they were removed, replaced, or a service has answered for them."""
        gone = set(tasks)
        waiting = {task: kind for task, kind in self.waiting.items() if task[0] not in gone}
        return Unserved(waiting, {n: kind for n, kind in self.named.items() if n not in gone})

    def due(self, task: Alien) -> Unserved:
        """The time to answer for a task is over; no effect if it was replaced or answered for."""
        kind = self.waiting.get(task)
        if kind is None:
            return self
        left = {other: k for other, k in self.waiting.items() if other != task}
        named = dict(list({**self.named, task[0]: kind}.items())[-MOST:])
        return Unserved(left, named)

    def wakes(self) -> tuple[Wake, ...]:
        """Wake-ups for the tasks that others may still answer for; their time starts anew."""
        return tuple(Wake(OTHERS_MS, task) for task in self.waiting)
