"""Reads captures of the CRATOUS protocol as lines: pcap of TCP and UDP, recorded sessions, text.

pcap: as `tcpdump -w` writes it (not pcapng), of Ethernet, loopback, `any` and raw IP, IPv4 only; TCP segments that
are repeated or out of order are put in their place, and bytes that were not captured are reported. Session: one JSON
object per line; those with `ev` send or write and a text `data` are used. Text: one line each, after `> ` (to UxAS)
or `< ` (to ICAROUS) if the direction is known.
"""

from __future__ import annotations

import json
import re
import struct
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from cratous.bridge.text_protocol.handshake import ACCEPT, HELLO, SECRET_LENGTH
from cratous.spec.errors import BadInput

PCAP = {
    b"\xd4\xc3\xb2\xa1": ("<", 1e-6), b"\xa1\xb2\xc3\xd4": (">", 1e-6),
    b"\x4d\x3c\xb2\xa1": ("<", 1e-9), b"\xa1\xb2\x3c\x4d": (">", 1e-9),
}  # fmt: skip
"""First bytes of a pcap file: byte order, and the unit of a time's fraction [s]."""
_LINK_BYTES = {1: 14, 113: 16, 276: 20, 101: 0, 0: 4, 12: 0}
"""Bytes before IP, by link type: Ethernet, Linux cooked (two), raw, BSD loopback."""
_TCP, _UDP = 6, 17
_LEFT_OUT = re.compile(r"\A<[^<>]*>")
"""The placeholder of a secret in a recorded session."""
_SECRET = re.compile(rb"[0-9a-fA-F]{%d}" % SECRET_LENGTH)
MOST_FLOWS = 1000
MOST_HELD = 1000
"""The most segments of one flow that wait for an earlier one."""
MOST_PENDING = 65_536
"""The most bytes held without a newline; more are given out as they are."""


class Heard(NamedTuple):
    """One captured line without its newline, or the handshake text in its place.

    at_s: time of capture [s], None if the capture has no times. who: sender and receiver as captured. missing: number
    of bytes not captured after `text`, which is truncated.
    """

    at_s: float | None
    who: str
    text: bytes
    missing: int = 0


@dataclass
class _Flow:
    """One direction of a connection: the incomplete line, and TCP's next number with the segments beyond it."""

    begun: bool = False
    pending: bytes = b""
    first: int | None = None
    following: int | None = None
    held: dict[int, bytes] = field(default_factory=dict)

    def lines(self, data: bytes) -> Iterator[bytes]:
        """The lines completed by these bytes; parts of the compatible handshake, which have no newline, count as
        lines."""
        self.pending += data
        while not self.begun:
            known = next((t for t in (HELLO, ACCEPT) if self.pending.startswith(t)), None)
            match = _SECRET.match(self.pending)
            if known is None and match is None:
                self.begun = bool(self.pending)
                break
            whole = known or (match[0] if match else b"")
            yield whole
            self.pending, self.begun = self.pending[len(whole) :], known != HELLO
        *whole_lines, self.pending = self.pending.split(b"\n")
        yield from whole_lines
        if self.pending[MOST_PENDING:]:
            yield self.pending
            self.pending = b""

    def segment(self, number: int, data: bytes) -> Iterator[tuple[int, bytes]]:
        """The data that follow once the segment with this number has arrived, each with the number of bytes missing
        before."""
        if self.following is None:
            self.first = self.following = number
        if data:
            self.held.setdefault(number, data)
        yield 0, self._joined()
        if len(self.held) > MOST_HELD:  # the missing bytes were not captured
            yield from self._onward()

    def rest(self) -> Iterator[tuple[int, bytes]]:
        """The same for the segments that still wait at the end of the capture."""
        while self.held:
            yield from self._onward()

    def _onward(self) -> Iterator[tuple[int, bytes]]:
        before = self.following or 0
        self.following = min(self.held, key=lambda n: (n - before) % 2**32)
        yield (self.following - before) % 2**32, self._joined()

    def _joined(self) -> bytes:
        found, following = b"", self.following or 0
        for _ in range(len(self.held) + 1):
            at = next((n for n in self.held if (following - n) % 2**32 < 2**31), None)
            if at is None:
                break
            part = self.held.pop(at)[(following - at) % 2**32 :]
            found += part
            following = (following + len(part)) % 2**32
        self.following = following
        return found

    def told(self, at_s: float, who: str, parts: Iterable[tuple[int, bytes]]) -> Iterator[Heard]:
        """The lines of parts before which bytes may be missing."""
        for missing, data in parts:
            if missing:
                yield Heard(at_s, who, self.pending, missing)
                self.pending = b""
            yield from (Heard(at_s, who, text) for text in self.lines(data))


def read(data: bytes, where: str) -> Iterator[Heard]:
    """The lines of a capture (pcap, session file or raw lines); BadInput for an unknown format or a truncated file."""
    if data[:4] in PCAP:
        yield from _pcap(data, where)
    elif data.lstrip().startswith(b"{"):
        yield from _session(data, where)
    else:
        flow = _Flow()
        for line in [*flow.lines(data), flow.pending]:
            text = line.removesuffix(b"\r")
            who = {b"> ": "to UxAS", b"< ": "to ICAROUS"}.get(text[:2], "")
            if text.strip():
                yield Heard(None, who, text[2:] if who else text)


def _session(data: bytes, where: str) -> Iterator[Heard]:
    flows: dict[tuple[str, str], _Flow] = {}
    for number, row in enumerate(data.splitlines(), 1):
        try:
            event = json.loads(row) if row.strip() else {}
        except (ValueError, RecursionError) as error:
            raise BadInput("no JSON", where=where, item=f"line {number}", got=str(error)) from None
        said = event.get("data") if isinstance(event, dict) else None
        if not isinstance(said, str) or event.get("ev") not in ("send", "write"):
            continue
        said = _LEFT_OUT.sub("", said)
        who, at_s = str(event.get("who", "")), event.get("t")
        flow = flows.setdefault((who, str(event.get("fd", ""))), _Flow())
        for text in flow.lines(said.encode("utf-8", "replace")):
            yield Heard(at_s if isinstance(at_s, float) else _seconds(at_s), who, text)
    yield from _unfinished((who, flow) for (who, _), flow in flows.items())


def _seconds(said: object) -> float | None:
    try:
        return float(said) if isinstance(said, int) else None
    except OverflowError:
        return None


def _unfinished(flows: Iterable[tuple[str, _Flow]]) -> Iterator[Heard]:
    """The incomplete lines at the end of the capture."""
    return (Heard(None, who, flow.pending) for who, flow in flows if flow.pending)


def _pcap(data: bytes, where: str) -> Iterator[Heard]:
    order, unit_s = PCAP[data[:4]]
    cut = BadInput("capture cut off", where=where, expected="whole packets")
    if len(data) < 24:
        raise cut
    skip = _LINK_BYTES.get(struct.unpack_from(order + "I", data, 20)[0] & 0xFFFF)
    if skip is None:
        raise BadInput(
            "link type of the capture", where=where, expected="Ethernet, loopback or raw IP"
        )
    flows: dict[str, _Flow] = {}
    at, first_s, at_s = 24, None, 0.0
    while at < len(data):
        if len(data) < at + 16:
            raise cut
        whole_s, fraction, length, sent = struct.unpack_from(order + "IIII", data, at)
        at_s = whole_s + fraction * unit_s
        first_s = at_s if first_s is None else first_s
        packet = data[at + 16 : at + 16 + length]
        if len(packet) < length:
            raise cut
        at += 16 + length
        found = _payload(packet[skip:])
        if found is None:
            continue
        if length < sent:
            raise BadInput(
                "packet captured in part", where=where, item=f"{at_s - first_s:.3f} s",
                expected=f"all of its {sent} bytes, as `tcpdump -s 0` has them", got=f"{length} bytes",
            )  # fmt: skip
        if found.who not in flows and len(flows) >= MOST_FLOWS:
            raise BadInput("too many connections", where=where, expected=f"{MOST_FLOWS} at most")
        flow = flows.setdefault(found.who, _Flow())
        if found.begins and flow.first not in (None, found.number):  # the port is reused
            yield from _ended(found.who, flow, at_s - first_s)
            flow = flows[found.who] = _Flow()
        if found.tcp:
            parts = flow.segment(found.number, found.data)
            yield from flow.told(at_s - first_s, found.who, parts)
        else:
            yield Heard(at_s - first_s, found.who, found.data)
    for who, flow in flows.items():
        yield from _ended(who, flow, at_s - (first_s or 0.0))


def _ended(who: str, flow: _Flow, at_s: float) -> Iterator[Heard]:
    """The remaining data of a connection at its end."""
    yield from flow.told(at_s, who, flow.rest())
    yield from _unfinished([(who, flow)])


class _Packet(NamedTuple):
    who: str
    tcp: bool
    begins: bool
    number: int
    data: bytes


def _payload(ip: bytes) -> _Packet | None:
    """The payload of an IPv4 packet; None for a fragment, or a packet other than TCP or UDP."""
    if len(ip) < 20 or ip[0] >> 4 != 4 or ip[0] & 15 < 5 or int.from_bytes(ip[6:8], "big") & 0x3FFF:
        return None
    head, total, kind = 4 * (ip[0] & 15), int.from_bytes(ip[2:4], "big"), ip[9]
    body = ip[head : total or None]
    if kind not in (_TCP, _UDP) or len(body) < (20 if kind == _TCP else 8):
        return None
    ends = [".".join(map(str, ip[k : k + 4])) for k in (12, 16)]
    source, to, number = struct.unpack_from(">HHI", body)
    who = f"{ends[0]}:{source} > {ends[1]}:{to}"
    if kind == _UDP:
        return _Packet(who, False, False, 0, body[8:])
    begins = bool(body[13] & 2)
    number += begins  # SYN counts as one byte
    return _Packet(who, True, begins, number % 2**32, body[4 * (body[12] >> 4) :])
