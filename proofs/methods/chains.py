"""Induction over a closed chain of edges, for folds whose items share their vertices.

`Claim.fold` does not know how items are connected. Here the items are the edges of a chain: each begins where the
previous one ended, and the last ends where the first began. The induction is over their number, and the invariant may
refer to the chain's first and current vertex. Base: no edge yet, both are the same vertex. Step: one more edge from
the current vertex to any other. Use: back at the first vertex, the goal follows.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from cratous.core.kernel import Fold, qualified
from cratous.proofs.claim import Claim
from cratous.proofs.engine.induction import arbitrary, no_more_premises
from cratous.proofs.engine.lift import REPLACED
from cratous.proofs.engine.terms import statement
from cratous.proofs.running import inductions
from cratous.proofs.running.statement import OnNumbers

Run = tuple[Fold[Any], Any, tuple[Any, ...]]
"""A fold, an arbitrary accumulator of it, and its context."""


def closed_chain(
    c: Claim,
    runs: Sequence[Run],
    *,
    invariant: Callable[[list[Any], Any, Any], Any],
    edge: Callable[[Any, Any], None],
    goal: Callable[[list[Any]], Any],
    text: str,
    models: Sequence[Run] = (),
    begin: Callable[[Any], None] = lambda first: None,
) -> None:
    """Show `goal(results)` of folds that run over the edges of one closed chain, of any length.

    invariant(accumulators, first, last): holds after any number of edges; edge(a, b): uses lemmas and premises on one
    more edge, which do not refer to accumulators; begin(first): premises on the first vertex; goal(results): the goal
    for the folds' results. models: folds over definitions that run along; their accumulators and results come after
    the others.
    """
    if c.prefix:
        return  # used as a lemma, an induction has no goals to offer, as with `Claim.fold`
    if isinstance(c, OnNumbers):
        both = (*runs, *models)
        inductions.closed_chain(
            c, both, invariant=invariant, edge=edge, goal=goal, text=text, begin=begin
        )
        return
    first, last, to = c.vector("first"), c.vector("last"), c.vector("to")
    folds = [REPLACED.get(fold, fold) for fold, _, _ in (*runs, *models)]
    accumulators = [acc for _, acc, _ in (*runs, *models)]
    contexts = [context for _, _, context in (*runs, *models)]
    readers = [c.use] * len(runs) + [c.define] * len(models)
    arbitrary(c, tuple(accumulators), tuple(contexts))
    for fold in folds[: len(runs)]:
        if qualified(fold) not in c.kernels:
            c.kernels.append(qualified(fold))
    begin(first)
    of_first = list(c.premises)
    starts = [fold.start for fold in folds]
    c._owe("base", f"{text}: a chain without edges", statement(invariant(starts, first, first)))
    # the folds are run only where the invariant holds, so their side conditions are owed there
    before = len(c.facts)
    c._grant(statement(invariant(accumulators, first, last)))
    no_more_premises(c, len(of_first))
    edge(last, to)
    of_edge = list(c.premises)
    after = [
        read(fold.step, acc, last, to, *context)
        for read, fold, acc, context in zip(readers, folds, accumulators, contexts, strict=True)
    ]
    c._owe("step", f"{text}: one more edge", statement(invariant(after, first, to)))
    # after the last edge there is no further one, so no premise on an edge may be used
    no_more_premises(c, len(of_edge))
    c.premises, c.facts = list(of_first), c.facts[:before]
    c._grant(statement(invariant(accumulators, first, first)))
    results = [
        acc if fold.finish is None else read(fold.finish, acc)
        for read, fold, acc in zip(readers, folds, accumulators, strict=True)
    ]
    c._owe("use", f"{text}: the chain is closed", statement(goal(results)))
    no_more_premises(c, len(of_first))
    c.premises, c.facts, c.granted = of_edge, c.facts[:before], ()
    # begin and edge may restrict only vertices
    arbitrary(c, tuple(accumulators), tuple(contexts))
