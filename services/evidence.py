"""Which kernels, folds and drivers are entered while something runs, and how often.

For that time every registered function, and every other reading of one (`core.compiled.Reading`,
the exact reading), gets an entry that counts and hands on to the code that was there before: that
runs, unchanged, and calls between kernels are counted as any others. Nothing else holds anything new,
so no call is missed, however the function is held. The ledger's gate reads the code of kernels: it
is asked before. A process started inside counts nothing here; threads count.
"""

from __future__ import annotations

import contextlib
import itertools
from collections import Counter
from collections.abc import Callable, Iterator
from types import CodeType, FunctionType
from typing import Any

from cratous.core import exactly, swift
from cratous.core.compiled import EXACT, Reading
from cratous.core.kernel import REGISTRY, Fold, entry_of, qualified
from cratous.core.sources import reached

PYTHON = "Python"
"""How a function is entered that CPython runs as written; the other ways are `Reading.how`."""


class Calls:
    """What was entered: per qualified name how often, by way of entry."""

    def __init__(self) -> None:
        self._plain: dict[str, Iterator[int]] = {}
        self._read: Counter[tuple[str, str]] = Counter()
        self._functions: dict[str, Any] = {}
        self._done: dict[str, int] = {}

    def entry(self, name: str) -> Callable[[], int]:
        """What counts one call of a function as it is written."""
        return self._plain.setdefault(name, itertools.count()).__next__  # type: ignore[attr-defined, no-any-return]

    def folded(self, fold: Fold[Any]) -> None:
        """A fold was called."""
        self._add(fold, PYTHON)

    def read(self, reading: Reading) -> None:
        """Machine code, or another reading, was called."""
        self._add(reading.function, reading.how)

    def exact(self, function: Any) -> None:
        """A kernel or fold was read exactly for one state."""
        self._add(function, EXACT)

    def _add(self, function: Any, how: str) -> None:
        name = qualified(function)
        self._functions[name] = function
        self._read[name, how] += 1

    def close(self) -> None:
        """No more is counted."""
        self._done = {name: next(count) for name, count in self._plain.items()}

    def data(self) -> dict[str, Any]:
        """The counts as plain data, the same for the same calls.

        called: per name the number of entries, by way; loops: the same for other functions that
        stand in machine code with kernels in them; within: for a kernel the names of what it is
        contained in and was entered otherwise than by CPython.
        """
        found: dict[str, dict[str, int]] = {}
        for name, count in self._done.items():
            if count:
                found.setdefault(name, {})[PYTHON] = count
        for (name, how), count in self._read.items():
            ways = found.setdefault(name, {})
            ways[how] = ways.get(how, 0) + count
        within: dict[str, set[str]] = {}
        for name in sorted({name for name, how in self._read if how != PYTHON}):
            for part in _parts(self._functions[name]) - {name}:
                within.setdefault(part, set()).add(name)
        containing = {name for names in within.values() for name in names}
        return {
            "called": {name: ways for name, ways in sorted(found.items()) if name in REGISTRY},
            "loops": {
                name: ways
                for name, ways in sorted(found.items())
                if name not in REGISTRY and name in containing
            },
            "within": {part: sorted(names) for part, names in sorted(within.items())},
        }


def _parts(function: Any) -> set[str]:
    """The registered functions that one rests on."""
    values = reached(function).values()
    names = {entry.name for entry in map(entry_of, values) if entry is not None}
    folds = {f"fold {name}": name for name, entry in REGISTRY.items() if entry.kind == "fold"}
    return names | {folds[name] for name in reached(function) if name in folds}


@contextlib.contextmanager
def counted() -> Iterator[Calls]:
    """Count all entries inside; the result can be asked for (`Calls.data`) after it.

    What the product remembers of former work and what decides when loops are compiled is forgotten
    at the beginning, so that the counts are those of this work alone.
    """
    calls = Calls()
    swift.begin_anew()
    with contextlib.ExitStack() as stack:
        for name, entry in REGISTRY.items():
            if not isinstance(entry.function, Fold):
                stack.enter_context(_entered(entry.function, _plainly, calls.entry(name)))
        for function, count in (
            (Fold.__call__, calls.folded),
            (Reading.__call__, calls.read),
            (exactly.exact_scalar, calls.exact),
        ):
            stack.enter_context(_entered(function, _by_subject, count))
        yield calls
    calls.close()


@contextlib.contextmanager
def _entered(function: Any, template: Any, count: Callable[..., Any]) -> Iterator[None]:
    """Inside, a function's entry counts and hands on to the code that it has now."""
    code, before = function.__code__, getattr(function, "__wrapped__", None)
    original = FunctionType(
        code, function.__globals__, function.__name__, function.__defaults__, function.__closure__
    )
    original.__kwdefaults__ = function.__kwdefaults__
    original.__annotations__ = function.__annotations__
    original.__qualname__, original.__module__ = function.__qualname__, function.__module__
    function.__code__ = _filled(template.__code__, {"count": count, "original": original})
    function.__wrapped__ = original  # signature and source are found there
    try:
        yield
    finally:
        function.__code__ = code
        if before is None:
            del function.__wrapped__
        else:
            function.__wrapped__ = before


def _filled(code: CodeType, values: dict[str, Any]) -> CodeType:
    """A template's code with values in the places of the texts that name them."""
    consts = tuple(values.get(c, c) if isinstance(c, str) else c for c in code.co_consts)
    return code.replace(co_consts=consts)


def _plainly(*given: Any, **named: Any) -> Any:
    # templates: the texts are replaced by what they name
    count: Any = "count"
    original: Any = "original"
    count()
    return original(*given, **named)


def _by_subject(subject: Any, *given: Any, **named: Any) -> Any:
    count: Any = "count"
    original: Any = "original"
    count(subject)
    return original(subject, *given, **named)
