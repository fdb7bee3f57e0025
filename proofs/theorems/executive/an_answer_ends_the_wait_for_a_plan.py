"""When the planner answers, a plan that was asked for is flown; without one a change fails all that is left
and a deadline its one task; nothing is asked for any more, and an answer that nobody waits for, a second
one too, changes nothing."""

from cratous.core.executive.steps import answered
from cratous.proofs.claim import Claim
from cratous.spec import executive


def claim(c: Claim) -> None:
    asked, found, again = c.integer("asked"), c.boolean("found"), c.boolean("again")
    after = c.use(answered, asked, found)
    c.show(c.define(executive.is_after_answer, asked, found, after), "as it must be")
    other = executive.Answer(c.integer("other_asked"), c.integer("other_act"))
    another = c.define(executive.is_after_answer, asked, found, other)
    c.show(c.implies(another, c.same(other, tuple(after))), "and it can be no other")
    waits = c.define(executive.is_asked, asked)
    c.show(c.implies(waits, after.awaited == executive.FOR_NOTHING), "it is waited for no more")
    second = c.use(answered, after.awaited, again)
    c.show(second.act == executive.KEEP_ON, "one question has one answer")
    c.show(c.same(after.act == executive.FLY_PLAN, c.all_of(waits, found)), "a plan is flown")
