"""Induction on a term of the process algebra: a task, or an operator over one or more operands.

The rule. Let a kernel give every term a value and a definition give it a meaning: a task its own, an operator the
result of combining its operands one after the other. If value and meaning of any task are related (task); if those of
no operand yet are (none); if one more operand preserves that, for any operand whose own value and meaning are related
(operand); and if value and meaning of the whole are related wherever those of its operands are (whole), then they are
related for every term: by induction on the number of its nodes, and for each operator on the number of its operands.
All else about an operator (its code, its timing, when its operands ran) is arbitrary, and may differ at each node.

This needs that the relation is the same at every node, that the values of operands are arbitrary but for the
relation, that nothing about a task uses premises about operators or the reverse, and that the definition's side
depends on meanings alone, never on a kernel's value.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Unpack

import z3

from cratous.proofs.claim import Claim
from cratous.proofs.engine.induction import all_given, arbitrary, names_in, no_more_premises, spread
from cratous.proofs.engine.terms import free_names, statement
from cratous.proofs.running import inductions
from cratous.proofs.running.inductions import Sides
from cratous.proofs.running.statement import OnNumbers


def every_term(
    c: Claim,
    *,
    related: Callable[[Any, Any], Any],
    alike: Callable[[Any, Any], Any],
    node: tuple[Any, ...],
    text: str,
    **sides: Unpack[Sides],
) -> None:
    """Show that value and meaning of every term are related.

    related(value, meaning): of a term; alike(value, meaning): of its operands so far; node: the other parts of a
    node, arbitrary values that differ at each node; sides: how values are computed, each a pair of the kernel's side
    and the definition's (see `Sides`).
    """
    if c.prefix:
        return  # used as a lemma, an induction has no goals to offer, as with `Claim.fold`
    all_given(sides, Sides)
    if isinstance(c, OnNumbers):
        inductions.every_term(c, sides, related=related, alike=alike, text=text)
        return
    task, none, add, whole = sides["task"], sides["none"], sides["add"], sides["whole"]
    so_far, operand = sides["so_far"], sides["operand"]
    arbitrary(c, (so_far, operand), node)
    premises = list(c.premises)
    of_task, of_node = spread(names_in(task), c), spread(names_in(node), c)
    with _without(c, of_node):
        c._owe("base", f"{text}: a task", statement(related(*task)))
    before = statement(alike(*so_far))
    one = statement(related(*operand))
    for term in (before, one):
        if shared := sorted(free_names(term) & of_node):
            raise ValueError(
                f"the relation depends on {shared[0]} of one node: it has to hold at every node"
            )
    of_kernel = spread(names_in((so_far[0], operand[0])), c)
    of_operands = of_kernel | spread(names_in((so_far[1], operand[1])), c)
    for what, values in (("a task", task), ("no operand", none)):
        _apart(f"the value or meaning of {what}", values, of_operands)
    with _without(c, of_task):
        c._owe("base", f"{text}: no operand yet", statement(alike(*none)))
        # the steps are run only where the relations hold, so their side conditions are owed there
        kept = len(c.facts)
        c._grant(z3.And(before, one))
        after, meant = add[0](so_far[0], operand[0]), add[1](so_far[1], operand[1])
        c._owe("step", f"{text}: one operand more", statement(alike(after, meant)))
        c.facts = c.facts[:kept]
        c._grant(before)
        value, meaning = whole[0](so_far[0]), whole[1](so_far[1])
        c._owe("use", f"{text}: the whole term", statement(related(value, meaning)))
        c.facts, c.granted = c.facts[:kept], ()
    for what, result in (("with an operand more", meant), ("of the whole", meaning)):
        _apart(f"the meaning {what}", result, of_kernel)
    no_more_premises(c, len(premises))


@contextmanager
def _without(c: Claim, names: set[str]) -> Iterator[None]:
    """Obligations stated within are owed without the premises on these values: there may be none."""
    premises, facts = c.premises, c.facts
    c.premises = [p for p in premises if not free_names(p) & names]
    # what was shown before may depend on the premises that are left out
    c.facts = [*c.roots, *c.congruences]
    kept = len(c.facts)
    try:
        yield
    finally:
        c.premises, c.facts = premises, [*facts, *c.facts[kept:]]


def _apart(what: str, value: Any, others: set[str]) -> None:
    shared = sorted(names_in(value) & others)
    if shared:
        raise ValueError(f"{what} depends on {shared[0]}")
