"""A tap on a CRATOUS bridge: clients connect here, and a relay process connects them to their destination.

The traffic of both ends passes unchanged (`relay`), whether it is observed or not; this process gets a copy.
"""

from __future__ import annotations

import os
import socket
import struct
import subprocess
import sys
from collections.abc import Iterator
from typing import Any, NamedTuple

import zmq

from cratous.bridge.link import Listener
from cratous.bridge.port import Address
from cratous.bridge.relay import LOST, RECORD
from cratous.bridge.text_protocol.keys import without_keys
from cratous.spec.errors import BadInput

_READ = 1 << 16


class Copied(NamedTuple):
    """One record of the relay's copy, see `relay`.

    time_ns: time of passing [ns, CLOCK_MONOTONIC]; lost: number of bytes not copied (kind LOST).
    """

    kind: int
    connection: int
    time_ns: int
    data: bytes
    lost: int = 0


class Tap:
    """A relay process and the copy that it makes of the traffic."""

    def __init__(self, listens: Address, leads_to: Address) -> None:
        """Raises BadInput if it cannot listen, or the other address cannot be resolved. Beyond loopback only v2
        passes."""
        self._part = b""
        where = _resolved(leads_to)
        host = "0.0.0.0" if listens.everywhere else listens.host
        self._listener = Listener(host, listens.port)
        self.bound = self._listener.address
        self._ours, theirs = socket.socketpair()
        handles = (self._listener.fileno(), theirs.fileno())
        words = [*map(str, handles), where[0], str(where[1])]
        words.append("plain" if listens.loopback else "sealed")
        # it keeps relaying open connections after the observer ends, so it ignores Ctrl-C
        self.process = subprocess.Popen(
            [sys.executable, "-m", "cratous.bridge.relay", *words],
            pass_fds=handles,
            # a reader of the observer's output must not have to wait for the relay to end
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env={**without_keys(os.environ), "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
            start_new_session=True,
        )
        theirs.close()
        self._listener.close()
        self._ours.setblocking(False)

    @property
    def stands(self) -> bool:
        """True while the relay process runs."""
        return self.process.poll() is None

    def handles(self) -> list[tuple[Any, int]]:
        """Socket to poll, with its flags; empty once closed."""
        return [(self._ours.fileno(), zmq.POLLIN)] if self._ours.fileno() >= 0 else []

    def step(self) -> Iterator[Copied]:
        """The records copied since the last call, in order of passing; bounded per call. Never blocks."""
        try:
            self._part += self._ours.recv(_READ)
        except (BlockingIOError, ConnectionError):
            return
        yield from self._records()

    def _records(self) -> Iterator[Copied]:
        at = 0
        while at + RECORD.size <= len(self._part):
            kind, connection, time_ns, count = RECORD.unpack_from(self._part, at)
            if at + RECORD.size + count > len(self._part):
                break
            data = self._part[at + RECORD.size : at + RECORD.size + count]
            at += RECORD.size + count
            lost = struct.unpack("!Q", data)[0] if kind == LOST else 0
            yield Copied(kind, connection, time_ns, data, lost)
        self._part = self._part[at:]

    def close(self) -> None:
        """Stop watching: no new client is accepted; open connections are relayed until they end."""
        self._ours.close()


def _resolved(where: Address) -> tuple[str, int]:
    try:
        found = socket.getaddrinfo(where.host, where.port, type=socket.SOCK_STREAM)
    except OSError as error:
        raise BadInput(
            "unknown host", where=where.text, expected="a name or an address",
            got=error.strerror or str(error),
        ) from None  # fmt: skip
    host, port = found[0][4][:2]
    return str(host), int(port)
