"""Samples from a CSV file whose first line names the signals, with or without `# ` before it."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from pathlib import Path

from cratous.spec.errors import BadInput
from cratous.spec.files.text_file import lines_of

Sample = dict[str, float | None]
Cells = dict[str, str]


class TraceOfChanges(BadInput):
    """The file lists changes of signals (`@time ...`) instead of samples."""


def samples(file: Path) -> Iterator[tuple[int, Sample]]:
    """(line, sample) of each row; an empty cell is None. The file may be gzipped.

    Raises BadInput with line and column name for a cell that is no number, a row of another length,
    and a first line that does not name each column once; TraceOfChanges.
    """
    for where, cells in rows_of(file):
        row = {name: _number(cell, where, name) for name, cell in cells.items()}
        yield int(where.rpartition(":")[2]), row


def rows_of(file: Path) -> Iterator[tuple[str, Cells]]:
    """(`file:line`, cells by column) of each row. Raises as `samples` does, except for the content of cells."""
    names: list[str] = []
    for number, line in lines_of(file):
        where = f"{file}:{number}"
        cells = [cell.strip() for cell in next(csv.reader([line.lstrip("# ")]), [])]
        if not any(cells):
            continue
        if not names:
            names = cells
            if not all(names) or len(set(names)) < len(names):
                raise BadInput("the columns have no names", where=where, expected="each its own")
            continue
        if cells[0].startswith("@"):
            raise TraceOfChanges("these are changes", where=where, expected="a sample in each row")
        if len(cells) != len(names):
            got = f"{len(cells)} cells"
            raise BadInput("a row is incomplete", where=where, expected=f"{len(names)}", got=got)
        yield where, dict(zip(names, cells, strict=True))
    if not names:
        raise BadInput(
            "the file is empty", where=str(file), expected="a line of names, then samples"
        )


def _number(cell: str, where: str, name: str) -> float | None:
    if not cell:
        return None
    try:
        return float(cell)
    except ValueError:
        raise BadInput(
            "this is no number", where=where, item=name, expected="a number", got=cell[:40]
        ) from None
