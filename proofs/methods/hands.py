"""What theorems on the certificate in hand are about: any event of it, and what is then so of what is in hand."""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.core.permit.hand import KNOWN, OFFERED, Hand, Offer, accepts, hand_passed, worn
from cratous.proofs.claim import Claim
from cratous.spec.permit import hand as permit

MOST = permit.MOST


class HandEvent(NamedTuple):
    """An event of a hand: `core.permit.hand.hand_step`. clear: of the one track or zone that is looked at, at the one
    instant, if what is offered, or was asked about, is flown."""

    kind: Any
    offer: Offer
    permitted: Any
    now: Any
    clear: Any


def any_hand(c: Claim) -> Hand:
    """Any hand, of numbers of any size: `hand_id`, `hand_knowledge`, `hand_expiry`, `hand_surprises`."""
    return Hand(*[c.whole(f"hand_{name}") for name in ("id", "knowledge", "expiry", "surprises")])


def any_hand_event(c: Claim, now: Any) -> HandEvent:
    """Any event of a hand at an instant: `kind`, `offer_id` and so on, `permitted`, `offer_clear`."""
    names = ("id", "base", "sigma", "knowledge", "expiry")
    offer = Offer(*[c.whole(f"offer_{name}") for name in names])
    return HandEvent(c.whole("kind"), offer, c.boolean("permitted"), now, c.boolean("offer_clear"))


def each_hand_event(c: Claim, event: HandEvent, known_as: Any, at: Any) -> Any:
    """What is given of each event: numbers that a machine counts, and that what is said to be permitted is.

    What is offered is clear, from its begin until its expiry, of all that it knows; what is said to be permitted
    against news is, from now until the expiry that was asked for.
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
    """Whether, flying what is in hand after an event, the vehicle is clear at the instant.

    was: whether it is, flying what is in hand before; asked: the reserve [ms], as what the one track or zone is known,
    and the instant. What begins later is until then what it begins on.
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
