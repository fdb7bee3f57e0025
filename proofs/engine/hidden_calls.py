"""What a lemma shows where it is used, held against what it shows where it meets no calls.

Its user may have called a function that neither looks into more or less often than the lemma does by itself.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol

import z3


class Shown(Protocol):
    """What a lemma gives its user."""

    goals: list[z3.BoolRef]
    premises: list[z3.BoolRef]


def alike(one: Sequence[z3.ExprRef], other: Sequence[z3.ExprRef]) -> bool:
    """The same terms in the same order."""
    return len(one) == len(other) and all(a.eq(b) for a, b in zip(one, other, strict=True))


def same(one: Shown, other: Shown) -> bool:
    """The same goals under the same premises."""
    return alike(one.goals, other.goals) and alike(one.premises, other.premises)


def show_nothing_else(name: str, lemma: Shown, blind: Callable[[], Shown]) -> None:
    """Refuse a lemma that shows something else without calls; ValueError. blind: reads it without them."""
    try:
        without = blind()
    except (ValueError, TypeError, IndexError):
        return  # it takes them for granted, which `lemma_calls` tells of the lemma itself
    if not same(lemma, without):
        raise ValueError(f"{name} is no lemma: what it shows hangs on the calls that it meets")
