"""Tables and lines of text. rich is imported only when a table is drawn."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import click

from cratous.spec.files.printable import printable

COLOURS = {"holds": "green", "violated": "red", "unknown": "yellow", "excused": "yellow"}


def margin_text(row: dict[str, Any]) -> str:
    """A margin with its unit, or a dash."""
    return "-" if row["margin"] is None else f"{row['margin']:.4g} {row['unit']}".strip()


def place_text(row: dict[str, Any]) -> str:
    """What the margin refers to, and its time."""
    text = str(row["item"])
    if row["time_ms"] is not None:
        text += f" at {row['time_ms'] / 1000:.2f} s"
    return text


def say(text: str, err: bool = False) -> None:
    """Print one line, parts of which may be untrusted."""
    click.echo(printable(text), err=err)


def table(head: list[str], rows: list[list[str]], verdict_column: int | None = None) -> None:
    """Print a table: drawn for a terminal, plain columns for a file or a pipe."""
    rows = [[printable(cell) for cell in row] for row in rows]
    if sys.stdout.isatty():
        from rich.console import Console
        from rich.markup import escape
        from rich.table import Table

        drawn = Table(*head, header_style="bold")
        for row in rows:
            cells = [escape(cell) for cell in row]
            if verdict_column is not None:
                colour = COLOURS.get(row[verdict_column], "white")
                cells[verdict_column] = f"[{colour}]{cells[verdict_column]}[/]"
            drawn.add_row(*cells)
        Console().print(drawn)
        return
    widths = [max(len(row[k]) for row in [head, *rows]) for k in range(len(head))]
    for row in [head, *rows]:
        line = "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True))
        click.echo(line.rstrip())


def shown_path(path: Path) -> str:
    """A path as shown in a report: never an absolute path."""
    return path.name if path.is_absolute() else path.as_posix()


def requirement_table(rows: list[dict[str, Any]]) -> None:
    """Print the verdicts on G1 to G5 with margins and places."""
    table(
        ["requirement", "verdict", "margin", "where"],
        [
            [
                f"{row['requirement']} {row['title']}",
                row["verdict"],
                margin_text(row),
                place_text(row)
                if row["verdict"] == "holds"
                else f"{place_text(row)}: {row['note']}",
            ]
            for row in rows
        ],
        verdict_column=1,
    )
