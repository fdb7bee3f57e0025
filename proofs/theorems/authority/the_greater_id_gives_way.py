"""Of two cooperating aircraft the one with the greater id gives way, and the other does not: which of
the two it is follows from the ids alone."""

from cratous.core.authority.gate import gives_way
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    less, greater = c.integer("less"), c.integer("greater")
    c.premise(less < greater)
    c.show(c.use(gives_way, greater, less, True), "the greater id does")
    c.show(c.negation(c.use(gives_way, less, greater, True)), "the smaller does not")
