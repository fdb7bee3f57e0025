"""The exact reading: the verdict of a division-free kernel on the real numbers that its doubles represent.

Four stages, each generated from the kernel's graph. The *filter* (`core.readings.exact.float_filter`) is as fast as
plain doubles and leaves undecided what rounding could have changed; *pairs* of doubles
(`core.readings.exact.double_pairs`) with residues of their error (`core.readings.exact.residues`) decide nearly all
of that, and *expansions* (`core.readings.exact.expansions`) the rest, in machine code while nothing can overflow or
underflow; *integers* (`core.readings.exact.integers`) decide everything else. All are exact where they answer, so the
verdict does not depend on which of them answered.
"""

from __future__ import annotations

import functools
import inspect
import math
from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction
from typing import Any

import numpy as np

from cratous.core.kernel import Fold
from cratous.core.readings.exact import double_pairs as pairs
from cratous.core.readings.exact import expansions, integers, residues
from cratous.core.readings.exact.expansion_arithmetic import primitives
from cratous.core.readings.exact.float_filter import TRUE, UNDECIDED, Certain, Filter, filtered
from cratous.core.readings.graph.nodes import Node, NotInSubset, Program, Record, Value, leaves
from cratous.core.readings.graph.printing import name, straight
from cratous.core.readings.machine.compiled import (
    EXACT,
    FLAGS,
    Reading,
    checked,
    load,
    loop_text,
    outcome,
    single,
)
from cratous.core.readings.machine.domain import nonnegative, refuse_negative
from cratous.spec.errors import BadInput

FEW = 64
"""Up to this many undecided states go straight to the integers, without compiling machine code for them."""

SHARED = "\n\n".join(
    ["import numpy as np", *(m(FLAGS) for m in (primitives, pairs.arithmetic, residues.arithmetic))]
)
"""The text shared by the machine code of all kernels."""


# -- arrays -----------------------------------------------------------------------------
@functools.cache
def _filter_map(found: Filter, scalars: frozenset[str]) -> Any:
    result = found.results[0]
    if isinstance(result, Certain):
        roots = [result.yes, result.no, found.sure]
        store = [
            f"        yes = {name(result.yes)} & {name(found.sure)}",
            f"        no = {name(result.no)} & {name(found.sure)}",
            "        out[i] = 1 if yes else (0 if no else 2)",
        ]
        outs = "out"
    else:
        roots = [result, found.sure]
        store = [
            f"        out[i] = {name(result)}",
            f"        code[i] = 1 if {name(found.sure)} else 2",
        ]
        outs = "out, code"
    body = [*straight(roots, "        "), *store]
    return load(loop_text(found.program.columns, scalars, outs, body))._map


@functools.cache
def _expansion_map(found: Filter, scalars: frozenset[str]) -> tuple[Any, int, int] | None:
    shared = load(SHARED).__name__
    made = expansions.text(found, scalars, FLAGS, shared)
    if made is None:
        return None
    text, cells, values = made
    return load(text)._map, cells, values


def exactly(kernel: Callable[..., Any], made: Filter | None = None) -> Callable[..., np.ndarray]:
    """The exact reading of a kernel with a truth value or an integer as result, over arrays.

    Takes columns as `compiled(kernel)` does, broadcasts them, and gives bool or int64. Raises
    BadInput, with column and index, for NaN, infinities and numbers that are no doubles;
    NotInSubset for a kernel that divides or whose result is a real number or a record.
    `out` may be given for the result. made: another filter than the kernel's own, for tests.
    """
    found = made or _filter_of(kernel)
    source = found.program
    if len(found.results) != 1 or not isinstance(source.result, Node):
        raise NotInSubset(f"{source.name} gives a record; `exact` reads it one state at a time")
    if source.result.kind == "float":
        raise NotInSubset(f"{source.name} gives a real number, which may be no double")
    truth = source.result.kind == "bool"
    names = nonnegative(kernel)

    def run(*columns: Any, out: np.ndarray | None = None) -> np.ndarray:
        flat, shape = checked(source, columns)
        refuse_negative(source.name, names, zip(source.labels, flat, strict=True))
        scalars = single(source, flat)
        result = outcome(source.name, out, shape, np.bool_ if truth else np.int64)
        code = result.view(np.uint8) if truth else np.empty(result.size, dtype=np.uint8)
        values = code if truth else result
        _filter_map(found, scalars)(*((code,) if truth else (values, code)), *flat)
        if code.size and code.max() >= UNDECIDED:
            _resolve(found, scalars, flat, values, code)
        return result.reshape(shape)

    return Reading(kernel, EXACT, run)


@functools.cache
def _filter_of(kernel: Callable[..., Any]) -> Filter:
    return filtered(kernel)


def _resolve(
    found: Filter,
    scalars: frozenset[str],
    flat: list[Any],
    out: np.ndarray,
    code: np.ndarray,
) -> None:
    """Decide what the filter left open: by expansions within their range, then by integers."""
    index = np.flatnonzero(code == UNDECIDED)
    if index.size > FEW:
        made = _expansion_map(found, scalars)
        if made is not None:
            decide, cells, values = made
            code[index] = TRUE
            work, lengths = np.zeros(cells), np.ones(values, dtype=np.int64)
            decide(out, code, index, work, lengths, *flat)
            index = index[code[index] == UNDECIDED]
    _refuse_not_finite(found.program, flat, index)
    decider = integers.decider(found.program)
    for i in index.tolist():
        row = [
            _plain(column.kind, value if np.ndim(value) == 0 else value[i])
            for column, value in zip(found.program.columns, flat, strict=True)
        ]
        (out[i],) = decider(*row)


def _plain(kind: str, value: Any) -> Any:
    return integers.pair(float(value)) if kind == "float" else value.item()


def _refuse_not_finite(source: Program, flat: list[Any], index: np.ndarray) -> None:
    for column, label, value in zip(source.columns, source.labels, flat, strict=True):
        if column.kind != "float":
            continue
        if np.ndim(value) == 0:
            if not np.isfinite(value):
                raise _not_finite(source, label, value)
        else:
            bad = index[~np.isfinite(value[index])]
            if bad.size:
                raise _not_finite(source, f"{label}[{bad[0]}]", value[bad[0]])


def _not_finite(source: Program, item: str, value: Any) -> BadInput:
    what = "is not finite: it has no exact reading"
    return BadInput(what, where=source.name, item=item, expected="a number", got=str(value))


# -- one state at a time ----------------------------------------------------------------
class NotFinite(BadInput, ValueError):
    """An argument that is not finite; also a ValueError, for compatibility."""


@functools.cache
def _scalar_filter(kernel: Callable[..., Any]) -> Callable[..., Any]:
    """The filter as run by CPython: (sure, results)."""
    found = _filter_of(kernel)
    sure, results, roots = name(found.sure), [], [found.sure]
    for result in found.results:
        if isinstance(result, Certain):
            roots += [result.yes, result.no]
            results.append(name(result.yes))
            sure += f" and ({name(result.yes)} or {name(result.no)})"
        else:
            roots.append(result)
            results.append(name(result))
    columns = ", ".join(str(c.value) for c in found.program.columns)
    lines = [f"def decide({columns}):", *straight(roots, "    ")]
    lines.append(f"    return {sure}, ({', '.join(results)},)")
    scope: dict[str, Any] = {}
    exec(compile("\n".join(lines), f"<filter of {found.program.name}>", "exec"), scope)
    decide: Callable[..., Any] = scope["decide"]
    return decide


def _numbers(value: Any) -> list[Any]:
    if isinstance(value, tuple):
        return [part for item in value for part in _numbers(item)]
    return [value]


def _fits(source: Program, row: list[Any]) -> bool:
    """True iff every number has its column's machine type, so that the filter applies."""
    if len(row) != len(source.columns):
        return False
    for column, value in zip(source.columns, row, strict=True):
        if column.kind == "float":
            if not isinstance(value, float):
                return False
        elif not isinstance(value, int | bool):
            return False
    return True


def _built(shape: Value, parts: list[Any]) -> Any:
    """Rebuild the kernel's record from its results."""
    if isinstance(shape, Record):
        fields = [_built(field, parts) for field in shape.fields]
        return shape.kind(*fields)
    return parts.pop(0)


def _rational(value: Any) -> Any:
    if isinstance(value, float):
        return Fraction(value)
    if isinstance(value, tuple):
        parts = [_rational(part) for part in value]
        return type(value)(*parts) if hasattr(value, "_fields") else tuple(parts)
    return value


def _filterable(function: Callable[..., Any]) -> Program | None:
    try:
        found = _filter_of(function).program
    except NotInSubset:
        return None
    # real results are required exactly, and a double may not be exact
    return None if any(leaf.kind == "float" for leaf in leaves(found.result)) else found


def exact(function: Callable[..., Any] | Fold[Any], *args: Any) -> Any:
    """The exact reading of a division-free kernel or fold: its result on the reals that args are.

    Decided by the float filter first, integers next, and rationals where neither applies. Raises
    NotFinite (a ValueError) for an argument that is not finite: it has no exact reading.
    """
    try:
        if isinstance(function, Fold):
            items, *context = args
            acc = function.start
            for item in items:
                acc = _one(function.step, (acc, *item, *context))
            return acc if function.finish is None else _one(function.finish, (acc,))
        return _one(function, args)
    except OverflowError as error:
        name_ = function.__name__
        raise NotFinite("an argument is not finite", where=name_) from error


def _labelled(values: Iterable[tuple[str, Any]]) -> Iterator[tuple[str, Any]]:
    """Names and values, those of records field by field as in the labels of columns."""
    for label, value in values:
        if hasattr(value, "_fields"):
            fields = ((f"{label}.{field}", part) for field, part in value._asdict().items())
            yield from _labelled(fields)
        else:
            yield label, value


@functools.cache
def _parameters(function: Callable[..., Any]) -> tuple[str, ...]:
    return tuple(inspect.signature(function).parameters)


def _any_below(values: Iterable[Any]) -> bool:
    """True iff a number in these, or in the records among them, is not 0 or more."""
    return any(
        _any_below(value) if isinstance(value, tuple) else not value >= 0 for value in values
    )


def _one(function: Callable[..., Any], args: tuple[Any, ...]) -> Any:
    names = nonnegative(function)
    if names:
        given = list(zip(_parameters(function), args, strict=False))
        # the offending number is determined only for the few that fail
        if _any_below(value for name, value in given if name in names):
            refuse_negative(function.__name__, names, _labelled(given))
    source = _filterable(function)
    row = _numbers(args) if source is not None else []
    if source is None or not _fits(source, row):
        return function(*map(_rational, args))
    # numpy's scalars would warn where a double overflows
    row = [float(value) if isinstance(value, float) else value for value in row]
    sure, results = _scalar_filter(function)(*row)
    if not sure:
        for label, value in zip(source.labels, row, strict=True):
            if not math.isfinite(value):
                raise NotFinite(
                    "is not finite: it has no exact reading", where=source.name, item=label
                )
        pairs = zip(source.columns, row, strict=True)
        ready = [integers.pair(v) if c.kind == "float" else v for c, v in pairs]
        results = integers.decider(source)(*ready)
    return _built(source.result, list(results))
