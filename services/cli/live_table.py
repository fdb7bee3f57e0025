"""A live table on the terminal: the current result of each requirement of a watch."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from cratous.spec.files.printable import printable

if TYPE_CHECKING:
    from rich.table import Table

    from cratous.services.requirements.outcome import Outcome
    from cratous.services.requirements.watch import Watch

PER_SECOND = 2
COLOURS = {"violated": "red", "unknown": "yellow", "holds so far": "green"}
HEAD = ("requirement", "so far", "holds", "violated", "unknown", "nearest to its bound")


def so_far(one: Outcome) -> str:
    """The current result of a requirement; `holds` is possible only at the end."""
    if one.violated:
        return "violated"
    if one.unknown:
        return "unknown"
    return "holds so far" if one.holds else "no verdict yet"


def nearest(one: Outcome) -> str:
    """The comparison with the least difference of its sides, and when it occurred."""
    found = []
    for margin in one.margins:
        ends = ((margin.least, margin.at), (margin.greatest, margin.greatest_at))
        found += [(abs(value), value, at, margin) for value, at in ends if at >= 0]
    if not found:
        return "-"
    _, value, at, margin = min(found, key=lambda each: each[0])
    unit = "" if margin.unit == "1" else f" {margin.unit}"
    right = margin.right if isinstance(margin.right, str) else f"{margin.right:g}{unit}"
    return f"{margin.left} - {right} = {value:.4g}{unit} at {at / 1e9:.1f} s"


def table_of(watch: Watch, messages: int, now_ms: int) -> Table:
    """One row per requirement; below it the number of messages and the faults of the trace."""
    from rich.markup import escape
    from rich.table import Table

    wrong = sum(one.count for one in watch.sampling.findings)
    caption = f"{now_ms / 1000:.1f} s, {messages} messages, {watch.count} samples, {wrong} findings"
    drawn = Table(*HEAD, header_style="bold", caption=caption)
    for one in watch.outcomes:
        word = so_far(one)
        told = " (unauthenticated)" if watch.is_unauthenticated(one) else ""
        severity = f" [{one.requirement.severity}]" if one.requirement.severity else ""
        counts = (f"{getattr(one, name)}" for name in ("holds", "violated", "unknown"))
        drawn.add_row(
            escape(printable(one.name + severity)),
            f"[{COLOURS.get(word, 'white')}]{word}{told}[/]",
            *counts,
            escape(nearest(one)),
        )
    return drawn


@contextmanager
def shown(table: Callable[[], Table], wanted: bool) -> Iterator[None]:
    """Show the table inside the block if standard output is a terminal; other output appears above it."""
    if not (wanted and sys.stdout.isatty()):
        yield
        return
    from rich.live import Live

    with Live(get_renderable=table, refresh_per_second=PER_SECOND, transient=True):
        yield
