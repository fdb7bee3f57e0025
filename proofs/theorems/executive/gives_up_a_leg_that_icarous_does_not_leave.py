"""A leg is given up exactly if ICAROUS has taken over too often on it or flown it for too long: one that is not
given up had at most as many takeovers as it may have, and once it is given up more of either changes nothing."""

from cratous.core.executive.steps import leg_given_up
from cratous.proofs.claim import Claim
from cratous.spec import executive


def claim(c: Claim) -> None:
    takeovers, most = c.integer("takeovers"), c.integer("most")
    under, longest = c.integer("under"), c.integer("longest")
    given_up = c.use(leg_given_up, takeovers, most, under, longest)
    c.show(
        c.define(executive.is_given_up, takeovers, most, under, longest, given_up), "as it must be"
    )
    c.show(c.implies(c.negation(given_up), takeovers <= most), "no more takeovers than it may have")
    c.show(c.implies(c.negation(given_up), under <= longest), "no longer than it may last")
    again = c.use(leg_given_up, takeovers + 1, most, under, longest)
    c.show(c.implies(given_up, again), "it stays given up")
