"""Of two cooperating aircraft with different ids exactly one gives way, whichever of them asks; to an
aircraft that does not cooperate the ownship always does. So no encounter is symmetric."""

from cratous.core.authority.gate import gives_way
from cratous.proofs.claim import Claim
from cratous.spec.authority import gate as authority


def claim(c: Claim) -> None:
    one, other = c.integer("one"), c.integer("other")
    yes = c.boolean("cooperates")
    c.premise(c.negation(one == other))
    mine = c.use(gives_way, one, other, yes)
    theirs = c.use(gives_way, other, one, yes)
    c.show(c.define(authority.one_gives_way, mine, theirs, yes), "they do not meet alike")
    c.show(c.implies(yes, c.same(mine, c.negation(theirs))), "exactly one of the two")
    c.show(c.implies(c.negation(yes), mine), "always to one that does not cooperate")
