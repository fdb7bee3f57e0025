"""In command, ICAROUS offers control exactly when none is offered, the way back is free and has been
for long enough, and UxAS can hear it; it withdraws an offer exactly when the way is free no more."""

from cratous.core.authority.gate import handback
from cratous.proofs.claim import Claim
from cratous.spec.authority import gate as authority


def claim(c: Claim) -> None:
    state = [c.boolean(name) for name in ("offered", "free", "lasted", "linked")]
    offered, free, _, _ = state
    does = c.use(handback, *state)
    c.show(c.same(does, c.define(authority.handback, *state)), "what is due")
    offers = c.define(authority.may_offer, *state)
    c.show(c.same(does == authority.OFFER, offers), "an offer is made iff it may be")
    withdrawn = c.define(authority.must_withdraw, offered, free)
    c.show(c.same(does == authority.WITHDRAW, withdrawn), "withdrawn iff it must be")
    c.show(c.any_of(does == 0, does == 1, does == 2), "one of the three")
