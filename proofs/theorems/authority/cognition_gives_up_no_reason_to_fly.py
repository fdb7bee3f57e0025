"""Where link loss, take-off or merging keep the vehicle, or a conflict is predicted, the mode does so as well, and
nowhere else; the vehicle may go back in a mode exactly where ICAROUS has it and all of them let it go. The final
descent and the ground after it, which keep it too, are parts of link loss."""

from cratous.core.authority.cognition import decide, mode_lets_go, mode_takes
from cratous.core.authority.link_loss import Loss, loss_lets_go, loss_takes
from cratous.core.authority.take_off import Departure, departure_lets_go, departure_takes
from cratous.core.merging.stages import merging_lets_go, merging_takes
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_conditions
from cratous.spec.authority import cognition, link_loss


def claim(c: Claim) -> None:
    before, seen = any_conditions(c)
    loss, stage = Loss(c.integer("mode_without"), c.integer("since_ms")), c.integer("stage")
    departure = Departure(c.integer("mode_up"), c.integer("up_ms"))
    told = (
        c.same(seen.landed, loss.mode == link_loss.LANDED),
        c.same(seen.descends, loss.mode == link_loss.FINAL),
        c.same(seen.lands, loss.mode == link_loss.LAND),
        c.same(seen.alone, c.use(loss_takes, loss, False)),
        c.same(seen.departs, c.use(departure_takes, departure, False)),
        c.same(seen.merges, c.use(merging_takes, stage, False)),
        before < cognition.LAND,
    )
    c.premise(c.all_of(*told))
    after = c.use(decide, before, seen)
    conflict = c.any_of(seen.traffic, seen.fence)
    kept = c.use(loss_takes, loss, conflict)
    kept = c.use(departure_takes, departure, c.use(merging_takes, stage, kept))
    watched = c.negation(seen.has)
    takes = c.use(mode_takes, after)
    c.show(c.implies(watched, c.same(takes, kept)), "it takes the vehicle where one of them does")
    c.show(c.implies(kept, takes), "and keeps it")
    goes = c.use(loss_lets_go, loss, c.negation(conflict))
    goes = c.use(departure_lets_go, departure, c.use(merging_lets_go, stage, goes))
    lets_go = c.use(mode_lets_go, after)
    c.show(c.implies(seen.has, c.same(lets_go, goes)), "it lets it go where all of them do")
    c.show(c.implies(watched, c.negation(lets_go)), "and only what it has")
