"""A theorem's statement run as Python on numbers: premises, kernels, definitions and goals.

The theorem's own function is run with another object in place of its claim. Numbers replace its arbitrary values,
kernels and definitions are run by CPython on rationals, and where the premises hold each goal, each premise of a
lemma and each step of an induction must be true. Neither solver nor lifter is used, so a fault of either shows.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, Unpack, get_type_hints

from cratous.core.kernel import Fold, Vec2, qualified
from cratous.proofs.engine.induction import DefinedBy, side_of
from cratous.proofs.running.copies import Undecided, rational_root, with_root
from cratous.proofs.running.late_values import All, Cell, Late, Open, made_true, now

Point = Mapping[str, Any]
ERRORS = (ZeroDivisionError, ValueError, OverflowError)
WHOLE = 2**61
ROWS = 6
"""The most arguments of a function that are passed on to the comparison of its readings."""


class Outside(Exception):
    """The numbers do not satisfy the premises."""


class NotRun(Exception):
    """The statement cannot be run on numbers: it uses operations that only terms have."""


class False_(Exception):
    """A goal, or another obligation, is false."""


class Values:
    """Numbers for the arbitrary values of a claim: from a point, or else drawn."""

    def __init__(self, point: Point, seed: str) -> None:
        self.point, self.rng = point, random.Random(seed)
        self.reach = self.rng.choice((1, 1, 2, 3, 8))
        self.special = self.rng.random() < 0.3

    def real(self, name: str) -> Fraction:
        if name in self.point:
            return Fraction(self.point[name])
        if self.special and self.rng.random() < 0.2:
            return Fraction(self.rng.choice(SPECIAL))
        below = -self.reach if self.rng.random() < 0.5 else 0
        return Fraction(self.rng.randint(2 * below, 2 * self.reach), self.rng.choice((1, 1, 2)))

    def whole(self, name: str) -> int:
        if name in self.point:
            return int(self.point[name])
        if self.special and self.rng.random() < 0.2:
            return self.rng.choice((2**53 - 1, 2**53, 2**53 + 1, WHOLE, -WHOLE))
        return self.rng.randint(-self.reach, self.reach + 3)

    def boolean(self, name: str) -> bool:
        return bool(self.point[name]) if name in self.point else self.rng.random() < 0.5

    def mask(self, name: str) -> int:
        if name in self.point:
            return int(self.point[name])
        return self.rng.choice((0, 1, 2, 3, self.rng.getrandbits(3), self.rng.getrandbits(64)))


SPECIAL = (0, 1, -1, 2**53 - 1, 2**53, 2**53 + 1, Fraction(1, 2**1074), Fraction(-1, 2**1074))


@dataclass
class OnNumbers:
    """In place of a `Claim` while its theorem is run; methods correspond to those of `Claim`."""

    values: Values
    load: Callable[[str], Callable[[Any], None]]
    prefix: str = ""
    fixed: dict[str, Any] = field(default_factory=dict)
    called: dict[tuple[str, str], list[tuple[Any, ...]]] = field(default_factory=dict)
    shown: dict[str, Any] = field(default_factory=dict)
    lemmas: dict[str, int] = field(default_factory=dict)
    goals: int = 0

    def _value(self, name: str, draw: Callable[[str], Any]) -> Any:
        found = self.fixed[name] if name in self.fixed else draw(self.prefix + name)
        self.shown[self.prefix + name] = found
        return found

    def real(self, name: str) -> Any:
        return self._value(name, lambda full: Late(Cell(lambda: self.values.real(full))))

    def reals(self, names: str) -> list[Any]:
        return [self.real(name) for name in names.split()]

    def integer(self, name: str) -> Any:
        value = self._value(name, self.values.whole)
        self.premise(-WHOLE <= value <= WHOLE)
        return value

    def whole(self, name: str) -> Any:
        return self._value(name, self.values.whole)

    def boolean(self, name: str) -> Any:
        return self._value(name, self.values.boolean)

    def mask(self, name: str) -> Any:
        return self._value(name, self.values.mask)

    def bits(self, value: int) -> Any:
        return value

    def vector(self, name: str) -> Vec2:
        return Vec2(*self.reals(f"{name}.x {name}.y"))

    def premise(self, condition: Any) -> None:
        if not (made_true(condition) if isinstance(condition, Open) else truth(condition)):
            raise Outside

    def assume(self, condition: Any, *, owner: str, reason: str) -> None:
        self.premise(condition)

    # -- functions -----------------------------------------------------------------------------
    def use(self, kernel: Callable[..., Any], *args: Any, when: Any = True) -> Any:
        if truth(when):
            return self._run(kernel, args)
        try:
            return self._run(kernel, args)
        except False_:
            raise Undecided("it is not defined where its value does not count") from None

    def define(self, definition: Callable[..., Any], *args: Any) -> Any:
        return self._run(definition, args)

    def _run(self, function: Callable[..., Any], args: tuple[Any, ...]) -> Any:
        given = _of_kinds(function, now(args))
        seen = self.called.setdefault((function.__module__, function.__qualname__), [])
        if len(seen) < ROWS and given not in seen:
            seen.append(given)
        try:
            return with_root(function, rational_root)(*given)
        except ERRORS as error:
            raise False_(f"{qualified(function)} is not defined there: {error}") from error

    def opaque(self, *functions: Callable[..., Any]) -> None:
        """No effect: a running function is not opaque."""

    def calls(self, function: Callable[..., Any]) -> Iterable[tuple[Any, ...]]:
        """Empty: calls on all paths are known for terms only. Statements about each call are not run."""
        return iter(())

    def congruence(
        self, function: Callable[..., Any], one: tuple[Any, ...], other: tuple[Any, ...]
    ) -> None:
        """No effect: running functions satisfy it."""

    def fold(
        self,
        kernel_fold: Fold[Any],
        *,
        acc: Any,
        model: Any,
        item: tuple[Any, ...],
        context: tuple[Any, ...],
        relation: Callable[[Any, Any], Any],
        **definition: Unpack[DefinedBy],
    ) -> None:
        if self.prefix:
            return
        model_start, model_step, model_finish = side_of(definition)

        def finished(finish: Callable[..., Any] | None, value: Any) -> Any:
            return value if finish is None else self._run(finish, (value,))

        self.show(relation(kernel_fold.start, model_start), "relation at the start")
        if truth(relation(acc, model)):
            after = self._run(kernel_fold.step, (acc, *item, *context))
            modelled = self._run(model_step, (model, *item, *context))
            self.show(relation(after, modelled), "relation is kept")
            results = finished(kernel_fold.finish, acc), finished(model_finish, model)
            self.show(self.same(*results), "results are equal")
        ours, theirs = kernel_fold.start, model_start
        for count in (0, 1, 2, 3):
            results = finished(kernel_fold.finish, ours), finished(model_finish, theirs)
            self.show(self.same(*results), f"the fold of {count} items is its definition")
            ours = self._run(kernel_fold.step, (ours, *item, *context))
            theirs = self._run(model_step, (theirs, *item, *context))

    # -- what is to be shown ---------------------------------------------------------------------
    def show(self, goal: Any, text: str = "the claim") -> None:
        if not truth(goal):
            raise False_(f"{text!r} is false there")
        self.goals += 1

    def step(self, goal: Any, text: str) -> None:
        self.show(goal, text)

    def cases(self, *conditions: Any, goal: Any, text: str = "the claim") -> None:
        self.show(any(map(truth, conditions)), f"{text}: the cases cover everything")
        self.show(goal, text)

    def lemma(self, name: str, *, when: Any = True, **values: Any) -> None:
        number = self.lemmas[name] = self.lemmas.get(name, -1) + 1
        if not truth(when):
            return
        inner = OnNumbers(
            self.values, self.load, f"{self.prefix}{name}!{number}!", _flat(values), self.called
        )
        try:
            self.load(name)(inner)
        except Outside:
            if set(inner.fixed) >= {n.removeprefix(inner.prefix) for n in inner.shown}:
                raise False_(f"a premise of the lemma {name} is false there") from None
            raise Undecided("a value that the lemma has of its own does not fit") from None

    # -- statements ------------------------------------------------------------------------------
    def implies(self, if_: Any, then: Any) -> Any:
        return then if truth(if_) else True

    def all_of(self, *conditions: Any) -> Any:
        # a premise makes each of them true in turn
        return All(tuple(c if isinstance(c, Open) else truth(c) for c in conditions))

    def any_of(self, *conditions: Any) -> Any:
        return any(list(map(truth, conditions)))

    def negation(self, condition: Any) -> Any:
        return not truth(condition)

    def when(self, condition: Any, yes: Any, no: Any) -> Any:
        return yes if truth(condition) else no

    def same(self, a: Any, b: Any) -> Any:
        if isinstance(a, tuple) or isinstance(b, tuple):
            return len(a) == len(b) and all(self.same(x, y) for x, y in zip(a, b, strict=True))
        return _decided(a) == _decided(b)


def truth(value: Any) -> bool:
    """The truth value of a statement that is run; raises NotRun for any other value."""
    if isinstance(value, Open):
        return bool(value)
    if not isinstance(value, bool):
        raise NotRun(f"{value!r} is taken for a statement")
    return value


def _decided(value: Any) -> Any:
    if isinstance(value, float):
        raise Undecided("a double came up")
    return bool(value) if isinstance(value, Open) else value


def _flat(values: dict[str, Any]) -> dict[str, Any]:
    flat: dict[str, Any] = {}
    for name, value in zip(values, now(tuple(values.values())), strict=True):
        if isinstance(value, Vec2):
            flat[name + ".x"], flat[name + ".y"] = value.x, value.y
        else:
            flat[name] = value
    return flat


def _of_kinds(function: Callable[..., Any], args: Iterable[Any]) -> tuple[Any, ...]:
    """Arguments converted to the function's types: an integer for a real becomes a fraction."""
    try:
        kinds = [kind for name, kind in get_type_hints(function).items() if name != "return"]
    except (NameError, TypeError):
        return tuple(args)
    given = tuple(args)
    return tuple(map(_of_kind, given, kinds)) if len(kinds) == len(given) else given


def _of_kind(value: Any, kind: Any) -> Any:
    if isinstance(value, float):
        raise Undecided("a double came up")
    if isinstance(value, tuple) and hasattr(kind, "_fields"):
        return type(value)(*map(_of_kind, value, get_type_hints(kind).values()))
    whole = isinstance(value, int) and not isinstance(value, bool)
    return Fraction(value) if kind is float and whole else value
