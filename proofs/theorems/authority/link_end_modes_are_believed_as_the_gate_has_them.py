"""UxAS believes a mode of a vehicle's ICAROUS exactly if the vehicle's gate says the same: an epoch that was
never given, of whatever size, takes no authority and gives none, nor does one that is past or that says
of the present one what is not so. The epoch never goes back, the same line twice is once, and an end
that agrees with the gate is changed by no line at all."""

from cratous.core.authority.gate import Gate, epoch_given
from cratous.core.authority.link_end import LinkEnd, link_mode
from cratous.proofs.claim import Claim
from cratous.spec.authority import gate as authority
from cratous.spec.authority import link_end


def claim(c: Claim) -> None:
    end = LinkEnd(c.boolean("active"), c.integer("epoch"), c.boolean("alive"))
    gate = Gate(c.integer("owner"), c.integer("gate_epoch"), c.boolean("offered"))
    says, began = c.boolean("says"), c.integer("began")
    other = LinkEnd(c.boolean("other_active"), c.integer("other_epoch"), c.boolean("other_alive"))
    act = c.integer("other_act")
    c.premise(c.define(authority.well_formed, gate))
    moved = c.use(link_mode, end, gate, says, began)
    right = c.define(link_end.is_after_mode, end, gate, says, began, moved.end, moved.act)
    c.show(right, "as it must be")
    another = c.define(link_end.is_after_mode, end, gate, says, began, other, act)
    only = c.all_of(c.same(other, moved.end), act == moved.act)
    c.show(c.implies(another, only), "and it can be no other")
    never = c.negation(c.use(epoch_given, gate, began))
    c.show(c.implies(never, c.same(moved.end, end)), "what was never given changes nothing")
    news = c.any_of(began != end.epoch, c.negation(c.same(says, end.active)))
    refused = moved.act == link_end.REFUSED
    c.show(c.implies(c.all_of(never, news), refused), "and is refused")
    c.show(moved.end.epoch >= end.epoch, "the epoch never goes back")
    again = c.use(link_mode, moved.end, gate, says, began)
    c.show(c.same(again.end, moved.end), "the same line twice is once")
    true = c.define(link_end.is_true, gate, says, began)
    believed = c.all_of(c.same(moved.end.active, says), moved.end.epoch == began)
    known = end.epoch <= gate.epoch  # it has heard of no epoch that has not begun
    c.show(c.implies(c.all_of(true, known), believed), "what the gate says too is believed")
    agrees = c.define(link_end.is_true, gate, end.active, end.epoch)
    c.show(c.implies(agrees, c.same(moved.end, end)), "who agrees with the gate stays so")
