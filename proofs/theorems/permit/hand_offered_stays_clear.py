"""If the certificate in hand is clear at every instant until it expires, so is the one after any offer, and it
expires no earlier or not before the reserve is over: whatever offers were sent, lost, doubled or delayed."""

from cratous.core.permit.hand import Hand, Offer, accepts, hand_offered
from cratous.proofs.claim import Claim
from cratous.spec.permit import hand as permit


def claim(c: Claim) -> None:
    hand = Hand(*[c.integer(f"hand_{name}") for name in ("id", "knowledge", "expiry", "surprises")])
    names = ("id", "base", "sigma", "knowledge", "expiry")
    offer = Offer(*[c.integer(f"offer_{name}") for name in names])
    now, reserve, at = (c.integer(name) for name in ("now", "reserve", "at"))
    clear, base_clear, offer_clear = (
        c.boolean(name) for name in ("hand_clear", "base_clear", "offer_clear")
    )
    c.premise(reserve >= 0)
    # one certificate has one trajectory
    c.premise(c.implies(offer.base == hand.id, c.same(base_clear, clear)))
    # what the pilot's kernel has permitted: from its begin on, and until then it is the one it begins on
    c.premise(c.define(permit.certified, offer.expiry_ms, offer_clear, offer.sigma_ms, at))
    c.premise(c.define(permit.agrees, offer.sigma_ms, offer_clear, base_clear, at))
    c.premise(c.define(permit.certified, hand.expiry_ms, clear, now, at))
    taken = c.use(accepts, hand, offer, now, reserve)
    may = c.define(permit.may_take_over, hand, offer, now, reserve)
    c.show(c.same(taken, may), "accepted exactly when it may be")
    after = c.use(hand_offered, hand, offer, now, reserve)
    c.show(c.define(permit.is_after_offer, hand, offer, now, reserve, after), "what becomes of it")
    flown = c.when(taken, offer_clear, clear)
    c.show(c.define(permit.certified, after.expiry_ms, flown, now, at), "clear until it expires")
    lasts = c.define(permit.lasts, hand.expiry_ms, after.expiry_ms, now, reserve)
    c.show(lasts, "not shortened by too much")
    other = Hand(*[c.integer(f"other_{name}") for name in ("id", "know", "expiry", "surprises")])
    another = c.define(permit.is_after_offer, hand, offer, now, reserve, other)
    c.show(c.implies(another, c.same(other, after)), "and no other")
