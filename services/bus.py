"""The message bus of one process: total order, virtual time, pure handlers.

A service is a pure step `handle(state, envelope, now_ms) -> (state, bodies)`; the bus owns the
states, the order and the clock. Messages are delivered one at a time in the order in which they
were published; a message's own publications follow everything that is already queued. Nothing
here reads a wall clock or a random number, so the same inputs give the same log.

Topics are full type names (`afrl.cmasi.AirVehicleState`); a subscription to a base type receives
its descendants. Bodies are LMCP objects of `cratous.bridge.lmcp`.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any, Protocol


@dataclass(frozen=True)
class Envelope:
    """A message on its way: sequence number, virtual time [ms], sender, topic and body."""

    seq: int
    time_ms: int
    source: str
    topic: str
    body: Any


class Service(Protocol):
    """Anything with a name, subscriptions, a first state and a pure handler."""

    name: str
    subscribes: tuple[str, ...]

    def start(self) -> Any:
        """The state before the first message."""

    def handle(self, state: Any, envelope: Envelope, now_ms: int) -> tuple[Any, Iterable[Any]]:
        """One step: the new state, and the bodies to publish, in order."""


class Bus:
    """Delivers published bodies to the services that subscribe to their type or a base of it."""

    def __init__(self, topics_of: Callable[[Any], tuple[str, ...]]) -> None:
        """topics_of(body) gives the full type name of a body, then those of its bases."""
        self._topics_of = topics_of
        self._services: list[Service] = []
        self._states: dict[str, Any] = {}
        self._queue: deque[Envelope] = deque()
        self._taps: list[Callable[[Envelope], None]] = []
        self._seq = 0
        self.now_ms = 0

    def add(self, service: Service) -> None:
        """Join a service; its name must be new."""
        if service.name in self._states:
            raise ValueError(f"a service named {service.name!r} is already on the bus")
        self._services.append(service)
        self._states[service.name] = service.start()

    def tap(self, listener: Callable[[Envelope], None]) -> None:
        """Call listener with each message, in order, before any service gets it (the log)."""
        self._taps.append(listener)

    def state(self, name: str) -> Any:
        """The present state of a service."""
        return self._states[name]

    def publish(self, body: Any, source: str) -> None:
        """Queue a body; it is delivered by `run`."""
        topic = self._topics_of(body)[0]
        self._queue.append(Envelope(self._seq, self.now_ms, source, topic, body))
        self._seq += 1

    def run(self) -> int:
        """Deliver until nothing is queued; returns how many messages were delivered."""
        delivered = 0
        while self._queue:
            envelope = replace(self._queue.popleft(), time_ms=self.now_ms)
            delivered += 1
            for listener in self._taps:
                listener(envelope)
            topics = self._topics_of(envelope.body)
            for service in self._services:
                if any(topic in service.subscribes for topic in topics):
                    state, bodies = service.handle(
                        self._states[service.name], envelope, self.now_ms
                    )
                    self._states[service.name] = state
                    for body in bodies:
                        self.publish(body, service.name)
        return delivered
