"""A loss is excused only if both judges say that there was no way out; where one says anything else it is
not, and a way out is said only if both say so."""

from cratous.core.excuse.way_out import both_say, is_excused
from cratous.proofs.claim import Claim
from cratous.spec import excuse


def claim(c: Claim) -> None:
    one, other = c.integer("one"), c.integer("other")
    said = c.use(both_say, one, other)
    c.show(c.define(excuse.agreed, one, other, said), "definition")
    excused = c.use(is_excused, said)
    c.show(c.same(excused, c.define(excuse.excuses, said)), "excused")
    c.show(c.same(excused, c.all_of(one == -1, other == -1)), "both")
