"""A progress bar for work that is done in other processes."""

from __future__ import annotations

import time
from contextlib import AbstractContextManager, nullcontext
from typing import Any


class Bar:
    """A progress bar on a terminal; silent everywhere else."""

    def __init__(self, title: str, total: int, shown: bool) -> None:
        self._parts: dict[str, tuple[int, int]] = {}
        self._total = total
        self._last = 0.0
        self._context: AbstractContextManager[Any] = nullcontext()
        if shown:
            from rich.console import Console
            from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

            columns = (
                TextColumn(title),
                BarColumn(),
                MofNCompleteColumn(),
                TextColumn("{task.fields[at]}"),
            )
            # no refresh thread: workers are forked from here
            self._bar = Progress(
                *columns, console=Console(stderr=True), auto_refresh=False, transient=True
            )
            self._task = self._bar.add_task(title, total=total, at="")
            self._context = self._bar
        self._shown = shown

    def __enter__(self) -> Bar:
        self._context.__enter__()
        return self

    def __exit__(self, *error: Any) -> None:
        self._context.__exit__(*error)

    def step(self, name: str, done: int, of: int) -> None:
        """One item is so far; the total grows as items become known."""
        if not self._shown:
            return
        self._parts[name] = (done, of)
        known = sum(o for _, o in self._parts.values())
        self._bar.update(
            self._task,
            completed=sum(d for d, _ in self._parts.values()),
            total=max(known, self._total),
            at=name,
        )
        if time.monotonic() - self._last > 0.1:
            self._last = time.monotonic()
            self._bar.refresh()
