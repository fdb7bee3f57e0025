"""Inductions of a theorem, run on numbers: from arbitrary accumulators, and along actual items.

The methods of `proofs.methods` call these functions where a theorem is run. As everywhere, a point counts only where
the premises of its edges or items hold; the base case is checked at every point.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any, TypedDict

from cratous.core.kernel import Fold
from cratous.proofs.running.statement import OnNumbers, truth

Run = tuple[Fold[Any], Any, tuple[Any, ...]]
LONGEST = 4
"""The greatest number of vertices, items or operands."""


def _at_arbitrary_ones(c: OnNumbers) -> bool:
    """Whether to check the step from arbitrary accumulators here; always at a solver's witness."""
    return bool(c.values.point) or c.values.rng.random() < 0.5


def _stepped(c: OnNumbers, runs: Sequence[Run], values: Sequence[Any], item: Any) -> list[Any]:
    return [
        c.define(fold.step, value, *item, *context)
        for (fold, _, context), value in zip(runs, values, strict=True)
    ]


def _results(c: OnNumbers, runs: Sequence[Run], values: Sequence[Any]) -> list[Any]:
    return [
        value if fold.finish is None else c.define(fold.finish, value)
        for (fold, _, _), value in zip(runs, values, strict=True)
    ]


def closed_chain(
    c: OnNumbers,
    runs: Sequence[Run],
    *,
    invariant: Callable[[list[Any], Any, Any], Any],
    edge: Callable[[Any, Any], None],
    goal: Callable[[list[Any]], Any],
    text: str,
    begin: Callable[[Any], None],
) -> None:
    """`proofs.methods.chains.closed_chain` on numbers: one more edge, or a whole polygon; runs: including
    definitions."""
    first = c.vector("first")
    begin(first)
    values = [fold.start for fold, _, _ in runs]
    c.show(invariant(values, first, first), f"{text}: a chain without edges")
    if _at_arbitrary_ones(c):
        last, to = c.vector("last"), c.vector("to")
        arbitrary = [acc for _, acc, _ in runs]
        if truth(invariant(arbitrary, first, last)):
            edge(last, to)
            after = _stepped(c, runs, arbitrary, (last, to))
            c.show(invariant(after, first, to), f"{text}: one more edge")
        if truth(invariant(arbitrary, first, first)):
            c.show(goal(_results(c, runs, arbitrary)), f"{text}: the chain is closed")
        return
    more = c.values.rng.randint(0, LONGEST - 1)
    vertices = [first, *(c.vector(f"vertex{k}") for k in range(more)), first]
    for k, (last, to) in enumerate(pairwise(vertices)):
        edge(last, to)
        values = _stepped(c, runs, values, (last, to))
        c.show(invariant(values, first, to), f"{text}: after edge {k}")
    c.show(goal(_results(c, runs, values)), f"{text}: the chain of {more + 1} edges")


def along_items(
    c: OnNumbers,
    runs: Sequence[Run],
    *,
    item: tuple[tuple[Any, ...], Any],
    invariant: Callable[[list[Any]], Any],
    goal: Callable[[list[Any]], Any],
    text: str,
    known: Callable[[list[Any]], None],
    beside: Sequence[Any] = (),
) -> None:
    """`proofs.methods.runs.along_items` on numbers: one more item, or LONGEST times the same item.

    item: its values, and the condition on every item.
    """
    own, each = item
    values = [fold.start for fold, _, _ in runs] + [one.start for one in beside]
    arbitrary = [acc for _, acc, _ in runs] + [one.state for one in beside]

    def results(accumulators: list[Any]) -> list[Any]:
        kept = accumulators[: len(runs)]
        return [*_results(c, runs, kept), *accumulators[len(runs) :]]

    c.show(invariant(values), f"{text}: no items")
    count = 1 if _at_arbitrary_ones(c) else LONGEST
    if count == 1 and truth(invariant(arbitrary)):
        c.show(goal(results(arbitrary)), f"{text}: no more items")
        values = arbitrary
    c.premise(each)
    for k in range(count):
        known(values)
        after = _stepped(c, runs, values[: len(runs)], own)
        values = [*after, *(one.step(values) for one in beside)]
        c.show(invariant(values), f"{text}: after {k + 1} more items")
        c.show(goal(results(values)), f"{text}: of {k + 1} more items")


class Sides(TypedDict):
    """How values of terms are computed, on the kernel's side and on the definition's.

    task: value of an arbitrary task; none: value before the first operand; so_far, operand: arbitrary values of the
    operands before and of one operand; add(so_far, operand): value including that operand; whole(so_far): value of
    the term after its last operand.
    """

    task: tuple[Any, Any]
    none: tuple[Any, Any]
    so_far: tuple[Any, Any]
    operand: tuple[Any, Any]
    add: tuple[Callable[[Any, Any], Any], Callable[[Any, Any], Any]]
    whole: tuple[Callable[[Any], Any], Callable[[Any], Any]]


def every_term(
    c: OnNumbers,
    sides: Sides,
    *,
    related: Callable[[Any, Any], Any],
    alike: Callable[[Any, Any], Any],
    text: str,
) -> None:
    """`proofs.methods.terms.every_term` on numbers: one more operand, or one task below two levels of operators."""
    task, none, add, whole = sides["task"], sides["none"], sides["add"], sides["whole"]
    so_far, operand = sides["so_far"], sides["operand"]
    c.show(related(*task), f"{text}: a task")
    c.show(alike(*none), f"{text}: no operand yet")

    def added(before: tuple[Any, Any], one: tuple[Any, Any]) -> tuple[Any, Any]:
        after = add[0](before[0], one[0]), add[1](before[1], one[1])
        c.show(alike(*after), f"{text}: one operand more")
        return after

    def made(before: tuple[Any, Any]) -> tuple[Any, Any]:
        result = whole[0](before[0]), whole[1](before[1])
        c.show(related(*result), f"{text}: the whole term")
        return result

    if _at_arbitrary_ones(c):
        if truth(alike(*so_far)):
            made(so_far)
            if truth(related(*operand)):
                made(added(so_far, operand))
        return
    inner = none
    for _ in range(c.values.rng.randint(1, LONGEST)):
        inner = added(inner, task)
    made(added(added(none, task), made(inner)))
