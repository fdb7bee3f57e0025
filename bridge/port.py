"""What all ports to the outside have in common: addresses, limits, counts, the loop's interface.

A port moves bytes between sockets and lists, without threads and without ever blocking. `step`
gives what has arrived; `send` takes or loses at once, and what it loses is counted and reported.
The runtime polls `handles` and calls `step` when one of them is ready or `due_s` has come.
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
    """Something that has arrived: the parts of one message, and from whom."""

    parts: tuple[bytes, ...]
    peer: str


class Address(NamedTuple):
    """An address of a socket: scheme, host and port, or the name of an ipc or inproc socket."""

    scheme: str
    host: str
    port: int
    text: str

    @property
    def everywhere(self) -> bool:
        """True if it means all interfaces of the machine."""
        return self.host == "*"

    @property
    def loopback(self) -> bool:
        """True if it is of this machine alone."""
        with suppress(ValueError):
            return ip_address(self.host).is_loopback
        return self.host == "localhost"  # any other name may be that of another machine


@dataclass(frozen=True)
class Limits:
    """What a port endures.

    payload_bytes: longest message; waiting_bytes: what may wait for one peer that does not read;
    when_full: which message is lost then, or that the peer is; frame_s: how long one frame may
    take to arrive; connections: how many peers at once; held_bytes: unfinished frames of all
    peers together.
    """

    payload_bytes: int = 16 * 1024 * 1024
    waiting_bytes: int = 4 * 1024 * 1024
    when_full: str = "DropOldest"
    frame_s: float = 30.0
    connections: int = 2000
    held_bytes: int = 64 * 1024 * 1024
    high_water: int = 100_000  # messages in a ZeroMQ socket, as UxAS has it


@dataclass
class Counts:
    """What a port has done: messages in and out, what was refused or lost, by reason."""

    received: int = 0
    sent: int = 0
    refused: Counter[str] = field(default_factory=Counter)
    lost: Counter[str] = field(default_factory=Counter)

    def add(self, other: Counts) -> None:
        """What another port has done besides."""
        self.received, self.sent = self.received + other.received, self.sent + other.sent
        self.refused.update(other.refused)
        self.lost.update(other.lost)

    def line(self) -> str:
        """All of it in one line."""
        text = f"received {self.received}, sent {self.sent}"
        for name, counter in (("refused", self.refused), ("lost", self.lost)):
            if counter:
                parts = ", ".join(f"{why}: {n}" for why, n in sorted(counter.items()))
                text += f", {name} {sum(counter.values())} ({parts})"
        return text


class Port(Protocol):
    """What the runtime needs of a port."""

    counts: Counts

    @property
    def due_s(self) -> float | None:
        """When `step` has something to do even if nothing arrives."""

    def handles(self) -> list[tuple[Any, int]]:
        """Sockets or file descriptors to poll, each with its zmq.POLLIN / POLLOUT flags."""

    def step(self, now_s: float) -> list[Incoming]:
        """Move bytes; what has arrived, in order. now_s: a clock that does not go back."""

    def send(self, parts: tuple[bytes, ...]) -> None:
        """Send one message, now or later; never blocks."""

    def close(self) -> None:
        """Free sockets and files; safe to call twice."""


def is_due(at_s: float | None, now_s: float) -> bool:
    """True if something has a time [s] and that has come."""
    return at_s is not None and now_s >= at_s


def often(count: int) -> bool:
    """True for 1, 2, 4, 8...: how often something that repeats itself is reported."""
    return count > 0 and count & (count - 1) == 0


class Tally:
    """Counts and reports in one: a reason is reported at its 1st, 2nd, 4th, 8th... time."""

    def __init__(self, name: str, report: Report) -> None:
        self.name, self.report = name, report
        self.counts = Counts()

    def refuse(self, why: str, detail: str = "") -> None:
        """Something that came in is not let through."""
        self._count(self.counts.refused, why, "refused", detail)

    def lose(self, why: str, detail: str = "") -> None:
        """Something that should go out does not."""
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
    """A socket's address, e.g. `tcp://127.0.0.1:5555`, `ipc:///run/user/x`, `inproc://hub`, else BadInput.

    `zmq://127.0.0.1:5560` is of a ZeroMQ socket on TCP, where plain TCP may be meant as well.

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
        if scheme == "ipc" and len(rest.encode()) > 100:  # of the operating system
            raise BadInput("path too long", where=where, item=item, expected="100 bytes", got=text)
        return Address(scheme, rest, 0, text)
    match = _ADDRESS.fullmatch(text)
    if match is None or not (0 if free else 1) <= int(match[3]) <= 65535:
        raise wrong
    return Address(scheme, match[2].strip("[]"), int(match[3]), text)
