"""Whether a theorem's goals could be false, were a kernel's result free, at more than a few arguments.

A condition in a goal (`c.implies(x == 3, ...)`) restricts a theorem as a premise does, and no premise tells. So the
claim is stated once more with results that may be any value of their type: where a goal is false then, and is not
with other results of definitions too, it holds the kernel against the definition. Two such places are asked for at
which an argument differs by next to nothing, as `argument_values` asks of premises.
"""

from __future__ import annotations

from collections.abc import Callable, Container
from dataclasses import dataclass, field
from typing import Any, get_args, get_origin, get_type_hints

import z3

from cratous.core.kernel import Fold
from cratous.proofs.engine.argument_values import Given, Possible, Uses
from cratous.proofs.engine.claim import Claim
from cratous.proofs.engine.lift import join
from cratous.proofs.engine.terms import free_names, fresh, known, leaves, statement

PARTS = 3000
"""A question with more parts than these is not asked."""


@dataclass(repr=False)
class FreeResults(Claim):
    """A claim whose uses of kernels, and of definitions, may each be switched to any result."""

    switches: dict[int, z3.BoolRef] = field(default_factory=dict)
    of_folds: set[int] = field(default_factory=set)
    said: list[tuple[list[z3.BoolRef], list[z3.BoolRef], z3.BoolRef]] = field(default_factory=list)
    free: dict[Any, tuple[z3.BoolRef, Any]] = field(default_factory=dict)
    kept: list[Any] = field(default_factory=list)
    number: int = 0

    def _freed(self, what: str, function: Callable[..., Any], args: Any, value: Any) -> Any:
        terms = [known(leaf) for leaf in leaves(args)]
        if not any(map(free_names, terms)):
            return value
        self.kept += terms
        key = (what, function, tuple(term.get_id() for term in terms))
        if key not in self.free:
            name = f"{what}!{len(self.free)}"
            any_value = _any(name, get_type_hints(function)["return"])
            self.free[key] = z3.Bool(f"{name}!switch"), any_value
        switch, any_value = self.free[key]
        return join([(switch, any_value), (z3.Not(switch), value)])

    def use(self, kernel: Callable[..., Any], *args: Any, when: Any = True) -> Any:
        value = self._freed("kernel", kernel, args, super().use(kernel, *args, when=when))
        key = ("kernel", kernel, tuple(known(leaf).get_id() for leaf in leaves(args)))
        if key in self.free:
            self.switches[self.number] = self.free[key][0]
        self.number += 1
        return value

    def define(self, definition: Callable[..., Any], *args: Any) -> Any:
        return self._freed("definition", definition, args, super().define(definition, *args))

    def fold(self, kernel_fold: Fold[Any], **how: Any) -> None:
        """It has no condition but its premises."""
        uses = 1 if kernel_fold.finish is None else 2
        self.of_folds |= set(range(self.number, self.number + uses))
        self.number += uses

    def step(self, goal: Any, text: str) -> None:
        """It helps to prove the goals."""

    def show(self, goal: Any, text: str = "the claim") -> None:
        self.said.append((list(self.premises), list(self.facts), statement(goal)))

    def cases(self, *conditions: Any, goal: Any, text: str = "the claim") -> None:
        self.show(goal, text)

    def _owe(self, kind: str, text: str, goal: z3.BoolRef) -> None:
        """A part of an induction is a goal; what functions and lemmas owe is another reading's matter."""
        if kind in ("base", "step", "use"):
            self.said.append((list(self.premises), list(self.facts), goal))

    def _closed(self, *_: Any) -> None:
        """As for what is owed."""

    def excluded(self, use: int, *, by_definition: bool) -> z3.BoolRef:
        """Some goal excludes a result of this use; by_definition: because of what a definition says."""
        switches = [switch for switch, _ in self.free.values()]
        ours = self.switches[use]
        off = [(s, z3.BoolVal(s.eq(ours))) for s in switches]
        meant = [(s, z3.BoolVal(s.eq(ours) or str(s).startswith("definition"))) for s in switches]
        found = []
        name = ours.decl().name()
        for premises, facts, goal in self.said:
            if name not in free_names(z3.And(*premises, goal)):
                continue  # it says nothing of this use
            here = z3.And(*premises)
            wrong = z3.substitute(z3.And(here, *facts, z3.Not(goal)), *off)
            right = z3.substitute(z3.Implies(here, goal), *meant)
            found.append(z3.And(wrong, right) if by_definition else wrong)
        return z3.Or(*found)


def _is_large(term: z3.ExprRef) -> bool:
    """It has more parts than the solver is asked about here: it counts none of its effort on reading them."""
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


def settled(
    claim: FreeResults | None, asked: Uses, rows: Container[int], possible: Possible
) -> dict[int, str]:
    """For each of these uses: sat, unsat or unknown.

    claim: None where it cannot be stated so; rows: uses whose definitions are evaluated at known numbers.
    """
    if claim is None:
        return dict.fromkeys(asked, "unknown")
    found = {}
    for use, terms in asked.items():
        if use in claim.of_folds:
            found[use] = "sat"
        elif use in claim.switches:
            found[use] = _of(claim, use, list(terms.values()), (use not in rows, possible))
        else:
            found[use] = "unknown"
    return found


def _of(claim: FreeResults, use: int, terms: list[z3.ExprRef], how: tuple[bool, Possible]) -> str:
    by_definition, possible = how
    terms = [term for term in terms if not z3.is_bv(term)]
    numbers = [term for term in terms if not z3.is_bool(term)]
    excluded = claim.excluded(use, by_definition=by_definition)
    if _is_large(excluded):
        return "unknown"
    answer = Given([excluded], possible).apart(numbers) if numbers else possible([excluded])
    if answer == "sat" and len(numbers) < len(terms):
        # of a truth value both count, though a definition may decide nothing at one of them
        plain = Given([claim.excluded(use, by_definition=False)], possible)
        return plain.apart([term for term in terms if z3.is_bool(term)])
    return answer
