"""A task that has ended or failed stays so, whatever happens, and may not begin again; and none ends that
had not begun."""

from cratous.core.executive.steps import may_begin, task_after
from cratous.proofs.claim import Claim
from cratous.spec import executive


def claim(c: Claim) -> None:
    life, event = c.integer("life"), c.integer("event")
    rows_open, early = c.boolean("rows_open"), c.boolean("early")
    is_life = c.all_of(life >= executive.LEFT, life <= executive.FAILED)
    after, other = c.use(task_after, life, event), c.integer("other")
    c.show(c.define(executive.is_after_event, life, event, after), "as it must be")
    another = c.define(executive.is_after_event, life, event, other)
    c.show(c.implies(another, other == after), "and it can be no other")
    begins = c.use(may_begin, life, rows_open, early)
    may = c.same(begins, c.define(executive.may_begin, life, rows_open, early))
    c.show(c.implies(is_life, may), "when it may begin")
    settled = c.define(executive.settled, life)
    c.show(c.implies(settled, after == life), "what is settled stays")
    c.show(c.implies(begins, c.negation(settled)), "and does not begin")
    later = c.use(may_begin, after, rows_open, early)
    c.show(c.implies(settled, c.negation(later)), "nor after anything else")
    ended = c.all_of(after == executive.ENDED, life != executive.ENDED)
    c.show(c.implies(ended, life == executive.BEGUN), "none ends that had not begun")
    stays = c.all_of(after >= executive.LEFT, after <= executive.FAILED)
    c.show(c.implies(is_life, stays), "a life stays one")
