"""What an induction over the items of a fold may refer to.

The rule. Let the accumulators of kernel and definition be arbitrary, and so the item. If the relation holds between
both starts (base), if one step preserves it for any item that satisfies the premises (step), and if it makes the two
results equal (use), then the results are equal for every list of items that satisfy the premises: by induction on its
length. This needs that the relation is the same after every item, so it does not depend on the item; that the
definition's step and result depend on its own accumulator; that the context is the same for all items; and that base
and use hold for the empty list too, so they must not use the existence of an item that satisfies the premises.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any, Protocol, TypedDict

import z3

from cratous.proofs.engine.terms import Stub, free_names, known, leaves


class Claim(Protocol):
    """What an induction needs of a claim: known facts and obligations, and its opaque functions."""

    premises: list[z3.BoolRef]
    facts: list[z3.BoolRef]
    roots: list[z3.BoolRef]
    congruences: list[z3.BoolRef]
    granted: tuple[z3.BoolRef, ...]
    stubs: dict[Callable[..., Any], Stub]


class _Stepwise(TypedDict):
    model_start: Any
    model_step: Callable[..., Any]


class DefinedBy(_Stepwise, total=False):
    """The definition's side of a fold: its start, its step and its result.

    Without a `model_finish` the result is its accumulator.
    """

    model_finish: Callable[..., Any] | None


def all_given(parts: Mapping[str, Any], kind: type) -> None:
    """Raise TypeError unless the parts are those of a TypedDict, none missing and none unknown."""
    needed: frozenset[str] = kind.__required_keys__  # type: ignore[attr-defined]
    allowed: frozenset[str] = needed | kind.__optional_keys__  # type: ignore[attr-defined]
    if missing := sorted(needed - parts.keys()):
        raise TypeError(f"an induction needs {', '.join(missing)}")
    if strange := sorted(parts.keys() - allowed):
        raise TypeError(f"an induction is not given {', '.join(strange)}")


def side_of(definition: DefinedBy) -> tuple[Any, Callable[..., Any], Callable[..., Any] | None]:
    """Start, step and finish of the definition's side; TypeError for other parts."""
    all_given(definition, DefinedBy)
    return definition["model_start"], definition["model_step"], definition.get("model_finish")


def names_in(value: Any) -> set[str]:
    """The names of the arbitrary values in a value."""
    return set().union(*[free_names(known(leaf)) for leaf in leaves(value)])


def spread(names: set[str], claim: Claim) -> set[str]:
    """These names and all that depend on them: results of opaque functions, and square roots."""
    found = set(names)
    while True:
        more: set[str] = set()
        for stub in claim.stubs.values():
            if not isinstance(stub, Stub):
                continue  # only an outline of the statement, in which nothing is proved
            for args, result in zip(stub.calls, stub.results.values(), strict=True):
                if names_in(args) & found:
                    more |= names_in(result)
        for fact in claim.facts:
            inside = free_names(fact)
            if inside & found:
                more |= {name for name in inside if name.startswith("sqrt!")}
        if more <= found:
            return found
        found |= more


def arbitrary(claim: Claim, accumulators: Any, others: Any) -> None:
    """Raise ValueError for accumulators over which no induction is possible.

    They must be distinct free values, and neither premises nor `others` may depend on them, not even through opaque
    functions.
    """
    own = [known(leaf) for leaf in leaves(accumulators)]
    if any(not z3.is_const(t) or t.decl().kind() != z3.Z3_OP_UNINTERPRETED for t in own):
        raise ValueError("a fold's accumulators are arbitrary values, not terms or literals")
    names = {str(term) for term in own}
    if len(names) < len(own):
        raise ValueError("a fold's accumulators are distinct values")
    names = spread(names, claim)
    for leaf in leaves(others):
        shared = sorted(names & free_names(known(leaf)))
        if shared:
            raise ValueError(f"an item or context depends on the accumulator {shared[0]}")
    for premise in claim.premises:
        shared = sorted(names & free_names(premise))
        if shared:
            raise ValueError(
                f"a premise restricts the accumulator {shared[0]}: no step keeps to it; "
                "put it into the relation (an unbounded integer is `c.whole`)"
            )


def no_more_premises(claim: Claim, number: int) -> None:
    """Raise ValueError if there are more than `number` premises."""
    if len(claim.premises) != number:
        raise ValueError("an induction's relation and steps state no premises")


def _apart(what: str, value: Any, others: set[str]) -> None:
    shared = sorted(names_in(value) & others)
    if shared:
        raise ValueError(f"{what} depends on {shared[0]}")


class Induction:
    """Checks one induction of a claim; acc, model: the accumulators."""

    def __init__(self, claim: Claim, acc: Any, model: Any, item: Any) -> None:
        self.claim, self.acc, self.model, self.item = claim, acc, model, item
        own = [known(leaf) for leaf in leaves(item)]
        plain = all(z3.is_const(t) and t.decl().kind() == z3.Z3_OP_UNINTERPRETED for t in own)
        if not plain or len(names_in(item)) < len(own):
            raise ValueError(
                "a fold's item is made of distinct arbitrary values: any item may come"
            )
        self.premises = list(claim.premises)

    def relation(self, *terms: z3.BoolRef, start: Any, context: Any) -> None:
        """Check that the relation, before an item and at the start, and the context do not depend on the item."""
        item = spread(names_in(self.item), self.claim)
        for term in terms:
            shared = sorted(free_names(term) & item)
            if shared:
                raise ValueError(
                    f"the relation depends on the item's {shared[0]}: it has to hold after every "
                    "item, so it speaks of the accumulators"
                )
        _apart("the definition's start", start, item | spread(names_in(self.acc), self.claim))
        _apart("the fold's context", context, item)
        known = names_in(self.item) | names_in(context)
        for premise in self.premises:
            names = free_names(premise)
            strange = sorted(names - spread(known, self.claim)) if names & item else []
            if strange:
                raise ValueError(
                    f"a premise makes the item depend on {strange[0]}: put it into the context, "
                    "which is the same for every item"
                )

    def model_only(self, after: Any, result: Any) -> None:
        """Check that the definition's step and result depend on its own accumulator, not on the kernel's."""
        acc = spread(names_in(self.acc), self.claim)
        _apart("the definition's step", after, acc)
        _apart("the definition's result", result, acc | spread(names_in(self.item), self.claim))
        no_more_premises(self.claim, len(self.premises))

    @contextmanager
    def without_items(self) -> Iterator[None]:
        """Obligations stated within must hold for the empty list too: premises on an item are left out."""
        claim = self.claim
        item = spread(names_in(self.item), claim)
        free = [p for p in claim.premises if not free_names(p) & item]
        if len(free) == len(claim.premises):
            yield
            return
        premises, facts = claim.premises, claim.facts
        # what was shown before may depend on the premises that are left out
        claim.premises, claim.facts = free, [*claim.roots, *claim.congruences, *claim.granted]
        kept = len(claim.facts)
        try:
            yield
        finally:
            claim.premises, claim.facts = premises, [*facts, *claim.facts[kept:]]
