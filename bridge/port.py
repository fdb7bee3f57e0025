"""What all ports to the outside have in common: addresses, limits, counts, the interface to the event loop.

A port moves bytes between sockets and lists, without threads and without ever blocking. `step` returns what has
arrived; `send` accepts or discards at once, and discarded messages are counted and reported. The runtime polls
`handles` and calls `step` when one of them is ready or `due_s` has come.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from ipaddress import ip_address
from typing import Any, NamedTuple, Protocol

from cratous.spec.errors import BadInput

Report = Callable[[str, str], None]
"""report(severity, sentence): severity is DEBUG, INFO, WARN or ERROR."""

FULL_POLICIES = ("DropNewest", "DropOldest", "Close")
LOOPBACK = "127.0.0.1"
_ADDRESS = re.compile(r"(tcp|udp|zmq)://(\*|\[[0-9a-fA-F:]+\]|[A-Za-z0-9_.-]+):([0-9]{1,5})")


class Incoming(NamedTuple):
    """One received message: its parts, and the peer that sent it."""

    parts: tuple[bytes, ...]
    peer: str


class Address(NamedTuple):
    """A socket's address: scheme, host and port, or the name of an ipc or inproc socket."""

    scheme: str
    host: str
    port: int
    text: str

    @property
    def everywhere(self) -> bool:
        """True if it denotes all network interfaces of this machine."""
        return self.host == "*"

    @property
    def loopback(self) -> bool:
        """True if it can be reached from this machine only."""
        with suppress(ValueError):
            return ip_address(self.host).is_loopback
        return self.host == "localhost"  # any other name may be that of another machine


@dataclass(frozen=True)
class Limits:
    """Resource limits of a port.

    payload_bytes: longest message; waiting_bytes: most that is queued for one peer that does not read; when_full:
    which message is then discarded, or that the peer is dropped; frame_s: longest time for one frame to arrive [s];
    connections: peers at once; held_bytes: incomplete frames of all peers together.
    """

    payload_bytes: int = 16 * 1024 * 1024
    waiting_bytes: int = 4 * 1024 * 1024
    when_full: str = "DropOldest"
    frame_s: float = 30.0
    connections: int = 2000
    held_bytes: int = 64 * 1024 * 1024
    high_water: int = 100_000  # messages in a ZeroMQ socket, as in UxAS


@dataclass
class Counts:
    """Statistics of a port: messages received and sent; refused and lost ones by reason."""

    received: int = 0
    sent: int = 0
    refused: Counter[str] = field(default_factory=Counter)
    lost: Counter[str] = field(default_factory=Counter)

    def add(self, other: Counts) -> None:
        """Add the statistics of another port."""
        self.received, self.sent = self.received + other.received, self.sent + other.sent
        self.refused.update(other.refused)
        self.lost.update(other.lost)

    def line(self) -> str:
        """All statistics as one line of text."""
        text = f"received {self.received}, sent {self.sent}"
        for name, counter in (("refused", self.refused), ("lost", self.lost)):
            if counter:
                parts = ", ".join(f"{why}: {n}" for why, n in sorted(counter.items()))
                text += f", {name} {sum(counter.values())} ({parts})"
        return text


class Port(Protocol):
    """The interface of a port, as event loops use it."""

    counts: Counts

    @property
    def due_s(self) -> float | None:
        """When `step` must be called even if no bytes arrive [s, monotonic clock]; None: not needed."""

    def handles(self) -> list[tuple[Any, int]]:
        """Sockets or file descriptors to poll, each with its zmq.POLLIN / POLLOUT flags."""

    def step(self, now_s: float) -> list[Incoming]:
        """Read and write without blocking; the received messages in order. now_s: monotonic clock [s]."""

    def send(self, parts: tuple[bytes, ...]) -> None:
        """Send or queue one message; never blocks."""

    def close(self) -> None:
        """Close sockets and files. May be called twice."""


def is_due(at_s: float | None, now_s: float) -> bool:
    """True if at_s is not None and now_s has reached it [s, same clock]."""
    return at_s is not None and now_s >= at_s


def often(count: int) -> bool:
    """True for 1, 2, 4, 8...: at which occurrences a repeated event is reported."""
    return count > 0 and count & (count - 1) == 0


class Tally:
    """Counts and reports events by reason: each reason is reported at its 1st, 2nd, 4th, 8th... occurrence."""

    def __init__(self, name: str, report: Report) -> None:
        self.name, self.report = name, report
        self.counts = Counts()

    def refuse(self, why: str, detail: str = "") -> None:
        """Count something received that is not accepted. why: the reason counted; detail: of this occurrence."""
        self._count(self.counts.refused, why, "refused", detail)

    def lose(self, why: str, detail: str = "") -> None:
        """Count something that could not be sent. why: the reason counted; detail: of this occurrence."""
        self._count(self.counts.lost, why, "lost", detail)

    def _count(self, counter: Counter[str], why: str, what: str, detail: str) -> None:
        counter[why] += 1
        number = counter[why]
        if often(number):
            more = f" ({number} times so far)" if number > 1 else ""
            tail = f": {detail}" if detail else ""
            self.report("WARN", f"{self.name}: {what}: {why}{tail}{more}")


def address(
    text: str, schemes: tuple[str, ...], *, where: str = "", item: str = "", free: bool = False
) -> Address:
    """A socket's address, e.g. `tcp://127.0.0.1:5555`, `ipc:///run/user/x`, `inproc://hub`; else BadInput.

    `zmq://127.0.0.1:5560` is a ZeroMQ socket on TCP, where plain TCP would be possible too.

    free: port 0 (chosen by the system) is allowed.
    """
    scheme, _, rest = text.partition("://")
    expected = " or ".join(
        f"{s}://HOST:PORT" if s in ("tcp", "udp", "zmq") else f"{s}://NAME" for s in schemes
    )
    wrong = BadInput("not an address", where=where, item=item, expected=expected, got=text)
    if scheme not in schemes or not rest:
        raise wrong
    if scheme in ("ipc", "inproc"):
        if scheme == "ipc" and len(rest.encode()) > 100:  # limit of the operating system
            raise BadInput("path too long", where=where, item=item, expected="100 bytes", got=text)
        return Address(scheme, rest, 0, text)
    match = _ADDRESS.fullmatch(text)
    if match is None or not (0 if free else 1) <= int(match[3]) <= 65535:
        raise wrong
    return Address(scheme, match[2].strip("[]"), int(match[3]), text)
