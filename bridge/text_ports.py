"""Several ports of the text protocol as one: each with its own address, dialect and keys."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import Any

from cratous.bridge.link import LinkEvent
from cratous.bridge.port import Counts
from cratous.bridge.text_port import Came, TextPort
from cratous.bridge.text_protocol.messages import Message


class TextPorts:
    """Several text ports as one, with connections numbered across them; `bound` is that of the first."""

    def __init__(self, ports: Sequence[TextPort]) -> None:
        """ports: at least one, none of them with a connection yet."""
        self.ports, numbers = tuple(ports), itertools.count(1)
        for port in self.ports:
            port.numbers = numbers
        self._of: dict[int, int] = {}

    def which(self, key: int) -> int:
        """The index of the port of connection `key`."""
        return self._of.get(key, 0)

    @property
    def bound(self) -> tuple[str, int]:
        """Host and port on which the first port listens."""
        return self.ports[0].bound

    @property
    def counts(self) -> Counts:
        """The statistics of all ports together."""
        found = Counts()
        for port in self.ports:
            found.add(port.counts)
        return found

    @property
    def due_s(self) -> float | None:
        """When `step` must be called even if no bytes arrive [s, monotonic clock]; None: not needed."""
        return min((p.due_s for p in self.ports if p.due_s is not None), default=None)

    def handles(self) -> list[tuple[Any, int]]:
        """Sockets to poll, each with its flags."""
        return [handle for port in self.ports for handle in port.handles()]

    def step(self, now_s: float) -> list[Came]:
        """Read and write without blocking; what was received, port by port. now_s: monotonic clock [s]."""
        found = []
        for number, port in enumerate(self.ports):
            for came in port.step(now_s):
                self._of[came.key] = number
                found.append(came)
        return found

    def send(self, key: int, message: Message) -> bool:
        """Queue a message for connection `key`; False if it has gone or the message cannot be encoded."""
        return self.ports[self.which(key)].send(key, message)

    def refuse(self, key: int, why: str, detail: str) -> None:
        """Tell a peer why it is refused, and end its connection, see `TextPort.refuse`."""
        self.ports[self.which(key)].refuse(key, why, detail)

    def name(self, key: int) -> str:
        """The address of the peer of connection `key`."""
        return self.ports[self.which(key)].name(key)

    def ended(self, came: Came) -> None:
        """Forget a connection whose end was handled."""
        if isinstance(came.what, LinkEvent):
            self._of.pop(came.key, None)

    def close(self) -> None:
        """Write what is queued, then close all sockets. May be called twice."""
        for port in self.ports:
            port.close()
