"""Arbitrary values for theorems on the certificate in hand: its events, and whether what is in hand is then clear."""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.core.permit.hand import KNOWN, OFFERED, Hand, Offer, accepts, hand_passed, worn
from cratous.proofs.claim import Claim
from cratous.spec.permit import hand as permit

MOST = permit.MOST


class HandEvent(NamedTuple):
    """An event of a hand: `core.permit.hand.hand_step`. clear: the vehicle is clear of the track or zone considered,
    at the instant considered, if what is offered, or was asked about, is flown."""

    kind: Any
    offer: Offer
    permitted: Any
    now: Any
    clear: Any


def any_hand(c: Claim) -> Hand:
    """An arbitrary hand, with numbers of any size: `hand_id`, `hand_knowledge`, `hand_expiry`, `hand_surprises`."""
    return Hand(*[c.whole(f"hand_{name}") for name in ("id", "knowledge", "expiry", "surprises")])


def any_hand_event(c: Claim, now: Any) -> HandEvent:
    """An arbitrary event of a hand at an instant: `kind`, `offer_id` etc., `permitted`, `offer_clear`."""
    names = ("id", "base", "sigma", "knowledge", "expiry")
    offer = Offer(*[c.whole(f"offer_{name}") for name in names])
    return HandEvent(c.whole("kind"), offer, c.boolean("permitted"), now, c.boolean("offer_clear"))


def each_hand_event(c: Claim, event: HandEvent, known_as: Any, at: Any) -> Any:
    """Condition on every event: numbers are within counting range, and permits are correct.

    An offer is clear, from its start until its expiry, of all that it knows; a permit against a new track or zone
    holds from now until the expiry that was asked for.
    """
    kind, offer, permitted, now, clear = event
    said = (*offer, now, kind)
    of_it = c.all_of(kind == OFFERED, offer.knowledge >= known_as)
    news = c.all_of(kind == KNOWN, offer.knowledge == known_as, permitted)
    return c.all_of(
        *[c.all_of(n >= -MOST, n <= MOST) for n in said],
        c.implies(of_it, c.define(permit.certified, offer.expiry_ms, clear, offer.sigma_ms, at)),
        c.implies(news, c.define(permit.certified, offer.expiry_ms, clear, now, at)),
    )


def in_hand_after(c: Claim, hand: Hand, was: Any, event: HandEvent, asked: tuple[Any, ...]) -> Any:
    """Whether the vehicle, flying what is in hand after an event, is clear at the instant.

    was: the same before the event; asked: the reserve [ms], the number of the knowledge change by which the track or
    zone became known, and the instant. Until a later offer begins, the trajectory that it begins on is flown.
    """
    reserve, known_as, at = asked
    kind, offer, permitted, now, clear = event
    present = c.use(hand_passed, hand, now)
    fresh = c.negation(c.use(worn, present))
    taken = c.all_of(kind == OFFERED, fresh, c.use(accepts, present, offer, now, reserve))
    begun = c.when(at < offer.sigma_ms, was, clear)
    news = c.all_of(kind == KNOWN, permitted, offer.knowledge == known_as)
    of_this = c.all_of(news, offer.id == present.id, present.knowledge + 1 == known_as)
    return c.when(taken, begun, c.when(of_this, clear, was))
