"""When a track or zone becomes known, the certificate in hand is either permitted against it and stays as it
is, or a surprise is declared and nothing counts as certain; no offer that does not allow for it is accepted
from then on, until there is one that does."""

from cratous.core.permit.hand import Hand, Offer, accepts, hand_told
from cratous.proofs.claim import Claim
from cratous.spec.permit import hand as permit


def claim(c: Claim) -> None:
    hand = Hand(*[c.integer(f"hand_{name}") for name in ("id", "knowledge", "expiry", "surprises")])
    names = ("id", "base", "sigma", "knowledge", "expiry")
    offer = Offer(*[c.integer(f"offer_{name}") for name in names])
    now, then, reserve, at = (c.integer(name) for name in ("now", "then", "reserve", "at"))
    allowed, clear, clear_of_it = (
        c.boolean("permitted"),
        c.boolean("clear"),
        c.boolean("clear_of_it"),
    )
    c.premise(reserve >= 0)
    c.premise(c.define(permit.certified, hand.expiry_ms, clear, now, at))
    # what the kernel says of the hand's trajectory against the newcomer
    of_it = c.define(permit.certified, hand.expiry_ms, clear_of_it, now, at)
    c.premise(c.implies(allowed, of_it))
    after = c.use(hand_told, hand, allowed, now)
    c.show(c.define(permit.is_after_news, hand, allowed, now, after), "what becomes of it")
    both = c.all_of(clear, clear_of_it)
    c.show(c.define(permit.certified, after.expiry_ms, both, now, at), "clear of all that is known")
    stale = offer.knowledge <= hand.knowledge
    late = c.use(accepts, after, offer, then, reserve)
    c.show(c.implies(stale, c.negation(late)), "an offer that does not allow for it")
    surprise = after.surprises == hand.surprises + 1
    c.show(c.same(surprise, c.negation(allowed)), "a surprise is declared")
    c.show(c.implies(after.expiry_ms > now, allowed), "what is certain was permitted")
    other = Hand(*[c.integer(f"other_{name}") for name in ("id", "know", "expiry", "surprises")])
    another = c.define(permit.is_after_news, hand, allowed, now, other)
    c.show(c.implies(another, c.same(other, after)), "and no other")
