"""Bounds on external input, in one place, each checked before its cost is incurred.

A bound is well above what the formats are used for, and low enough that a file costs no more than some hundred
megabytes and a few seconds. Input beyond a bound is refused with the bound.
"""

from __future__ import annotations

import json
import re
import zlib
from typing import Any

from cratous.spec.errors import BadInput

CONFIG_BYTES = 1_000_000
"""A configuration or a process-algebra text."""
MISSION_BYTES, MISSION_NODES, MISSION_DEPTH = 5_000_000, 100_000, 32
"""A mission file: its size, its number of values, and its nesting depth."""
DOCUMENT_BYTES = 64_000_000
"""A file held in memory as a whole: JSON, XML, encounters, captured bytes; also its size after decompression."""
CONTAINERS, VALUES, DEPTH = 1_000_000, 16_000_000, 100
"""A JSON text: its lists and objects, its values, and its nesting depth."""
TAGS = 2_000_000
"""Start and end tags in an XML file."""
LINE_BYTES, LINES, STREAM_BYTES = 64_000_000, 1_000_000, 1_000_000_000
"""A file read line by line: the length of a line; for a gzipped one, also the number of lines and the total size."""
MESSAGES_BYTES = 256_000_000
"""LMCP messages in one input, after decompression."""
ENCOUNTER_ROWS = 500_000
"""States in an encounter file."""
CELL_BYTES = 64_000_000
"""A value in a database, and a record or a decompressed chunk of an MCAP file."""
STATES = 500_000
"""States of one layer in a certificate; the search keeps at most 200 000."""
TRAVEL_CELLS = 10_000_000
"""Entries of an assignment problem's travel times: vehicles times options squared."""
DIGITS = 300
"""Digits of a number: this many fit a double, so that it can be compared and shown."""

_EXPONENT = re.compile(r"[eE][+-]?[0-9]{3}")
_SURROGATE = re.compile(r"\\u[dD][89a-fA-F]")


def at_most(size: int, most: int, what: str, where: str, unit: str = "bytes") -> None:
    """Raise BadInput unless a size is within its bound."""
    if size > most:
        raise BadInput(what, where=where, expected=f"at most {most} {unit}", got=f"{size}")


def json_of(text: str | bytes, where: str, most: int = DOCUMENT_BYTES) -> Any:
    """The data of a JSON text; raises BadInput for malformed text or text beyond a bound.

    In addition to Python's own reader: numbers must be finite, texts valid Unicode, and names unique in an object.
    """
    at_most(len(text), most, "the JSON is too long", where)
    if isinstance(text, bytes):
        try:
            text = text.decode("utf-8-sig")
        except UnicodeDecodeError as error:
            raise _wrong("not a text file", where, "UTF-8", f"byte {error.start} is not") from None
    nested = text.count("[") + text.count("{")
    at_most(nested, CONTAINERS, "too many lists and objects", where, "of them")
    at_most(text.count(","), VALUES, "too many values", where, "of them")
    suspect = _is_suspect(text)
    try:
        found = (_CAREFUL if suspect else _PLAIN).decode(text)
        if suspect:
            json.dumps(found, ensure_ascii=False).encode("utf-8")
    except json.JSONDecodeError as error:
        place = f"line {error.lineno}, column {error.colno}"
        raise BadInput(
            "not JSON", where=where, expected="JSON", got=f"{error.msg} ({place})"
        ) from None
    except UnicodeEncodeError:
        raise _wrong("half a character in a text", where, "Unicode", "a lone surrogate") from None
    except _Refused as error:
        raise _wrong(str(error), where, error.expected, error.got) from None
    except RecursionError:
        raise _wrong("nested too deeply", where, f"at most {DEPTH} levels", "more") from None
    if nested > DEPTH:
        _not_deep(found, where)
    return found


def _is_suspect(text: str) -> bool:
    """Whether numbers or texts of a JSON text need a closer check; rarely true, as that check is slow."""
    if _EXPONENT.search(text) or ("\\u" in text and _SURROGATE.search(text)):
        return True
    step = DIGITS // 2  # more than DIGITS digits in a row fill one such block
    for k in range(0, len(text) - step, step):  # noqa: SIM110  a generator is slower
        if text[k : k + step].isdigit():
            return True
    return False


def integer_of(text: str, low: int, high: int) -> int | None:
    """The integer of a decimal text if it is within the range; None for any other text, however long."""
    digits = text.strip().removeprefix("-").removeprefix("+")
    if not (digits.isascii() and digits.isdecimal() and len(digits) <= DIGITS):
        return None
    value = int(text)
    return value if low <= value <= high else None


def inflated(data: bytes, where: str, most: int = DOCUMENT_BYTES) -> bytes:
    """The decompressed bytes of gzipped data; raises BadInput if they are too many, truncated or malformed."""
    parts: list[bytes] = []
    left = most
    while data:
        unpacker = zlib.decompressobj(31)
        try:
            parts.append(unpacker.decompress(data, left + 1))
        except zlib.error as error:
            raise BadInput("not gzip", where=where, got=str(error)) from None
        left -= len(parts[-1])
        if left < 0:
            at_most(most - left, most, "too long unpacked", where)
        if not unpacker.eof:
            raise BadInput("gzip ends too early", where=where, expected="the whole file")
        data = unpacker.unused_data.lstrip(b"\0")  # members may follow each other, and padding
    return b"".join(parts)


class _Refused(Exception):
    def __init__(self, what: str, expected: str, got: str) -> None:
        super().__init__(what)
        self.expected, self.got = expected, got if len(got) <= 40 else f"{got[:37]}..."


def _integer(text: str) -> int:
    if len(text.removeprefix("-")) > DIGITS:
        raise _Refused("a number with too many digits", f"at most {DIGITS}", text)
    return int(text)


def _real(text: str) -> float:
    value = float(text) if len(text) <= 2 * DIGITS else float("inf")
    if value - value != 0:
        raise _Refused("not a number that a double holds", "a finite number", text)
    return value


def _no_constant(text: str) -> float:
    raise _Refused(f"{text} is not a JSON number", "a finite number", text)


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Build an object; of two values of one name, Python's own reader silently keeps the last."""
    found = dict(pairs)
    if len(found) < len(pairs):
        seen: set[str] = set()
        for name, _ in pairs:
            if name in seen:
                raise _Refused("a name is given twice in one object", "each name once", name)
            seen.add(name)
    return found


_PLAIN = json.JSONDecoder(parse_constant=_no_constant, object_pairs_hook=_once)
_CAREFUL = json.JSONDecoder(
    parse_int=_integer, parse_float=_real, parse_constant=_no_constant, object_pairs_hook=_once
)


def _not_deep(found: Any, where: str) -> None:
    layer = [found] if isinstance(found, (list, dict)) else []
    for _ in range(DEPTH):
        layer = [
            part
            for whole in layer
            for part in (whole.values() if type(whole) is dict else whole)
            if type(part) is list or type(part) is dict
        ]
        if not layer:
            return
    raise _wrong("nested too deeply", where, f"at most {DEPTH} levels", "more")


def _wrong(what: str, where: str, expected: str, got: str) -> BadInput:
    return BadInput(what, where=where, expected=expected, got=got)
