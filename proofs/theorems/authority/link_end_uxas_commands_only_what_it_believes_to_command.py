"""While the last accepted mode says that ICAROUS commands, UxAS's own flying is suspended and commands
nothing, whatever modes and signs of life come; as soon as the last accepted mode says otherwise it is
not suspended any more."""

from cratous.core.authority import link_end as kernels
from cratous.core.authority.gate import Gate
from cratous.proofs.claim import Claim
from cratous.spec.authority import gate as authority
from cratous.spec.authority import link_end


def claim(c: Claim) -> None:
    end = kernels.LinkEnd(c.boolean("active"), c.integer("epoch"), c.boolean("alive"))
    says, began, changed = c.boolean("says"), c.integer("began"), c.boolean("changed")
    suspended = end.active  # so it is at the start, and after each step
    gate = Gate(c.integer("owner"), c.integer("gate_epoch"), c.boolean("offered"))
    c.premise(c.define(authority.well_formed, gate))
    moved = c.use(kernels.link_mode, end, gate, says, began)
    after = c.use(kernels.suspended_after, suspended, moved.act)
    right = c.define(link_end.is_after_answer, suspended, moved.act, after)
    c.show(right, "its definition")
    c.show(c.same(after, moved.end.active), "suspended exactly while ICAROUS commands")
    told = c.use(kernels.track_is_told, after, changed)
    c.show(c.same(told, c.define(link_end.may_tell, after, changed)), "what is told")
    believed = c.define(link_end.believes_uxas, moved.end)
    c.show(c.implies(told, believed), "UxAS commands only what it believes to command")
    c.show(c.implies(moved.act == link_end.TAKE_BACK, believed), "and takes back no other")
    event, heard, now, bound = (c.integer(n) for n in ("event", "heard", "now", "bound"))
    c.premise(bound >= 0)
    sign = c.use(kernels.link_sign, end, event, heard, now, bound)
    c.show(c.same(sign.end.active, suspended), "no sign of life changes it")
    any_act, held = c.integer("any_act"), c.boolean("held")
    free = c.use(kernels.suspended_after, held, any_act)
    c.show(c.define(link_end.is_after_answer, held, any_act, free), "for every answer")
    other = c.boolean("other")
    another = c.define(link_end.is_after_answer, held, any_act, other)
    c.show(c.implies(another, c.same(other, free)), "and it can be no other")
    plain = c.use(kernels.track_is_told, held, changed)
    c.show(c.same(plain, c.define(link_end.may_tell, held, changed)), "whoever is suspended")
