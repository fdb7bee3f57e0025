"""The kinds of values in the kernel subset: real, integer, truth value, record, written integer."""

from __future__ import annotations

import inspect
from dataclasses import dataclass
from typing import Any, get_type_hints

from cratous.proofs.engine import written_types

EXACT = 2**53
"""Every integer up to this magnitude is a double."""
INT64 = 2**63


@dataclass(frozen=True)
class Literal:
    """An integer that is written, or computed from written ones; bound: its greatest magnitude."""

    bound: int


Kind = Any
"""float, int, bool, a record class, or a Literal."""

GENERATED = {
    "__annotations__", "__doc__", "__firstlineno__", "__getnewargs__", "__match_args__", "__module__",
    "__new__", "__orig_bases__", "__replace__", "__repr__", "__slots__", "__static_attributes__",
    "_asdict", "_field_defaults", "_fields", "_make", "_replace",
    "__classdictcell__", "__annotate__", "__annotate_func__", "__annotations_cache__", "__slotnames__",
}  # fmt: skip
"""Attributes that `NamedTuple`, and `copy` on first use, add to a record class."""


def is_record(value: Any) -> bool:
    """A `NamedTuple` of the subset's kinds, as its file writes it: no methods, properties, defaults or further bases."""
    if not (inspect.isclass(value) and value.__bases__ == (tuple,) and type(value) is type):
        return False
    kind: Any = value
    fields = vars(value).get("_fields", ())
    if not fields or vars(value).get("_field_defaults"):
        return False
    more = set(vars(value)) - GENERATED - set(fields)
    plain = all(_is_field(vars(value).get(f), number) for number, f in enumerate(fields))
    # what NamedTuple makes comes from a scope of its own; a class may not bring another
    scope = getattr(value.__new__, "__globals__", {})
    made = scope.get("__name__") == f"namedtuple_{value.__name__}"
    hints = get_type_hints(value)
    kinds = set(hints) == set(fields) and all(map(is_kind, hints.values()))
    return not more and plain and made and kinds and written_types.record(kind)


def _is_field(value: Any, number: int) -> bool:
    """Whether the value is the getter that `NamedTuple` makes for the field at this index."""
    return type(value).__name__ == "_tuplegetter" and value.__reduce__()[1][0] == number


def is_kind(value: Any) -> bool:
    """True iff an argument of a kernel may be of this type."""
    return value in (float, int, bool) or is_record(value)


def shown(kind: Kind) -> str:
    """The kind's name, for messages."""
    if isinstance(kind, Literal):
        return "a written integer"
    return {float: "a real", int: "an integer", bool: "a truth value"}.get(
        kind, f"a record {getattr(kind, '__name__', kind)}"
    )


def fits(given: Kind, wanted: Kind) -> bool:
    """Whether a value of kind `given` may stand where `wanted` is required."""
    if isinstance(given, Literal):
        return bool(
            (wanted is float and given.bound <= EXACT) or (wanted is int and given.bound < INT64)
        )
    return bool(given is wanted)


def merged(one: Kind, other: Kind) -> Kind | None:
    """The common kind of two values; None if there is none."""
    if isinstance(one, Literal) and isinstance(other, Literal):
        return Literal(max(one.bound, other.bound))
    if isinstance(one, Literal):
        one, other = other, one
    if one in (float, int) and fits(other, one):
        return one
    return one if one is other else None
