"""Which arguments of kernels change when a theorem's values are changed slightly, and so take many values.

A statement is run twice, with its reals at one place and at a minute offset from it; all other drawn values are the
same. If the premises hold at both and an argument differs, the argument is not a piecewise constant function of the
values, unless it happens to jump between the two places; these are derived from a hash of the whole statement, so an
author cannot aim at them. The solver is not used.
"""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from hashlib import sha256
from pathlib import Path
from typing import Any, Unpack

import z3

from cratous.core.kernel import Fold
from cratous.proofs.engine.argument_values import Place, Taken, enough
from cratous.proofs.engine.claim import Claim
from cratous.proofs.engine.induction import DefinedBy
from cratous.proofs.engine.terms import leaves
from cratous.proofs.engine.theorem_files import load_claim
from cratous.proofs.running.copies import Undecided
from cratous.proofs.running.late_values import Open, made_true, now
from cratous.proofs.running.statement import (
    ERRORS,
    False_,
    NotRun,
    OnNumbers,
    Outside,
    Values,
    truth,
)

TRIES = 40
"""The most places tried while not all arguments have been found to change."""
PLACE_BITS, HAIR_BITS = 128, 64
COARSE, FINE = 140, 400
"""A place is on a grid of 2**-COARSE; the offset is at most 2**(HAIR_BITS - FINE)."""
STOPS = (Outside, Undecided, False_, NotRun, TypeError, AttributeError, *ERRORS)
"""Exceptions that end the run of a statement; arguments observed before count if all premises held."""


def taken(name: str, claim: Claim, folder: Path) -> Taken | None:
    """A function that finds which arguments of a theorem's kernel uses take many values; claim: the stated claim.

    None for a theorem that calls `Claim.calls`: these may enter its premises, which a run would not see.
    """
    if claim.asked:
        return None
    return functools.partial(_found, load_claim(name, folder)[0], len(claim.premises))


def _found(
    statement: Callable[[Any], None], premises: int, seed: str, asked: Mapping[Place, z3.ExprRef]
) -> set[Place]:
    values: dict[Place, set[Any]] = {place: set() for place in asked}
    many: set[Place] = set()
    for number in range(TRIES):
        here = _arguments(statement, premises, _Nudged(f"{seed} {number}", 0))
        beside = _arguments(statement, premises, _Nudged(f"{seed} {number}", 1)) if here else {}
        for place in asked.keys() & here.keys() - many:
            values[place].add(here[place])
            moved = place in beside and here[place] != beside[place]
            if moved if z3.is_real(asked[place]) else enough(asked[place], values[place]):
                many.add(place)
        if len(many) == len(asked):
            break
    return many


def _arguments(statement: Callable[[Any], None], premises: int, values: Values) -> dict[Place, Any]:
    """The arguments of the kernel uses if all premises hold; otherwise empty."""
    on = _Observed(values, _no_lemma)
    with contextlib.suppress(*STOPS):
        statement(on)
    return on.arguments if on.premises == premises else {}


def _no_lemma(name: str) -> Callable[[Any], None]:
    raise NotRun(name)


class _Nudged(Values):
    """Pseudo-random numbers determined by the seed: at one place, or at a minute offset from it."""

    def __init__(self, seed: str, hairs: int) -> None:
        super().__init__({}, seed)
        self.seed, self.hairs = seed, hairs

    def real(self, name: str) -> Fraction:
        said = int(sha256(f"{self.seed} {name}".encode()).hexdigest(), 16)
        rest, place = divmod(said, 2**PLACE_BITS)
        hair = self.hairs * (1 + rest % 2**HAIR_BITS)
        return super().real(name) + Fraction(place, 2**COARSE) + Fraction(hair, 2**FINE)


@dataclass
class _Observed(OnNumbers):
    """A run of a statement that records its premises and the arguments of its kernels; goals are ignored."""

    arguments: dict[Place, Any] = field(default_factory=dict)
    premises: int = 0
    uses: int = 0

    def premise(self, condition: Any) -> None:
        super().premise(condition)
        self.premises += 1

    def assume(self, condition: Any, *, owner: str, reason: str) -> None:
        if not (made_true(condition) if isinstance(condition, Open) else truth(condition)):
            raise Outside

    def use(self, kernel: Callable[..., Any], *args: Any, when: Any = True) -> Any:
        self._observe(args)
        return super().use(kernel, *args, when=when)

    def _observe(self, args: tuple[Any, ...]) -> None:
        found = leaves(now(args))
        self.arguments |= {(self.uses, position): leaf for position, leaf in enumerate(found)}
        self.uses += 1

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
        self._observe((acc, *item, *context))
        if kernel_fold.finish is not None:
            self._observe((acc,))

    def show(self, goal: Any, text: str = "the claim") -> None:
        """Ignored: goals are checked by another run."""

    def cases(self, *conditions: Any, goal: Any, text: str = "the claim") -> None:
        """Ignored, as in `show`."""

    def lemma(self, name: str, *, when: Any = True, **values: Any) -> None:
        """Ignored: a lemma restricts nothing."""


# `proofs.statements.other_results` uses these too
Nudged = _Nudged
Observed = _Observed
no_lemma = _no_lemma
