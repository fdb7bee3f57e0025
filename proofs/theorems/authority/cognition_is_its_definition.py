"""The mode of the decision logic is the gravest one for which there is a reason, and no other; the same conditions do not
change it again; and whether a manoeuvre is a turn, how a conflict is avoided by one that changes direction, altitude or
speed, whether ICAROUS has to have the vehicle, and whether it may go back are what their definitions say."""

from cratous.core.authority.cognition import (
    decide,
    mode_avoids,
    mode_lets_go,
    mode_takes,
    resolution,
    turns_by,
)
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_conditions
from cratous.spec.authority import cognition


def claim(c: Claim) -> None:
    before, seen = any_conditions(c)
    other, meant = c.integer("other"), cognition.is_decided
    after = c.use(decide, before, seen)
    c.show(c.define(meant, before, seen, after, other), "there is a reason, and no graver one")
    another = c.define(meant, before, seen, other, after)
    c.show(c.implies(another, c.same(other, after)), "and it can be no other")
    c.show(c.same(c.use(decide, after, seen), after), "it stays with the same conditions")
    avoids, flies = cognition.avoids, cognition.must_fly
    c.show(c.same(c.use(mode_avoids, after), c.define(avoids, after)), "whether it avoids")
    c.show(c.same(c.use(mode_takes, after), c.define(flies, after)), "why ICAROUS has it")
    goes = c.define(cognition.may_go_back, after)
    c.show(c.same(c.use(mode_lets_go, after), goes), "when it may go back")
    off, least = c.real("off"), c.real("least")
    c.premise(least >= 0)
    a_turn = c.define(cognition.is_turn, off, least)
    c.show(c.same(c.use(turns_by, off, least), a_turn), "a turn")
    flown = tuple(c.boolean(name) for name in ("turns", "climbs", "paces", "clear"))
    c.premise(c.any_of(*flown[:3]))
    found, another = c.use(resolution, after, *flown), c.integer("another")
    c.show(c.define(cognition.is_resolution, after, *flown, found), "a resolution")
    taken = c.define(cognition.is_resolution, after, *flown, another)
    c.show(c.implies(taken, c.same(another, found)), "and no other")
