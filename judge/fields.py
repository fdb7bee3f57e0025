"""Typed access to plain data (from JSON or YAML): invalid values raise BadInput with their path."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from cratous.spec.errors import BadInput

MOST = 2**61
"""Exclusive limit of integers."""
FARTHEST = 1e15
"""Limit of real numbers; squares and products of four are far from overflow."""


def is_plain(value: Any) -> bool:
    """Whether a value is a double that `real` accepts unchanged; the comparison is false for NaN too."""
    return type(value) is float and -FARTHEST <= value <= FARTHEST


class Node:
    """A value with its position; `where` is the file."""

    __slots__ = ("_name", "_whole", "data", "where")

    def __init__(self, data: Any, where: str, name: str | int, whole: Node | None = None) -> None:
        """name: the item; for a part of another value (`whole`) its field or index."""
        self.data, self.where, self._name, self._whole = data, where, name, whole

    @property
    def item(self) -> str:
        """Its path in the file, computed only when an error needs it."""
        if self._whole is None:
            return str(self._name)
        part = f"[{self._name}]" if isinstance(self._name, int) else f".{self._name}"
        return self._whole.item + part

    def wrong(self, expected: str) -> BadInput:
        """The error for an invalid value."""
        try:
            got = repr(self.data) if not isinstance(self.data, int) else _digits(self.data)
        except RecursionError:
            got = "what is nested too deeply to be shown"
        return BadInput(
            "does not fit", where=self.where, item=self.item, expected=expected, got=got[:80]
        )

    def __getitem__(self, name: str) -> Node:
        """A field of an object; BadInput if it is missing."""
        if not isinstance(self.data, dict):
            raise self.wrong("an object")
        if name not in self.data:
            raise BadInput(
                "a field is missing", where=self.where, item=f"{self.item}.{name}", expected=name
            )
        return Node(self.data[name], self.where, name, self)

    def get(self, name: str, default: Any = None) -> Node:
        """A field of an object, or the default."""
        if not isinstance(self.data, dict):
            raise self.wrong("an object")
        return Node(self.data.get(name, default), self.where, name, self)

    def __iter__(self) -> Iterator[Node]:
        """The entries of a list."""
        if not isinstance(self.data, list):
            raise self.wrong("a list")
        for k, part in enumerate(self.data):
            yield Node(part, self.where, k, self)

    def has(self, name: str) -> bool:
        """Whether an object has the field with a value other than null."""
        return isinstance(self.data, dict) and self.data.get(name) is not None

    @property
    def whole(self) -> int:
        """An integer."""
        if type(self.data) is not int or abs(self.data) >= MOST:
            raise self.wrong("a whole number of at most 61 bits")
        return self.data

    @property
    def real(self) -> float:
        """A finite number."""
        if type(self.data) not in (int, float):
            raise self.wrong("a number")
        if not abs(self.data) <= FARTHEST or not math.isfinite(self.data):
            raise self.wrong(f"a number of at most {FARTHEST:g}")
        return float(self.data)

    def reals(self, *names: str) -> list[float]:
        """Fields of an object, each a finite number."""
        if type(self.data) is dict:
            values: list[Any] = list(map(self.data.get, names))
            if all(map(is_plain, values)):
                return values
        return [self[name].real for name in names]

    @property
    def text(self) -> str:
        """A string."""
        if type(self.data) is not str:
            raise self.wrong("a text")
        return self.data

    @property
    def flag(self) -> bool:
        """A boolean."""
        if type(self.data) is not bool:
            raise self.wrong("true or false")
        return self.data

    def one_of(self, *choices: str) -> str:
        """One of these strings."""
        if self.data not in choices:
            raise self.wrong(" or ".join(choices))
        return str(self.data)


def _digits(number: int) -> str:
    # a number with very many digits is not printed
    return str(number) if abs(number) < 10**60 else f"a number of {number.bit_length()} bits"
