"""Messages of a running system, received from its port: a TCP or ZeroMQ bridge of UxAS, or AMASE.

Nothing is sent, and input is read at once, so that the peer never waits. Times are arrival times
[ms] since the first connection, on a monotonic clock.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

import zmq

from cratous.bridge import envelope
from cratous.bridge.port import Address, Report, is_due
from cratous.bridge.subscription import Subscription
from cratous.bridge.tcp_port import TcpPort
from cratous.services.logs.entry import Entry
from cratous.services.logs.files import entry_of
from cratous.spec.errors import BadInput

POLL_S = 0.1
"""Interval for checking whether to end [s]."""


class Attached:
    """A connection that is re-established when lost; `find(kind)` is called with what was missed."""

    def __init__(self, where: Address, report: Report, find: Callable[[str, int], None]) -> None:
        self._port: TcpPort | Subscription = (
            Subscription(where, report)
            if where.scheme == "zmq"
            else TcpPort(where, server=False, report=report)
        )
        self._where, self._find = where, find
        self._begun_s: float | None = None
        self._refused = 0
        self.seq = 0

    def now_ms(self) -> int:
        """Time since the first connection [ms], 0 before."""
        return 0 if self._begun_s is None else int((time.monotonic() - self._begun_s) * 1000)

    def messages(self, wait_s: float, until: Callable[[int], bool]) -> Iterator[Entry]:
        """The messages, until `until(ms)` is true. Raises BadInput if no system answers within wait_s seconds."""
        given_up_s, was_there = time.monotonic() + wait_s, False
        try:
            while not until(self.now_ms()):
                self._sleep()
                incoming = self._port.step(time.monotonic())
                if (is_there := bool(self._port.peers)) and self._begun_s is None:
                    self._begun_s = time.monotonic()
                for one in incoming:
                    if (found := self._entry(one.parts[0])) is not None:
                        yield found
                if was_there and not is_there:
                    self._find("cut", self.now_ms() * 10**6)
                was_there = is_there
                if self._begun_s is None and is_due(given_up_s, time.monotonic()):
                    raise BadInput(
                        "no program listens there", where=self._where.text, expected="UxAS or AMASE"
                    )
                self._count_refused()
        finally:
            self._port.close()

    def left(self) -> list[str]:
        """What remains running after the watch, in words: nothing."""
        return []

    def _sleep(self) -> None:
        poll = zmq.Poller()
        for handle, _ in self._port.handles():
            poll.register(handle, zmq.POLLIN)
        due_s = self._port.due_s
        left_s = POLL_S if due_s is None else min(POLL_S, max(0.0, due_s - time.monotonic()))
        poll.poll(int(left_s * 1000))

    def _entry(self, payload: bytes) -> Entry | None:
        seq, self.seq = self.seq, self.seq + 1
        try:
            return entry_of(seq, self.now_ms(), envelope.parse(payload, f"message {seq}"))
        except BadInput:
            self._find("refused", self.now_ms() * 10**6)
            return None

    def _count_refused(self) -> None:
        refused = sum(self._port.counts.refused.values())
        if refused != self._refused:
            self._find("refused", self.now_ms() * 10**6)
        self._refused = refused
