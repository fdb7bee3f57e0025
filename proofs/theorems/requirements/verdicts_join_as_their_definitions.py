"""Not, and, or of verdicts say true or false exactly where that holds however the unknown turns out."""

from cratous.core.requirements.verdict import both, either, negated
from cratous.proofs.claim import Claim
from cratous.spec.requirements.operators import and_, not_, or_


def claim(c: Claim) -> None:
    phi, psi = c.integer("phi"), c.integer("psi")
    for verdict in (phi, psi):
        c.premise(verdict >= 0)
        c.premise(verdict <= 2)
    c.show(c.define(not_, phi, c.use(negated, phi)), "not")
    c.show(c.define(and_, phi, psi, c.use(both, phi, psi)), "and")
    c.show(c.define(or_, phi, psi, c.use(either, phi, psi)), "or")
