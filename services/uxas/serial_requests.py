"""SerialAutomationRequestTestService: forwards requests one at a time, each once the previous is
answered.

AutomationRequest, ImpactAutomationRequest -> the same, to the address UniqueAutomationRequest; the
next after an AutomationResponse or an ImpactAutomationResponse, or after a time-out.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

from cratous.services.bus import Envelope, Send, Wake

ADDRESS = "UniqueAutomationRequest"
REQUESTS = ("afrl.cmasi.AutomationRequest", "afrl.impact.ImpactAutomationRequest")
RESPONSES = ("afrl.cmasi.AutomationResponse", "afrl.impact.ImpactAutomationResponse")
WAITING_MOST = 10_000


class Queue(NamedTuple):
    """Waiting requests, the number sent, and whether the last is unanswered."""

    waiting: tuple[Any, ...] = ()
    sent: int = 0
    busy: bool = False


Step = tuple[Queue, Iterable[Any]]


class SerialAutomationRequestTestService:
    """Lets one request through at a time."""

    subscribes: tuple[str, ...] = (*REQUESTS, *RESPONSES)

    def __init__(self, name: str, limit_ms: int) -> None:
        """limit_ms: time-out for an answer [ms]."""
        self.name, self._limit_ms = name, limit_ms

    def start(self) -> Queue:
        return Queue()

    def handle(self, state: Queue, envelope: Envelope, now_ms: int) -> Step:
        if envelope.topic in RESPONSES:
            return self._next(state._replace(busy=False))
        waiting = (*state.waiting, envelope.body)[:WAITING_MOST]
        return self._next(state._replace(waiting=waiting))

    def wake(self, state: Queue, key: Any, now_ms: int) -> Step:
        """Time-out of request number `key`."""
        return self._next(state._replace(busy=False)) if key == state.sent else (state, ())

    def _next(self, state: Queue) -> Step:
        if state.busy or not state.waiting:
            return state, ()
        first, *rest = state.waiting
        state = Queue(tuple(rest), state.sent + 1, True)
        return state, [Send(first, ADDRESS), Wake(self._limit_ms, state.sent)]
