"""Messages to lines: the exact order of fields and the number formats of the originals.

`%f` has six decimals; latitudes and longitudes have nine in our dialect (0.1 mm instead of
0.1 m), which the originals read as well, and six with `original=True`. Integers end in `.0`.
"""

from __future__ import annotations

import math

from cratous.bridge.text_protocol.layouts import (
    LAYOUT_OF,
    ORIGINAL_LIMITS,
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
# What the words are called on our side: without the underscores of the wire.
WRAPPED = {"_KEEPIN_", "_KEEPOUT_", "_TRAFFIC_", "_OBSTACLE_", "_ACTIVE_", "_PASSIVE_"}


def direction_of(message: Message) -> Direction:
    """Which way the message goes."""
    return LAYOUT_OF[type(message)].direction


def encode(message: Message, *, original: bool = False, limits: Limits = ORIGINAL_LIMITS) -> bytes:
    """The line of a message, newline included; BadInput if a value cannot stand on the wire.

    original: as an original peer writes it: six decimals for positions, no fields of our dialect.
    """
    layout = LAYOUT_OF[type(message)]
    parts = [layout.tag, f"type{layout.form}"] if layout.form else [layout.tag]
    for field in layout.fields:
        value = getattr(message, field.attribute)
        if value is None and field.optional:
            continue
        if original and field.label == "epoch":
            continue
        try:
            parts.append(field.label + _text(field, value, message, original, limits))
        except BadInput as err:
            raise BadInput(
                err.what,
                item=f"{type(message).__name__}.{field.attribute}",
                expected=err.expected,
                got=err.got,
            ) from None
    return (",".join(parts) + ",\n").encode("ascii")


def _text(
    field: FieldLayout, value: object, message: Message, original: bool, limits: Limits
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
        # The original leaves out the .0 only here; fences of ten vertices break it there.
        bare = field.kind is Kind.BARE and not isinstance(message, FenceVertex)
        keepin = isinstance(message, FenceVertex) and message.fence == "KEEPIN"
        if bare or (field.kind is Kind.BARE and original and keepin):
            return f"{value}"
        return f"{value}.0"
    if field.kind is Kind.DEGREES and abs(value) > (90 if "lat" in field.label else 180):
        raise wrong("degrees of latitude or longitude")
    if field.kind is Kind.DEGREES and not original:
        return f"{value:.9f}"
    return f"{value:.6f}"
