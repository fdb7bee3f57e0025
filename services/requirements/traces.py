"""The rows of a trace with times: a CSV file with a column `time_s`, or a message log of any
format.

In a log a signal is a field of messages of one type, as in
`AirVehicleState[ID=1].Location.Altitude`; messages with equal times form one row. In CSV an empty
cell gives no value.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction
from itertools import groupby
from math import isfinite
from operator import itemgetter
from pathlib import Path
from typing import Any

from cratous.services.logs.entry import Entry, to_data
from cratous.services.logs.source import doubts as doubts_of_log
from cratous.services.logs.source import open_log
from cratous.services.requirements.csv_trace import Cells, rows_of
from cratous.services.requirements.field_units import is_known, refuse_no_word, unit_of
from cratous.services.requirements.formula import MAX_TIME
from cratous.services.requirements.sampling import Row
from cratous.services.requirements.specification import Signal, Specification
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import DIGITS

TIME = "time_s"


ToldBy = Callable[[str, Iterable[str], int], None]
"""Callback with the source of a message, its signals and its time [ns]: `Sampling.told_by`."""


def rows(
    trace: Path, spec: Specification, names: Iterable[str], told_by: ToldBy | None = None
) -> Iterator[Row]:
    """The rows of a trace; BadInput with the position for an invalid file."""
    if _is_csv(trace):
        return _of_csv(trace, {name: spec.signals[name] for name in sorted(names)})
    return _of_log(trace, wanted_of(spec, names), told_by)


def doubts(trace: Path) -> list[str]:
    """Why a log is incomplete: `open`, `lost`; BadInput if it was altered after writing."""
    return [] if _is_csv(trace) else doubts_of_log(trace)


def _is_csv(trace: Path) -> bool:
    return trace.suffixes[-1:] == [".csv"] or trace.suffixes[-2:] == [".csv", ".gz"]


def _of_csv(trace: Path, wanted: Mapping[str, Signal]) -> Iterator[Row]:
    for where, cells in rows_of(trace):
        for name in (TIME, *wanted):
            if name not in cells:
                raise BadInput("a signal has no column", where=str(trace), item=name)
        row = {name: _cell(cells, name, where) for name in wanted if cells[name]}
        for name, value in row.items():
            # non-finite values are handled by the sampling
            if wanted[name].kind == "bool" and isfinite(value) and value not in (0.0, 1.0):
                got = cells[name][:40]
                raise BadInput(
                    "this is no truth value", where=where, item=name, expected="0 or 1", got=got
                )
        yield _time(cells[TIME], where), row


def _cell(cells: Cells, name: str, where: str) -> float:
    try:
        return float(cells[name])
    except ValueError:
        raise BadInput(
            "this is no number", where=where, item=name, expected="a number", got=cells[name][:40]
        ) from None


def _time(text: str, where: str) -> int:
    try:
        time = Fraction(text) * 10**9 if len(text) <= DIGITS and "/" not in text else None
    except ValueError:
        time = None
    if time is None or time.denominator != 1 or not 0 <= time <= MAX_TIME:
        expected = "seconds from 0 on, to the nanosecond"
        raise BadInput("this is no time", where=where, item=TIME, expected=expected, got=text[:40])
    return int(time)


def wanted_of(spec: Specification, names: Iterable[str]) -> dict[str, Signal]:
    """The signals of these names, for messages; BadInput if one has no message field, or in another unit."""
    wanted = {name: spec.signals[name] for name in sorted(names)}
    for name, signal in wanted.items():
        if not signal.message:
            expected = f"signal {name}: {signal.unit or 'bool'} from TYPE[FIELD=VALUE].FIELD"
            raise BadInput("nothing says where a log has this signal", item=name, expected=expected)
        unit = unit_of(signal.message, signal.field)
        if signal.word:
            refuse_no_word(signal.message, signal.field, signal.word, name)
        elif unit and signal.unit != unit:
            what = "the field has another unit" if signal.unit else "the field is no bool"
            raise BadInput(what, item=name, expected=unit, got=signal.unit or "bool")
    return wanted


def _of_log(trace: Path, wanted: Mapping[str, Signal], told_by: ToldBy | None) -> Iterator[Row]:
    source = open_log(trace)
    known = {topic.topic for topic in source.topics()}
    for name, signal in wanted.items():
        # a type that the models have may never occur: its requirements are unknown then
        if not is_known(signal.message) and not any(_is(one, signal.message) for one in known):
            got = ", ".join(sorted(topic.rpartition(".")[2] for topic in known))
            raise BadInput(
                "the log has no message of this type", where=str(trace), item=name,
                expected=signal.message, got=got[:300],
            )  # fmt: skip
    yield from rows_of_messages(source.entries(), wanted, told_by=told_by)


def rows_of_messages(
    entries: Iterable[Entry],
    wanted: Mapping[str, Signal],
    unread: Callable[[Entry], None] | None = None,
    told_by: ToldBy | None = None,
) -> Iterator[Row]:
    """The rows of messages in time order; messages with equal times form one row.

    unread: called for a message that cannot be decoded or lacks the fields, which is then omitted;
    without it BadInput is raised.
    """
    for time_ms, parts in groupby(
        _of_messages(entries, wanted, unread, told_by), key=itemgetter(0)
    ):
        row: dict[str, float | None] = {}
        for _, part in parts:
            row.update(part)
        yield time_ms * 10**6, row


def _of_messages(
    entries: Iterable[Entry],
    wanted: Mapping[str, Signal],
    unread: Callable[[Entry], None] | None,
    told_by: ToldBy | None,
) -> Iterator[tuple[int, Mapping[str, float | None]]]:
    """The time [ms] of each message that has a signal, and its values."""
    for entry in entries:
        mine = {n: s for n, s in wanted.items() if _is(entry.topic, s.message)}
        if not mine:
            continue
        try:
            data = to_data(entry)
            found = {
                name: _field(data, signal, name, entry)
                for name, signal in mine.items()
                if all(_chosen(data, field, value, entry) for field, value in signal.chosen)
            }
        except BadInput:
            if unread is None:
                raise
            unread(entry)
            continue
        if found:
            if told_by is not None:
                told_by(entry.source, found, entry.time_ms * 10**6)
            yield entry.time_ms, found


def _is(topic: str, wanted: str) -> bool:
    return topic == wanted or topic.endswith(f".{wanted}")


def _at(data: Any, path: str, entry: Entry) -> Any:
    """The value of a field; None if a list is too short, or its element is of a type without the field."""
    listed = False
    for part in path.split("."):
        if isinstance(data, list) and part.isdecimal():
            if int(part) >= len(data):
                return None
            data, listed = data[int(part)], True
            continue
        if listed and (not isinstance(data, dict) or part not in data):
            return None
        if not isinstance(data, dict) or part not in data:
            known = ", ".join(k for k in data if k != "$type") if isinstance(data, dict) else "none"
            raise BadInput(
                "the message has no such field",
                where=entry.place,
                item=path,
                expected=known,
                got=part,
            )
        data = data[part]
    return data


def _chosen(data: Any, path: str, value: str, entry: Entry) -> bool:
    return str(_at(data, path, entry)) == value


def _field(data: Any, signal: Signal, name: str, entry: Entry) -> float | None:
    value = _at(data, signal.field, entry)
    if value is None:
        return None
    if signal.word:
        if not isinstance(value, str):
            raise BadInput(
                "the field is no word", where=entry.place, item=name, expected=signal.word,
                got=str(value)[:40],
            )  # fmt: skip
        return float(value == signal.word)
    if isinstance(value, bool) != (signal.kind == "bool") or not isinstance(value, int | float):
        expected = "true or false" if signal.kind == "bool" else "a number"
        raise BadInput(
            "the field is of another kind", where=entry.place, item=name, expected=expected,
            got=str(value)[:40],
        )  # fmt: skip
    return float(value)
