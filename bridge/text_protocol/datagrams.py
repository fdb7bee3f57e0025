"""Lines of v2 as datagrams that vehicles send each other, where no connection keeps their order.

A datagram is one packet, as in a connection of v2, with fields that replace the connection:

    CRATOUS-2D,SESSION,SEQUENCE,TIME,VEHICLE,HEARD,CRC,MAC,LINE

SESSION: 16 random hexadecimal digits, new at each start of the sender; SEQUENCE: from 1 in each session; TIME: the
sender's clock [ms]; VEHICLE: the sender; HEARD: the sessions that it hears, joined by `+`, or `-`; CRC and MAC
as in a connection, the MAC by the sender's direct key. A sender is accepted once it reports that it hears the
receiver's own session; this excludes anything recorded before the receiver's start. Within a session a number is
accepted at most once, by a window of 64 (`core.authority.replay_window`). When a new session of a sender is accepted,
which must not begin before what was accepted from it, older ones end. Nothing is encrypted, and anyone who has the
direct key of a vehicle can speak for it.
"""

from __future__ import annotations

import hmac
import os
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from cratous.bridge.text_protocol.authenticated_lines import DAMAGED, FORGED, Nonce, crc_of, mac_of
from cratous.core.authority.replay_window import Window
from cratous.core.authority.timeliness import lasted

NAME = b"CRATOUS-2D"
MOST_BYTES = 1400
"""The longest datagram, so that none is fragmented."""
MOST_VEHICLES = 20
"""The most vehicles with a direct link to each other: the sessions that they hear have to fit a datagram."""
MOST_SESSIONS = 64
"""How often a sender may be started while the receiver runs."""
AHEAD = 100_000
"""The most by which a number may exceed the greatest one so far: on this link packets may be lost for long."""
REPEATED = "datagram that came before, is older than the window, or far ahead"
STRANGER = "datagram of a vehicle without a direct key here"
NOT_HEARD = "datagram of one that does not hear this session"
OVER = "datagram of a session that is over"
TOO_LONG = f"datagram of more than {MOST_BYTES} bytes"
_HEX16 = rb"[0-9a-f]{16}"
_DATAGRAM = re.compile(
    NAME + rb",(" + _HEX16 + rb"),([0-9]{1,18}),([0-9]{1,18}),([0-9]{1,18}),"
    rb"(-|" + _HEX16 + rb"(?:\+" + _HEX16 + rb"){0,40}),([0-9a-f]{8}),([0-9a-f]{64}),"
)  # fmt: skip


class Said(NamedTuple):
    """An accepted datagram: the sender's vehicle, its clock [ms], and the line with its newline."""

    vehicle_id: int
    time_ms: int
    line: bytes


class Refused(NamedTuple):
    """Why a datagram is dropped. why: the reason counted; detail: of this datagram."""

    why: str
    detail: str


@dataclass
class _Sender:
    """Another vehicle: windows of the accepted sessions, the newest last; time_ms: the latest accepted time;
    candidate: a session with its key that does not hear this vehicle yet, or may be a recording."""

    windows: dict[bytes, Window] = field(default_factory=dict)
    time_ms: int = 0
    candidate: bytes = b""

    @property
    def heard(self) -> list[bytes]:
        """The sessions reported as heard."""
        return [*list(self.windows)[-1:], *([self.candidate] if self.candidate else [])]


class Datagrams:
    """Seals the datagrams of one vehicle, and verifies those of the others."""

    def __init__(
        self, vehicle_id: int, keys: Mapping[int, bytes], nonce: Nonce = os.urandom
    ) -> None:
        """keys: the direct keys, of this vehicle and of the others; nonce: random bytes."""
        self.vehicle_id, self._keys = vehicle_id, dict(keys)
        self.session = nonce(8).hex().encode()
        self._sent = 0
        self._others = {vid: _Sender() for vid in keys if vid != vehicle_id}

    def wrap(self, line: bytes, now_ms: int) -> bytes:
        """The sealed datagram of a line with its newline. now_ms: this vehicle's clock [ms]."""
        self._sent += 1
        heard = b"+".join(name for one in self._others.values() for name in one.heard) or b"-"
        numbers = b"%d,%d,%d" % (self._sent, now_ms, self.vehicle_id)
        head, body = b"%b,%b,%b,%b" % (NAME, self.session, numbers, heard), line.removesuffix(b"\n")
        mac = mac_of(self._keys[self.vehicle_id], head, body)
        return b"%b,%08x,%b,%b" % (head, crc_of(head, body), mac, body)

    def open(self, data: bytes) -> Said | Refused | None:
        """Verify and decode a datagram; Refused says why not, None for one of our own that came back."""
        if data[MOST_BYTES:]:
            return Refused(TOO_LONG, f"{len(data)} bytes")
        match = _DATAGRAM.match(data)
        if match is None:
            return Refused(DAMAGED, ascii(data[:40])[1:])
        head = b",".join((NAME, *match.groups()[:5]))
        session, body = match[1], data[match.end() :]
        sequence, time_ms, vehicle_id = map(int, match.groups()[1:4])
        what = f"datagram {sequence} of vehicle {vehicle_id}"
        if vehicle_id == self.vehicle_id and session == self.session:
            return None
        other = self._others.get(vehicle_id)
        if other is None:
            return Refused(STRANGER, what)
        if b"%08x" % crc_of(head, body) != match[6]:
            return Refused(DAMAGED, what)
        if not hmac.compare_digest(mac_of(self._keys[vehicle_id], head, body), match[7]):
            return Refused(FORGED, what)
        if b"\n" in body:
            return Refused(DAMAGED, what)
        refused = self._believed(other, session, sequence, time_ms, match[5])
        return refused or Said(vehicle_id, time_ms, body + b"\n")

    def _believed(
        self, other: _Sender, session: bytes, sequence: int, time_ms: int, heard: bytes
    ) -> Refused | None:
        """Why a genuine datagram is out of date or a repetition; None once it is recorded as received."""
        what = f"number {sequence} of session {session.decode()}"
        if self.session not in heard.split(b"+"):
            if session not in other.windows:
                other.candidate = session  # maybe a recording: reported as heard, it must answer
            return Refused(NOT_HEARD, what)
        if session not in other.windows:
            # a session that was delayed on the way is out of date too
            if len(other.windows) >= MOST_SESSIONS or not lasted(other.time_ms, time_ms, 0):
                return Refused(OVER, what)
            other.windows[session] = Window(AHEAD)
        if session != list(other.windows)[-1]:
            return Refused(OVER, what)
        if not other.windows[session].take(sequence):
            return Refused(REPEATED, what)
        other.time_ms = max(other.time_ms, time_ms)
        if other.candidate == session:
            other.candidate = b""
        return None
