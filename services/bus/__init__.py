"""The message bus of one process: total order, virtual time, pure handlers.

A service is a pure step `handle(state, envelope, now_ms) -> (state, bodies)`; the bus owns the states, the
order and the clock. Messages are delivered one at a time in the order in which they were published; a
message's own publications follow everything already queued. Nothing here reads a wall clock or a random
number, so the same inputs give the same log.

Topics are full type names (`afrl.cmasi.AirVehicleState`); a subscription to a base type receives its
descendants. A message may carry an address instead (`Send`): that of one service (`eid100.sid55`), of all
services of an entity (`eid100.sidall`) or of their group, which receive it if they subscribe to its type; or
any other address, whose subscribers receive it. Bodies are LMCP objects of `cratous.bridge.lmcp`.

A service may also have `prefixes`: it receives every message whose address begins with one of them (bridges,
loggers); `outlet`, true if it sends messages out of the process and publishes nothing: it receives each
message before the others; `wake(state, key, now_ms)`, called when a `Wake` that it requested is due; and
`stop(state)`, called when it leaves. Wakes are due in virtual time, ordered by time, then by age.
"""

from __future__ import annotations

import heapq
from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple, Protocol

from cratous.core.authority.timeliness import in_time
from cratous.spec.records import replace


@dataclass(frozen=True)
class Envelope:
    """A message in transit: sequence number, virtual time [ms], sender, topic and body.

    address: destination if not the subscribers of its type; group, entity_id, service_id: the sender as UxAS
    names it; raw: the body's bytes as received from outside, if they were.
    """

    seq: int
    time_ms: int
    source: str
    topic: str
    body: Any
    address: str = ""
    group: str = ""
    entity_id: int = 0
    service_id: int = 0
    raw: bytes | None = None

    @property
    def to(self) -> str:
        """The address used on the wire: the message's own, or else its type."""
        return self.address or self.topic

    @cached_property
    def packed(self) -> bytes:
        """The body's bytes, encoded once for all who need them. BadInput if it has no form on the wire."""
        from cratous.bridge.lmcp import binary

        return self.raw or binary.pack(self.body)


class Send(NamedTuple):
    """A body for an address (one service, all of an entity, a group) instead of its type."""

    body: Any
    address: str = ""
    group: str = ""


class Wake(NamedTuple):
    """Request to be called again after some virtual time [ms], with a key of the service's own."""

    after_ms: int
    key: Any = None


class Identity(NamedTuple):
    """Identity of a service on the wire: entity id, service id, and the group of its messages."""

    entity_id: int = 0
    service_id: int = 0
    group: str = ""

    @property
    def addresses(self) -> tuple[str, ...]:
        """The addresses at which it is reached: its own, that of its entity, that of its group."""
        group = (self.group,) if self.group else ()
        if not self.service_id:
            return group
        return unicast(self.entity_id, self.service_id), f"eid{self.entity_id}.sidall", *group


def unicast(entity_id: int, service_id: int) -> str:
    """The address of one service: `eid100.sid55`."""
    return f"eid{entity_id}.sid{service_id}"


class Service(Protocol):
    """A service: name, subscriptions, initial state and a pure handler."""

    name: str
    subscribes: tuple[str, ...]

    def start(self) -> Any:
        """The state before the first message."""

    def handle(self, state: Any, envelope: Envelope, now_ms: int) -> tuple[Any, Iterable[Any]]:
        """One step: the new state, and the bodies (or Send, Wake) to publish, in order."""


Fault = Callable[[str, "Envelope | None", Exception], None]


class Bus:
    """Delivers published bodies to the services that subscribe to their type or a base of it."""

    def __init__(
        self,
        topics_of: Callable[[Any], tuple[str, ...]],
        *,
        on_fault: Fault | None = None,
        echo: bool = True,
    ) -> None:
        """topics_of(body) gives the full type name of a body, then those of its bases.

        on_fault(name, envelope, error) receives exceptions of handlers, and the service keeps its state;
        without it they propagate to the caller. echo: a service also receives its own messages.
        """
        self._topics_of = topics_of
        self._on_fault = on_fault
        self._echo = echo
        self._services: dict[str, Any] = {}
        self._states: dict[str, Any] = {}
        self._identities: dict[str, Identity] = {}
        self._queue: deque[Envelope] = deque()
        self._wakes: list[tuple[int, int, Any, Any]] = []
        self._routes: dict[tuple[str, str], tuple[Any, ...]] = {}
        self._taps: list[Callable[[Envelope], None]] = []
        self._seq = 0
        self._wake_count = 0
        self.now_ms = 0

    def add(self, service: Service, identity: Identity = Identity()) -> None:
        """Add a service, whose name must be new (ValueError otherwise), and publish what its `begin(state)`
        returns.
        """
        if service.name in self._states:
            raise ValueError(f"a service named {service.name!r} is already on the bus")
        self._services[service.name] = service
        self._identities[service.name] = identity
        self._states[service.name] = service.start()
        self._routes.clear()
        begin = getattr(service, "begin", None)
        if begin is not None:
            self._step(service, None, lambda: begin(self._states[service.name]))

    def remove(self, name: str) -> None:
        """Remove a service: its `stop(state)` is called; its state, wakes and routes are dropped."""
        service = self._services.pop(name)
        state = self._states.pop(name)
        self._identities.pop(name)
        self._wakes = [wake for wake in self._wakes if wake[2] is not service]
        heapq.heapify(self._wakes)
        self._routes.clear()
        stop = getattr(service, "stop", None)
        if stop is not None:
            try:
                stop(state)
            except Exception as error:
                self._fault(name, None, error)

    def tap(self, listener: Callable[[Envelope], None]) -> None:
        """Call listener with each message, in order, before any service receives it (the log)."""
        self._taps.append(listener)

    def state(self, name: str) -> Any:
        """The present state of a service."""
        return self._states[name]

    def names(self) -> tuple[str, ...]:
        """The services on the bus, in the order in which they joined."""
        return tuple(self._services)

    def identity(self, name: str) -> Identity:
        """The identity of a service on the wire."""
        return self._identities[name]

    def publish(self, body: Any, source: str, address: str = "", group: str = "") -> None:
        """Queue a body (for an address, if one is given); it is delivered by `run`."""
        who = self._identities.get(source, Identity())
        topic = self._topics_of(body)[0]
        address = "" if address == topic else address
        self.put(
            Envelope(
                self._seq,
                self.now_ms,
                source,
                topic,
                body,
                address,
                group or who.group,
                who.entity_id,
                who.service_id,
            )
        )

    def put(self, envelope: Envelope) -> None:
        """Queue a message from outside under its own sender, with a new sequence number."""
        if envelope.seq != self._seq:
            envelope = replace(envelope, seq=self._seq)
        self._seq += 1
        self._queue.append(envelope)

    def run(self) -> int:
        """Deliver until nothing is queued; returns how many messages were delivered."""
        delivered = 0
        while self._queue:
            envelope = self._queue.popleft()
            if not in_time(envelope.time_ms, self.now_ms, 0):
                envelope = replace(envelope, time_ms=self.now_ms)
            delivered += 1
            for listener in self._taps:
                listener(envelope)
            for service in self._receivers(envelope):
                if not self._here(service):
                    continue  # it left while this message was being delivered
                if not self._echo and service.name == envelope.source:
                    continue
                self._hand(service, envelope)
        return delivered

    def call(self, name: str, step: Callable[[Any], tuple[Any, Iterable[Any]]]) -> None:
        """Run a step that no message has caused (e.g. input at its port): `step(state)` returns the same as a
        handler.
        """
        state = self._states[name]
        self._step(self._services[name], None, lambda: step(state))

    def next_wake_ms(self) -> int | None:
        """When the next wake is due, or None."""
        return self._wakes[0][0] if self._wakes else None

    def run_until(self, time_ms: int) -> int:
        """Deliver messages and advance time to `time_ms`, one wake at a time; returns how many messages were
        delivered.

        Each wake runs at its own time, however late this is called.
        """
        delivered = self.run()
        while self._wakes and self._wakes[0][0] <= time_ms:
            due, _, service, key = heapq.heappop(self._wakes)
            self.now_ms = max(self.now_ms, due)
            self._wake(service, key)
            delivered += self.run()
        self.now_ms = max(self.now_ms, time_ms)
        return delivered

    def _here(self, service: Any) -> bool:
        return self._services.get(service.name) is service

    def _receivers(self, envelope: Envelope) -> tuple[Any, ...]:
        # the sender is not a part of the key, so routes are few
        key = (envelope.topic, envelope.address)
        found = self._routes.get(key)
        if found is None:
            if len(self._routes) > 10_000:  # addresses come from outside
                self._routes.clear()
            topics = self._topics_of(envelope.body)
            wanting = (
                service
                for service in self._services.values()
                if self._wants(service, envelope.address, topics)
            )
            # a peer can work on a message while the services here do
            outlets_first = sorted(wanting, key=lambda one: not getattr(one, "outlet", False))
            found = self._routes[key] = tuple(outlets_first)
        return found

    def _wants(self, service: Any, address: str, topics: tuple[str, ...]) -> bool:
        if (address or topics[0]).startswith(tuple(getattr(service, "prefixes", ()))):
            return True
        if address and address in service.subscribes:
            return True
        if address and address not in self._identities[service.name].addresses:
            return False
        # messages to its own address are limited to its subscriptions too
        return any(topic in service.subscribes for topic in topics)

    def _hand(self, service: Any, envelope: Envelope) -> None:
        state = self._states[service.name]
        self._step(service, envelope, lambda: service.handle(state, envelope, self.now_ms))

    def _wake(self, service: Any, key: Any) -> None:
        state = self._states[service.name]
        self._step(service, None, lambda: service.wake(state, key, self.now_ms))

    def _step(
        self,
        service: Any,
        envelope: Envelope | None,
        call: Callable[[], tuple[Any, Iterable[Any]]],
    ) -> None:
        try:
            state, bodies = call()
            bodies = list(bodies)
        except Exception as error:
            if self._on_fault is None:
                raise
            self._fault(service.name, envelope, error)
            return
        self._states[service.name] = state
        for body in bodies:
            if isinstance(body, Wake):
                self._wake_count += 1
                due = self.now_ms + max(0, body.after_ms)
                heapq.heappush(self._wakes, (due, self._wake_count, service, body.key))
            elif isinstance(body, Send):
                self.publish(body.body, service.name, body.address, body.group)
            else:
                self.publish(body, service.name)

    def _fault(self, name: str, envelope: Envelope | None, error: Exception) -> None:
        if self._on_fault is None:
            raise error
        self._on_fault(name, envelope, error)
