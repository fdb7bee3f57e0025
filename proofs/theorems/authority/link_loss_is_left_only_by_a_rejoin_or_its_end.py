"""A mode that was begun without the link is left only when UxAS is heard again, when it has been flown to its
end, or when its way is no longer permitted; a circle that was flown for want of a permitted way is left for what
is chosen once that is permitted. What has ended is left by a rejoin alone. A last descent to the ground is another
claim: it is left for the ground."""

from cratous.core.authority.link_loss import loss_step
from cratous.core.authority.timeliness import in_time
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_loss
from cratous.spec.authority import link_loss


def claim(c: Claim) -> None:
    before, seen = any_loss(c)
    chosen, heard, now, bound, permitted, ended = seen
    after = c.use(loss_step, before, *seen).loss
    committed = c.define(link_loss.is_committed, before.mode)
    c.premise(c.negation(committed))
    lost, left = before.mode != link_loss.LINKED, after.mode != before.mode
    linked = c.use(in_time, heard, now, bound)
    c.show(
        c.implies(lost, c.same(linked, after.mode == link_loss.LINKED)), "a rejoin, and no other"
    )
    goes_on = c.all_of(lost, left, c.negation(linked))
    is_chosen = before.mode == chosen
    end = c.any_of(after.mode == link_loss.OVER, after.mode == link_loss.FINAL)
    ends = c.all_of(ended, end)
    falls = c.all_of(c.negation(permitted), after.mode == link_loss.LOITER)
    c.show(c.implies(c.all_of(goes_on, is_chosen), c.any_of(ends, falls)), "what is chosen")
    waits = c.all_of(before.mode == link_loss.LOITER, permitted, after.mode == chosen)
    other = c.negation(is_chosen)
    was_chosen = c.any_of(is_chosen, before.mode == link_loss.LOITER, before.mode == link_loss.OVER)
    c.show(c.implies(c.all_of(goes_on, other, was_chosen), waits), "a circle for want of a way")
    over = c.all_of(before.mode == link_loss.OVER, c.negation(linked))
    c.show(c.implies(over, c.same(after, before)), "what has ended")
    same = c.negation(left)
    c.show(c.implies(same, after.since_ms == before.since_ms), "what is not left goes on")
