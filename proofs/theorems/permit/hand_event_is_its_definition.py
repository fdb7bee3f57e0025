"""What becomes of the certificate in hand at each event is what is defined, and nothing else: time has passed first,
an expired one holds nothing; where another trajectory is flown nothing is certain, and nothing begins on the old one."""

from cratous.core.permit.hand import (
    Hand,
    Offer,
    accepts,
    hand_left,
    hand_passed,
    hand_step,
    news_for,
    worn,
)
from cratous.proofs.claim import Claim
from cratous.spec.permit import hand as permit


def claim(c: Claim) -> None:
    hand = Hand(*[c.integer(f"hand_{name}") for name in ("id", "knowledge", "expiry", "surprises")])
    names = ("id", "base", "sigma", "knowledge", "expiry")
    offer = Offer(*[c.integer(f"offer_{name}") for name in names])
    kind, now, reserve, at = (c.integer(name) for name in ("kind", "now", "reserve", "at"))
    permitted, clear = c.boolean("permitted"), c.boolean("clear")
    c.premise(reserve >= 0)
    passed = c.use(hand_passed, hand, now)
    c.show(c.define(permit.is_after_time, hand, now, passed), "time passes")
    c.show(passed.expiry_ms >= now, "an offer may begin now")
    before = c.define(permit.certified, hand.expiry_ms, clear, now, at)
    same = c.define(permit.certified, passed.expiry_ms, clear, now, at)
    c.show(c.implies(before, same), "as clear as before")
    left = c.use(hand_left, hand, now)
    c.show(c.define(permit.is_after_leaving, hand, now, left), "another is flown")
    c.show(c.define(permit.certified, left.expiry_ms, clear, now, at), "nothing is certain then")
    late = c.use(accepts, left, offer, now, reserve)
    on_it = offer.base <= hand.id
    c.show(c.implies(on_it, c.negation(late)), "nothing begins on what was left")
    asked = c.use(news_for, hand, offer)
    c.show(c.same(asked, c.define(permit.is_news_for, hand, offer)), "what was asked about")
    often = c.use(worn, hand)
    c.show(c.same(often, c.define(permit.is_worn, hand)), "changed too often")
    after = c.use(hand_step, hand, kind, offer, permitted, now, reserve)
    meant = c.define(permit.is_after_event, hand, kind, offer, permitted, now, reserve, after)
    c.show(meant, "each event")
    other = Hand(*[c.integer(f"other_{name}") for name in ("id", "know", "expiry", "surprises")])
    another = c.define(permit.is_after_event, hand, kind, offer, permitted, now, reserve, other)
    c.show(c.implies(another, c.same(other, after)), "and no other")
