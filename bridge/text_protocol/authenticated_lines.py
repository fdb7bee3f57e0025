"""The dialect v2: both ends prove that they have the vehicle's key, and each line is numbered and authenticated.

Opening, one line each:

1. UxAS: `CRATOUS-2,NONCE`; 2. ICAROUS: `CRATOUS-2,VEHICLE,NONCE,PROOF`; 3. UxAS: `ok,PROOF` or `error,REASON`.
A proof is the HMAC-SHA256, by the key, of the prover, the vehicle and both nonces (16 random bytes each). Then
each line of the text protocol is sent as a packet

    SEQUENCE,TIME,VEHICLE,ACK,CRC,MAC,LINE

SEQUENCE: from 1 in each direction; TIME: the sender's monotonic clock [ms]; ACK: the greatest SEQUENCE that the
sender has accepted from the other end; CRC: CRC-32 of numbers and line, which distinguishes damaged packets from
forged ones; MAC: HMAC-SHA256 by a key that belongs to this connection and direction only, so a packet of another
connection, direction or vehicle is not accepted. Nothing is encrypted.
"""

from __future__ import annotations

import hmac
import os
import re
import zlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from cratous.bridge.text_protocol.handshake import Handshake
from cratous.bridge.text_protocol.parser import MAX_LINE, WireError
from cratous.core.authority.replay import mark_after, packet_is_new
from cratous.core.authority.timeliness import lasted

NAME = b"CRATOUS-2"
WINDOW = 1024
"""The most by which a packet's number may exceed the last one's; a greater number is taken for a forgery."""
MOST_UNACKNOWLEDGED = 100_000
"""The most packets sent without acknowledgement."""
MOST_LINE, MOST_TAG = MAX_LINE + 256, 6
REPLAYED, FORGED, DAMAGED = (
    "packet number that came before or is far ahead",
    "forged packet",
    "damaged packet",
)
Nonce = Callable[[int], bytes]
_HEX32, _HEX64 = rb"[0-9a-f]{32}", rb"[0-9a-f]{64}"
_FIRST = re.compile(NAME + rb",(" + _HEX32 + rb")\Z")
_SECOND = re.compile(NAME + rb",([0-9]{1,18}),(" + _HEX32 + rb"),(" + _HEX64 + rb")\Z")
_THIRD = re.compile(rb"ok,(" + _HEX64 + rb")\Z")
_PACKET = re.compile(
    rb"([0-9]{1,18}),([0-9]{1,18}),([0-9]{1,18}),([0-9]{1,18}),([0-9a-f]{8}),(" + _HEX64 + rb"),"
)


def proof(key: bytes, who: str, vehicle_id: int, nonces: tuple[bytes, bytes]) -> bytes:
    """HMAC-SHA256 over the prover (`who`), the vehicle and both nonces, as hexadecimal digits."""
    text = b",".join((NAME, who.encode(), b"%d" % vehicle_id, *nonces))
    return hmac.new(key, text, "sha256").hexdigest().encode()


def direction_keys(key: bytes, vehicle_id: int, nonces: tuple[bytes, bytes]) -> list[bytes]:
    """The keys that seal the packets of ICAROUS and of UxAS in one connection, in this order."""
    return [bytes.fromhex(proof(key, w, vehicle_id, nonces).decode()) for w in ("up", "down")]


def line_in(packet: bytes) -> bytes | None:
    """The line of a packet without its newline; only the checksum is verified, None if it is wrong."""
    match = _PACKET.match(packet)
    if match is None:
        return None
    head, body = b",".join(match.groups()[:4]), packet[match.end() :]
    return body if b"%08x" % crc_of(head, body) == match[5] else None


class Opening(NamedTuple):
    """Lines 1 and 2 of the opening, decoded. proved: ICAROUS's proof."""

    vehicle_id: int
    nonces: tuple[bytes, bytes]
    proved: bytes


def opening_of(first: bytes, second: bytes) -> Opening | None:
    """The opening decoded from its first two lines, UxAS's and ICAROUS's; None if malformed."""
    uxas, icarous = _FIRST.match(first), _SECOND.match(second)
    if uxas is None or icarous is None:
        return None
    return Opening(int(icarous[1]), (uxas[1], icarous[2]), icarous[3])


@dataclass
class Seal:
    """Seals and verifies the packets of one connection. out_key, in_key: of what is sent and received."""

    vehicle_id: int
    out_key: bytes = field(repr=False)
    in_key: bytes = field(repr=False)
    sent: int = 0
    acknowledged: int = 0
    mark: int = 0
    time_ms: int = 0
    _pending: bytes = b""
    _count: int = 0

    @property
    def unacknowledged(self) -> int:
        """Number of packets sent that the other end has not acknowledged."""
        return self.sent - self.acknowledged

    def wrap(self, line: bytes, now_ms: int) -> bytes:
        """The sealed packet of a line, both with their newline. now_ms: the sender's clock [ms]."""
        self.sent += 1
        head = b"%d,%d,%d,%d" % (self.sent, now_ms, self.vehicle_id, self.mark)
        body = line.removesuffix(b"\n")
        return b"%b,%08x,%b,%b\n" % (
            head,
            crc_of(head, body),
            mac_of(self.out_key, head, body),
            body,
        )

    def feed(self, data: bytes) -> tuple[bytes, list[WireError]]:
        """The lines of all packets completed by these bytes, and errors for the packets that are refused."""
        *packets, self._pending = (self._pending + data).split(b"\n")
        lines, wrong = list[bytes](), list[WireError]()
        for packet in packets:
            self._count += 1
            found = self._open(packet)
            if isinstance(found, bytes):
                lines.append(found + b"\n")
            else:
                wrong.append(WireError(self._count, 1, *found, tag=_tag(packet)))
        if self._pending[MOST_LINE:]:
            wrong.append(WireError(self._count + 1, 1, DAMAGED, f"{MOST_LINE} bytes", "more"))
            self._pending = b""
        return b"".join(lines), wrong

    def _open(self, packet: bytes) -> bytes | tuple[str, str, str]:
        """The line of a packet; or what is wrong, what was expected, and what was received."""
        match = _PACKET.match(packet)
        if match is None:
            return DAMAGED, "a packet of v2", ascii(packet[:40])[1:]
        head, body = b",".join(match.groups()[:4]), packet[match.end() :]
        sequence, time_ms, vehicle_id, acknowledged = map(int, match.groups()[:4])
        if b"%08x" % crc_of(head, body) != match[5]:
            return DAMAGED, "its checksum", f"packet {sequence}"
        if not hmac.compare_digest(mac_of(self.in_key, head, body), match[6]):
            return FORGED, "its authentication code", f"packet {sequence}"
        if not packet_is_new(self.mark, sequence, WINDOW):
            return REPLAYED, f"a number from {self.mark + 1} to {self.mark + WINDOW}", str(sequence)
        if vehicle_id != self.vehicle_id:
            return FORGED, f"vehicle {self.vehicle_id}", f"vehicle {vehicle_id}"
        if not lasted(self.time_ms, time_ms, 0):
            return FORGED, f"a time not before {self.time_ms} ms", f"{time_ms} ms"
        if acknowledged not in range(self.acknowledged, self.sent + 1):
            return FORGED, f"ACK of {self.acknowledged} to {self.sent}", str(acknowledged)
        self.mark = mark_after(self.mark, sequence, WINDOW)
        self.time_ms, self.acknowledged = time_ms, acknowledged
        return body


def _tag(packet: bytes) -> str:
    """The tag of the line in a refused packet; empty if there is none."""
    match = _PACKET.match(packet)
    tag = packet[match.end() :].partition(b",")[0] if match else b""
    return tag.decode() if tag.isalpha() and len(tag) <= MOST_TAG else ""


def crc_of(head: bytes, body: bytes) -> int:
    """CRC-32 of a packet's numbers and line."""
    return zlib.crc32(head + b"," + body)


def mac_of(key: bytes, head: bytes, body: bytes) -> bytes:
    """HMAC-SHA256 of a packet's numbers and line, as hexadecimal digits."""
    return hmac.new(key, head + b"," + body, "sha256").hexdigest().encode()


@dataclass
class SealedHandshake(Handshake):
    """Handshake of dialect v2, both ends. keys: by vehicle; seal: set when it is complete; nonce: source of random
    bytes."""

    keys: Mapping[int, bytes] = field(default_factory=dict, repr=False)
    nonce: Nonce = os.urandom
    seal: Seal | None = field(default=None, repr=False)
    _own: bytes = b""

    def _line(self) -> bytes | None:
        """The next line, None if it is not complete yet."""
        line, newline, rest = self.rest.partition(b"\n")
        if newline:
            self.rest = rest
            return line
        if self.rest[MOST_LINE:]:
            self.failed = "no line of the opening of v2"
        return None

    def _sealed(self, up: bool, key: bytes, vehicle_id: int, nonces: tuple[bytes, bytes]) -> None:
        keys = direction_keys(key, vehicle_id, nonces)
        out, back = keys if up else reversed(keys)
        self.seal, self.done = Seal(vehicle_id, out, back), True


@dataclass
class SealedServer(SealedHandshake):
    """UxAS's end, which speaks first."""

    def start(self) -> bytes:
        """The first line: protocol name and UxAS's nonce."""
        self._own = self.nonce(16).hex().encode()
        return NAME + b"," + self._own + b"\n"

    def _step(self) -> bytes:
        line = self._line()
        if line is None:
            return b""
        match = _SECOND.match(line)
        if match is None:
            return self._refuse("another dialect than v2")
        vehicle_id, nonces = int(match[1]), (self._own, match[2])
        key = self.keys.get(vehicle_id)
        if key is None:
            return self._refuse(f"no key of vehicle {vehicle_id} here")
        if not hmac.compare_digest(proof(key, "icarous", vehicle_id, nonces), match[3]):
            return self._refuse(f"the key of vehicle {vehicle_id} is another one here")
        self._sealed(False, key, vehicle_id, nonces)
        return b"ok," + proof(key, "uxas", vehicle_id, nonces) + b"\n"

    def _refuse(self, why: str) -> bytes:
        self.failed = why
        return b"error," + why.encode() + b"\n"


@dataclass
class SealedClient(SealedHandshake):
    """ICAROUS's end; `keys` holds its vehicle's key."""

    _theirs: bytes = b""

    def _step(self) -> bytes:
        line = self._line()
        begins = (self.rest if line is None else line)[:20]
        if not self._theirs and not NAME.startswith(begins[: len(NAME)]):
            # a UxAS of another dialect sends a greeting without newline, and nothing after it
            self.failed = f"the other end does not speak v2: it begins with {ascii(begins)[1:]}"
            return b""
        if line is None:
            return b""
        ((vehicle_id, key),) = self.keys.items()
        if not self._theirs:
            match = _FIRST.match(line)
            if match is None:
                self.failed = "the other end does not speak v2"
                return b""
            self._own, self._theirs = self.nonce(16).hex().encode(), match[1]
            said = proof(key, "icarous", vehicle_id, (self._theirs, self._own))
            return b"%b,%d,%b,%b\n" % (NAME, vehicle_id, self._own, said)
        nonces = (self._theirs, self._own)
        match = _THIRD.match(line)
        if match is None:
            said = line[:80].removeprefix(b"error,")
            self.failed = f"UxAS refuses: {said.decode('ascii', 'replace')}"
        elif not hmac.compare_digest(proof(key, "uxas", vehicle_id, nonces), match[1]):
            self.failed = f"the other end does not have the key of vehicle {vehicle_id}"
        else:
            self._sealed(True, key, vehicle_id, nonces)
        return b""
