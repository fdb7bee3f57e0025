"""Whatever happens to the certificate in hand, in any number of events (offers that are taken or refused, news that is
permitted or not, another trajectory flown, time), at any instant from the last event until it expires the vehicle
that flies it is clear of any one track or zone that is known: a surprise ends it at once."""

from typing import Any

from cratous.core.kernel import Fold
from cratous.core.permit.hand import KNOWN, OFFERED, Hand, Offer, hand_after
from cratous.proofs.claim import Claim
from cratous.proofs.methods.runs import Items, along_items
from cratous.spec.permit import hand as permit

MOST = permit.MOST


def claim(c: Claim) -> None:
    hand = Hand(*[c.whole(f"hand_{name}") for name in ("id", "knowledge", "expiry", "surprises")])
    names = ("id", "base", "sigma", "knowledge", "expiry")
    offer = Offer(*[c.whole(f"offer_{name}") for name in names])
    kind, now, permitted = c.whole("kind"), c.whole("now"), c.boolean("permitted")
    reserve, at = c.integer("reserve"), c.integer("at")
    c.premise(reserve >= 0)
    # one arbitrary certificate, one arbitrary track or zone; clear of it, at one arbitrary instant, if it is flown
    this, known_as, clear = c.integer("this"), c.integer("known_as"), c.boolean("clear")

    def until(expiry: Any, begin: Any) -> Any:
        return c.define(permit.certified, expiry, clear, begin, at)

    offered = c.all_of(kind == OFFERED, offer.id == this, offer.knowledge >= known_as)
    of_it = c.all_of(kind == KNOWN, offer.id == this, offer.knowledge == known_as, permitted)
    said = (offer.id, offer.base, offer.sigma_ms, offer.knowledge, offer.expiry_ms, now, kind)
    each = c.all_of(
        *[c.all_of(n >= -MOST, n <= MOST) for n in said],
        # what is offered begins at once, and is permitted against all that it knows
        c.implies(kind == OFFERED, offer.sigma_ms == now),
        c.implies(offered, until(offer.expiry_ms, now)),
        # and what is said to be permitted against news is
        c.implies(of_it, until(offer.expiry_ms, now)),
    )
    item = Items((kind, offer, permitted, now), each)

    def invariant(state: list[Any]) -> Any:
        held, clock = state
        flown = c.all_of(held.id == this, held.knowledge >= known_as, clock.in_order)
        clear_of_it = c.implies(flown, until(held.expiry_ms, clock.now_ms))
        counted = (held.id, held.knowledge, held.surprises, held.expiry_ms)
        return c.all_of(*[c.all_of(n >= -MOST, n <= MOST) for n in counted], clear_of_it)

    def goal(results: list[Any]) -> Any:
        held, clock = results
        flown = c.all_of(held.id == this, held.knowledge >= known_as, clock.in_order)
        within = c.all_of(at >= clock.now_ms, at < held.expiry_ms)
        return c.implies(c.all_of(flown, within), clear)

    clock = Fold("clock", "permit.hand.clock_step", permit.clock_step, permit.Clock(0, True), None)
    along_items(
        c,
        [(hand_after, hand, (reserve,))],
        item=item,
        invariant=invariant,
        goal=goal,
        text="clear",
        models=[(clock, permit.Clock(c.whole("clock_now"), c.boolean("in_order")), (reserve,))],
    )
