"""Tasks of kinds that no service of this process does: another's service may speak for them.

A task's service says TaskInitialized at once. Where a task manager of this process hears of a task whose
kind nobody here does, another's service has `OTHERS_MS` to speak for it; after that, a request with this
task is answered with the name of its kind, and need not wait until its time is over. Who speaks later is
heard all the same: the next request counts on it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import NamedTuple

from cratous.services.bus import Wake

OTHERS_MS = 1000
MOST = 10_000
"""Tasks that are remembered; the oldest makes room, and a request with it waits as for any task."""

Alien = tuple[int, int]
"""A task's id and the number of the message that told of it."""


class Unserved(NamedTuple):
    """Kinds by task: those that others still have time to speak for, and those that nobody has."""

    waiting: Mapping[Alien, str] = MappingProxyType({})
    named: Mapping[int, str] = MappingProxyType({})

    def arrived(self, task: Alien, kind: str) -> tuple[Unserved, Wake]:
        """A task of a kind that nobody here does; when to look whether another has spoken."""
        waiting = {**self.without([task[0]]).waiting, task: kind}
        kept = dict(list(waiting.items())[-MOST:])
        return self.without([task[0]])._replace(waiting=kept), Wake(OTHERS_MS, task)

    def without(self, tasks: Iterable[int]) -> Unserved:
        """These are removed, told anew, or somebody has spoken for them."""
        gone = set(tasks)
        waiting = {task: kind for task, kind in self.waiting.items() if task[0] not in gone}
        return Unserved(waiting, {n: kind for n, kind in self.named.items() if n not in gone})

    def due(self, task: Alien) -> Unserved:
        """The time to speak for a task is over; nothing if it is another task by now, or spoken for."""
        kind = self.waiting.get(task)
        if kind is None:
            return self
        left = {other: k for other, k in self.waiting.items() if other != task}
        named = dict(list({**self.named, task[0]: kind}.items())[-MOST:])
        return Unserved(left, named)

    def wakes(self) -> tuple[Wake, ...]:
        """When to look for those that others have time to speak for, which begins anew."""
        return tuple(Wake(OTHERS_MS, task) for task in self.waiting)
