"""Induction over several folds at once: what it owes, and what it refuses to speak of."""

from __future__ import annotations

from typing import Any

import pytest
import z3

from cratous.core.geofence.regions import place_in_all, place_in_any
from cratous.proofs.claim import Claim
from cratous.proofs.methods.runs import Items, along_items


def stated(**other: Any) -> Claim:
    """Of every list of places, the least is not above the greatest, if there is one."""
    c = Claim()
    place, least, most = c.whole("place"), c.whole("least"), c.whole("most")
    given: dict[str, Any] = {
        "item": Items((place,)),
        "invariant": lambda state: c.any_of(state[0] <= state[1], state[0] == 1),
        "goal": lambda results: c.any_of(results[0] <= results[1], results[0] == 1),
        "text": "order",
    }
    given |= {key: make(c, place) for key, make in other.items()}
    along_items(c, [(place_in_all, least, ()), (place_in_any, most, ())], **given)
    return c


def unproved(c: Claim) -> list[str]:
    found = []
    for owed in c.obligations:
        solver = z3.Solver()
        solver.add(*owed.given, z3.Not(owed.goal))
        if solver.check() != z3.unsat:
            found.append(owed.kind)
    return found


def test_what_holds_is_shown() -> None:
    c = stated()
    assert [o.kind for o in c.obligations if o.kind != "defined"] == ["base", "step", "use"]
    assert unproved(c) == []


def test_what_does_not_hold_is_not() -> None:
    first = stated(goal=lambda c, place: lambda results: results[0] < results[1])
    assert unproved(first) == ["use"]
    second = stated(invariant=lambda c, place: lambda state: state[0] == 1)
    assert "step" in unproved(second)
    third = stated(invariant=lambda c, place: lambda state: state[0] <= state[1])
    assert "base" in unproved(third)


def test_an_item_may_be_restricted_for_the_step_alone() -> None:
    low = stated(
        item=lambda c, place: Items((place,), each=c.all_of(place >= 1, place <= 9)),
        invariant=lambda c, place: lambda state: state[0] == 1,
        goal=lambda c, place: lambda results: results[0] == 1,
    )
    assert unproved(low) == []


@pytest.mark.parametrize(
    ("key", "says"),
    [("invariant", "the invariant depends on the item"), ("goal", "the goal depends on the item")],
)
def test_what_is_carried_does_not_speak_of_the_item(key: str, says: str) -> None:
    with pytest.raises(ValueError, match=says):
        stated(**{key: lambda c, place: lambda state: state[0] <= place})


def test_no_premise_restricts_what_is_arbitrary() -> None:
    for name, says in (("place", "the item's place"), ("least", "the accumulator least")):
        c = Claim()
        values = {n: c.whole(n) for n in ("place", "least")}
        c.premise(values[name] >= 0)
        with pytest.raises(ValueError, match=f"a premise restricts {says}"):
            along_items(
                c,
                [(place_in_all, values["least"], ())],
                item=Items((values["place"],)),
                invariant=lambda state: state[0] <= 1,
                goal=lambda results: results[0] <= 1,
                text="",
            )
