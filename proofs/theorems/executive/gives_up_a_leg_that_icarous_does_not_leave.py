"""A leg is given up exactly if ICAROUS has taken over too often on it or flown it for too long: one that is not
given up is within both bounds, one at both bounds is not given up, one takeover or one millisecond past its bound it
is, and once it is given up one more of either changes nothing."""

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
    c.show(c.implies(given_up, again), "after one more takeover it stays given up")
    longer = c.use(leg_given_up, takeovers, most, under + 1, longest)
    c.show(c.implies(given_up, longer), "a millisecond later it stays given up")
    at_most = c.use(leg_given_up, most, most, longest, longest)
    c.show(c.negation(at_most), "at both bounds it is flown on")
    one_more = c.use(leg_given_up, most + 1, most, under, longest)
    c.show(one_more, "at the first takeover past the bound it is given up")
    too_long = c.use(leg_given_up, takeovers, most, longest + 1, longest)
    c.show(too_long, "at the first millisecond past the bound it is given up")
