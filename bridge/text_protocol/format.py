"""Messages to lines: the exact order of fields and the number formats of the originals.

`%f` has six decimals; latitudes and longitudes have nine in our dialect (0.1 mm instead of 0.1 m), which the
originals read as well, and six in the others. Integers end in `.0`; in the thesis's dialect they do not, and trailing
zeros of decimals are omitted, as in its example.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

from cratous.bridge.text_protocol.dialects import LAYOUT_IN, Dialect
from cratous.bridge.text_protocol.layouts import (
    LAYOUT_OF,
    ORIGINAL_LIMITS,
    OURS_ALONE,
    TEXT,
    FieldLayout,
    Kind,
    Limits,
)
from cratous.bridge.text_protocol.messages import (
    Direction,
    FenceVertex,
    Message,
)
from cratous.spec.errors import BadInput

# Numbers beyond this have more digits than any of the protocol's quantities can need.
LARGEST_NUMBER = 10**15
# Our names of the words: without the underscores of the wire.
WRAPPED = {"_KEEPIN_", "_KEEPOUT_", "_TRAFFIC_", "_OBSTACLE_", "_ACTIVE_", "_PASSIVE_"}


def direction_of(message: Message) -> Direction:
    """The direction in which a message of this type is sent."""
    return LAYOUT_OF[type(message)].direction


def may_go(message: Message, direction: Direction) -> bool:
    """True if a message of this type may be sent in that direction."""
    layout = LAYOUT_OF[type(message)]
    return layout.both or layout.direction is direction


def encode(
    message: Message, *, dialect: Dialect = Dialect.CRATOUS, limits: Limits = ORIGINAL_LIMITS
) -> bytes:
    """The line of a message, newline included; BadInput if a value cannot be encoded.

    dialect: in which it is written; in dialects other than ours there are no epochs and no request numbers.
    """
    if dialect is Dialect.CRATOUS:
        plain = _plain_line(message, limits)
        if plain is not None:
            return plain
    layout = LAYOUT_IN[dialect][type(message)]
    parts = [f"type{layout.form}"] if layout.form else []
    for field in layout.fields:
        value = getattr(message, field.attribute)
        if value is None and field.optional:
            continue
        if not dialect.ours and field.optional and field.label in OURS_ALONE:
            continue
        try:
            parts.append(field.label + _text(field, value, message, dialect, limits))
        except BadInput as err:
            raise BadInput(
                err.what,
                item=f"{type(message).__name__}.{field.attribute}",
                expected=err.expected,
                got=err.got,
            ) from None
    tag = layout.tag if dialect is Dialect.THESIS else layout.tag + ","
    return (tag + ",".join(parts) + ",\n").encode("ascii")


class _Plain(NamedTuple):
    """How a field is written in our dialect. digits: of decimals, for a float; suffix: after an integer, None where
    none may stand; low, most: bounds of both; high: name of the limit of an integer; words: by our names of them.
    """

    attribute: str
    label: str
    optional: bool
    digits: str
    suffix: str | None
    low: float
    most: float
    high: str
    words: Mapping[str, str]


def _plain(field: FieldLayout, kind: type[Message]) -> _Plain:
    low, most, digits = -LARGEST_NUMBER, LARGEST_NUMBER, ""
    suffix: str | None = None
    if field.kind is Kind.REAL:
        digits = ".6f"
    elif field.kind is Kind.DEGREES:
        most = 90 if "lat" in field.label else 180
        low, digits = -most, ".9f"
    elif field.kind in (Kind.COUNT, Kind.BARE):
        low = low if field.low is None else field.low
        suffix = "" if field.kind is Kind.BARE and kind is not FenceVertex else ".0"
    words = {word.strip("_"): word for word in field.words} if field.kind is Kind.WORD else {}
    return _Plain(
        field.attribute, field.label, field.optional, digits, suffix, low, most, field.high, words
    )


_PLAIN = {
    kind: (
        f"{layout.tag}," + (f"type{layout.form}," if layout.form else ""),
        tuple(_plain(field, kind) for field in layout.fields),
    )
    for kind, layout in LAYOUT_IN[Dialect.CRATOUS].items()
}
"""The beginning of the lines of each type of message, and its fields."""


def _plain_line(message: Message, limits: Limits) -> bytes | None:
    """The line of a message in our dialect if each value is of its type and within its bounds, as nearly all are; None
    otherwise, and `encode` writes it or says what is wrong.
    """
    begins, fields = _PLAIN[type(message)]
    parts = [begins]
    for attribute, label, optional, digits, suffix, low, most, high, words in fields:
        value = getattr(message, attribute)
        if value is None and optional:
            continue
        if type(value) is float:
            # below the largest number, but up to 90 and 180 degrees
            if not digits or not (low < value < most or abs(value) == most < LARGEST_NUMBER):
                return None
            parts.append(f"{label}{value:{digits}},")
        elif type(value) is int:
            highest = getattr(limits, high) if high else most
            if suffix is None or not low <= value <= highest or not -most < value < most:
                return None
            parts.append(f"{label}{value}{suffix},")
        elif type(value) is str and value in words:
            parts.append(f"{label}{words[value]},")
        else:
            return None
    if len(parts) == 1:
        return None
    parts.append("\n")
    return "".join(parts).encode("ascii")


def _text(
    field: FieldLayout, value: object, message: Message, dialect: Dialect, limits: Limits
) -> str:
    def wrong(expected: str) -> BadInput:
        return BadInput("value that cannot be sent", expected=expected, got=repr(value)[:60])

    if field.kind is Kind.WORD:
        for word in field.words:
            if value == word.strip("_"):
                return word
        raise wrong(" or ".join(word.strip("_") for word in field.words))
    if field.kind is Kind.TEXT:
        if not isinstance(value, str) or not TEXT.fullmatch(value):
            raise wrong("1 to 40 letters, digits and _")
        return value
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise wrong("a number")
    if not math.isfinite(value) or abs(value) >= LARGEST_NUMBER:
        raise wrong("a finite number below 1e15")
    if field.kind in (Kind.COUNT, Kind.BARE):
        high = getattr(limits, field.high) if field.high else LARGEST_NUMBER
        if (
            not isinstance(value, int)
            or value > high
            or (field.low is not None and value < field.low)
        ):
            raise wrong(f"an integer from {field.low} to {high}")
        if dialect is Dialect.THESIS:
            return f"{value + field.first}"
        # The original omits the .0 only here, and thereby misreads its own zones of ten vertices.
        bare = field.kind is Kind.BARE and not isinstance(message, FenceVertex)
        keepin = isinstance(message, FenceVertex) and message.fence == "KEEPIN"
        if bare or (field.kind is Kind.BARE and dialect is Dialect.ORIGINAL and keepin):
            return f"{value}"
        return f"{value}.0"
    if field.kind is Kind.DEGREES and abs(value) > (90 if "lat" in field.label else 180):
        raise wrong("degrees of latitude or longitude")
    if field.kind is Kind.DEGREES and dialect.ours:
        return f"{value:.9f}"
    text = f"{value:.6f}"
    return text.rstrip("0").rstrip(".") if dialect is Dialect.THESIS else text
