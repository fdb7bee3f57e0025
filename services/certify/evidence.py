"""Counts which kernels, folds and drivers are entered while something runs, and how often.

During that time every registered function, and every entry into another reading of one (`Reading`,
a fold's call, the exact reading of one state), has an entry that counts and forwards to the
original code, which runs unchanged; calls between kernels are counted too. The function objects are
kept, so no call is missed however a reference is held; threads count, other processes do not.

A loop over arrays (`core.readings.tiered`), or of a small assignment (`core.assignment.compiled`),
runs in CPython or as machine code, whichever is available. Its entry is counted, but the functions
it calls are not: they are listed as parts of it, so that counts do not depend on the cache. In
CPython it runs as a copy that calls no counting entries (`services.certify.uncounted`).

The ledger's gate compares code with files, so it is queried beforehand: while counting, it vouches
for nothing.
"""

from __future__ import annotations

import contextlib
import itertools
import threading
from collections import Counter
from collections.abc import Callable, Iterator
from functools import cache
from types import CodeType, FunctionType
from typing import Any

from cratous.core import ledger
from cratous.core.kernel import REGISTRY, Fold, entry_of, qualified
from cratous.core.kernel.sources import reached
from cratous.core.readings import exact, tiered
from cratous.core.readings.machine.compiled import EXACT, Reading
from cratous.services.certify.uncounted import entered, uncounted
from cratous.spec.errors import BadInput

PYTHON, LOOP = "CPython", "CPython or machine code"
"""Ways of entry: a function run by CPython as written, and a loop that may be compiled; the other
ways are `Reading.how`.
"""
_counting = threading.Lock()
_looping = threading.RLock()


class Calls:
    """Entry counts by qualified name and way of entry."""

    def __init__(self) -> None:
        self._functions: dict[str, Any] = {}
        self._counts: dict[tuple[str, str], Iterator[int]] = {}
        self._done: dict[tuple[str, str], int] = {}
        self._known = frozenset(REGISTRY)
        self._late: list[str] = []
        self._parts: dict[str, list[str]] = {}
        self._copies: dict[str, Callable[..., Any]] = {}
        self._taken: Counter[str] = Counter()

    def entry(self, name: str) -> Callable[[], int]:
        """The counter for calls of a registered function as it is written."""
        return self._count(name, PYTHON)

    def folded(self, fold: Fold[Any]) -> None:
        """Count a call of a fold."""
        self._add(fold, PYTHON)

    def read(self, reading: Reading) -> None:
        """Count a call of machine code or of another reading."""
        self._add(reading.function, reading.how)

    def exact(self, function: Any) -> None:
        """Count an exact reading of a kernel or fold for one state."""
        self._add(function, EXACT)

    def looped(self, function: Callable[..., Any], run: Callable[..., Any]) -> Callable[..., Any]:
        """A loop that counts one entry, whichever way it runs."""
        ran = run.run if isinstance(run, Reading) else run
        if ran is function:
            ran = self._plain(function)

        def loop(*given: Any) -> Any:
            self._add(function, LOOP)
            if ran is not function:  # nothing in it counts
                return ran(*given)
            with self._apart(function):
                return ran(*given)

        return loop

    def _plain(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """The loop without entries that count, made once."""
        name = qualified(function)
        if name not in self._copies:
            self._copies[name] = uncounted(function)
        return self._copies[name]

    @contextlib.contextmanager
    def _apart(self, function: Callable[..., Any]) -> Iterator[None]:
        """While active, entries into a loop and into its parts are not counted, in no thread; one loop at a time.

        For a loop that has no copy without counting entries.
        """
        name = qualified(function)
        if name not in self._parts:
            self._parts[name] = sorted(entered(function).keys() & self._known)
        keys = [(part, PYTHON) for part in self._parts[name]]
        counts = [(key[0], self._counts[key]) for key in keys if key in self._counts]
        with _looping:
            before = [next(count) for _, count in counts]
            try:
                yield
            finally:
                # reading the counts above is not an entry either
                for (part, count), then in zip(counts, before, strict=True):
                    self._taken[part] += next(count) - then + 1

    def _add(self, function: Any, how: str) -> None:
        name = qualified(function)
        self._functions[name] = function
        self._count(name, how)()

    def _count(self, name: str, how: str) -> Callable[[], int]:
        # `next` of a count is atomic in the interpreter, so threads lose no count
        made = self._counts.setdefault((name, how), itertools.count())
        return made.__next__

    def close(self) -> None:
        """End counting."""
        found = {key: next(count) for key, count in list(self._counts.items())}
        for name, taken in self._taken.items():
            found[name, PYTHON] -= taken
        self._done = {key: number for key, number in found.items() if number}
        self._late = sorted(REGISTRY.keys() - self._known)

    def data(self) -> dict[str, Any]:
        """The counts as plain data, after counting has ended.

        called: registered functions, with the number of entries by way; loops: the same for other
        functions compiled with kernels in them; within: for a registered function, the names of
        what it is a part of that was entered in another way than by CPython; uncounted: functions
        registered while counting, whose entries by CPython are not known.
        """
        called: dict[str, dict[str, int]] = {}
        within: dict[str, set[str]] = {}
        for (name, how), number in sorted(self._done.items()):
            called.setdefault(name, {})[how] = number
            if how != PYTHON:
                for part in _parts(self._functions[name]) - {name}:
                    within.setdefault(part, set()).add(name)
        containing = {name for names in within.values() for name in names}
        return {
            "called": {name: ways for name, ways in called.items() if name in REGISTRY},
            "loops": {
                name: ways
                for name, ways in called.items()
                if name not in REGISTRY and name in containing
            },
            "within": {part: sorted(names) for part, names in sorted(within.items())},
            "uncounted": self._late,
        }


def _parts(function: Any) -> set[str]:
    """The registered functions that a function depends on."""
    found = reached(function)
    names = {entry.name for entry in map(entry_of, found.values()) if entry is not None}
    return names | {
        name for name, entry in REGISTRY.items() if entry.kind == "fold" and f"fold {name}" in found
    }


@contextlib.contextmanager
def counted() -> Iterator[Calls]:
    """Count all entries in the `with` block; read the result (`Calls.data`) after it.

    Caches filled by earlier work are cleared first, so that the counts follow from this work alone.
    Raises BadInput if entries are being counted already.
    """
    if not _counting.acquire(blocking=False):
        raise BadInput(
            "entries are being counted already", expected="one count at a time", got="two"
        )
    try:
        ledger.load_all()  # functions registered later have no counting entry
        from cratous.core.assignment import layers

        layers.forget()
        calls = Calls()
        with contextlib.ExitStack() as stack:
            stack.enter_context(tiered.entered_by(calls.looped))
            stack.callback(calls.close)
            for name, entry in REGISTRY.items():
                if not isinstance(entry.function, Fold):
                    stack.enter_context(_entered(entry.function, calls.entry(name), subject=False))
            for function, count in (
                (Fold.__call__, calls.folded),
                (Reading.__call__, calls.read),
                (exact.exact, calls.exact),
            ):
                stack.enter_context(_entered(function, count, subject=True))
            yield calls
    finally:
        _counting.release()


@contextlib.contextmanager
def _entered(function: Any, count: Callable[..., Any], *, subject: bool) -> Iterator[None]:
    """While active, calls of a function count and forward to the code that it has now.

    subject: whether `count` gets the first argument.
    """
    code, before = function.__code__, vars(function).get("__wrapped__")
    original = FunctionType(
        code, function.__globals__, function.__name__, function.__defaults__, function.__closure__
    )
    original.__kwdefaults__ = function.__kwdefaults__
    original.__annotations__ = function.__annotations__
    original.__qualname__, original.__module__ = function.__qualname__, function.__module__
    try:
        function.__wrapped__ = original  # signature and source are found there
        function.__code__ = _filled(_template(*_parameters(code), subject), count, original)
        yield
    finally:
        function.__code__ = code
        if before is None:
            vars(function).pop("__wrapped__", None)
        else:
            function.__wrapped__ = before


Names = tuple[str, ...]


def _parameters(code: CodeType) -> tuple[Names, Names, Names, str, str]:
    """Names of the parameters: positional-only, positional-or-keyword, keyword-only, `*`, `**`."""
    if code.co_freevars:
        raise BadInput(
            "a function within another one cannot be counted", item=code.co_qualname,
            expected="kernels and drivers at the top of their modules",
        )  # fmt: skip
    only, both = code.co_posonlyargcount, code.co_argcount
    named = both + code.co_kwonlyargcount
    left = list(code.co_varnames[named:])
    star = left.pop(0) if code.co_flags & 0x04 else ""
    stars = left.pop(0) if code.co_flags & 0x08 else ""
    names = code.co_varnames
    return names[:only], names[only:both], names[both:named], star, stars


@cache
def _template(
    only: Names, either: Names, named: Names, star: str, stars: str, subject: bool
) -> CodeType:
    """The code of an entry with these parameters, with two placeholder constants for what it calls."""
    head = [*only, *["/"][: len(only)], *either]
    head += [f"*{star}"] if star else ["*"] if named else []
    head += [*named, *[f"**{stars}"][: bool(stars)]]
    hand = [*only, *either, *[f"*{star}"][: bool(star)], *[f"{n}={n}" for n in named]]
    hand += [f"**{stars}"] if stars else []
    count, original = "count__", "original__"
    while {count, original} & {*only, *either, *named, star, stars}:
        count, original = f"{count}_", f"{original}_"
    lines = [
        f"def entry({', '.join(head)}):",
        f"    {count} = {COUNT!r}",
        f"    {original} = {ORIGINAL!r}",
        f"    {count}({(only or either)[0] if subject else ''})",
        f"    return {original}({', '.join(hand)})",
    ]
    module = compile("\n".join(lines), "<entry that is counted>", "exec", dont_inherit=True)
    return next(part for part in module.co_consts if isinstance(part, CodeType))


COUNT, ORIGINAL = "what counts", "what is counted"


def _filled(code: CodeType, count: Any, original: Any) -> CodeType:
    """A template's code with the placeholders replaced by what it calls."""
    values = {COUNT: count, ORIGINAL: original}
    consts = tuple(values.get(c, c) if isinstance(c, str) else c for c in code.co_consts)
    return code.replace(co_consts=consts)


def is_data(value: Any) -> bool:
    """True iff a value has the form of `Calls.data`."""
    parts = {"called": dict, "loops": dict, "within": dict, "uncounted": list}
    if not isinstance(value, dict) or set(value) != set(parts):
        return False
    if not all(isinstance(value[key], kind) for key, kind in parts.items()):
        return False
    ways = [way for key in ("called", "loops") for way in value[key].values()]
    return all(
        isinstance(way, dict) and all(type(n) is int and n > 0 for n in way.values())
        for way in ways
    ) and all(
        isinstance(names, list) and all(isinstance(name, str) for name in names)
        for names in (*value["within"].values(), value["uncounted"])
    )
