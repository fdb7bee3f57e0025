"""The commands of ZRE version 2 (RFC 36 of ZeroMQ) as bytes, and its beacon.

A command is `AA A1`, its number, version 2, a sequence number, and its fields, big endian; short strings have a
length of one byte, long ones of four. WHISPER and SHOUT are followed by their content in further frames. A beacon is
`ZRE`, version 1, the sender's uuid and its port, 0 when it leaves.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass, field

from cratous.spec.errors import BadInput

SIGNATURE = b"\xaa\xa1"
VERSION = 2
HELLO, WHISPER, SHOUT, JOIN, LEAVE, PING, PING_OK = range(1, 8)
ELECT, LEADER, GOODBYE = 8, 9, 10  # of the C implementation; the first two are not used here
_KNOWN = frozenset(range(1, 11))
_HEAD = struct.Struct(">2sBBH")
_BEACON = struct.Struct(">3sB16sH")
_MOST = 1000  # entries of a list or a table
_TEXT = 65536  # [bytes] of a long string


@dataclass(frozen=True)
class Command:
    """One ZRE command: number, sequence number, and the fields that its kind has."""

    number: int
    sequence: int
    endpoint: str = ""
    groups: tuple[str, ...] = ()
    status: int = 0
    name: str = ""
    headers: dict[str, str] = field(default_factory=dict)
    group: str = ""


def _short(text: str) -> bytes:
    data = text.encode()
    if len(data) > 255:
        raise BadInput("text too long", expected="at most 255 bytes", got=f"{len(data)}")
    return bytes((len(data),)) + data


def _long(text: str) -> bytes:
    data = text.encode()
    return struct.pack(">I", len(data)) + data


def pack(command: Command) -> bytes:
    """The first frame of a command, encoded."""
    c = command
    head = _HEAD.pack(SIGNATURE, c.number, VERSION, c.sequence)
    if c.number == HELLO:
        groups = struct.pack(">I", len(c.groups)) + b"".join(map(_long, c.groups))
        headers = struct.pack(">I", len(c.headers))
        headers += b"".join(_short(k) + _long(v) for k, v in c.headers.items())
        return b"".join(
            (head, _short(c.endpoint), groups, bytes((c.status,)), _short(c.name), headers)
        )
    if c.number == SHOUT:
        return head + _short(c.group)
    if c.number in (JOIN, LEAVE):
        return head + _short(c.group) + bytes((c.status,))
    return head


class _Reader:
    def __init__(self, data: bytes) -> None:
        self.data, self.at = data, _HEAD.size

    def take(self, size: int) -> bytes:
        part = self.data[self.at : self.at + size]
        if len(part) < size:
            raise BadInput(
                "command ends too early",
                where=f"byte {self.at}",
                expected=f"{size} bytes",
                got=f"{len(part)}",
            )
        self.at += size
        return part

    def text(self, data: bytes) -> str:
        try:
            return data.decode()
        except UnicodeDecodeError as error:
            raise BadInput("not UTF-8", where=f"byte {self.at}", got=error.reason) from None

    def short(self) -> str:
        return self.text(self.take(self.take(1)[0]))

    def count(self, most: int) -> int:
        (count,) = struct.unpack(">I", self.take(4))
        if count > most:
            raise BadInput(
                "too long", where=f"byte {self.at}", expected=f"at most {most}", got=f"{count}"
            )
        return int(count)

    def long(self) -> str:
        return self.text(self.take(self.count(_TEXT)))


def unpack(data: bytes) -> Command:
    """The command decoded from a first frame; BadInput with the byte if it is not one."""
    if len(data) < _HEAD.size:
        raise BadInput("command too short", expected=f"{_HEAD.size} bytes", got=f"{len(data)}")
    signature, number, version, sequence = _HEAD.unpack_from(data)
    if signature != SIGNATURE or number not in _KNOWN:
        raise BadInput("not a ZRE command", expected="AAA1 and 1 to 10", got=data[:3].hex())
    if version != VERSION:
        raise BadInput("other version of ZRE", expected=f"{VERSION}", got=f"{version}")
    reader = _Reader(data)
    if number == HELLO:
        endpoint = reader.short()
        groups = tuple(reader.long() for _ in range(reader.count(_MOST)))
        status, name = reader.take(1)[0], reader.short()
        headers = {reader.short(): reader.long() for _ in range(reader.count(_MOST))}
        return Command(number, sequence, endpoint, groups, status, name, headers)
    if number == SHOUT:
        return Command(number, sequence, group=reader.short())
    if number in (JOIN, LEAVE):
        return Command(number, sequence, group=reader.short(), status=reader.take(1)[0])
    return Command(number, sequence)


def beacon(uuid: bytes, port: int) -> bytes:
    """The bytes of a beacon; port 0 announces that the node leaves."""
    return _BEACON.pack(b"ZRE", 1, uuid, port)


def read_beacon(data: bytes) -> tuple[bytes, int] | None:
    """(uuid, port) of a beacon, or None if it is not one of version 1 (other protocols share the port)."""
    if len(data) != _BEACON.size:
        return None
    name, version, uuid, port = _BEACON.unpack(data)
    return (uuid, port) if name == b"ZRE" and version == 1 else None
