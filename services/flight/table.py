"""A mapping that does not change: what an actor remembers by id, as a value."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TypeVar

K = TypeVar("K")
V = TypeVar("V")


class Table(Mapping[K, V]):
    """Values by key, in the order in which the keys came; equal to any mapping that says the same."""

    __slots__ = ("_rows",)

    def __init__(self, rows: Mapping[K, V] | Iterable[tuple[K, V]] = ()) -> None:
        object.__setattr__(self, "_rows", dict(rows))

    def with_row(self, key: K, value: V) -> Table[K, V]:
        """The same with another value for one key."""
        return Table({**self._rows, key: value})

    def __getitem__(self, key: K) -> V:
        value: V = self._rows[key]
        return value

    def __iter__(self) -> Iterator[K]:
        return iter(self._rows)

    def __len__(self) -> int:
        return len(self._rows)

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"a table does not change: {name}")

    def __hash__(self) -> int:
        return hash(tuple(self._rows.items()))

    def __repr__(self) -> str:
        return f"Table({self._rows!r})"

    def __reduce__(self) -> tuple[type[Table[K, V]], tuple[dict[K, V]]]:
        return Table, (self._rows,)
