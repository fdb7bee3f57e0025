"""Fast reading of lines in the form that our writer and the originals produce: all fields, in order, numbers in full.

Nearly all lines have this form, including those of each heartbeat. For any other line, including a malformed one, the
result is None, and `parser` reads it and reports errors; both give the same message for a line read here.
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
"""The number of bytes that distinguish the tags."""
_REAL, _COUNT = rb"(-?[0-9]{1,14}\.[0-9]{1,12})", rb"([0-9]{1,14})\.0"
_KINDS = {
    Kind.REAL: (_REAL, float),
    Kind.DEGREES: (_REAL, float),
    Kind.COUNT: (_COUNT, int),
    Kind.BARE: (_COUNT, int),
}


MOST_KNOWN = 512
"""The most lines cached with their messages: the same line goes to every vehicle at a heartbeat."""


class Plain(NamedTuple):
    """How one message is read. read: pattern of the whole line; values: conversion of each field; within: index and
    bounds of values, outside of which the line is not plain; known: cache of recent lines."""

    read: re.Pattern[bytes]
    message: type[Message]
    names: tuple[str, ...]
    values: tuple[Callable[[bytes], Any], ...]
    within: tuple[tuple[int, float, float], ...]
    known: dict[bytes, Message]


@functools.cache
def plain_lines(layouts: tuple[Layout, ...], limits: Limits) -> Mapping[bytes, Plain]:
    """Messages with a single form and no optional fields, by the first bytes of their tag."""
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
    """The message of the line data[start:end], without its newline; None if it is not plain."""
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
