"""A task fails with another exactly if a row makes it wait for that one and it has not begun; what is
begun or settled is left as it is."""

from cratous.core.executive.steps import falls_with, may_begin
from cratous.proofs.claim import Claim
from cratous.spec import executive


def claim(c: Claim) -> None:
    kind, named, life = c.integer("kind"), c.boolean("named"), c.integer("life")
    rows_open, early = c.boolean("rows_open"), c.boolean("early")
    falls = c.use(falls_with, kind, named, life)
    c.show(c.same(falls, c.define(executive.falls_with, kind, named, life)), "its definition")
    c.show(c.implies(falls, life == executive.LEFT), "only what is left")
    failed = c.use(may_begin, executive.FAILED, rows_open, early)
    c.show(c.negation(failed), "and then it never begins")
