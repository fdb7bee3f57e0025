"""Shows that folds over any number of items equal the folds of their definitions."""

from __future__ import annotations

from typing import Any

from cratous.proofs.claim import Claim
from cratous.spec.geofence import Parts, place_of


def verdict_is_defined(
    c: Claim, kernel: Any, item: tuple[Any, ...], context: tuple[Any, ...], model_step: Any,
    *, start: bool,
) -> None:  # fmt: skip
    """A fold to a verdict equals that of its definition's step, for any number of items."""
    c.fold(
        kernel,
        acc=c.boolean("verdict"),
        model=c.boolean("defined"),
        item=item,
        context=context,
        model_start=start,
        model_step=model_step,
        relation=c.same,
    )


def places_are_combined(c: Claim, kernel: Any, model_step: Any, *, start: bool) -> None:
    """A fold over places gives the place in the combination, by the step, of open and of closed parts."""
    place = c.integer("place")
    c.premise(c.any_of(place == -1, place == 0, place == 1))

    def related(found: Any, parts: Any) -> Any:
        word = c.when(parts.open, 1, c.when(parts.closed, 0, -1))
        return c.all_of(c.same(found, word), c.implies(parts.open, parts.closed))

    c.fold(
        kernel,
        acc=c.whole("found"),
        model=Parts(c.boolean("open"), c.boolean("closed")),
        item=(place,),
        context=(),
        model_start=Parts(start, start),
        model_step=model_step,
        model_finish=place_of,
        relation=related,
    )
