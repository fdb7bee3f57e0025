"""Decodes both directions of a CRATOUS connection for an observer who takes no part in it.

The opening tells which end is UxAS's, and the dialect. Packets of v2 are verified with the vehicle's key where it is
available; without it their lines are read unauthenticated, like those of the dialects without keys. Nothing raises
because of received data: what cannot be read is a `WireError`.
"""

from __future__ import annotations

import hmac
from collections.abc import Callable
from typing import NamedTuple

from cratous.bridge.text_connection import PROGRAM_LIMITS
from cratous.bridge.text_protocol.authenticated_lines import (
    DAMAGED,
    MOST_LINE,
    NAME,
    Opening,
    Seal,
    direction_keys,
    line_in,
    opening_of,
    proof,
)
from cratous.bridge.text_protocol.dialects import (
    Dialect,
    has_comma_after_tag,
    has_label_after_tag,
)
from cratous.bridge.text_protocol.handshake import ACCEPT, HELLO, SECRET_LENGTH, is_secret
from cratous.bridge.text_protocol.messages import Direction, Hello, OwnPosition
from cratous.bridge.text_protocol.parser import MAX_LINE, Record, StreamParser, WireError

KeyOf = Callable[[int], bytes | None]
MOST_OPENING = 2 * MOST_LINE
UNJUDGED = 10**18
"""The number of packets sent by the other end is unknown here, so any acknowledgement is accepted."""
NO_OPENING, REFUSED = "not the opening of a CRATOUS bridge", "the opening was refused"


class Said(NamedTuple):
    """A record with its direction; direction None: an error of the connection itself."""

    direction: Direction | None
    record: Record


class _Lines:
    """One direction of a dialect without keys; the first line tells which one."""

    def __init__(self, direction: Direction) -> None:
        self._direction, self._held = direction, b""
        self._parser: StreamParser | None = None

    def feed(self, data: bytes) -> list[Record]:
        if self._parser is None:
            self._held += data
            if b"\n" not in self._held and len(self._held) <= MAX_LINE:
                return []
            line = self._held.partition(b"\n")[0].decode("ascii", "replace")
            thesis = has_label_after_tag(line) and not has_comma_after_tag(line)
            self._parser = _parser(self._direction, Dialect.THESIS if thesis else Dialect.CRATOUS)
            data, self._held = self._held, b""
        return self._parser.feed(data)

    def skip(self) -> None:
        """Bytes are missing here: decoding resumes at the next complete line."""
        if self._parser is not None:
            self._parser.feed(b"\x00")  # makes the truncated line invalid


class _Packets:
    """One direction of v2: verified by its seal, or without a key by checksums alone."""

    def __init__(self, direction: Direction, seal: Seal | None) -> None:
        self._seal, self._part = seal, b""
        self._parser, self._count = _parser(direction, Dialect.CRATOUS), 0

    def feed(self, data: bytes) -> list[Record]:
        wrong: list[WireError] = []
        if self._seal is not None:
            lines, wrong = self._seal.feed(data)
        else:
            *packets, self._part = (self._part + data).split(b"\n")
            lines = b""
            for packet in packets:
                self._count += 1
                line = line_in(packet)
                if line is None:
                    got = ascii(packet[:40])[1:]
                    wrong.append(WireError(self._count, 1, DAMAGED, "a packet of v2", got))
                else:
                    lines += line + b"\n"
            if self._part[MOST_LINE:]:
                wrong.append(WireError(self._count + 1, 1, DAMAGED, f"{MOST_LINE} bytes", "more"))
                self._part = b""
        return [*self._parser.feed(lines), *wrong]

    def skip(self) -> None:
        """Packets are missing here: their sequence numbers are no longer checked."""
        self._seal, self._part = None, b"\x00"


def _parser(direction: Direction, dialect: Dialect) -> StreamParser:
    return StreamParser(direction, limits=PROGRAM_LIMITS, original_peer=True, dialect=dialect)


class Overheard:
    """Decoder of one connection observed from outside.

    vehicle_id: 0 until a message gives it. authenticated: packets are verified with the vehicle's key.
    """

    def __init__(self, key_of: KeyOf = lambda _vehicle: None) -> None:
        """key_of: returns the key of a vehicle, None if it is not available here."""
        self._key_of = key_of
        self.vehicle_id, self.authenticated, self.over = 0, False, False
        self.other_key = False
        """True if the vehicle's key available here is not the one that the two ends use."""
        self._held = {True: b"", False: b""}
        self._ways: dict[bool, tuple[Direction, _Lines | _Packets]] = {}

    @property
    def is_open(self) -> bool:
        """True once the handshake is complete."""
        return bool(self._ways)

    def feed(self, near: bool, data: bytes) -> list[Said]:
        """The records of the next bytes; near: sent by the end that connected, otherwise by the end that listens."""
        if self.over:
            return []
        if not self._ways:
            self._held[near] += data
            return self._opening()
        direction, way = self._ways[near]
        found = [Said(direction, record) for record in way.feed(data)]
        for one in found:
            self._learn(one.record)
        return found

    def skip(self) -> None:
        """Bytes were not copied: decoding resumes at the next complete line, unauthenticated from now on."""
        self.authenticated = False
        for _, way in self._ways.values():
            way.skip()
        if not self._ways:
            self.over = True

    def _learn(self, record: Record) -> None:
        if isinstance(record, Hello) or (isinstance(record, OwnPosition) and not self.vehicle_id):
            self.vehicle_id = self.vehicle_id or record.vehicle_id

    def _opening(self) -> list[Said]:
        """Continue with the opening; bytes received after it are decoded."""
        begun = {uxas: way for uxas in (False, True) if (way := self._begun(self._held[uxas]))}
        if len(begun) == 2:  # both claim to be UxAS's end
            return self._fail(NO_OPENING)
        for uxas, way in begun.items():
            return way(uxas)
        held = [text for text in self._held.values() if text]
        begins = (HELLO, NAME + b",")
        if all(any(b.startswith(t[: len(b)]) for b in begins) for t in held) and len(held) == 1:
            return [] if len(held[0]) <= MOST_OPENING else self._fail(NO_OPENING)
        return self._fail(NO_OPENING)

    def _begun(self, text: bytes) -> Callable[[bool], list[Said]] | None:
        """The continuation for an end that opens like UxAS's; None for any other text."""
        if text.startswith(HELLO):
            return self._plain
        line, newline, _ = text.partition(b"\n")
        opens = newline and line.startswith(NAME + b",") and line.count(b",") == 1
        return self._sealed if opens else None

    def _plain(self, uxas: bool) -> list[Said]:
        answer, secret = self._held[uxas][len(HELLO) :], self._held[not uxas]
        if not ACCEPT.startswith(answer[: len(ACCEPT)]):
            return self._fail(REFUSED)
        if len(answer) < len(ACCEPT) or len(secret) < SECRET_LENGTH:
            return [] if len(answer) + len(secret) < MOST_OPENING else self._fail(NO_OPENING)
        if not is_secret(secret[:SECRET_LENGTH].decode("ascii", "replace")):
            return self._fail(NO_OPENING)
        ways = (_Lines(Direction.DOWN), _Lines(Direction.UP))
        return self._begin(uxas, ways, answer[len(ACCEPT) :], secret[SECRET_LENGTH:])

    def _sealed(self, uxas: bool) -> list[Said]:
        first, _, more = self._held[uxas].partition(b"\n")
        second, newline, up = self._held[not uxas].partition(b"\n")
        third, answered, down = more.partition(b"\n")
        if not (newline and answered):
            held = len(self._held[True]) + len(self._held[False])
            return [] if held < MOST_OPENING else self._fail(NO_OPENING)
        opening = opening_of(first, second)
        if opening is None or not third.startswith(b"ok,"):
            return self._fail(REFUSED)
        self.vehicle_id = opening.vehicle_id
        up_seal, down_seal = self._seals(opening, third)
        ways = (_Packets(Direction.DOWN, down_seal), _Packets(Direction.UP, up_seal))
        return self._begin(uxas, ways, down, up)

    def _seals(self, opening: Opening, third: bytes) -> tuple[Seal | None, Seal | None]:
        vehicle_id, nonces, proved = opening
        key = self._key_of(vehicle_id)
        if key is None:
            return None, None
        both = ((b"", proved, "icarous"), (b"ok,", third, "uxas"))
        for before, given, who in both:
            if not hmac.compare_digest(before + proof(key, who, vehicle_id, nonces), given):
                self.other_key = True
                return None, None
        self.authenticated = True
        up, down = direction_keys(key, vehicle_id, nonces)
        return (
            Seal(vehicle_id, b"", up, sent=UNJUDGED),
            Seal(vehicle_id, b"", down, sent=UNJUDGED),
        )

    def _begin(
        self, uxas: bool, ways: tuple[_Lines | _Packets, _Lines | _Packets], down: bytes, up: bytes
    ) -> list[Said]:
        self._ways = {uxas: (Direction.DOWN, ways[0]), not uxas: (Direction.UP, ways[1])}
        self._held = {}
        return [*self.feed(uxas, down), *self.feed(not uxas, up)]

    def _fail(self, why: str) -> list[Said]:
        held = [text for text in self._held.values() if text]
        # the answer to an opening may contain a secret
        shown = ascii(held[0][:20])[1:] if why == NO_OPENING and len(held) == 1 else ""
        self.over, self._held = True, {}
        return [Said(None, WireError(1, 1, why, "the dialects without keys, or v2", shown))]
