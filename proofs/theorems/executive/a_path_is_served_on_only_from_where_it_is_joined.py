"""A task that was interrupted goes on exactly when UxAS flies its vehicle and the vehicle has come to where
the way back joins the path; once it has, it has for every place farther on."""

from cratous.core.executive.steps import rejoined
from cratous.proofs.claim import Claim
from cratous.spec import executive


def claim(c: Claim) -> None:
    away, suspended = c.boolean("away"), c.boolean("suspended")
    flown_m, join_m, later_m = c.real("flown_m"), c.real("join_m"), c.real("later_m")
    again = c.use(rejoined, away, suspended, flown_m, join_m)
    right = c.define(executive.on_path_again, away, suspended, flown_m, join_m)
    c.show(c.same(again, right), "its definition")
    c.show(c.implies(again, c.negation(suspended)), "only while UxAS flies it")
    farther = c.use(rejoined, away, suspended, later_m, join_m)
    c.show(c.implies(c.all_of(again, later_m >= flown_m), farther), "and it stays so")
