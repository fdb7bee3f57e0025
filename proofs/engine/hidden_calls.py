"""Compares what a lemma shows where it is used with what it shows where it meets no calls.

Its user may have called a function that neither looks into more or less often than the lemma does by itself.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol

import z3


class Shown(Protocol):
    """What a lemma gives its user: premises and goals."""

    goals: list[z3.BoolRef]
    premises: list[z3.BoolRef]


def alike(one: Sequence[z3.ExprRef], other: Sequence[z3.ExprRef]) -> bool:
    """Whether both have the same terms in the same order."""
    return len(one) == len(other) and all(a.eq(b) for a, b in zip(one, other, strict=True))


def same(one: Shown, other: Shown) -> bool:
    """Whether both state the same goals under the same premises."""
    return alike(one.goals, other.goals) and alike(one.premises, other.premises)


def show_nothing_else(name: str, lemma: Shown, blind: Callable[[], Shown]) -> None:
    """Raise ValueError for a lemma that states something else without calls. blind: states it without them."""
    try:
        without = blind()
    except (ValueError, TypeError, IndexError):
        return  # it fails without calls, which `lemma_calls` reports of the lemma itself
    if not same(lemma, without):
        raise ValueError(f"{name} is no lemma: what it shows hangs on the calls that it meets")
