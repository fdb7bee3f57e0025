"""Parses lines to messages, from bytes in any segmentation.

The parser never raises on input: `feed` returns messages, `Skipped` for what is legal but not known here, and
`WireError` values. It refuses lines that the original would read differently from how they are written (a label
inside a longer one, a label twice, an integer without `.0`, a tag that only begins like a known one), since two ends
that understand one line differently are worse than a line reported as lost. Memory is bounded: a line longer than
`max_line` bytes is an error and is dropped up to the next newline.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from cratous.bridge.text_protocol.dialects import (
    LAYOUTS_OF,
    TAG_LETTERS,
    Dialect,
    has_comma_after_tag,
    has_label_after_tag,
)
from cratous.bridge.text_protocol.fast_lines import TAG_BYTES, message_of, plain_lines
from cratous.bridge.text_protocol.format import LARGEST_NUMBER
from cratous.bridge.text_protocol.layouts import (
    ORIGINAL_LIMITS,
    TEXT,
    FieldLayout,
    Kind,
    Layout,
    Limits,
)
from cratous.bridge.text_protocol.messages import (
    Direction,
    Message,
)

MAX_LINE = 4096
OTHER_DIALECT = "line of another dialect"
_MAX_NUMBER = 64
_NUMBER = re.compile(r" *([+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?)\Z")
_PRINTABLE = re.compile(rb"[\x20-\x7e]*\Z")


@dataclass(frozen=True)
class WireError:
    """A refused line: its number and the column (both from 1) of the error.

    kind: the type of an unknown COMND; tag: for a v2 packet, the tag of its line.
    """

    line: int
    column: int
    what: str
    expected: str
    got: str
    kind: str = ""
    tag: str = ""

    def __str__(self) -> str:
        text = f"line {self.line}, column {self.column}: {self.what}"
        if self.expected:
            text += f"; expected {self.expected}"
        return text + (f"; got {self.got}" if self.got else "")


@dataclass(frozen=True)
class Skipped:
    """A line, or a field of an accepted message, that is legal but unknown here; it is recorded."""

    line: int
    column: int
    text: str


Record = Message | WireError | Skipped


class _Bad(Exception):
    """Internal: the error in the current line."""

    def __init__(self, column: int, what: str, expected: str, got: str, kind: str = "") -> None:
        super().__init__(what)
        self.kind = kind
        self.column, self.what, self.expected, self.got = column, what, expected, got


def _labels_of(layout: Layout, thesis: bool) -> list[tuple[str, str]]:
    """The labels of a message, the longest first: as compared (lower-case if labels are, since the thesis's may be
    capitals), and as in the layout."""
    labels = [*(field.label for field in layout.fields), *(["type"] if layout.form else [])]
    return [(x.lower() if thesis else x, x) for x in sorted(labels, key=len, reverse=True)]


class StreamParser:
    """Parses the bytes that come from one peer.

    direction: of the messages. original_peer: accept a `vertIndex` without `.0` also where the original's own client
    misreads it. limits: largest counts. dialect: of the peer; additions of one dialect are accepted in every other
    but the thesis's, whose lines begin differently.
    """

    def __init__(
        self,
        direction: Direction,
        *,
        limits: Limits = ORIGINAL_LIMITS,
        max_line: int = MAX_LINE,
        original_peer: bool = False,
        dialect: Dialect = Dialect.CRATOUS,
    ) -> None:
        self._layouts: dict[str, list[Layout]] = {}
        self._labels: dict[type[Message], list[tuple[str, str]]] = {}
        self._thesis = dialect is Dialect.THESIS
        for layout in LAYOUTS_OF[dialect]:
            if layout.both or layout.direction is direction:
                self._layouts.setdefault(layout.tag, []).append(layout)
                self._labels[layout.message] = _labels_of(layout, self._thesis)
        self._limits, self._max_line, self._original_peer = limits, max_line, original_peer
        ours = [one for layouts in self._layouts.values() for one in layouts]
        self._plain = {} if self._thesis else plain_lines(tuple(ours), limits)
        self._pending = bytearray()
        self._dropping = False
        self._line = 1

    def feed(self, data: bytes) -> list[Record]:
        """The records of all lines completed by these bytes."""
        records: list[Record] = []
        start = 0
        while (end := data.find(b"\n", start)) >= 0:
            if not (self._pending or self._dropping) and end - start <= self._max_line:
                plain = self._plain.get(bytes(data[start : start + TAG_BYTES]))
                message = None if plain is None else message_of(plain, data, start, end)
                if message is not None:
                    records.append(message)
                    self._line += 1
                    start = end + 1
                    continue
            self._extend(data[start:end], records)
            if not self._dropping:
                self._parse(bytes(self._pending), records)
            self._pending.clear()
            self._dropping = False
            self._line += 1
            start = end + 1
        self._extend(data[start:], records)
        return records

    def finish(self) -> list[Record]:
        """The stream has ended: an incomplete line is an error."""
        records: list[Record] = []
        if self._pending and not self._dropping:
            got = ascii(bytes(self._pending[:40]))[1:]
            records.append(
                WireError(self._line, len(self._pending) + 1, "message cut off", "a newline", got)
            )
        self._pending.clear()
        return records

    def _extend(self, piece: bytes, records: list[Record]) -> None:
        if self._dropping:
            return
        room = self._max_line - len(self._pending)
        self._pending += piece[:room]
        if len(piece) > room:
            got = ascii(bytes(self._pending[:40]))[1:]
            records.append(
                WireError(
                    self._line,
                    self._max_line + 1,
                    "line too long",
                    f"at most {self._max_line} bytes",
                    got,
                )
            )
            self._pending.clear()
            self._dropping = True

    def _parse(self, line: bytes, records: list[Record]) -> None:
        line = line.removesuffix(b"\r")  # a peer that ends its lines with CR LF
        try:
            if not _PRINTABLE.match(line):
                at = next(i for i, byte in enumerate(line) if not 0x20 <= byte <= 0x7E)
                raise _Bad(at + 1, "byte that is not printable", "ASCII text", f"{line[at]:#04x}")
            records.extend(self._message(line.decode("ascii")))
        except _Bad as bad:
            wrong = (bad.what, bad.expected, bad.got, bad.kind)
            records.append(WireError(self._line, bad.column, *wrong))

    def _message(self, line: str) -> list[Record]:
        if self._thesis:
            tag, rest, begin = line[:TAG_LETTERS], line[TAG_LETTERS:], TAG_LETTERS + 1
            other, after = has_comma_after_tag, "a label"
        else:
            tag, _, rest = line.partition(",")
            begin, other, after = len(tag) + 2, has_label_after_tag, "a comma"
        layouts = self._layouts.get(tag)
        if (self._thesis or layouts is None) and other(line):
            raise _Bad(1, OTHER_DIALECT, f"a tag and {after}", repr(line[:40]))
        if layouts is None:
            for known in self._layouts:
                if tag.upper().startswith(known):
                    raise _Bad(1, "unknown tag", f"{known} and {after}", repr(tag[:40]))
            return [Skipped(self._line, 1, line[:80])]
        if rest and not rest.endswith(","):
            raise _Bad(len(line) + 1, "field is not ended", "a comma", repr(line[-20:]))
        pieces = rest[:-1].split(",") if rest else []
        places = [begin]
        for piece in pieces:
            places.append(places[-1] + len(piece) + 1)
        layout = self._form(layouts, pieces, places) if layouts[0].form else layouts[0]
        return self._fill(layout, pieces, places)

    def _form(self, layouts: list[Layout], pieces: list[str], places: list[int]) -> Layout:
        """The form of a COMND or RPRSP that its `type` field selects."""
        forms = {"type" + layout.form: layout for layout in layouts}
        for piece, place in zip(pieces, places, strict=False):
            if (piece[:4].lower() if self._thesis else piece[:4]) == "type":
                if "type" + piece[4:] in forms:
                    return forms["type" + piece[4:]]
                expected = " or ".join(layout.form for layout in layouts)
                kind = re.sub(r"[^A-Za-z0-9_]", "_", piece[4:44])
                raise _Bad(place + 4, "unknown type", expected, repr(piece[4:44]), kind)
        raise _Bad(places[-1], "field missing", "type", "")

    def _fill(self, layout: Layout, pieces: list[str], places: list[int]) -> list[Record]:
        known, thesis = self._labels[layout.message], self._thesis
        texts: dict[str, tuple[str, int]] = {}
        skipped: list[Record] = []
        for piece, place in zip(pieces, places, strict=False):
            as_read = piece.lower() if thesis else piece
            label = next((name for read, name in known if as_read.startswith(read)), None)
            if label is None:
                inside = next((name for read, name in known if read in as_read), None)
                if inside:
                    raise _Bad(
                        place, "label inside another", f"a label without {inside!r}", repr(piece)
                    )
                skipped.append(Skipped(self._line, place, piece[:80]))
            elif label in texts:
                raise _Bad(place, "field given twice", f"one {label}", repr(piece[:40]))
            else:
                texts[label] = (piece[len(label) :], place + len(label))
        values = {}
        for field in layout.fields:
            if field.label in texts:
                text, column = texts[field.label]
                values[field.attribute] = self._value(field, text, column)
            elif not field.optional:
                raise _Bad(places[-1], "field missing", field.label, "")
        self._bare_vertex(texts)
        given = [field for field in layout.fields if field.label in texts]
        if layout.form == "RESET_SFT" and 0 < len(given) < 3:
            raise _Bad(places[-1], "field missing", "lat, long and alt, or none of them", "")
        return [layout.message(**values), *skipped]

    def _bare_vertex(self, texts: dict[str, tuple[str, int]]) -> None:
        """Refuse a bare vertIndex that the original, after a two-digit totalvert, reads as another number."""
        text, column = texts.get("vertIndex", ("", 0))
        total = texts.get("totalvert", ("", 0))[0]
        bare_is_right = self._original_peer or self._thesis
        if text.isdigit() and float(total or 0) >= 10 and not bare_is_right:
            raise _Bad(column, "integer without .0", f"{text}.0", repr(text))

    def _value(self, field: FieldLayout, text: str, column: int) -> object:
        if field.kind is Kind.WORD:
            if text not in field.words:
                raise _Bad(column, "unknown word", " or ".join(field.words), repr(text[:40]))
            return text.strip("_")
        if field.kind is Kind.TEXT:
            if not TEXT.fullmatch(text):
                raise _Bad(column, "not a name", "1 to 40 letters, digits and _", repr(text[:40]))
            return text
        match = _NUMBER.match(text) if len(text) <= _MAX_NUMBER else None
        if match is None:
            what = "number too long" if len(text) > _MAX_NUMBER else "not a number"
            raise _Bad(column, what, f"a decimal number after {field.label}", repr(text[:40]))
        digits = match.group(1)
        bare_is_right = field.kind is Kind.BARE or self._thesis
        if not bare_is_right and digits.lstrip("+-").isdigit():
            raise _Bad(column, "integer without .0", f"{digits}.0", repr(text))
        number = float(digits)
        if not abs(number) < LARGEST_NUMBER:
            raise _Bad(column, "number too large", "below 1e15", repr(text))
        if field.kind is Kind.DEGREES and abs(number) > (90 if "lat" in field.label else 180):
            raise _Bad(column, "angle out of range", "degrees of latitude or longitude", text)
        if field.kind in (Kind.REAL, Kind.DEGREES):
            return number
        high = getattr(self._limits, field.high) if field.high else LARGEST_NUMBER
        low = -LARGEST_NUMBER if field.low is None else field.low
        low, high = low + field.first, high + field.first
        if not number.is_integer() or not low <= number <= high:
            raise _Bad(column, "number out of range", f"an integer from {low} to {high}", text)
        return int(number) - field.first
