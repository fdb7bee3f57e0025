"""Writes the selected messages of a log in another format; the file is complete or absent.

What a format cannot represent (undecodable bytes, text that XML forbids) is counted and named,
never omitted silently.
"""

from __future__ import annotations

import csv
import json
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from cratous.core.files.whole_file import replacing
from cratous.services.logs import files
from cratous.services.logs.entry import Entry, any_data
from cratous.services.logs.selection import Selection
from cratous.services.logs.source import Source
from cratous.services.logs.store import LogStore, cannot_write
from cratous.spec.errors import BadInput
from cratous.spec.files.printable import cell

FORMATS = ("mcap", "jsonl", "csv", "xml", "lmcp", "frames", "sqlite", "uxas")
_HEAD = ("seq", "time_ms", "source", "topic")


@dataclass
class Exported:
    """Number of messages written, and those omitted or written only as bytes, with the reason."""

    count: int = 0
    left_out: list[str] = field(default_factory=list)
    undecoded: list[str] = field(default_factory=list)
    damage: BadInput | None = None


def export(
    source: Source,
    target: Path,
    form: str,
    selection: Selection | None = None,
    *,
    with_bytes: bool = False,
    salvage: bool = False,
) -> Exported:
    """Write `target`, which appears only when complete.

    with_bytes: MCAP also gets the LMCP bytes. salvage: write what can be read of a damaged log and
    state the damage in the result; without it damage raises BadInput and writes no file.
    """
    if target.exists() and target.resolve() == source.path.resolve():
        raise BadInput("the log would replace itself", where=str(target))
    if form == "sqlite" and target.exists():  # a log may be evidence
        raise BadInput(
            "the log exists already", where=str(target), expected="a new file", got="a file"
        )
    done = Exported()
    chosen = selection or Selection()

    def entries() -> Iterator[Entry]:
        try:
            yield from source.entries(chosen)
        except BadInput as error:
            if not salvage:
                raise
            done.damage = error

    try:
        target.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise cannot_write(target, error) from None
    with replacing(target, "the log") as part:
        _WRITERS[form](_Job(source, entries, part, done, chosen, with_bytes))
    return done


@dataclass
class _Job:
    source: Source
    entries: Callable[[], Iterator[Entry]]
    part: Path
    done: Exported
    selection: Selection
    with_bytes: bool

    def wrote(self, entry: Entry, error: BadInput | None = None) -> None:
        self.done.count += 1
        if error is not None:
            self.done.undecoded.append(f"{entry.place}: {error}")

    def left_out(self, entry: Entry, error: BadInput) -> None:
        self.done.left_out.append(f"{entry.place}: {error}")

    def meta(self) -> dict[str, Any]:
        with suppress(BadInput):  # damaged meta data: reading the messages reports the damage
            meta = self.source.meta()
            return {**meta, "selected": True} if self.selection else meta
        return {}


def _mcap(job: _Job) -> None:
    from cratous.services.logs.mcap_log import McapWriter

    with job.part.open("wb") as stream:
        writer = McapWriter(stream, with_bytes=job.with_bytes)
        for entry in job.entries():
            job.wrote(entry, writer.write(entry))
        gaps = job.source.gaps() if job.done.damage is None else []
        writer.close(job.meta(), gaps)


def _jsonl(job: _Job) -> None:
    with job.part.open("w", encoding="utf-8") as out:
        for entry in job.entries():
            line, error = files.json_line(entry)
            out.write(line + "\n")
            job.wrote(entry, error)


def _xml(job: _Job) -> None:
    with job.part.open("w", encoding="utf-8") as out:
        out.write(files.XML_HEAD)
        for entry in job.entries():
            try:
                out.write(files.xml_event(entry))
                job.wrote(entry)
            except BadInput as error:
                job.left_out(entry, error)
        out.write(files.XML_TAIL)


def _binary(job: _Job, form: Callable[[Entry], bytes]) -> None:
    with job.part.open("wb") as out:
        for entry in job.entries():
            try:
                out.write(form(entry))
                job.wrote(entry)
            except BadInput as error:
                job.left_out(entry, error)


def _lmcp(job: _Job) -> None:
    from cratous.services.logs.entry import to_bytes

    _binary(job, to_bytes)


def _frames(job: _Job) -> None:
    _binary(job, files.framed)


def _sqlite(job: _Job) -> None:
    store = LogStore(job.part, every_s=None, **job.meta())
    with store:
        for entry in job.entries():
            store.keep(entry)
            job.wrote(entry)
        if job.done.damage is None:
            for gap in job.source.gaps():
                store.keep_gap(gap)


def _uxas(job: _Job) -> None:
    from cratous.services.logs.uxas_log import UxasWriter

    writer = UxasWriter(job.part)
    for entry in job.entries():
        error = writer.write(entry)
        if error is None:
            job.wrote(entry)
        else:
            job.left_out(entry, error)
    writer.close()


def _csv(job: _Job) -> None:
    # first pass: columns in order of first appearance; second pass: rows
    columns: dict[str, None] = dict.fromkeys(_HEAD)
    for entry in job.entries():
        columns.update(dict.fromkeys(flat(any_data(entry)[0])))
    with job.part.open("w", encoding="utf-8", newline="") as out:
        writer = csv.DictWriter(out, list(columns))
        writer.writerow({name: cell(name) for name in columns})
        for entry in job.entries():
            data, error = any_data(entry)
            row = dict(zip(_HEAD, entry[:4], strict=True))
            writer.writerow({k: cell(v) for k, v in {**row, **flat(data)}.items()})
            job.wrote(entry, error)


def flat(data: Any, prefix: str = "") -> dict[str, Any]:
    """Fields by dotted path; arrays become JSON text in one cell, null an empty cell."""
    cells: dict[str, Any] = {}
    for key, value in data.items():
        if key == "$type":
            continue
        if isinstance(value, dict):
            cells.update(flat(value, f"{prefix}{key}."))
        elif isinstance(value, list):
            cells[prefix + key] = json.dumps(value, ensure_ascii=False, separators=(",", ":"))
        elif isinstance(value, bool):
            cells[prefix + key] = "true" if value else "false"
        else:
            cells[prefix + key] = value
    return cells


_WRITERS: dict[str, Callable[[_Job], None]] = {
    "mcap": _mcap,
    "jsonl": _jsonl,
    "csv": _csv,
    "xml": _xml,
    "lmcp": _lmcp,
    "frames": _frames,
    "sqlite": _sqlite,
    "uxas": _uxas,
}
