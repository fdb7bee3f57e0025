"""UxAS believes the modes of a vehicle's ICAROUS in the order of their epochs: one of an old epoch
changes nothing, a newer one is what is believed from then on, and the epoch never goes back; so of
several modes, in whatever order they come, the last one to have begun decides."""

from cratous.core.authority.link_end import LinkEnd, link_mode
from cratous.proofs.claim import Claim
from cratous.spec.authority import link_end


def claim(c: Claim) -> None:
    end = LinkEnd(c.boolean("active"), c.integer("epoch"), c.boolean("alive"))
    says, began = c.boolean("says"), c.integer("began")
    other = LinkEnd(c.boolean("other_active"), c.integer("other_epoch"), c.boolean("other_alive"))
    act = c.integer("other_act")
    moved = c.use(link_mode, end, says, began)
    right = c.define(link_end.is_after_mode, end, says, began, moved.end, moved.act)
    c.show(right, "as it must be")
    another = c.define(link_end.is_after_mode, end, says, began, other, act)
    only = c.all_of(c.same(other, moved.end), act == moved.act)
    c.show(c.implies(another, only), "and it can be no other")
    old = c.all_of(c.same(moved.end, end), moved.act == link_end.OVERTAKEN)
    c.show(c.implies(began <= end.epoch, old), "an old one changes nothing")
    c.show(moved.end.epoch >= end.epoch, "the epoch never goes back")
    believed = c.all_of(c.same(moved.end.active, says), moved.end.epoch == began)
    c.show(c.implies(began > end.epoch, believed), "a newer one is believed")
    again = c.use(link_mode, moved.end, says, began)
    c.show(c.same(again.end, moved.end), "the same line twice is once")
    late_says, late = c.boolean("late_says"), c.integer("late")
    swapped = c.use(link_mode, c.use(link_mode, end, late_says, late).end, says, began)
    straight = c.use(link_mode, moved.end, late_says, late)
    c.show(
        c.implies(late != began, c.same(swapped.end, straight.end)), "in whatever order they come"
    )
