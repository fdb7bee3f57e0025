"""A bounded list of rows: a new row replaces the one with the same key, and the oldest are dropped."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from typing import Any

Row = dict[str, Any]


class Bounded:
    """Rows in order. let_go: number of rows dropped without being replaced."""

    def __init__(self, most: int, places: int, key: Callable[[Row], Any] | None = None) -> None:
        """most: maximum number of rows; places: maximum number of map points in all rows; key: rows
        with equal keys describe one object.
        """
        self._most, self._places, self._key = most, places, key
        self._rows: dict[Any, Row] = {}
        self._held = self._number = self.let_go = 0
        self._new: deque[Row] = deque(maxlen=most)

    def append(self, row: Row) -> None:
        """Add a row."""
        self._number += 1
        key = self._number if self._key is None else self._key(row)
        self._drop(key)
        self._rows[key] = row
        self._new.append(row)
        self._held += _size(row)
        while len(self._rows) > self._most or self._held > self._places:
            self._drop(next(iter(self._rows)))
            self.let_go += 1

    def _drop(self, key: Any) -> None:
        if key in self._rows:
            self._held -= _size(self._rows.pop(key))

    def __iter__(self) -> Iterator[Row]:
        return iter(list(self._rows.values()))

    def take_new(self) -> list[Row]:
        """The rows added since the last call that are still stored."""
        kept = {id(row) for row in self._rows.values()}
        taken = [row for row in self._new if id(row) in kept]
        self._new.clear()
        return taken


def _size(row: Row) -> int:
    return len(row.get("points", ())) + len(row.get("vertices", ()))
