"""Direct operator commands to vehicles in flight: queued until the next step, then changes of the mission."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any, NamedTuple

from cratous.spec.errors import CratousError
from cratous.spec.mission import Change, Mission


class Directed(NamedTuple):
    """A mission with one more command, the last of its changes; text: of its file."""

    text: str
    mission: Mission


class DirectOrders:
    """Commands, from any thread, that the flight executes at its next step; the mission grows by them."""

    def __init__(self, text: str, put: Callable[[str, int, Any], Directed]) -> None:
        """text: of the current mission; put: adds a command known at a time [ms] to a text.

        put raises CratousError if the mission cannot have it.
        """
        self.text = text
        self.mission: Mission | None = None
        """The mission with all commands so far, None without any."""
        self._put = put
        self._given: list[Any] = []
        self._lock = threading.Lock()

    def give(self, command: Any) -> None:
        """Queue a command for the next step."""
        with self._lock:
            self._given.append(command)

    def due(self, now_ms: int, told: Callable[[dict[str, Any]], None]) -> tuple[Change, ...]:
        """The commanded changes at a step; told: called for each command with the new text, or with
        why it is refused.
        """
        with self._lock:
            given, self._given = self._given, []
        found = []
        for command in given:
            refused = ""
            try:
                directed = self._put(self.text, now_ms, command)
                self.text, self.mission = directed
                found.append(directed.mission.changes[-1])
            except CratousError as error:
                refused = str(error)
            told({"directed": {"text": self.text, "refused": refused}})
        return tuple(found)
