"""How long the way back must have been free doubles with each takeover soon after a handback, up to the
fourth in a row; without one it is the least."""

from cratous.core.authority.cycle import patience
from cratous.proofs.claim import Claim
from cratous.spec.authority import cycle as authority_cycle


def claim(c: Claim) -> None:
    relapses, least = c.integer("relapses"), c.integer("least")
    c.premise(c.all_of(least >= 0, least <= 2**56))
    asked, before = c.use(patience, relapses, least), c.use(patience, relapses - 1, least)
    c.show(c.define(authority_cycle.is_patience, relapses, least, asked, before))
    c.show(c.all_of(least <= before, before <= asked, asked <= 16 * least), "within bounds")
