"""Whether a theorem's goals could be false, if a kernel's result were free, at more than a few arguments.

A condition in a goal (`c.implies(x == 3, ...)`) restricts a theorem like a premise, but is not among its premises. So
the claim is stated once more with results that may have any value of their type: where a goal is then false, but not
with other results of definitions too, it relates the kernel to the definition, provided that every goal is true there
with the definition's own value in the kernel's place: else they say something else, such as the negation. Two such
points with neighbouring arguments are required, as `argument_values` requires for premises.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any, get_args, get_origin, get_type_hints

import z3

from cratous.core.kernel import Fold
from cratous.proofs.engine.argument_values import Given, Possible
from cratous.proofs.engine.claim import Claim
from cratous.proofs.engine.lift import join
from cratous.proofs.engine.terms import free_names, fresh, known, leaves, statement
from cratous.proofs.statements.closed_definitions import full_name
from cratous.proofs.statements.other_results import kinds

PARTS = 3000
"""A question with more distinct subterms is not asked."""


@dataclass(repr=False)
class FreeResults(Claim):
    """A claim whose uses of kernels and definitions can each be switched to an arbitrary result."""

    switches: dict[int, z3.BoolRef] = field(default_factory=dict)
    keys: dict[int, Any] = field(default_factory=dict)
    given: dict[int, tuple[Any, ...]] = field(default_factory=dict)
    said: list[tuple[list[z3.BoolRef], list[z3.BoolRef], z3.BoolRef]] = field(default_factory=list)
    free: dict[Any, tuple[z3.BoolRef, Any]] = field(default_factory=dict)
    own: dict[Any, Any] = field(default_factory=dict)
    named: dict[Any, set[str]] = field(default_factory=dict)
    kept: list[Any] = field(default_factory=list)
    number: int = 0

    def _freed(self, what: str, function: Callable[..., Any], args: Any, value: Any) -> Any:
        terms = [known(leaf) for leaf in leaves(args)]
        if not any(map(free_names, terms)):
            return value
        self.kept += terms
        names = set[str]().union(*map(free_names, terms))
        key = (what, function, tuple(term.get_id() for term in terms))
        if key not in self.free:
            name = f"{what}!{full_name(function)}!{len(self.free)}"
            any_value = _any(name, get_type_hints(function)["return"])
            self.named[key] = names
            self.free[key], self.own[key] = (z3.Bool(f"{name}!switch"), any_value), value
        switch, any_value = self.free[key]
        return join([(switch, any_value), (z3.Not(switch), value)])

    def use(self, kernel: Callable[..., Any], *args: Any, when: Any = True) -> Any:
        value = self._freed("kernel", kernel, args, super().use(kernel, *args, when=when))
        key = ("kernel", kernel, tuple(known(leaf).get_id() for leaf in leaves(args)))
        if key in self.free:
            self.switches[self.number], self.keys[self.number] = self.free[key][0], key
        self.given[self.number] = args
        self.number += 1
        return value

    def define(self, definition: Callable[..., Any], *args: Any) -> Any:
        return self._freed("definition", definition, args, super().define(definition, *args))

    def fold(self, kernel_fold: Fold[Any], **how: Any) -> None:
        """No goal is recorded here: only premises restrict it."""
        self.number += 1 if kernel_fold.finish is None else 2

    def step(self, goal: Any, text: str) -> None:
        """Ignored: an intermediate step is not a goal."""

    def show(self, goal: Any, text: str = "the claim") -> None:
        self.said.append((list(self.premises), list(self.facts), statement(goal)))

    def cases(self, *conditions: Any, goal: Any, text: str = "the claim") -> None:
        self.show(goal, text)

    def _owe(self, kind: str, text: str, goal: z3.BoolRef) -> None:
        """The parts of an induction are goals; other obligations are ignored here."""
        if kind in ("base", "step", "use"):
            self.said.append((list(self.premises), list(self.facts), goal))

    def _closed(self, *_: Any) -> None:
        """Ignored, like other obligations."""

    def arguments(self, use: int) -> list[z3.ExprRef]:
        """The arguments of a use as stated, without literals."""
        off = [(switch, z3.BoolVal(False)) for switch, _ in self.free.values()]
        terms = [known(leaf) for leaf in leaves(self.given.get(use, ()))]
        return [z3.simplify(z3.substitute(term, *off)) for term in terms if free_names(term)]

    def excluded(self, use: int, by_definition: str = "", *, further: bool = False) -> z3.BoolRef:
        """Some goal excludes a result of this use; by_definition: because of the result of this definition.

        further: the goals may deny it (see `other_results.Statement`).
        """
        switches = [switch for switch, _ in self.free.values()]
        ours = self.switches[use]
        off = [(s, z3.BoolVal(s.eq(ours))) for s in switches]
        own = self._own(use) if further else set()
        ways = []  # with any value of the definition, or, if it may be denied, with those of further values alone
        for left_out in [own, set()] if further else [set()]:
            meant = [
                (
                    s,
                    z3.BoolVal(
                        s.eq(ours) or (_of(s, by_definition) and s.get_id() not in left_out)
                    ),
                )
                for s in switches
            ]
            found = self._false(ours, off, meant if by_definition else None)
            denies = left_out is own and further
            met = [self._met(use, by_definition)] if by_definition and not denies else []
            ways.append(z3.And(z3.Or(*found), *met))
        return z3.Or(*ways)

    def _false(self, ours: z3.BoolRef, off: list[Any], meant: list[Any] | None) -> list[z3.BoolRef]:
        """Where a goal that depends on the use is false; meant: and is true with other results switched on."""
        found = []
        name = ours.decl().name()
        for premises, facts, goal in self.said:
            if name not in free_names(z3.And(*premises, goal)):
                continue  # the goal does not depend on this use
            here = z3.And(*premises)
            wrong = z3.substitute(z3.And(here, *facts, z3.Not(goal)), *off)
            right = [z3.substitute(z3.Implies(here, goal), *meant)] if meant else []
            found.append(z3.And(wrong, *right))
        return found

    def _own(self, use: int) -> set[int]:
        """Switches of the definitions whose arguments name nothing but what the use's arguments name."""
        given = set[str]().union(*[free_names(known(v)) for v in leaves(self.given[use])])
        alike = {key for key, names in self.named.items() if names <= given}
        return {self.free[key][0].get_id() for key in alike}

    def _met(self, use: int, meant: str) -> z3.BoolRef:
        """Every goal is true with a value of this definition as the result of the use, if one is of its kind."""
        key = self.keys[use]
        ours, any_value = self.free[key]
        off = [(switch, z3.BoolVal(False)) for switch, _ in self.free.values()]
        calls = [k for k in self.own if k[0] == "definition" and full_name(k[1]) == meant]
        free = {k: _terms(self.own[k]) for k in calls}
        calls = [k for k, terms in free.items() if not _within(ours, terms)]
        here = [k for k in calls if k[2] == key[2]]
        if calls and not here and kinds(calls[0][1]) == kinds(key[1]):
            return z3.BoolVal(
                False
            )  # it is meant for the same arguments, at which only runs compute it
        own = [k for k in calls if set(k[2]) <= set(key[2])]
        places, now = _terms(any_value), _terms(self.own[key])
        goals = z3.And(*[z3.Implies(z3.And(*p, *f), goal) for p, f, goal in self.said])
        switched = [(s, z3.BoolVal(s.eq(ours))) for s, _ in off]
        ways = []
        for values in _ways(now, [free[k] for k in here or own or calls]):
            at = [z3.substitute(value, *off) for value in values]
            ways.append(z3.substitute(goals, *switched, *zip(places, at, strict=True)))
        return z3.Or(*ways) if ways else z3.BoolVal(True)


def _of(switch: z3.BoolRef, definition: str) -> bool:
    return str(switch).startswith(f"definition!{definition}!")


def _terms(value: Any) -> list[z3.ExprRef]:
    return [known(leaf) for leaf in leaves(value)]


def _within(switch: z3.BoolRef, terms: list[z3.ExprRef]) -> bool:
    """Whether these terms depend on the result that this switch frees."""
    return any(switch.decl().name() in free_names(term) for term in terms)


def _ways(result: list[z3.ExprRef], values: list[list[z3.ExprRef]]) -> Iterator[list[z3.ExprRef]]:
    """The result with one of these values in its place, or in that of a part of its kind."""
    kinds = [term.sort() for term in result]
    for value in values:
        if kinds == [term.sort() for term in value]:
            yield value
        elif len(value) == 1:
            for k, kind in enumerate(kinds):
                if kind == value[0].sort():
                    yield [*result[:k], value[0], *result[k + 1 :]]


def _is_large(term: z3.ExprRef) -> bool:
    """Whether it has more than PARTS subterms: the solver's effort does not count reading them."""
    seen: set[int] = set()
    todo = [term]
    while todo and len(seen) <= PARTS:
        part = todo.pop()
        if part.get_id() not in seen:
            seen.add(part.get_id())
            todo += part.children()
    return len(seen) > PARTS


def _any(name: str, kind: Any) -> Any:
    if get_origin(kind) is tuple:
        return tuple(_any(f"{name}.{k}", part) for k, part in enumerate(get_args(kind)))
    return fresh(name, kind)


def decides(
    claim: FreeResults, use: int, meant: str, possible: Possible, *, further: bool = False
) -> bool:
    """Whether some goal decides this use's result at more than a few arguments, as far as the solver finds.

    meant: the definition through which it does; empty where that was evaluated at known numbers, which are in the
    goals. further: see `FreeResults.excluded`. False for uses with masks.
    """
    terms = claim.arguments(use)
    if use not in claim.switches or any(map(z3.is_bv, terms)):
        return False
    excluded = claim.excluded(use, meant, further=further)
    numbers = [term for term in terms if not z3.is_bool(term)]
    if _is_large(z3.And(excluded, *[term == term for term in terms])):
        return False
    if numbers and len(Given([excluded], possible).many(numbers)) < len(_different(numbers)):
        return False
    if len(numbers) == len(terms):
        return bool(numbers) or possible([excluded]) == "sat"
    # both values of a truth value count, though a definition may decide nothing at one of them
    truths = [term for term in terms if z3.is_bool(term)]
    plain = Given([claim.excluded(use)], possible)
    decided = bool(numbers) or possible([excluded]) == "sat"
    return decided and len(plain.many(truths)) == len(_different(truths))


def excludes(claim: FreeResults, use: int, meant: str, possible: Possible) -> bool:
    """Whether some goal that mentions a definition is false of another result of this use, as far as the solver finds.

    So the definition is not true of any result there.
    """
    if use not in claim.switches:
        return False
    ours = claim.switches[use]
    off = [(s, z3.BoolVal(s.eq(ours))) for s, _ in claim.free.values()]
    for premises, facts, goal in claim.said:
        names = free_names(goal)
        told = any(name.startswith(f"definition!{meant}!") for name in names)
        if told and ours.decl().name() in names:
            wrong = [z3.substitute(term, *off) for term in (*premises, *facts, z3.Not(goal))]
            if possible(wrong) == "sat":
                return True
    return False


def _different(terms: list[z3.ExprRef]) -> set[int]:
    return {term.get_id() for term in terms}
