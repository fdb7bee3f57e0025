"""A peer counts as alive exactly while it is heard in time and its connection stands; when that changes
it is said, once, and who commands the vehicle does not change with it."""

from cratous.core.authority.link_end import LinkEnd, link_sign
from cratous.core.authority.timeliness import in_time
from cratous.proofs.claim import Claim
from cratous.spec.authority import link_end


def claim(c: Claim) -> None:
    end = LinkEnd(c.boolean("active"), c.integer("epoch"), c.boolean("alive"))
    event, heard, now, bound = (c.integer(n) for n in ("event", "heard", "now", "bound"))
    c.premise(bound >= 0)
    moved = c.use(link_sign, end, event, heard, now, bound)
    after = moved.end
    right = c.define(link_end.is_after_sign, end, event, heard, now, bound, after, moved.act)
    c.show(right, "as it must be")
    other = LinkEnd(c.boolean("other_active"), c.integer("other_epoch"), c.boolean("other_alive"))
    act = c.integer("other_act")
    c.premise(act >= 0)
    another = c.define(link_end.is_after_sign, end, event, heard, now, bound, other, act)
    only = c.all_of(c.same(other, after), act == moved.act)
    c.show(c.implies(another, only), "and it can be no other")
    commander = c.all_of(c.same(after.active, end.active), after.epoch == end.epoch)
    c.show(commander, "who commands is another matter")
    again = c.use(link_sign, after, event, heard, now, bound)
    told = c.all_of(c.same(again.end, after), c.any_of(event == link_end.ENDED, again.act == 0))
    c.show(told, "it is said once")
    watched = c.all_of(event == link_end.PASSED, after.alive)
    c.show(c.implies(watched, c.use(in_time, heard, now, bound)), "alive is heard in time")
