"""The ownship acts exactly when the loss is too near for any wait, or its prediction is trusted and
the loss so near that right of way counts no more, or it has to give way and cannot wait."""

from cratous.core.authority.right_of_way import must_act
from cratous.proofs.claim import Claim
from cratous.spec.authority import right_of_way


def claim(c: Claim) -> None:
    times = c.reals("first last hard persist")
    facts = [c.boolean(name) for name in ("persists", "in_turn", "has_to_give_way")]
    acts = c.use(must_act, *times, *facts)
    c.show(c.same(acts, c.define(right_of_way.must_act, *times, *facts)))
