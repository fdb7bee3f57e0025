"""The exact reading of a fold over arrays: one list of items, many contexts; compiled.

The fold's step is read by its filter (`core.readings.exact.float_filter`) for every context and item, in blocks that
stay in the cache, with the items in the outer loop so that several contexts are processed at once. A context for
which every step is certain has the result that the fold has on the real numbers that the doubles represent. The few
others are left to `rest`, or to the exact reading one by one. This applies to folds whose accumulator consists of
truth values and integers; no other has an exact result here.
"""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from typing import Any, get_type_hints

import numpy as np

from cratous.core.kernel import Fold
from cratous.core.readings.exact import exact
from cratous.core.readings.exact.float_filter import Certain, Filter, filtered
from cratous.core.readings.graph.nodes import Node, NotInSubset
from cratous.core.readings.graph.printing import name, straight
from cratous.core.readings.machine.compiled import EXACT, FLAGS, Reading, aligned, load
from cratous.spec.errors import BadInput

BLOCK = 1024
Rest = Callable[[tuple[Any, ...], list[np.ndarray]], np.ndarray]


def _width(kind: Any) -> int:
    fields = get_type_hints(kind) if inspect.isclass(kind) and issubclass(kind, tuple) else {}
    return sum(_width(k) for k in fields.values()) or 1


class _Shape:
    """Which of the step's columns are the accumulator, the item and the context."""

    def __init__(self, fold: Fold[Any], arguments: int) -> None:
        names = list(inspect.signature(fold.step).parameters)
        hints = get_type_hints(fold.step)
        widths = [_width(hints[n]) for n in names]
        self.kinds = [hints[n] for n in names[1:]]
        program = filtered(fold.step).program
        columns = [str(column.value) for column in program.columns]
        state, items = widths[0], sum(widths[1 : 1 + arguments])
        self.state = columns[:state]
        self.items = columns[state : state + items]
        self.context = columns[state + items :]
        self.labels = program.labels[state + items :]


def _certainty(found: Filter) -> str:
    """Text that evaluates to true where every result is certain."""
    parts = [name(found.sure)]
    for result in found.results:
        if isinstance(result, Certain) and not result.sharp:
            parts.append(f"({name(result.yes)} | {name(result.no)})")
    return " & ".join(parts)


def _roots(found: Filter) -> list[Node]:
    roots = [found.sure]
    for result in found.results:
        roots += [result.yes, result.no] if isinstance(result, Certain) else [result]
    return roots


def _values(found: Filter) -> list[str]:
    return [name(r.yes if isinstance(r, Certain) else r) for r in found.results]


def _start(value: Any) -> list[Any]:
    if isinstance(value, tuple):
        return [leaf for part in value for leaf in _start(part)]
    return [value]


def _ending(finish: Filter | None, kinds: list[str]) -> list[str]:
    """Lines for the result of one context, from its last accumulator."""
    state = [
        f"s_{k}[j] != 0" if kind == "np.uint8" else f"s_{k}[j]" for k, kind in enumerate(kinds)
    ]
    pad = " " * 12
    if finish is None:
        return [f"{pad}found[j] = {state[0]}"]
    columns = [str(column.value) for column in finish.program.columns]
    lines = [f"{pad}{c} = {same}" for c, same in zip(columns, state, strict=True)]
    return [*lines, *straight(_roots(finish), pad), f"{pad}found[j] = {_values(finish)[0]}"]


@functools.cache
def _map(fold: Fold[Any], arguments: int) -> tuple[Any, _Shape]:
    """The compiled loop: (out, code, items..., contexts...)."""
    step, shape = filtered(fold.step), _Shape(fold, arguments)
    finish = None if fold.finish is None else filtered(fold.finish)
    results = step.results if finish is None else finish.results
    if any(leaf.kind == "float" for leaf in _roots(step)[1:]) or len(results) != 1:
        raise NotInSubset(f"{fold.name}: only truth values and integers are folded over arrays")
    start = _start(fold.start)
    names = [*(f"i_{c}" for c in shape.items), *(f"c_{c}" for c in shape.context)]
    kinds = ["np.uint8" if isinstance(v, bool) else "np.int64" for v in start]
    lines = ["import numpy as np", "from numba import njit", "", "", f"@{FLAGS}"]
    lines += [f"def _fold(out, code, {', '.join(names)}):"]
    for k, kind in enumerate(kinds):
        lines.append(f"    s_{k} = np.empty({BLOCK}, dtype={kind})")
    lines += [
        f"    for begin in range(0, out.size, {BLOCK}):",
        f"        size = min({BLOCK}, out.size - begin)",
        "        found, open_ = out[begin : begin + size], code[begin : begin + size]",
    ]
    lines += [f"        v_{c} = c_{c}[begin : begin + size]" for c in shape.context]
    lines += ["        for j in range(found.size):", "            open_[j] = 0"]
    lines += [f"            s_{k}[j] = {int(value)}" for k, value in enumerate(start)]
    lines.append(f"        for k in range(i_{shape.items[0]}.size):")
    lines += [f"            {c} = i_{c}[k]" for c in shape.items]
    lines.append("            for j in range(found.size):")
    for k, column in enumerate(shape.state):
        same = f"s_{k}[j] != 0" if kinds[k] == "np.uint8" else f"s_{k}[j]"
        lines.append(f"                {column} = {same}")
    lines += [f"                {c} = v_{c}[j]" for c in shape.context]
    lines += straight(_roots(step), " " * 16)
    lines += [f"                s_{k}[j] = {value}" for k, value in enumerate(_values(step))]
    lines += [
        f"                open_[j] |= not ({_certainty(step)})",
        "        for j in range(found.size):",
    ]
    lines += [*_ending(finish, kinds), ""]
    return load("\n".join(lines))._fold, shape


def folded(fold: Fold[Any], arguments: int = 2, rest: Rest | None = None) -> Callable[..., Any]:
    """The exact reading of a fold for arrays of contexts.

    Gives a function of (items, contexts...): items is a tuple of arrays, one for each scalar of
    the step's items (`arguments`: how many arguments of the step those are), of one length; the
    contexts are broadcast, and the result has their shape, of int8 or bool. rest(items, contexts)
    decides the contexts that the filter left open. Raises BadInput, with column and index, for
    what is not finite.
    """

    def run(items: tuple[Any, ...], *contexts: Any) -> np.ndarray:
        compiled, shape = _map(fold, arguments)
        try:
            flat, result_shape = aligned(contexts)
        except ValueError as error:
            raise BadInput(
                "the columns cannot be broadcast to one shape", where=fold.name, got=str(error)
            ) from error
        size = int(np.prod(result_shape, dtype=np.int64))
        flat = [np.full(size, c) if np.ndim(c) == 0 else c for c in flat]
        columns = [np.ascontiguousarray(c, dtype=np.float64) for c in flat]
        edges = tuple(np.ascontiguousarray(c, dtype=np.float64) for c in items)
        truth = get_type_hints(fold.kernels[-1])["return"] is bool
        out: np.ndarray = np.empty(size, dtype=np.bool_ if truth else np.int8)
        code = np.empty(size, dtype=np.uint8)
        compiled(out, code, *edges, *columns)
        index = np.flatnonzero(code)
        if index.size:
            left = [column[index] for column in columns]
            _refuse_not_finite(fold.name, shape, left, index)
            out[index] = (rest or functools.partial(_one_by_one, fold, shape))(edges, left)
        return out.reshape(result_shape)

    return Reading(fold, EXACT, run)


def _refuse_not_finite(
    where: str, shape: _Shape, columns: list[np.ndarray], index: np.ndarray
) -> None:
    for label, column in zip(shape.labels, columns, strict=True):
        bad = np.flatnonzero(~np.isfinite(column))
        if bad.size:
            raise BadInput(
                "is not finite: it has no exact reading",
                where=where,
                item=f"{label}[{index[bad[0]]}]",
                expected="a number",
                got=str(column[bad[0]]),
            )


def _one_by_one(
    fold: Fold[Any], shape: _Shape, items: tuple[Any, ...], columns: list[np.ndarray]
) -> np.ndarray:
    rows = [_rows(shape.kinds, row) for row in zip(*items, strict=True)]
    count = len(rows[0]) if rows else 0
    context = shape.kinds[count:]
    found = []
    for values in zip(*columns, strict=True):
        found.append(exact(fold, rows, *_rows(context, values)))
    return np.array(found)


def _rows(kinds: list[Any], values: Any) -> tuple[Any, ...]:
    """Scalars grouped into arguments of these types, as far as they go."""
    left, made = [float(v) for v in values], []
    for kind in kinds:
        if not left:
            break
        width = _width(kind)
        part, left = left[:width], left[width:]
        made.append(kind(*part) if width > 1 else part[0])
    return tuple(made)
