"""A last descent begins only at the end of the way to a landing site, where a landing is chosen, UxAS is not heard
and the way is permitted to the ground. It is left for the ground alone, once that is reached, whatever is heard; a vehicle that
has landed stays there, and its ICAROUS keeps it."""

from cratous.core.authority.link_loss import loss_lets_go, loss_step, loss_takes
from cratous.core.authority.timeliness import in_time
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_loss
from cratous.spec.authority import link_loss


def claim(c: Claim) -> None:
    before, seen = any_loss(c)
    chosen, heard, now, bound, permitted, ended = seen
    after = c.use(loss_step, before, *seen).loss
    final, landed = before.mode == link_loss.FINAL, before.mode == link_loss.LANDED
    c.show(c.implies(landed, c.same(after, before)), "who has landed stays")
    touches = after.mode == link_loss.LANDED
    c.show(c.implies(final, c.same(touches, ended)), "a descent ends on the ground")
    goes_on = c.all_of(final, c.negation(ended))
    c.show(c.implies(goes_on, c.same(after, before)), "and is left for nothing else")
    c.show(c.implies(touches, c.any_of(final, landed)), "nobody lands but by a descent")

    begins = c.all_of(after.mode == link_loss.FINAL, c.negation(final))
    asked = c.all_of(chosen == link_loss.LAND, before.mode == link_loss.LAND)
    c.show(c.implies(begins, asked), "a descent follows a landing that is chosen")
    linked = c.use(in_time, heard, now, bound)
    lost = c.all_of(ended, permitted, c.negation(linked))
    c.show(c.implies(begins, lost), "at its end, permitted, without the link")

    foreseen, free = c.boolean("foreseen"), c.boolean("way_free")
    committed = c.define(link_loss.is_committed, after.mode)
    c.show(c.implies(committed, c.use(loss_takes, after, foreseen)), "ICAROUS has the vehicle")
    lets_go = c.use(loss_lets_go, after, free)
    c.show(c.implies(committed, c.negation(lets_go)), "and does not let it go")
