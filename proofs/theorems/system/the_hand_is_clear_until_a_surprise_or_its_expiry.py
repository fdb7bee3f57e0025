"""Whatever happens to the certificate in hand, in any number of events (offers that are taken or refused and begin at once
or later on the one in hand, news that is permitted or not, another trajectory flown, time), at any instant from the last
event until it expires the vehicle that flies it is clear of any one track or zone that is known: a surprise ends it at once."""

from typing import Any

from cratous.core.kernel import Fold
from cratous.core.permit.hand import hand_after
from cratous.proofs.claim import Claim
from cratous.proofs.methods.hands import (
    MOST,
    any_hand,
    any_hand_event,
    each_hand_event,
    in_hand_after,
)
from cratous.proofs.methods.runs import Beside, Items, along_items
from cratous.spec.permit import hand as permit


def claim(c: Claim) -> None:
    # one arbitrary track or zone, known as that, and one arbitrary instant
    hand, known_as, at = any_hand(c), c.integer("known_as"), c.integer("at")
    event, reserve, clear = (
        any_hand_event(c, c.whole("now")),
        c.integer("reserve"),
        c.boolean("clear"),
    )
    c.premise(reserve >= 0)
    each = each_hand_event(c, event, known_as, at)

    def is_certain(state: list[Any]) -> Any:
        held, clock, flown_clear = state
        known = c.all_of(held.knowledge >= known_as, clock.in_order)
        certified = c.define(permit.certified, held.expiry_ms, flown_clear, clock.now_ms, at)
        return c.implies(known, certified)

    def invariant(state: list[Any]) -> Any:
        counted = (*state[0], state[1].now_ms)
        return c.all_of(*[c.all_of(n >= -MOST, n <= MOST) for n in counted], is_certain(state))

    def goal(results: list[Any]) -> Any:
        held, clock, flown_clear = results
        known = c.all_of(held.knowledge >= known_as, clock.in_order)
        within = c.all_of(at >= clock.now_ms, at < held.expiry_ms)
        return c.implies(c.all_of(known, within), flown_clear)

    def after(state: list[Any]) -> Any:
        return in_hand_after(c, state[0], state[2], event, (reserve, known_as, at))

    clock = Fold("clock", "permit.hand.clock_step", permit.clock_step, permit.Clock(0, True), None)
    along_items(
        c,
        [(hand_after, hand, (reserve,))],
        item=Items((event.kind, event.offer, event.permitted, event.now), each, (event.clear,)),
        invariant=invariant,
        goal=goal,
        text="clear",
        models=[(clock, permit.Clock(c.whole("clock_now"), c.boolean("in_order")), (reserve,))],
        beside=[Beside(False, clear, after)],
    )
