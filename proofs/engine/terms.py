"""Values of the kernel subset as solver terms, and arbitrary values.

Utilities of `claim` and of mutation: arbitrary values of a type, the names in a term, and a stub in place of an
opaque function.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable
from fractions import Fraction
from typing import Any, get_type_hints

import z3

from cratous.core.kernel import Vec2
from cratous.proofs.engine.canonical import canonical
from cratous.proofs.engine.symbolic import (
    PATHS,
    LiftError,
    Sym,
    SymBool,
    SymInt,
    SymMask,
    SymReal,
    _raw,
    as_real,
    told,
    wrap,
)


class Stub:
    """In place of an opaque function: same arguments, same unknown result."""

    def __init__(self, name: str, function: Callable[..., Any]) -> None:
        self.name = name
        hints = get_type_hints(function)
        self.result = hints["return"]
        self.kinds = [hints[n] for n in inspect.signature(function).parameters]
        self.calls: list[tuple[Any, ...]] = []
        self.results: dict[str, Any] = {}

    def key(self, args: tuple[Any, ...]) -> str:
        """A text that equal arguments share."""
        return "; ".join(normal(arg, kind) for arg, kind in zip(args, self.kinds, strict=True))

    def __call__(self, *args: Any) -> Any:
        key = self.key(args)
        if key not in self.results:
            self.results[key] = fresh(f"{self.name}#{len(self.calls)}", self.result)
            self.calls.append(args)
        return self.results[key]


def normal(value: Any, kind: Any) -> str:
    """A text that equal arguments of this type share: polynomials are expanded and sorted."""
    if isinstance(value, tuple):
        kinds = get_type_hints(kind)
        fields = [kinds[part] for part in kind._fields]
        return ", ".join(normal(part, one) for part, one in zip(value, fields, strict=True))
    # an integer literal where a real is expected is a real
    return canonical(as_real(known(value)) if kind is float else known(value))


def fresh(name: str, kind: Any) -> Any:
    """An arbitrary value of this type."""
    if kind is bool:
        return SymBool(z3.Bool(name))
    if kind is int:
        return SymInt(z3.Int(name))
    if kind is float:
        return SymReal(z3.Real(name))
    fields = get_type_hints(kind)
    return kind(*[fresh(f"{name}.{part}", fields[part]) for part in fields])


def leaves(value: Any) -> list[Any]:
    """The scalars of a value, in order."""
    if isinstance(value, tuple):
        return [leaf for part in value for leaf in leaves(part)]
    return [value]


def fields_of_both(a: Any, b: Any) -> list[tuple[Any, Any]]:
    """Pairs of corresponding fields of two records of one type; TypeError for two types."""
    if not (isinstance(a, tuple) and isinstance(b, tuple)) or len(a) != len(b):
        raise TypeError("a record is compared with what has other fields")
    if getattr(a, "_fields", ()) != getattr(b, "_fields", ()) and all(
        type(one) is not tuple for one in (a, b)
    ):
        names = f"{type(a).__name__} and {type(b).__name__}"
        raise TypeError(f"records of two kinds are compared: {names}")
    return list(zip(a, b, strict=True))


def free_names(term: z3.ExprRef) -> set[str]:
    """The names of the values in a term."""
    return {value.decl().name() for value in free_values([term])}


def free_values(terms: Iterable[z3.ExprRef]) -> list[z3.ExprRef]:
    """The arbitrary values in these terms, ordered by name."""
    seen: set[int] = set()
    found: dict[str, z3.ExprRef] = {}
    todo = list(terms)
    while todo:
        part = todo.pop()
        if part.get_id() in seen:
            continue
        seen.add(part.get_id())
        below = part.children()
        todo += below
        # the declaration's name: `str` would pretty-print the term
        if not below and z3.is_app(part) and (what := part.decl()).kind() == z3.Z3_OP_UNINTERPRETED:
            found[what.name()] = part
    return [found[name] for name in sorted(found)]


def flatten(values: dict[str, Any]) -> dict[str, Any]:
    """Values by name, with each field of a vector under a name of its own."""
    flat: dict[str, Any] = {}
    for name, value in values.items():
        if isinstance(value, Vec2):
            flat[name + ".x"], flat[name + ".y"] = value.x, value.y
        else:
            flat[name] = value
    # a literal serves as well as a term
    return {k: v if isinstance(v, Sym) else wrap(known(v)) for k, v in flat.items()}


def of_kind(value: Sym, fresh: Sym, name: str) -> Sym:
    """A value to substitute for an arbitrary one: of the same kind, or an integer literal for a real."""
    wanted = fresh.term.sort()
    term = as_real(value.term) if z3.is_real(fresh.term) else value.term
    if z3.is_bv(fresh.term) and z3.is_int_value(term) and 0 <= term.as_long() < 2**64:
        term = z3.BitVecVal(term.as_long(), 64)
    if term.sort() != wanted:
        raise TypeError(f"the lemma's value {name!r} is of kind {wanted}, given is {term.sort()}")
    return wrap(term)


def of_its_kinds(function: Callable[..., Any], args: tuple[Any, ...]) -> None:
    """Raise TypeError for arguments that do not fit a function's types. A function without types accepts all."""
    try:
        kinds = get_type_hints(function)
    except (NameError, TypeError, AttributeError):
        return  # faulty types are reported where the function is linted
    names = list(inspect.signature(function).parameters)
    for name, value in zip(names, args, strict=False):
        if name in kinds and not _is_of(value, kinds[name]):
            wanted = getattr(kinds[name], "__name__", kinds[name])
            raise TypeError(
                f"{function.__name__}: {name!r} is of type {wanted}, given is another kind"
            )


def _is_of(value: Any, kind: Any) -> bool:
    if kind is bool:
        return isinstance(value, SymBool | bool)
    if isinstance(value, bool | SymBool):
        return kind not in (float, int)
    if kind is int:
        return isinstance(value, SymInt | SymMask | int)
    if kind is float:
        return isinstance(value, SymReal | int | Fraction | float) or _is_literal(value)
    if hasattr(kind, "_fields"):
        fields = get_type_hints(kind)
        parts = [fields[part] for part in kind._fields]
        if getattr(value, "_fields", kind._fields) != kind._fields:
            return False  # a stub takes them by position, the function by name
        return (
            isinstance(value, tuple) and len(value) == len(parts) and all(map(_is_of, value, parts))
        )
    return True


def depending(args: tuple[Any, ...], names: set[str]) -> list[tuple[str, z3.ArithRef]]:
    """The integer arguments that depend on these values, each with a text for messages."""
    found = []
    for leaf in leaves(args):
        if isinstance(leaf, SymInt) and not _is_literal(leaf) and free_names(leaf.term) & names:
            found.append((" ".join(str(leaf.term).split())[:40], leaf.term))
    return found


def _is_literal(value: Any) -> bool:
    """Whether the value is an integer literal, or a choice between literals."""
    if not isinstance(value, SymInt):
        return False
    try:
        return bool(z3.is_real(as_real(value.term)))
    except LiftError:
        return False


def known(value: Any) -> z3.ExprRef:
    """The term of a value or literal; TypeError for anything else."""
    term = _raw(value)
    if term is None:
        raise TypeError(f"{told(value)} is no value of the kernel subset")
    return term


def statement(value: Any) -> z3.BoolRef:
    """The term of a condition that a theorem states; TypeError for anything else."""
    if PATHS:
        raise RuntimeError("a theorem's statement was evaluated inside a lifted function")
    if isinstance(value, bool):
        return z3.BoolVal(value)
    if isinstance(value, SymBool):
        return value.term
    raise TypeError(f"{told(value)} is no statement")
