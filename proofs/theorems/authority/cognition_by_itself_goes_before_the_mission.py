"""Without the link, or after a declared failure, the vehicle is by itself: it is never under UxAS, on its way back or
merging, ICAROUS has to have it and does not let it go. A final descent is left for the ground alone, and a vehicle that
has landed stays there, whatever else is the case."""

from cratous.core.authority.cognition import decide, mode_lets_go, mode_takes
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_conditions
from cratous.spec.authority import cognition


def claim(c: Claim) -> None:
    before, seen = any_conditions(c)
    after = c.use(decide, before, seen)
    alone = seen.alone
    c.show(c.implies(alone, after >= cognition.LOST_LINK), "the mission's modes are left")
    c.show(c.implies(alone, c.use(mode_takes, after)), "ICAROUS has to have it")
    c.show(c.implies(alone, c.negation(c.use(mode_lets_go, after))), "and keeps it")
    undisturbed = c.all_of(
        alone, c.negation(c.any_of(seen.traffic, seen.fence, seen.departs, seen.descends)),
        c.negation(seen.landed), before < cognition.LAND,
    )  # fmt: skip
    to_land = c.all_of(undisturbed, seen.lands)
    c.show(c.implies(to_land, after == cognition.DITCH), "to its landing site")
    fails = c.all_of(undisturbed, seen.failed, c.negation(seen.lands))
    c.show(c.implies(fails, after == cognition.FAILED), "or what follows its failure")
    lost = c.all_of(undisturbed, c.negation(c.any_of(seen.failed, seen.lands)))
    c.show(c.implies(lost, after == cognition.LOST_LINK), "or what is flown without the link")

    lands = before == cognition.LAND
    ground = c.all_of(lands, seen.landed)
    c.show(c.implies(ground, after == cognition.LANDED), "a descent ends on the ground")
    falls = c.all_of(lands, c.negation(seen.landed))
    c.show(c.implies(falls, after == cognition.LAND), "and is left for nothing else")
    stays = before == cognition.LANDED
    c.show(c.implies(stays, after == cognition.LANDED), "who has landed stays")
