"""Progress display on stderr, for commands that take more than a second.

`waiting` is for work in this process, `Bar` for work in other processes.
"""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sized
from contextlib import AbstractContextManager, contextmanager, nullcontext
from typing import Any, TypeVar

import click

from cratous.services.cli.stopping import heed
from cratous.spec.files.printable import printable

T = TypeVar("T")
CLEARED = "\r\x1b[2K"
"""Terminal sequence: move to the start of the line and clear it."""
PATIENCE_S, BETWEEN_S, CELLS = 1.0, 5.0, 24
"""Delay of the first message, interval of lines without a terminal [s], and length of the bar."""


class Waiting:
    """The current activity; displayed by a thread, since the work may be one long call."""

    def __init__(self, what: str) -> None:
        self._now = (what, 0, 0)
        self._over = threading.Event()
        self._drawing = threading.Lock()
        self._drawn = False

    def at(self, what: str, done: int = 0, of: int = 0) -> None:
        """Report progress: current activity and items done; `of`: number of items, 0 if unknown."""
        self._now = (what, done, of)

    def each(self, items: Iterable[T], what: str, of: int = 0) -> Iterator[T]:
        """Iterate over the items, reporting each as it begins."""
        of = of or (len(items) if isinstance(items, Sized) else 0)
        for number, item in enumerate(items):
            self.at(what, number + 1, of)
            yield item

    def tell(self, text: str) -> None:
        """Print a permanent line; one that begins with a carriage return sets the current activity."""
        if text.startswith("\r"):
            self.at(text[1:].strip())
        else:
            self.line(text)

    def text(self) -> str:
        """The line for a file or a pipe."""
        what, done, of = self._now
        return printable(what + (f": {done} of {of}" if of else f": {done}" if done else ""))

    def bar(self) -> str:
        """The line for a terminal."""
        _, done, of = self._now
        cells = round(CELLS * min(1.0, done / of)) if of else 0
        return f"[{'#' * cells}{'.' * (CELLS - cells)}] {self.text()}" if of else self.text()

    def say(self, stream: Any, terminal: bool) -> None:
        """Display the progress until the end, after an initial delay."""
        pause, said = PATIENCE_S, ""
        while not self._over.wait(pause):
            line = self.bar() if terminal else self.text()
            with self._drawing:
                if line != said and not self._over.is_set():
                    stream.write(f"{CLEARED}{line}" if terminal else f"{line}\n")
                    stream.flush()
                    self._drawn, said = terminal, line
            pause = 0.2 if terminal else BETWEEN_S

    def line(self, text: str) -> None:
        """Print a permanent line above the bar."""
        with self._drawing:
            self._clear(sys.stderr)
            click.echo(printable(text), err=True)

    def end(self, stream: Any) -> None:
        """Stop displaying progress; a bar is removed."""
        with self._drawing:
            self._over.set()
            self._clear(stream)

    def _clear(self, stream: Any) -> None:
        if self._drawn:
            stream.write(CLEARED)
            stream.flush()
        self._drawn = False


@contextmanager
def waiting(what: str, quiet: bool = False) -> Iterator[Waiting]:
    """Display progress during the block: a bar on a terminal, lines elsewhere; quiet: neither."""
    made, stream = Waiting(what), sys.stderr
    if quiet:
        yield made
        return
    thread = threading.Thread(target=made.say, args=(stream, stream.isatty()), daemon=True)
    thread.start()
    try:
        yield made
    finally:
        made.end(stream)
        thread.join()


def passing(tell: Callable[[str], None]) -> Callable[[str], None]:
    """A function that shows lines as the current activity, none permanently. Raises `Stopped` after a signal."""

    def told(text: str) -> None:
        heed()
        tell(f"\r{text}")

    return told


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
        """Set the progress of one item; the total grows as items become known."""
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
