"""Whether a theorem's goals would be false if a kernel had another result, at pseudo-random values.

A condition in a goal (`c.implies(x == 3, ...)`) restricts a theorem like a premise. So the statement is run once more
at the places of `nudged`, with the result of a use of a kernel replaced: some goal must then be false, at a place and
at a minute offset from it, and must not be false if the result of a definition is replaced too. Only then does this
goal relate the kernel to the definition, for as many arguments as change.
"""

from __future__ import annotations

import contextlib
import functools
import inspect
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from hashlib import sha256
from types import MappingProxyType
from typing import Any, NamedTuple, get_type_hints

import z3

from cratous.core.kernel import qualified
from cratous.proofs.engine.argument_values import Place, enough
from cratous.proofs.engine.terms import leaves
from cratous.proofs.running.late_values import now
from cratous.proofs.running.nudged import STOPS, Nudged, Observed, no_lemma
from cratous.proofs.running.statement import Values, truth
from cratous.proofs.statements.closed_definitions import full_name

NO, GOAL, BY_DEFINITION = 0, 1, 2
"""No goal excludes another result; one does; one does because of the result of a definition."""

PLACES = 600
"""The most places tried."""

Call = tuple[Callable[..., Any], tuple[Any, ...]]
"""A function, and the numbers passed to it."""


class Statement(NamedTuple):
    """A statement; uses: the uses of kernels to decide, by number, each with its kernel's name and its arguments
    other than literals.

    further: uses that goals hold against the definition of further values (THERE IS one), so that they may deny it
    of these, each with the names in its own arguments;
    meant: the definition's full name; rows: uses whose goals refer to it without a condition, but not by a result
    that could be replaced (it is evaluated at literals).
    """

    run: Callable[[Any], None]
    uses: Mapping[int, tuple[str, Mapping[Place, z3.ExprRef]]]
    meant: str
    rows: frozenset[int]
    further: Mapping[int, frozenset[str]] = MappingProxyType({})


def decided(
    statement: Statement,
    seed: str,
    calls: int,
    enough_of: Callable[[set[int]], bool],
    otherwise: set[int] | None = None,
) -> tuple[set[int], bool]:
    """The uses whose results the goals are found to decide at many values, and whether they decide one anywhere.

    enough_of: ends the search; calls: the most calls of functions. otherwise: gets the uses of which goals are false
    with the definition's value in the kernel's place, at some place: what they say is another thing, even if not
    everywhere.
    """
    others = set[int]() if otherwise is None else otherwise
    anywhere = False
    asked = {use: terms for use, (_, terms) in statement.uses.items()}
    values: dict[Place, set[Any]] = {place: set() for use in asked.values() for place in use}
    many: set[Place] = set()
    meant: set[int] = set()
    found: set[int] = set()
    left = [calls]
    hairs = (0, 1) if any(z3.is_real(t) for use in asked.values() for t in use.values()) else (0,)
    for number in range(PLACES):
        places = [_Place(statement, f"{seed} {number}", some, left) for some in hairs]
        for use in sorted(asked.keys() - found - others):
            how = _least(place.holds(use) for place in places)
            others |= {use} if any(use in place.otherwise for place in places) else set()
            if how == NO:
                continue
            anywhere = True
            if how == BY_DEFINITION:
                meant.add(use)
            here, beside = places[0].base.arguments, places[-1].base.arguments
            for at, term in asked[use].items():
                # both values of a truth value count, though a definition may decide nothing at one of them
                if at in here and at in beside and (how == BY_DEFINITION or z3.is_bool(term)):
                    values[at].add(here[at])
                    moved = here[at] != beside[at]
                    if moved if z3.is_real(term) else enough(term, values[at]):
                        many.add(at)
            if use in meant and asked[use].keys() <= many:
                found.add(use)
                if enough_of(found):
                    return found, anywhere
        if len(found | others) == len(asked) or left[0] <= 0:
            break
    return found, anywhere


def _least(found: Iterator[int]) -> int:
    least = BY_DEFINITION
    for one in found:
        least = min(least, one)
        if least == NO:
            break
    return least


class _InUnit(Nudged):
    """Pseudo-random reals from 0 to 1."""

    def real(self, name: str) -> Fraction:
        said = int(sha256(f"{self.seed} in unit {name}".encode()).hexdigest(), 16)
        return Fraction(said >> 128, 2**128) + super().real(name) % Fraction(1, 2**130)


class _Elsewhere(Nudged):
    """Pseudo-random numbers, but for the values of a point."""

    def __init__(self, seed: str, point: Mapping[str, Any]) -> None:
        super().__init__(seed, 0)
        self.point = dict(point)

    def real(self, name: str) -> Fraction:
        return self.point[name] if name in self.point else super().real(name)


class _Place:
    """The runs of a statement at one place."""

    def __init__(self, of: Statement, seed: str, hairs: int, left: list[int]) -> None:
        self.statement, self.uses, self.rows, self.meant = of.run, of.uses, of.rows, of.meant
        self.further = of.further
        self.otherwise: set[int] = set()
        self.seed, self.hairs, self.left = seed, hairs, left
        # some statements about a fraction (from 0 to 1) seldom apply elsewhere
        self.values = _InUnit if int(sha256(seed.encode()).hexdigest(), 16) % 2 else Nudged

    @functools.cached_property
    def base(self) -> _Replaced:
        """The run of the statement as it is."""
        return self._run({}, strict=False)

    def _own(self, use: int) -> list[Call]:
        """The calls of definitions that stay the same where values that the use's arguments do not name are others."""
        known = {n: now(v) for n, v in self.base.shown.items() if n in self.further[use]}
        beside = self._run({}, strict=False, values=_Elsewhere(f"{self.seed} elsewhere", known))
        return beside.definitions

    def _run(
        self, results: Mapping[Call, Any], *, strict: bool = True, values: Values | None = None
    ) -> _Replaced:
        values = values or self.values(self.seed, self.hairs)
        on = _Replaced(values, no_lemma, results=results, strict=strict)
        with contextlib.suppress(*STOPS):
            if self.left[0] > 0:
                self.statement(on)
        self.left[0] -= 1 + len(on.found)
        return on

    def holds(self, use: int) -> int:
        """Whether some goal excludes another result of this use: NO, GOAL or BY_DEFINITION."""
        call = self.base.kernels.get(use)
        if call not in self.base.found or qualified(call[0]) != self.uses[use][0]:
            return NO
        found = NO
        for other in _others(self.base.found[call], self.seed):
            wrong = self._run({call: other})
            if not wrong.false:
                continue
            own: list[
                Call
            ] = []  # calls of the definition that only relate it to the kernel's own arguments
            if not self._meets(call, wrong):
                if use not in self.further:
                    # a truth value may be joined with another: done before, or long enough
                    given = [m for m in wrong.definitions if full_name(m[0]) == self.meant]
                    if not any(isinstance(wrong.found.get(m), bool) for m in given):
                        self.otherwise.add(use)
                    return NO
                own = self._own(use)
            if use in self.rows:
                return BY_DEFINITION
            found = GOAL
            for meant in wrong.definitions:
                if meant not in wrong.found or meant in own or full_name(meant[0]) != self.meant:
                    continue
                for result in (other, *leaves(other), *_others(wrong.found[meant], self.seed)):
                    if _shape(result) != _shape(wrong.found[meant]):
                        continue
                    right = self._run({call: other, meant: result})
                    if any(n <= right.asked and n not in right.false for n in wrong.false):
                        return BY_DEFINITION
                    if right.outside and right.asked < max(wrong.false):
                        return BY_DEFINITION
        return found

    def _meets(self, call: Call, wrong: _Replaced) -> bool:
        """Whether every goal is true with a value of the definition as this use's result; true where none is of its
        kind.

        wrong: a run with another result; a call of the definition that takes it is none of the statement alone.
        """
        base, result = self.base, self.base.found[call]
        calls = [m for m in base.definitions if full_name(m[0]) == self.meant and m in base.found]
        calls = [m for m in calls if m in wrong.definitions]
        here = [m for m in calls if m[1] == call[1]]
        if calls and not here and kinds(calls[0][0]) == kinds(call[0]):
            return False  # taking the same kinds of arguments, it is meant for the same ones
        given = leaves(call[1])
        own = [m for m in calls if all(value in given for value in leaves(m[1]))]
        values = [base.found[m] for m in here or own or calls]
        fit = [new for value in values for new in _with_value(result, value)]
        return not fit or any(not self._run({call: new}).false for new in fit)


def kinds(function: Callable[..., Any]) -> tuple[list[Any], Any]:
    """The kinds of a function's arguments, in order, and of its result."""
    hints = get_type_hints(function)
    return [hints.get(name) for name in inspect.signature(function).parameters], hints.get("return")


def _with_value(result: Any, value: Any) -> Iterator[Any]:
    """The result with this value in its place, or in that of a part of its kind."""
    if _shape(result) == _shape(value):
        # a record with the same fields in another order takes each by its name
        fields, own = getattr(value, "_fields", ()), getattr(result, "_fields", ())
        by_name = fields != own and set(fields) == set(own)
        yield type(result)(*(getattr(value, name) for name in own)) if by_name else value
    elif isinstance(result, tuple):
        for k, part in enumerate(result):
            for new in _with_value(part, value):
                parts = [*result[:k], new, *result[k + 1 :]]
                yield type(result)(*parts) if hasattr(result, "_fields") else tuple(parts)


@dataclass
class _Replaced(Observed):
    """A run of a statement with some results replaced; records which goals are false."""

    results: Mapping[Call, Any] = field(default_factory=dict)
    strict: bool = True
    kernels: dict[int, Call] = field(default_factory=dict)
    definitions: list[Call] = field(default_factory=list)
    false: set[int] = field(default_factory=set)
    asked: int = 0
    outside: bool = False

    def __post_init__(self) -> None:
        self.given, self.found = self.results, dict[Call, Any]()

    def premise(self, condition: Any) -> None:
        self.outside = True
        with contextlib.nullcontext() if self.strict else contextlib.suppress(*STOPS):
            super().premise(condition)
        self.outside = False

    def use(self, kernel: Callable[..., Any], *args: Any, when: Any = True) -> Any:
        self.kernels[self.uses] = (kernel, now(args))
        return super().use(kernel, *args, when=when)

    def define(self, definition: Callable[..., Any], *args: Any) -> Any:
        call = (definition, now(args))
        if call not in self.definitions:
            self.definitions.append(call)
        return super().define(definition, *args)

    def _run(self, function: Callable[..., Any], args: tuple[Any, ...]) -> Any:
        call = (function, now(args))
        if call not in self.found:
            self.found[call] = (
                self.given[call] if call in self.given else super()._run(function, args)
            )
        return self.found[call]

    def show(self, goal: Any, text: str = "the claim") -> None:
        self.asked += 1
        if not truth(goal):
            self.false.add(self.asked)

    def cases(self, *conditions: Any, goal: Any, text: str = "the claim") -> None:
        self.show(goal, text)


def _others(value: Any, seed: str) -> Iterator[Any]:
    """Other values of the same type; of a record, with one field changed at a time."""
    if isinstance(value, tuple):
        for k, part in enumerate(value):
            for other in _others(part, f"{seed}.{k}"):
                parts = [*value[:k], other, *value[k + 1 :]]
                yield type(value)(*parts) if hasattr(value, "_fields") else tuple(parts)
    elif isinstance(value, bool):
        yield not value
    elif isinstance(value, int):
        yield from (value + apart for apart in (1, -1, 2, -2, 7, -7))
    elif isinstance(value, Fraction):
        by = 1 + Fraction(int(sha256(seed.encode()).hexdigest(), 16), 2**256)
        yield from (
            value + by,
            value - by,
            value + by / 64,
            value - by / 64,
            value + 64 * by,
            value - 64 * by,
        )


def _shape(value: Any) -> Any:
    return tuple(map(_shape, value)) if isinstance(value, tuple) else type(value)
