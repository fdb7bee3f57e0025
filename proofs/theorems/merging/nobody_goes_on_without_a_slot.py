"""In the schedule zone a vehicle without a slot granted by a majority holds; a vehicle is flown to a slot only if it
has one. In both stages ICAROUS has the vehicle and makes no offer; with the fix behind it, or far ahead, all is as
without merging."""

from cratous.core.authority.cycle import cycle_flown
from cratous.core.merging.stages import merge_step, merging_lets_go, merging_takes
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_cycle
from cratous.spec.authority import cycle as authority_cycle
from cratous.spec.merging import stages


def claim(c: Claim) -> None:
    before = c.integer("stage")
    seen = [c.boolean(n) for n in ("near", "inside", "slotted", "early", "entered")]
    near, inside, slotted, _, _ = seen
    c.premise(c.define(stages.is_stage, before))
    after = c.use(merge_step, before, *seen)
    c.show(c.define(stages.is_after_heartbeat, before, *seen, after), "it is its definition")
    c.show(c.define(stages.is_stage, after), "it is one of the four")
    bare = c.all_of(near, inside, c.negation(slotted))
    c.show(c.implies(bare, after == stages.HOLDING), "without a slot it holds")
    c.show(c.implies(after == stages.IN_SLOT, slotted), "who flies by a slot has one")
    foreseen, free = c.boolean("foreseen"), c.boolean("way_free")
    takes = c.use(merging_takes, after, foreseen)
    lets_go = c.use(merging_lets_go, after, free)
    c.show(c.same(takes, c.define(stages.must_fly, after, foreseen)), "why it is taken")
    c.show(c.same(lets_go, c.define(stages.may_go_back, after, free)), "when it may go back")
    c.show(c.implies(bare, takes), "ICAROUS has it")
    alone = c.implies(c.negation(near), c.all_of(c.same(takes, foreseen), c.same(lets_go, free)))
    c.show(alone, "away from the fix all is as without merging")
    cycle, heard, now = any_cycle(c), c.integer("heard"), c.integer("now")
    bound, least = c.integer("bound"), c.integer("least")
    c.premise(c.all_of(bound >= 0, least >= 0, least <= 2**56))
    c.premise(c.define(authority_cycle.is_mode, cycle.mode))
    flown = c.use(cycle_flown, cycle, lets_go, heard, now, bound, least)
    kept = c.any_of(after == stages.IN_SLOT, after == stages.HOLDING)
    c.show(c.implies(kept, flown.act != authority_cycle.OFFER), "nothing is offered")
