"""Induction over several folds that run over the same items at once, with any goal on their results.

`Claim.fold` shows that two results are equal. Here an invariant of the accumulators of several folds, of kernels and
of definitions, is carried along the items, and the goal need not be an equation. Base: no item yet. Step: any further
item that satisfies `Items.each`. Use: the goal on the results.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, TypedDict, Unpack

from cratous.core.kernel import Fold, qualified
from cratous.proofs.claim import Claim
from cratous.proofs.engine.induction import all_given, arbitrary, names_in, no_more_premises, spread
from cratous.proofs.engine.lift import REPLACED
from cratous.proofs.engine.terms import free_names, statement
from cratous.proofs.running import inductions
from cratous.proofs.running.statement import OnNumbers

Run = tuple[Fold[Any], Any, tuple[Any, ...]]
"""A fold, an arbitrary accumulator of it, and its context."""


class Beside(NamedTuple):
    """A state that no fold keeps: the result of steps of several kernels together, or the true situation.

    start: before the first item; state: an arbitrary one; step(accumulators): the state after one more item, from all
    accumulators before it.
    """

    start: Any
    state: Any
    step: Callable[[list[Any]], Any]


class Items(NamedTuple):
    """The arbitrary values of one item; each: condition on every item; more: values that are passed to no fold, only
    to the steps of `Beside`."""

    values: tuple[Any, ...]
    each: Any = True
    more: tuple[Any, ...] = ()


class Others(TypedDict, total=False):
    """What runs along the items beside the kernels' folds.

    models: folds of definitions, whose accumulators come after the kernels'; beside: states that come after these.
    """

    models: Sequence[Run]
    beside: Sequence[Beside]


def along_items(
    c: Claim,
    runs: Sequence[Run],
    *,
    item: Items,
    invariant: Callable[[list[Any]], Any],
    goal: Callable[[list[Any]], Any],
    text: str,
    known: Callable[[list[Any]], None] = lambda accumulators: None,
    **others: Unpack[Others],
) -> None:
    """Show `goal(results)` of folds over the same items, of any number.

    invariant(accumulators): holds after any number of items; known(accumulators): uses lemmas on one more item, from
    the accumulators before it, and states no premises; others: what runs along beside the kernels' folds (see
    `Others`).
    """
    if c.prefix:
        return  # used as a lemma, an induction has no goals to offer, as with `Claim.fold`
    all_given(others, Others)
    models, beside = others.get("models", ()), others.get("beside", ())
    values, each, *more = item
    if isinstance(c, OnNumbers):
        both = (*runs, *models)
        inductions.along_items(
            c, both, item=(values, each), invariant=invariant, goal=goal, text=text, known=known,
            beside=beside,
        )  # fmt: skip
        return
    folds = [REPLACED.get(fold, fold) for fold, _, _ in (*runs, *models)]
    accumulators = [acc for _, acc, _ in (*runs, *models)] + [one.state for one in beside]
    contexts = [context for _, _, context in (*runs, *models)]
    readers = [c.use] * len(runs) + [c.define] * len(models)
    arbitrary(c, tuple(accumulators), (values, tuple(contexts), each, *more))
    own = spread(names_in((values, *more)), c)
    # base and use must hold without any item, so no premise on one may be used
    if shared := sorted(own & names_in(tuple(contexts))):
        raise ValueError(f"the context depends on the item's {shared[0]}: it is the same for each")
    if shared := sorted(own & set().union(*map(free_names, c.premises))):
        raise ValueError(f"a premise restricts the item's {shared[0]}: put it into `each`")
    for fold in folds[: len(runs)]:
        if qualified(fold) not in c.kernels:
            c.kernels.append(qualified(fold))
    starts = [fold.start for fold in folds] + [one.start for one in beside]
    before = len(c.facts)
    held, base = statement(invariant(accumulators)), statement(invariant(starts))
    for term in (held, base):
        shared = sorted(free_names(term) & own)
        if shared:
            raise ValueError(
                f"the invariant depends on the item's {shared[0]}: it holds after each"
            )
    c._owe("base", f"{text}: no items", base)
    # the folds are run only where the invariant holds, so their side conditions are owed there
    of_any = list(c.premises)
    if each is not True:
        c.premise(each)
    of_item = list(c.premises)
    c._grant(held)
    known(accumulators)
    kept = accumulators[: len(folds)]
    after = [
        read(fold.step, acc, *values, *context)
        for read, fold, acc, context in zip(readers, folds, kept, contexts, strict=True)
    ] + [one.step(accumulators) for one in beside]
    c._owe("step", f"{text}: one more item", statement(invariant(after)))
    no_more_premises(c, len(of_item))
    c.premises, c.facts = list(of_any), c.facts[:before]
    c._grant(held)
    results = [
        acc if fold.finish is None else read(fold.finish, acc)
        for read, fold, acc in zip(readers, folds, kept, strict=True)
    ] + accumulators[len(folds) :]
    wanted = statement(goal(results))
    shared = sorted(free_names(wanted) & spread(own, c))
    if shared:
        raise ValueError(f"the goal depends on the item's {shared[0]}: there may be none")
    c._owe("use", f"{text}: no more items", wanted)
    no_more_premises(c, len(of_any))
    c.premises, c.facts, c.granted = of_item, c.facts[:before], ()
