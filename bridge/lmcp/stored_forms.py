"""Messages from bytes in any of the forms in which they are stored, and back.

    for found in forms.read(data, "capture.bin"): found.where, found.address, found.object

| form | is |
|---|---|
| `binary` | LMCP messages one after the other |
| `envelope` | one message with address and attributes, as in a ZeroMQ part |
| `frames` | a stream of sentinel frames |
| `hex` | any of these in hexadecimal, blanks and line ends ignored |
| `xml` | an LMCP object, or a root that holds several |
| `json` | our JSON form: one object, a list of objects, or one per line |

Gzipped data are unpacked first. A malformed message does not hide the others of a stream: it is
returned as an error in its place.
"""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from cratous.bridge import envelope, sentinel
from cratous.bridge.lmcp import binary, jsonform, xml
from cratous.bridge.lmcp.objects import LmcpObject, full_names
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import MESSAGES_BYTES, inflated, json_of

FORMS = ("binary", "envelope", "frames", "hex", "xml", "json")
OUTPUTS = ("json", "xml", "binary", "envelope", "frames", "hex")
_LOGS = (b"SQLite format 3\0", b"\x89MCAP0")
_HEX = re.compile(rb"[0-9a-fA-F\s]+\Z")
_ENVELOPE = re.compile(rb"[^$\0]{1,4096}\$[^$\0]{1,4096}\$LMCP")


@dataclass(frozen=True)
class Found:
    """One message: its place, its object or the error, its envelope if any."""

    where: str
    object: Any
    error: BadInput | None = None
    envelope: envelope.AddressedMessage | None = None


def form_of(data: bytes, where: str = "input") -> str:
    """The form of these bytes; raises BadInput if it is none of them."""
    start = data[:4096].lstrip(b"\xef\xbb\xbf \t\r\n")
    if data.startswith(binary.TAG):
        return "binary"
    if sentinel.HEAD in data[:65536]:
        return "frames"
    if start.startswith(b"<"):
        return "xml"
    if start.startswith((b"{", b"[")):
        return "json"
    if _ENVELOPE.match(data):
        return "envelope"
    if start and _HEX.match(data):
        return "hex"
    if data.startswith(_LOGS):
        raise BadInput(
            "a message log", where=where, expected="LMCP; `cratous log` reads logs, also into .lmcp"
        )
    got = repr(data[:24])[1:] if data else "nothing: it is empty"
    raise BadInput("no form of LMCP", where=where, expected=" or ".join(FORMS), got=got)


def read(data: bytes, where: str = "input", form: str = "auto") -> Iterator[Found]:
    """Every message of these bytes; raises BadInput where no further messages can be separated."""
    data = _unzipped(data, where)
    form = form_of(data, where) if form == "auto" else form
    if form == "hex":
        text = b"".join(data.split())
        try:
            plain = bytes.fromhex(text.decode("ascii"))
        except ValueError as err:
            raise BadInput("not hexadecimal", where=where, got=str(err)) from None
        inner = form_of(plain, where)
        if inner not in ("binary", "envelope", "frames"):
            raise BadInput("no LMCP in this hexadecimal", where=where, got=inner)
        yield from read(plain, where, inner)
    elif form == "binary":
        at = 0
        for raw in binary.split(data, where):
            yield _message(raw, f"{where}: message at byte {at}", None)
            at += len(raw)
    elif form == "envelope":
        yield _addressed(data, where)
    elif form == "frames":
        yield from _frames(data, where)
    elif form == "xml":
        notes: list[str] = []
        for number, obj in enumerate(xml.loads(data, where, notes, finite=False), 1):
            yield Found(f"{where}: object {number}", obj)
    elif form == "json":
        yield from _json(data, where)
    else:
        raise BadInput("unknown form", item="form", expected=" or ".join(FORMS), got=form)


def _unzipped(data: bytes, where: str) -> bytes:
    if not data.startswith(b"\x1f\x8b"):
        return data
    return inflated(data, where, MESSAGES_BYTES)


def _message(raw: bytes, where: str, around: envelope.AddressedMessage | None) -> Found:
    try:
        return Found(where, binary.unpack(raw, where), None, around)
    except BadInput as err:
        return Found(where, None, err, around)


def _addressed(raw: bytes, where: str) -> Found:
    try:
        around = envelope.parse(raw, where)
    except BadInput as err:
        return Found(where, None, err)
    return _message(around.payload, where, around)


def _frames(data: bytes, where: str) -> Iterator[Found]:
    waiting: list[sentinel.Drop] = []
    stream = sentinel.FrameStream(on_drop=waiting.append)
    number = 0
    for at in range(0, len(data) + 1, 65536):
        part = data[at : at + 65536]
        for payload in stream.feed(part) if part else stream.close():
            number += 1
            yield _addressed(payload, f"{where}: frame {number}")
        for drop in waiting:
            yield Found(f"{where}: byte {drop.offset}", None, drop.error(where))
        waiting.clear()
    for payload in stream.close():
        number += 1
        yield _addressed(payload, f"{where}: frame {number}")
    for drop in waiting:
        yield Found(f"{where}: byte {drop.offset}", None, drop.error(where))


def _json(data: bytes, where: str) -> Iterator[Found]:
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as err:
        raise BadInput("not UTF-8", where=f"{where}: byte {err.start}", got=err.reason) from None
    try:
        whole = json_of(text, where)
    except BadInput:
        whole = None  # one object per line, or malformed: reading by lines tells
    if whole is not None:
        parts = whole if isinstance(whole, list) else [whole]
        for number, part in enumerate(parts, 1):
            yield _found(jsonform.from_dict, part, f"{where}: object {number}")
        return
    for number, line in enumerate(io.StringIO(text), 1):
        if line.strip():
            yield _found(jsonform.from_json, line, f"{where}:{number}")


def _found(read_one: Callable[[Any, str], Any], part: Any, where: str) -> Found:
    try:
        return Found(where, read_one(part, where))
    except BadInput as err:
        return Found(where, None, err)


def write(obj: LmcpObject, form: str, around: envelope.AddressedMessage | None = None) -> bytes:
    """An object in one of OUTPUTS, text forms with a line end.

    `envelope` and `frames` take the address and attributes of `around`, or else those of a message addressed to its
    type, from entity 0 and service 0.
    """
    if form == "json":
        return jsonform.to_json(obj).encode() + b"\n"
    if form == "xml":
        return xml.dumps(obj).encode()
    raw = binary.pack(obj)
    if form == "binary":
        return raw
    if form == "hex":
        return raw.hex().encode() + b"\n"
    name = full_names(obj)[0]
    message = envelope.enclose(name, raw)
    if around is not None:
        message = envelope.AddressedMessage(
            around.address or name, around.content_type, name, around.group, around.entity_id,
            around.service_id, raw,
        )  # fmt: skip
    if form == "envelope":
        return message.pack()
    if form == "frames":
        return sentinel.frame(message.pack())
    raise BadInput("unknown form", item="form", expected=" or ".join(OUTPUTS), got=form)
