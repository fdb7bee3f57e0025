"""Lines as our writer and the originals write them, read at once: all fields, in order, numbers in full.

That is how nearly all lines come, those of each heartbeat among them. Any other line gives None here, one that is refused
too, and is read by `parser`, which says what is wrong; what is read here it reads as the same message.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from cratous.bridge.text_protocol.layouts import FieldLayout, Kind, Layout, Limits
from cratous.bridge.text_protocol.messages import Message

TAG_BYTES = 5
"""So many bytes tell the tags apart."""
_REAL, _COUNT = rb"(-?[0-9]{1,14}\.[0-9]{1,12})", rb"([0-9]{1,14})\.0"
_KINDS = {
    Kind.REAL: (_REAL, float),
    Kind.DEGREES: (_REAL, float),
    Kind.COUNT: (_COUNT, int),
    Kind.BARE: (_COUNT, int),
}


MOST_KNOWN = 512
"""So many lines are remembered with what they say: the same one goes to every vehicle at a heartbeat."""


class Plain(NamedTuple):
    """How one message is read. read: the whole line; values: of each field; within: which value lies from where to
    where, else the line is not plain; known: lines that were read last."""

    read: re.Pattern[bytes]
    message: type[Message]
    names: tuple[str, ...]
    values: tuple[Callable[[bytes], Any], ...]
    within: tuple[tuple[int, float, float], ...]
    known: dict[bytes, Message]


@functools.cache
def plain_lines(layouts: tuple[Layout, ...], limits: Limits) -> Mapping[bytes, Plain]:
    """By the first bytes of their tag: the messages of one form, each of whose fields is always there."""
    found = {}
    for layout in layouts:
        fields = layout.fields
        if not layout.form and not any(f.optional or f.kind is Kind.TEXT for f in fields):
            found[layout.tag.encode()[:TAG_BYTES]] = _plain(layout, limits)
    return MappingProxyType(found)


def _plain(layout: Layout, limits: Limits) -> Plain:
    pattern, values = re.escape(layout.tag.encode()) + b",", list[Callable[[bytes], Any]]()
    for field in layout.fields:
        text, value = _field(field)
        pattern += re.escape(field.label.encode()) + text + b","
        values.append(value)
    within = [
        (k, *_bounds(field, limits))
        for k, field in enumerate(layout.fields)
        if field.kind in (Kind.DEGREES, Kind.COUNT, Kind.BARE)
    ]
    names = tuple(field.attribute for field in layout.fields)
    read = re.compile(pattern + rb"\r?")
    return Plain(read, layout.message, names, tuple(values), tuple(within), {})


def _field(field: FieldLayout) -> tuple[bytes, Callable[[bytes], Any]]:
    if field.kind is not Kind.WORD:
        return _KINDS[field.kind]
    words = {word.encode(): word.strip("_") for word in field.words}
    return b"(" + b"|".join(map(re.escape, words)) + b")", words.__getitem__


def _bounds(field: FieldLayout, limits: Limits) -> tuple[float, float]:
    if field.kind is Kind.DEGREES:
        most = 90.0 if "lat" in field.label else 180.0
        return -most, most
    low = 0 if field.low is None else field.low
    return low, getattr(limits, field.high) if field.high else 10**14


def message_of(plain: Plain, data: bytes, start: int, end: int) -> Message | None:
    """The message of the line from start to end of data, without its newline; None if it is not plain."""
    line = bytes(data[start:end])
    known = plain.known.get(line)
    if known is not None:
        return known
    match = plain.read.fullmatch(line)
    if match is None:
        return None
    values = [value(text) for value, text in zip(plain.values, match.groups(), strict=True)]
    for k, low, high in plain.within:
        if not low <= values[k] <= high:
            return None
    message = plain.message(**dict(zip(plain.names, values, strict=True)))
    if len(plain.known) >= MOST_KNOWN:
        plain.known.clear()
    plain.known[line] = message
    return message
