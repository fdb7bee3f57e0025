"""Logs as text or frame files: JSON lines, XML of AMASE, sentinel frames; reading and writing.

JSON lines and MCAP preserve all of an entry. The XML is an AMASE scenario (`Time` in seconds), so
that AMASE can play it; the envelope is in additional attributes. Frames and bare LMCP messages have
no times: entries read from them have time 0.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

from cratous.bridge import envelope, lmcp
from cratous.bridge.sentinel import FrameStream, frame
from cratous.services.logs.entry import (
    RAW,
    Entry,
    any_data,
    from_raw_data,
    to_bytes,
    to_object,
    topic_of,
)
from cratous.services.logs.records import canonical
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import json_of
from cratous.spec.files.printable import json_text, printable
from cratous.spec.files.text_file import bytes_of, lines_of

_OPTIONAL = ("address", "group", "entity_id", "service_id", "content_type")
_XML_NAMES = ("Address", "Group", "EntityID", "ServiceID", "ContentType")
_BLOCK = 1 << 16


def json_line(entry: Entry) -> tuple[str, BadInput | None]:
    """An entry as one line of JSON; an undecodable body is included raw, with the error."""
    data, error = any_data(entry)
    head: dict[str, Any] = {
        "seq": entry.seq,
        "time_ms": entry.time_ms,
        "source": entry.source,
        "topic": entry.topic,
    }
    for name, value in zip(_OPTIONAL, entry[5:], strict=True):
        if value is not None:
            head[name] = value
    if isinstance(entry.body, bytes) and error is None:
        head["form"] = "lmcp"  # the body was logged as bytes
    head["body"] = data
    return json_text(head), error


def read_json_lines(path: Path) -> Iterator[Entry]:
    """The messages of a JSON-lines file; BadInput with the line number for an invalid entry."""
    for number, line in lines_of(path):
        if line.strip():
            yield _from_line(line, f"{path}:{number}")


def _from_line(line: str, where: str) -> Entry:
    try:
        data = json_of(line, where)
    except BadInput as error:
        if error.what == "not JSON":
            error = BadInput("not JSON (is the file truncated?)", where=where, got=error.got)
        raise error from None
    wanted: tuple[tuple[str, type], ...] = (
        ("seq", int),
        ("time_ms", int),
        ("source", str),
        ("topic", str),
        ("body", dict),
    )
    for name, kind in wanted:
        if not isinstance(data, dict) or type(data.get(name)) is not kind:
            raise BadInput("not a logged message", where=where, item=name, expected=kind.__name__)
    outside = [data.get(name) for name in _OPTIONAL]
    if any(not isinstance(value, (str, type(None))) for value in outside):
        raise BadInput("wrong envelope", where=where, expected="texts", got=repr(outside)[:80])
    body = data["body"]
    form: str | bytes
    if RAW in body:
        form = from_raw_data(body, where)
    elif set(body) == {"$text"}:
        form = str(body["$text"])
    elif data.get("form") == "lmcp":
        form = lmcp.binary.pack(lmcp.from_dict(body, where))
    else:
        form = json.dumps(body, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    return Entry(data["seq"], data["time_ms"], data["source"], data["topic"], form, *outside)


XML_HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n<AMASE>\n<ScenarioEventList>\n'
XML_TAIL = "</ScenarioEventList>\n</AMASE>\n"


def xml_event(entry: Entry) -> str:
    """One event of an AMASE scenario; BadInput if the message has no XML form."""
    text = lmcp.xml.dumps(to_object(entry))
    about = f' Time="{entry.time_ms / 1000:.3f}" Seq="{entry.seq}"'
    about += f" Source={quoteattr(entry.source)}"
    for name, value in zip(_XML_NAMES, entry[5:], strict=True):
        if value is not None:
            about += f" {name}={quoteattr(value)}"
    end = text.index(">")  # of the root's tag, whose attributes contain no such character
    return text[:end] + about + text[end:]


def read_xml(path: Path) -> Iterator[Entry]:
    """The messages of an AMASE scenario or playback file, or of a file of LMCP objects."""
    root = lmcp.xml.parse(bytes_of(path), str(path))
    events: Any = root
    if root.tag == "AMASE":
        events = root.find("ScenarioEventList")
        events = [] if events is None else events
    elif root.get("Series") is not None:
        events = [root]
    for number, element in enumerate(events):
        where = f"{path}:{element.sourceline}"
        message = lmcp.xml.read_element(element, str(path), [])
        time_ms = round(_number(element.get("Time", "0"), where) * 1000)
        seq = int(_number(element.get("Seq", str(number)), where))
        outside = [element.get(name) for name in _XML_NAMES]
        topic = message.all_names[0]
        source = element.get("Source", "")
        yield Entry(seq, time_ms, source, topic, lmcp.to_json(message), *outside)


def _number(text: str, where: str) -> float:
    try:
        number = float(text)
        if number - number == 0:  # neither infinite nor not-a-number
            return number
    except ValueError:
        pass
    raise BadInput("wrong number", where=where, item="Time or Seq", expected="a number", got=text)


def addressed(entry: Entry) -> envelope.AddressedMessage:
    """The message in its original envelope, or in one made from its type."""
    return envelope.AddressedMessage(
        entry.address or entry.topic,
        entry.content_type or envelope.LMCP,
        entry.topic,
        entry.group or "",
        entry.entity_id or "0",
        entry.service_id or "0",
        to_bytes(entry),
    )


def framed(entry: Entry) -> bytes:
    """The sentinel frame of a message, as on UxAS's TCP bridge."""
    return frame(addressed(entry).pack())


def entry_of(seq: int, time_ms: int, message: envelope.AddressedMessage) -> Entry:
    """The log entry of a message in an envelope, whose parts are kept as received."""
    topic = message.descriptor or message.address
    return Entry(
        seq,
        time_ms,
        f"{message.entity_id}/{message.service_id}",
        topic,
        message.payload,
        None if message.address == topic else message.address,
        message.group or None,
        message.entity_id,
        message.service_id,
        None if message.content_type == envelope.LMCP else message.content_type,
    )


def read_frames(path: Path) -> Iterator[Entry]:
    """The messages of a captured stream of sentinel frames; BadInput for bytes between them."""
    stream, seq = FrameStream(), 0
    with path.open("rb") as source:
        while True:
            data = source.read(_BLOCK)
            for payload in stream.feed(data) if data else stream.close():
                where = f"{path}: frame {seq}"
                yield entry_of(seq, 0, envelope.parse(payload, where))
                seq += 1
            if stream.drops:
                raise stream.drops[0].error(str(path))
            if not data:
                return


def read_lmcp(path: Path) -> Iterator[Entry]:
    """The messages of a file of concatenated bare LMCP messages."""
    at = seq = 0
    with path.open("rb") as source:
        while head := source.read(8):
            where = f"{path}: byte {at}"
            size = int.from_bytes(head[4:8], "big") + 4
            if len(head) < 8 or head[:4] != b"LMCP" or size > 1 << 28:
                raise BadInput("not an LMCP message", where=where, got=repr(head))
            rest = source.read(size)
            if len(rest) < size:
                raise BadInput(
                    "the file ends too early", where=where, expected=f"{size}", got=f"{len(rest)}"
                )
            body = head + rest
            yield Entry(seq, 0, "", topic_of(body), body)
            at, seq = at + len(body), seq + 1


def text_form(entry: Entry) -> str:
    """One line of text: number, time [s], sender, address if any, type, body as JSON."""
    data, error = any_data(entry)
    body = canonical(data) if error is None else f"({error})"
    to = f" to {entry.address}" if entry.address else ""
    line = f"{entry.seq:>7} {entry.time_ms / 1000:10.3f} {entry.source}{to} {entry.topic} {body}"
    return printable(line)
