"""Compares the readings of a function with each other on numbers.

The reference is CPython on rationals: the lifted term and the exact reading are compared with it everywhere, CPython
on doubles where no intermediate result is rounded. Machine code must equal CPython on the same doubles everywhere.
Rows that violate a side condition (a division by zero, 64 bits) are left out for machine code and doubles.
"""

from __future__ import annotations

import functools
import math
import types
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, get_type_hints

import numpy as np

from cratous.core.kernel import entry_of, qualified
from cratous.core.kernel.sources import reached
from cratous.core.readings.exact import exact
from cratous.core.readings.graph.nodes import NotInSubset
from cratous.core.readings.machine.compiled import compiled
from cratous.core.readings.machine.domain import nonnegative
from cratous.proofs.engine.lift import LiftError
from cratous.proofs.engine.terms import leaves
from cratous.proofs.running import arguments, lifted
from cratous.proofs.running.copies import Undecided, rational_root, with_root
from cratous.proofs.running.tracked import Rounded, Tracked, tracked_root

Row = tuple[Any, ...]
ERRORS = (ZeroDivisionError, ValueError, OverflowError)
ENOUGH = 3
"""The most differences reported per function."""
DOUBLES, RATIONALS = "CPython on doubles", "CPython on rationals"
MACHINE, EXACT, TERM = "machine code", "the exact reading", "the lifted term"


@dataclass(frozen=True)
class Compared:
    """The result of comparing a function's readings.

    differences: texts with arguments and results; readings: those compared, with the number of rows; left_out:
    readings that could not be compared, with the reason.
    """

    name: str
    differences: tuple[str, ...]
    readings: tuple[tuple[str, int], ...]
    left_out: tuple[str, ...] = ()


class _Comparison:
    """One function's readings, compared row by row."""

    def __init__(
        self, function: Callable[..., Any], masks: frozenset[int], rows: list[Row]
    ) -> None:
        self.function, self.masks, self.rows = function, masks, rows
        self.kinds = arguments.kinds_of(function)
        self.differences: list[str] = []
        self.counts: dict[str, int] = {}
        self.left_out: list[str] = []

    def differs(self, one: str, got: Any, other: str, wanted: Any, row: Row) -> None:
        text = (
            f"{qualified(self.function)}: {one} gives {_text(got)}, {other} gives {_text(wanted)}, "
            f"at {_text(row)}"
        )
        if len(self.differences) < ENOUGH and text not in self.differences:
            self.differences.append(text)

    def compare(self, machine: bool) -> Compared:
        rational = [_as(row, self.kinds, Fraction) for row in self.rows]
        fits = self.term(rational)
        kernel = entry_of(self.function) is not None
        if kernel or not self.masks:
            self.doubles(rational, fits)
        if kernel and machine:
            self.machine(fits)
        if kernel:
            self.exact(rational)
        return Compared(
            qualified(self.function),
            tuple(self.differences),
            tuple(self.counts.items()),
            tuple(self.left_out),
        )

    def term(self, rows: list[Row]) -> list[bool]:
        """Compare the lifted term with CPython; returns for each row whether all side conditions hold."""
        try:
            term = lifted.term_of(self.function, self.masks)
        except (LiftError, KeyError, RecursionError, TypeError) as error:
            self.left_out.append(f"{TERM}: {error}")
            return [False] * len(rows)
        evaluated = [(row, *term(row)) for row in rows]
        for row, got, wanted in lifted.disagreeing(self.function, evaluated):
            self.differs(TERM, got, RATIONALS, wanted, row)
        self.counts[TERM] = len(rows)
        return [fits for _, _, fits, _ in evaluated]

    def doubles(self, rational: list[Row], fits: list[bool]) -> None:
        """Compare doubles with rationals where no intermediate result is rounded."""
        count = 0
        watched, exactly = (with_root(self.function, r) for r in (tracked_root, rational_root))
        for row, plain, good in zip(self.rows, rational, fits, strict=True):
            if not good:
                continue
            try:
                watched(*_as(plain, self.kinds, Tracked))
                wanted = exactly(*plain)
                got: Any = self.function(*_as(row, self.kinds, float))
            except (Rounded, Undecided):
                continue
            except ERRORS:
                continue  # not defined there, which the comparison of the lifted term covers
            count += 1
            if not _same(got, wanted):
                self.differs(DOUBLES, got, RATIONALS, wanted, row)
        self.counts[DOUBLES] = count

    def machine(self, fits: list[bool]) -> None:
        """Compare machine code with CPython on the same doubles."""
        rows, wanted = [], []
        for row, good in zip(self.rows, fits, strict=True):
            if not good or any(type(v) is int and not -(2**63) <= v < 2**63 for v in leaves(row)):
                continue
            row = _as(row, self.kinds, float)
            try:
                result = self.function(*row)
            except ERRORS:
                continue
            rows.append(row)
            wanted.append(result)
        if not rows:
            self.left_out.append(f"{MACHINE}: no row on which the kernel is defined")
            return
        try:
            found = self._run(rows)
        except (
            Exception
        ) as error:  # any compiler error: without machine code there is nothing to compare
            text = str(error).strip().splitlines()
            self.left_out.append(f"{MACHINE}: {type(error).__name__}: {text[0] if text else ''}")
            return
        for row, got, result in zip(rows, found, wanted, strict=True):
            if not _same(got, result):
                self.differs(MACHINE, got, DOUBLES, result, row)
        self.counts[MACHINE] = len(rows)

    def _run(self, rows: list[Row]) -> list[Any]:
        run = compiled(self.function)
        flat = arguments.leaves_of(self.kinds)
        types = {float: np.float64, int: np.int64, bool: np.bool_}

        def once(some: list[Row]) -> list[Any]:
            columns = zip(*[leaves(row) for row in some], strict=True)
            arrays: list[Any] = [
                np.array(c, dtype=types[k]) for c, k in zip(columns, flat, strict=True)
            ]
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                results = [array.tolist() for array in leaves(run(*arrays))]
            return [list(row) for row in zip(*results, strict=True)]

        try:
            return once(rows)
        except ERRORS:
            found: list[Any] = []
            for row in rows:
                try:
                    found += once([row])
                except ERRORS as error:
                    found.append(type(error).__name__)
            return found

    def exact(self, rational: list[Row]) -> None:
        """Compare the exact reading with rationals, where the kernel has one."""
        exactly = with_root(self.function, rational_root)
        below = _below(self.function)
        if _has_root(self.function):
            return  # the exact reading has no square root
        count = 0
        for row, plain in zip(self.rows, rational, strict=True):
            if any(type(v) is int and not -(2**63) <= v < 2**63 for v in leaves(row)) or below(
                plain
            ):
                continue
            try:
                wanted = exactly(*plain)
            except (Undecided, *ERRORS):
                continue
            if any(isinstance(part, float) for part in leaves(wanted)):
                continue  # an irrational literal
            try:
                got = exact(self.function, *_as(row, self.kinds, float))
            except NotInSubset:
                return
            except ERRORS as error:
                got = type(error).__name__
            except (KeyError, TypeError) as error:
                self.left_out.append(f"{EXACT}: {error!r}")
                return
            count += 1
            if not _same(got, wanted):
                self.differs(EXACT, got, RATIONALS, wanted, row)
        self.counts[EXACT] = count


def _has_root(function: Callable[..., Any]) -> bool:
    """Whether a function, or one that it calls, takes a square root."""
    codes = [f.__code__ for f in reached(function).values() if isinstance(f, types.FunctionType)]
    return any("sqrt" in code.co_names for code in codes)


def _below(function: Callable[..., Any]) -> Callable[[Row], bool]:
    """Returns a test whether a row has a negative number where the kernel refuses one."""
    names = nonnegative(function)
    places = [k for k, n in enumerate(get_type_hints(function)) if n in names]
    return lambda row: any(part < 0 for k in places for part in leaves(row[k]))


def _as(value: Any, kinds: Any, real: Callable[[Any], Any]) -> Any:
    """Arguments with each real number converted by `real`."""
    return tuple(_one(part, kind, real) for part, kind in zip(value, kinds, strict=True))


def _one(value: Any, kind: Any, real: Callable[[Any], Any]) -> Any:
    if isinstance(value, tuple):
        return type(value)(*_as(value, _fields(kind), real))
    return real(value) if kind is float else value


@functools.cache
def _fields(kind: Any) -> tuple[Any, ...]:
    """The types of a record's fields."""
    return tuple(get_type_hints(kind).values())


def _same(one: Any, other: Any) -> bool:
    if isinstance(one, str) or isinstance(other, str):
        return bool(one == other)
    left, right = leaves(tuple(one)) if isinstance(one, list) else leaves(one), leaves(other)
    return len(left) == len(right) and all(map(_equal, left, right))


def _equal(a: Any, b: Any) -> bool:
    if isinstance(a, bool) != isinstance(b, bool):
        return False
    nan = isinstance(a, float) and math.isnan(a)
    return bool(a == b) or (nan and isinstance(b, float) and math.isnan(b))


def _text(value: Any) -> str:
    if isinstance(value, list) and len(value) == 1:
        return _text(value[0])
    if isinstance(value, tuple | list):
        return f"({', '.join(map(_text, value))})"
    return str(value) if isinstance(value, Fraction) else repr(value)


def compare(
    function: Callable[..., Any],
    masks: frozenset[int] = frozenset(),
    more: tuple[Row, ...] = (),
    *,
    machine: bool = True,
) -> Compared:
    """Compare all readings of a kernel or definition.

    masks: positions of bit masks; more: additional rows; machine: include machine code.
    """
    try:
        rows = arguments.rows(function, masks, more)
    except (KeyError, TypeError, NameError, AttributeError) as error:
        why = f"no arguments can be made for its types: {error!r}"
        return Compared(qualified(function), (), (), (why,))
    try:
        return _Comparison(function, masks, rows).compare(machine)
    except (TypeError, AttributeError, NameError, LookupError) as error:
        why = f"{qualified(function)}: a reading of it ends in {type(error).__name__}: {error}"
        return Compared(qualified(function), (why,), ())
