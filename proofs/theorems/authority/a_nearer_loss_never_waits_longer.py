"""If the ownship must act on a predicted loss, it must act on a nearer one, on one that persists, and
on one that it has to give way to; within the hard limit it always acts."""

from cratous.core.authority.right_of_way import must_act
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    first, nearer, last, hard, persist = c.reals("first nearer last hard persist")
    persists, in_turn, gives = (c.boolean(n) for n in ("persists", "in_turn", "has_to_give_way"))
    c.premise(nearer <= first)
    c.premise(hard <= last)
    acts = c.use(must_act, first, last, hard, persist, persists, in_turn, gives)
    c.show(
        c.implies(acts, c.use(must_act, nearer, last, hard, persist, persists, in_turn, gives)),
        "on a nearer one",
    )
    c.show(
        c.implies(acts, c.use(must_act, first, last, hard, persist, True, in_turn, gives)),
        "on one that has persisted",
    )
    c.show(
        c.implies(acts, c.use(must_act, first, last, hard, persist, persists, in_turn, True)),
        "on one that has to be given way to",
    )
    c.show(
        c.implies(
            nearer <= hard, c.use(must_act, nearer, last, hard, persist, persists, in_turn, gives)
        ),
        "within the hard limit always",
    )
