"""Lines of the CRATOUS text protocol, whole and split at every position, and recorded sessions of
the original.

A case with `line` and `direction` is compared with `strict` (`accept` or `reject`): splitting must
change nothing, and a line of kind `valid` is written again byte for byte. An event `send` of a
session contains whole messages. A case with `true_m` is the distance of a place from a leg, which
our end must judge as neither smaller nor larger. Cases on the original's own behaviour
(publications, exits, its deviation formula) are not covered.
"""

from __future__ import annotations

import struct
from typing import Any

from cratous.bridge.text_protocol import (
    ORIGINAL_LIMITS,
    Dialect,
    Direction,
    Message,
    StreamParser,
    WireError,
    encode,
)
from cratous.bridge.text_protocol.handshake import ACCEPT, HELLO, REFUSE, ClientHandshake
from cratous.bridge.text_protocol.parser import Record
from cratous.core.avoidance.way_ahead import near_line
from cratous.core.kernel import Vec2
from cratous.services.conform import Result, edge, failed, not_covered, passed
from cratous.services.conform.values import number
from cratous.services.mission.frames import Projection
from cratous.spec.errors import BadInput
from cratous.spec.mission import Frame

ITS_OWN = ("split", "bug")
"""Kinds of cases that the original reads incorrectly: split lines, or a fault of its own."""
WHOLE_BYTES = 65535
"""Length of a line that the file abbreviates."""


SPHERE_M, AGREES = 6_371_000.0, 1e-6
"""Radius [m] of the sphere on which distances from a leg are given, and the relative tolerance for ours."""
ELLIPSOID = 0.006
"""On WGS84, where our end flies, distances differ from those by up to this fraction, as radii of curvature do."""


def judge(case: dict[str, Any]) -> Result:
    """Judge one line, or one event of a session."""
    if "line" in case and "direction" in case:
        return _line(case)
    if case.get("ev") == "send":
        return _sent(case)
    if "true_m" in case:
        return _deviation(case)
    return not_covered(str(case.get("n", case.get("test", "?"))), "the original's own behaviour")


def _line(case: dict[str, Any]) -> Result:
    name, text = str(case.get("n", "?")), case["line"]
    if not isinstance(text, str) or case.get("strict") not in ("accept", "reject"):
        raise BadInput("not a case", item=name, expected="a text `line`, `strict` accept or reject")
    if case.get("kind") == "handshake":
        return _handshake(name, text.encode())
    try:
        direction = Direction(case["direction"])
    except ValueError:
        expected = " or ".join(d.value for d in Direction)
        raise BadInput("not a direction", item=name, expected=expected) from None
    data = text.encode()
    if case.get("kind") == "overlong" and "shortened" in str(case.get("note", "")):
        data = data[:1] * WHOLE_BYTES
    whole = _records(direction, data)
    wrong = _cut(direction, data, whole)
    if wrong:
        return failed(name, "another reading when cut", wrong)
    refused = [record for record in whole if isinstance(record, WireError)]
    if bool(refused) != (case["strict"] == "reject"):
        if not refused and case.get("kind") in ITS_OWN:
            return edge(name, "right, and read wrongly by the original", str(case.get("note", "")))
        got = "; ".join(map(str, refused)) or "accepted"
        return failed(name, "another verdict", f"expected {case['strict']}, got {got}")
    if case.get("kind") == "valid" and case["strict"] == "accept":
        written = b"".join(
            encode(one, dialect=Dialect.ORIGINAL, limits=ORIGINAL_LIMITS)
            for one in whole
            if isinstance(one, Message)
        )
        if written != data:
            return failed(name, "written otherwise", f"expected {data!r}, got {written!r}")
    return passed(name, len(data))


def _sent(case: dict[str, Any]) -> Result:
    name, data = f"at {case.get('t', '?')} s", str(case.get("data", "")).encode()
    direction = Direction.DOWN if case.get("who") == "ICS" else Direction.UP
    whole = _records(direction, data, original=True)
    wrong = _cut(direction, data, whole, original=True)
    if wrong:
        return failed(name, "another reading when cut", wrong)
    bad = [str(record) for record in whole if not isinstance(record, Message)]
    if bad or not whole:
        return failed(name, "a message of the original's is not read", "; ".join(bad) or "nothing")
    return passed(name, len(whole))


def _deviation(case: dict[str, Any]) -> Result:
    """Whether our end decides correctly for limits slightly above and below the distance, on the
    sphere and on the ellipsoid. The position has 32-bit numbers, as in the original.
    """
    names = ("lat1", "lon1", "lat2", "lon2", "lat", "lon", "true_m")
    lat1, lon1, lat2, lon2, lat, lon, true_m = (number(case, name) for name in names)
    name = f"{lat:g} {lon:g}, {true_m:.1f} m"
    lat, lon = struct.unpack("ff", struct.pack("ff", lat, lon))
    places = ((lat1, lon1), (lat2, lon2), (lat, lon))
    frame = Frame(lat1, lon1)
    for shape, share in ((Projection(frame, SPHERE_M), AGREES), (Projection(frame), ELLIPSOID)):
        a, b, here = (Vec2(*shape.to_local(*place)) for place in places)
        expected = f"expected {true_m:g} m from the leg, within {share:g} of it"
        if not near_line(here, a, b, true_m * (1 + share)):
            return failed(name, "taken for farther", expected)
        if true_m and near_line(here, a, b, true_m * (1 - share)):
            return failed(name, "taken for nearer", expected)
    return passed(name)


def _records(direction: Direction, *pieces: bytes, original: bool = False) -> list[Record]:
    parser, found = StreamParser(direction, original_peer=original), list[Record]()
    for piece in pieces:
        found += parser.feed(piece)
    return found + parser.finish()


def _cut(direction: Direction, data: bytes, whole: list[Record], original: bool = False) -> str:
    """The first place at which splitting the bytes changes the messages read; empty if none does."""
    for at in range(1, len(data)):
        found = _records(direction, data[:at], data[at:], original=original)
        if found != whole:
            return f"cut after byte {at}: {found}, whole: {whole}"[:300]
    return ""


def _handshake(name: str, data: bytes) -> Result:
    """The server's response to a client's handshake, in one piece and split."""
    if data not in (HELLO, ACCEPT, REFUSE):
        return not_covered(name, "a secret that is not given")
    for at in range(len(data)):
        client = ClientHandshake()
        told = client.feed(b"" if data == HELLO else HELLO)
        for piece in (data[:at], data[at:]):
            told += client.feed(piece)
        right = {HELLO: not client.failed, ACCEPT: client.done, REFUSE: bool(client.failed)}[data]
        if not right or told != client.secret.encode():
            return failed(name, "handshake", f"cut after byte {at}: {client.failed or 'not done'}")
    return passed(name, len(data))
