"""Whether what a theorem shows would be false if a kernel had another result there, at values that nobody chose.

A condition in a goal (`c.implies(x == 3, ...)`) restricts a theorem as a premise does. So the statement is run
once more at the places of `nudged`, with the result of a use of a kernel replaced by another one: some goal must be
false then, at a place and a hair away from it, and must not be false if the result of a definition is replaced too.
For only then it is this goal that holds the one against the other, and does so for as many arguments as move.
"""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple

import z3

from cratous.core.kernel import Fold
from cratous.proofs.engine.argument_values import Held, Place, Possible, Runs, Uses, enough
from cratous.proofs.engine.claim import Claim
from cratous.proofs.engine.free_results import FreeResults, settled
from cratous.proofs.engine.lift import LiftError
from cratous.proofs.engine.terms import free_names, known, leaves
from cratous.proofs.engine.theorem_files import load_claim, load_lemma
from cratous.proofs.running.late_values import now
from cratous.proofs.running.nudged import STOPS, Nudged, Observed, no_lemma, taken
from cratous.proofs.running.statement import truth

NO, GOAL, BY_DEFINITION = 0, 1, 2
"""No goal excludes another result; one does; it does because of what a definition says."""

CALLS = 4_000
"""So many calls of functions are made for a theorem at most."""

Call = tuple[Callable[..., Any], tuple[Any, ...]]
"""A function, and numbers it is given."""


def runs(name: str, claim: Claim, folder: Path) -> Runs:
    """What runs of a theorem tell of it; claim: the same, stated."""
    return Runs(taken(name, claim, folder), held(name, claim, folder))


def held(name: str, claim: Claim, folder: Path) -> Held:
    """Finds the uses of kernels that a theorem's goals hold against a definition; claim: the same, stated."""
    statement = load_claim(name, folder)[0]
    rows = _rows(claim)

    def found(seed: str, asked: Uses, possible: Possible) -> set[int]:
        # no run sees the calls of a function
        held = set() if claim.asked else _found(_Statement(statement, rows), seed, asked)
        rest = {use: terms for use, terms in asked.items() if use not in held}
        if rest:
            answers = settled(_freed(statement, folder), rest, rows, possible)
            held |= {use for use, answer in answers.items() if answer != "unsat"}
        return held

    return found


class _Statement(NamedTuple):
    """A statement; rows: its uses of kernels for which a definition is evaluated at numbers written down in them.

    These are the definition's results, and stand in the goals: no other ones are tried.
    """

    run: Callable[[Any], None]
    rows: frozenset[int]


def _rows(claim: Claim) -> frozenset[int]:
    runs = getattr(claim, "runs", ())
    points = [_written(run.args) for run in runs if run.role == "definition"]
    points = [point for point in points if point and None not in point]
    uses = [_written(run.args) for run in runs if run.role == "kernel"]
    return frozenset(n for n, use in enumerate(uses) if any(point <= use for point in points))


def _written(args: tuple[Any, ...]) -> set[str | None]:
    """The numbers among arguments that are written down; None stands for all others."""
    terms = [known(leaf) for leaf in leaves(args)]
    return {None if free_names(term) else str(term) for term in terms}


def _freed(statement: Callable[[Any], None], folder: Path) -> FreeResults | None:
    """The claim with free results; None where it cannot be stated so."""
    claim = FreeResults(load=functools.cache(lambda other: load_lemma(other, folder)))
    try:
        statement(claim)
    except (LiftError, TypeError, ValueError, RuntimeError, AttributeError, KeyError, IndexError):
        return None
    return claim


def _found(statement: _Statement, seed: str, asked: Uses) -> set[int]:
    """Those of some uses, each with its arguments that are no numbers which are written down."""
    values: dict[Place, set[Any]] = {place: set() for use in asked.values() for place in use}
    many: set[Place] = set()
    meant: set[int] = set()
    found: set[int] = set()
    left = [CALLS]
    hairs = (0, 1) if any(z3.is_real(t) for use in asked.values() for t in use.values()) else (0,)
    for number in range(CALLS):
        places = [_Place(statement, f"{seed} {number}", some, left) for some in hairs]
        for use in sorted(asked.keys() - found):
            how = _least(place.holds(use) for place in places)
            if how == NO:
                continue
            if how == BY_DEFINITION:
                meant.add(use)
            here, beside = places[0].base.arguments, places[-1].base.arguments
            for at, term in asked[use].items():
                # of a truth value both count, though a definition may decide nothing at one of them
                if at in here and at in beside and (how == BY_DEFINITION or z3.is_bool(term)):
                    values[at].add(here[at])
                    moved = here[at] != beside[at]
                    if moved if z3.is_real(term) else enough(term, values[at]):
                        many.add(at)
            if use in meant and asked[use].keys() <= many:
                found.add(use)
        if len(found) == len(asked) or left[0] <= 0:
            break
    return found


def _least(found: Iterator[int]) -> int:
    least = BY_DEFINITION
    for one in found:
        least = min(least, one)
        if least == NO:
            break
    return least


class _Place:
    """A statement at one place."""

    def __init__(self, of: _Statement, seed: str, hairs: int, left: list[int]) -> None:
        self.statement, self.rows = of.run, of.rows
        self.seed, self.hairs, self.left = seed, hairs, left

    @functools.cached_property
    def base(self) -> _Replaced:
        """As it is stated."""
        return self._run({}, strict=False)

    def _run(self, results: Mapping[Call, Any], *, strict: bool = True) -> _Replaced:
        on = _Replaced(Nudged(self.seed, self.hairs), no_lemma, results=results, strict=strict)
        with contextlib.suppress(*STOPS):
            if self.left[0] > 0:
                self.statement(on)
        self.left[0] -= 1 + len(on.found)
        return on

    def holds(self, use: int) -> int:
        """Whether some goal excludes another result of this use."""
        if use in self.base.of_folds:
            return BY_DEFINITION  # an induction has no condition but its premises
        call = self.base.kernels.get(use)
        if call not in self.base.found:
            return NO
        found = NO
        for other in _others(self.base.found[call], self.seed):
            wrong = self._run({call: other})
            if not wrong.false:
                continue
            if use in self.rows:
                return BY_DEFINITION
            found = GOAL
            for meant in wrong.definitions:
                if meant not in wrong.found:
                    continue
                for result in (other, *_others(wrong.found[meant], self.seed)):
                    if _shape(result) != _shape(wrong.found[meant]):
                        continue
                    right = self._run({call: other, meant: result})
                    if any(n <= right.asked and n not in right.false for n in wrong.false):
                        return BY_DEFINITION
                    if right.outside and right.asked < max(wrong.false):
                        return BY_DEFINITION
        return found


@dataclass
class _Replaced(Observed):
    """A run of a statement with other results of some calls; notes which goals are false."""

    results: Mapping[Call, Any] = field(default_factory=dict)
    strict: bool = True
    kernels: dict[int, Call] = field(default_factory=dict)
    definitions: list[Call] = field(default_factory=list)
    of_folds: set[int] = field(default_factory=set)
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

    def fold(self, kernel_fold: Fold[Any], **how: Any) -> None:
        first = self.uses
        super().fold(kernel_fold, **how)
        self.of_folds |= set(range(first, self.uses))

    def show(self, goal: Any, text: str = "the claim") -> None:
        self.asked += 1
        if not truth(goal):
            self.false.add(self.asked)

    def cases(self, *conditions: Any, goal: Any, text: str = "the claim") -> None:
        self.show(goal, text)


def _others(value: Any, seed: str) -> Iterator[Any]:
    """Other values of the same type; of a record, one field at a time."""
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
