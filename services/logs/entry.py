"""One logged message, and its body as object, JSON text or LMCP bytes.

A body is kept in the form in which it was logged: canonical JSON text (a flight's log) or the bytes
of the LMCP message (the message logger, lossless for series without a model). What cannot be
decoded is kept as `{"$lmcp": base64}` and never omitted.
"""

from __future__ import annotations

import base64
import binascii
from typing import Any, NamedTuple

from cratous.spec.errors import BadInput
from cratous.spec.files.limits import json_of

RAW = "$lmcp"


class Entry(NamedTuple):
    """A message in a log; the last five fields are those of UxAS's envelope, if there was one.

    seq: number in the log, from 0, consecutive unless messages were lost; time_ms: time of the
    log's clock [ms]; source: the sender's name; topic: full type name; body: JSON text or LMCP
    bytes; address: where it was sent, None for its topic; ids are strings as on the wire;
    content_type: None for `lmcp`.
    """

    seq: int
    time_ms: int
    source: str
    topic: str
    body: str | bytes
    address: str | None = None
    group: str | None = None
    entity_id: str | None = None
    service_id: str | None = None
    content_type: str | None = None

    @property
    def place(self) -> str:
        """How an error message names this message."""
        return f"message {self.seq} ({self.topic})"


def to_object(entry: Entry) -> Any:
    """The LMCP object; BadInput if its type is unknown or the body is damaged."""
    from cratous.bridge import lmcp

    if isinstance(entry.body, bytes):
        return lmcp.binary.unpack(entry.body, entry.place)
    raw = raw_bytes(entry)
    if raw is not None:
        return lmcp.binary.unpack(raw, entry.place)
    return lmcp.from_json(entry.body, entry.place)


def to_bytes(entry: Entry) -> bytes:
    """The bytes of the LMCP message, as logged or packed again."""
    from cratous.bridge import lmcp

    if isinstance(entry.body, bytes):
        return entry.body
    raw = raw_bytes(entry)
    return lmcp.binary.pack(to_object(entry)) if raw is None else raw


def to_text(entry: Entry) -> str:
    """Canonical JSON text; BadInput for bytes that cannot be decoded."""
    from cratous.bridge import lmcp

    return entry.body if isinstance(entry.body, str) else lmcp.to_json(to_object(entry))


def to_data(entry: Entry) -> Any:
    """The JSON form as plain data; BadInput if it cannot be decoded or is not JSON."""
    if isinstance(entry.body, bytes):
        from cratous.bridge import lmcp

        return lmcp.to_data(lmcp.binary.unpack(entry.body, entry.place))
    return json_of(entry.body, entry.place)


def to_raw_data(body: bytes) -> dict[str, str]:
    """The JSON form of bytes that cannot be decoded."""
    return {RAW: base64.b64encode(body).decode("ascii")}


def any_data(entry: Entry) -> tuple[Any, BadInput | None]:
    """The JSON form, or the undecodable bytes as `{"$lmcp": ...}` with the reason."""
    try:
        return to_data(entry), None
    except BadInput as error:
        if isinstance(entry.body, bytes):
            return to_raw_data(entry.body), error
        return {"$text": entry.body}, error


def raw_bytes(entry: Entry) -> bytes | None:
    """The bytes in a body `{"$lmcp": ...}`; None for any other body."""
    if isinstance(entry.body, bytes) or not entry.body.startswith(f'{{"{RAW}"'):
        return None
    return from_raw_data(json_of(entry.body, entry.place), entry.place)


def from_raw_data(data: Any, where: str) -> bytes:
    """The bytes of `{"$lmcp": base64}`; BadInput if they are damaged."""
    try:
        return base64.b64decode(data[RAW], validate=True)
    except (KeyError, TypeError, binascii.Error) as error:
        raise BadInput("damaged bytes", where=where, expected="base64", got=str(error)) from None


def topic_of(body: bytes) -> str:
    """Full type name in the header of an LMCP message, `unknown.SERIES.type` without a model.

    BadInput if the bytes are too short to contain it.
    """
    if len(body) < 23 or body[:4] != b"LMCP" or body[8] != 1:
        raise BadInput("not an LMCP message", got=repr(body[:12]))
    series = body[9:17].rstrip(b"\0").decode("latin-1")
    number = int.from_bytes(body[17:21], "big")
    for cls in _classes(series):
        if cls.type_id == number:
            return str(cls.all_names[0])
    return f"unknown.{series}.{number}"


def _classes(series: str) -> list[Any]:
    from cratous.bridge.lmcp import model, types

    try:
        loaded = model.load(series)
    except BadInput:
        return []
    return [types[loaded.full_name(name)] for name in loaded.structs]
