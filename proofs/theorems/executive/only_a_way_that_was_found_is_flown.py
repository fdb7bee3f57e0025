"""A way is flown exactly if one was found that keeps the zones; where none was, the task that needs it fails,
and a vehicle without a task circles where it is."""

from cratous.core.executive.steps import way_act
from cratous.proofs.claim import Claim
from cratous.spec import executive


def claim(c: Claim) -> None:
    found, tasked, other = c.boolean("found"), c.boolean("tasked"), c.integer("other")
    act = c.use(way_act, found, tasked)
    c.show(c.define(executive.is_after_search, found, tasked, act), "as it must be")
    another = c.define(executive.is_after_search, found, tasked, other)
    c.show(c.implies(another, other == act), "and it can be no other")
    c.show(c.implies(c.negation(found), act != executive.FLY_WAY), "nothing else is flown")
