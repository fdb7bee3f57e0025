"""Before anything has happened nothing is in hand; afterwards, whatever happens in any number of events, no more has become known
than there were events, and each surprise is one of something that has become known."""

from typing import Any

from cratous.core.permit.hand import hand_after
from cratous.proofs.claim import Claim
from cratous.proofs.methods.hands import MOST, any_hand, any_hand_event, each_hand_event
from cratous.proofs.methods.runs import Beside, Items, along_items


def claim(c: Claim) -> None:
    hand, reserve = any_hand(c), c.integer("reserve")
    event = any_hand_event(c, c.whole("now"))
    c.premise(reserve >= 0)
    each = each_hand_event(c, event, c.integer("known_as"), c.integer("at"))

    def counts(state: list[Any]) -> Any:
        held, events = state
        known = c.all_of(held.surprises >= 0, held.surprises <= held.knowledge)
        nothing = c.all_of(*[number == 0 for number in held])
        return c.all_of(known, held.knowledge <= events, c.implies(events == 0, nothing))

    def invariant(state: list[Any]) -> Any:
        small = [c.all_of(n >= -MOST, n <= MOST) for n in state[0]]
        return c.all_of(*small, state[1] >= 0, counts(state))

    along_items(
        c,
        [(hand_after, hand, (reserve,))],
        item=Items((event.kind, event.offer, event.permitted, event.now), each, (event.clear,)),
        invariant=invariant,
        goal=counts,
        text="counted",
        beside=[Beside(0, c.whole("events"), lambda state: state[1] + 1)],
    )
