"""A search counts as served exactly when there is a part of it, at least 99 hundredths of the whole, that
lies within what was seen."""

from cratous.core.tasks.coverage_steps import enough_seen
from cratous.proofs.claim import Claim
from cratous.spec.geofence import part_seen


def claim(c: Claim) -> None:
    unseen, whole, part = c.reals("unseen whole part")
    c.premise(c.all_of(unseen >= 0, whole >= 0))
    enough = c.use(enough_seen, unseen, whole)
    c.show(c.implies(c.define(part_seen, part, unseen, whole), enough), "any such part will do")
    most = c.define(part_seen, whole - unseen, unseen, whole)
    c.show(c.implies(enough, most), "all that was seen is such a part")
    c.show(c.define(part_seen, 99, 1, 100), "an example: 99 of 100")
    c.show(c.negation(c.define(part_seen, 98, 2, 100)), "an example: 98 of 100")
