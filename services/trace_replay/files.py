"""Trace files, written by `cratous search-faults --traces`, and read by `cratous replay-trace`."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple, get_type_hints

from cratous.core.files.whole_file import cannot_write, write_atomically
from cratous.spec.errors import BadInput
from cratous.spec.files.text_file import text_of
from cratous.spec.system import hand_trace, trace
from cratous.spec.system.trace import NOTHING

FORMAT = "cratous authority trace 1"
HAND_FORMAT = "cratous certificate trace 1"
MOST_BYTES = 1_000_000
MOST_ENTRIES = 100
MOST = 1000
"""Maximum of epochs and of change counts."""
WORDS = 500
"""Maximum length of a text in a trace."""


Entries = tuple[trace.Entry, ...] | tuple[hand_trace.Entry, ...]
KINDS: dict[str, tuple[Any, Any, Any, tuple[str, ...]]] = {
    FORMAT: (trace.Entry, trace.Event, trace.Standing, trace.KINDS),
    HAND_FORMAT: (hand_trace.Entry, hand_trace.Event, hand_trace.InHand, hand_trace.KINDS),
}
"""By format: types of an entry, its event and state, and the kinds of events."""


class Trace(NamedTuple):
    """design: its name; says: what is wrong in it; wrong: the fault at the end, empty if none."""

    design: str
    says: str
    wrong: str
    entries: Entries

    @property
    def texts(self) -> tuple[str, ...]:
        """Its events as text."""
        return tuple(one.text for one in self.entries)

    @property
    def of_hand(self) -> bool:
        """Whether it is a trace of the certificate in hand; otherwise of authority."""
        return any(isinstance(one, hand_trace.Entry) for one in self.entries)


def place(folder: Path, designs: Iterable[str]) -> dict[str, Path]:
    """Trace files by design in a folder, which is created; BadInput if a file of such a name is not a trace."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise cannot_write(folder, error, "the folder of traces") from None
    files = {name: folder / f"{name}.json" for name in designs}
    for file in files.values():
        if file.exists():
            read(file)
    return files


def write(file: Path, told: Trace) -> None:
    """The trace as JSON, whole or not at all."""
    rows = [
        {"text": e.text, "event": e.event._asdict(), "after": e.after._asdict()}
        for e in told.entries
    ]
    form = HAND_FORMAT if told.of_hand else FORMAT
    data = {"format": form, **told._asdict(), "entries": rows}
    write_atomically(file, json.dumps(data, indent=1) + "\n", "the trace")


def read(file: Path) -> Trace:
    """A trace; BadInput with the position if the file is invalid."""
    text = text_of(file, MOST_BYTES, "a trace of `cratous search-faults --traces`")
    try:
        data = json.loads(text)
    except (ValueError, RecursionError) as error:
        why = str(error).splitlines()[0]
        raise BadInput("not a trace", where=str(file), expected="JSON", got=why) from None
    reader = _Reader(str(file))
    top = reader.table(data, ("format", *Trace._fields), "")
    form = top["format"]
    if not isinstance(form, str) or form not in KINDS:
        raise reader.wrong("format", " or ".join(KINDS), form)
    rows = top["entries"]
    if not isinstance(rows, list) or len(rows) not in range(1, MOST_ENTRIES + 1):
        raise reader.wrong("entries", f"a list of 1 to {MOST_ENTRIES}", rows)
    texts = {name: reader.text(top[name], name) for name in ("design", "says", "wrong")}
    return Trace(**texts, entries=tuple(_entries(reader, rows, form)))


def _entries(reader: _Reader, rows: list[Any], form: str) -> Iterable[Any]:
    of, event_of, after_of, kinds = KINDS[form]
    for number, one in enumerate(rows):
        item = f"entries[{number}]"
        row = reader.table(one, of._fields, item)
        event = reader.fields(row["event"], event_of, f"{item}.event")
        after = reader.fields(row["after"], after_of, f"{item}.after")
        if event["kind"] not in kinds:
            raise reader.wrong(f"{item}.event.kind", " or ".join(kinds), event["kind"])
        text = reader.text(row["text"], f"{item}.text")
        yield of(text, event_of(**event), after_of(**after))


class _Reader:
    """Validates each part of the data."""

    def __init__(self, where: str) -> None:
        self._where = where

    def wrong(self, item: str, expected: str, got: object) -> BadInput:
        return BadInput(
            "not a trace", where=self._where, item=item, expected=expected, got=repr(got)[:80]
        )

    def table(self, data: object, names: Iterable[str], item: str) -> dict[str, Any]:
        if not isinstance(data, dict) or set(data) != set(names):
            got = sorted(data) if isinstance(data, dict) else data
            raise self.wrong(item or "file", f"the names {', '.join(names)}", got)
        return data

    def text(self, data: object, item: str) -> str:
        if not isinstance(data, str) or len(data) not in range(WORDS + 1):
            raise self.wrong(item, f"a text of at most {WORDS} characters", data)
        return data

    def fields(self, data: object, of: type[Any], item: str) -> dict[str, Any]:
        """The fields of a named tuple of strings, booleans and integers."""
        row = self.table(data, of._fields, item)
        for name, kind in get_type_hints(of).items():
            value, place = row[name], f"{item}.{name}"
            if kind is str:
                self.text(value, place)
            elif kind is bool and not isinstance(value, bool):
                raise self.wrong(place, "true or false", value)
            elif kind is int:
                least = NOTHING if name == "sent" else 0
                if type(value) is not int or value not in range(least, MOST + 1):
                    raise self.wrong(place, f"a whole number from {least} to {MOST}", value)
        return row
