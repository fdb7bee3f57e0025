"""Traffic and zones are watched in every mode: whatever the mode was, a conflict with one of them is avoided from the same
heartbeat on, unless the take-off is not over, the final descent has begun or the vehicle is on the ground. Nothing is
avoided without such a conflict, and while one is avoided the vehicle is not offered to UxAS."""

from cratous.core.authority.cognition import decide, mode_avoids, mode_lets_go, mode_takes
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_conditions
from cratous.spec.authority import cognition


def claim(c: Claim) -> None:
    before, seen = any_conditions(c)
    after = c.use(decide, before, seen)
    conflict = c.any_of(seen.traffic, seen.fence)
    committed = c.any_of(
        seen.departs, seen.descends, seen.landed,
        before == cognition.LAND, before == cognition.LANDED,
    )  # fmt: skip
    avoids = c.use(mode_avoids, after)
    answered = c.all_of(conflict, c.negation(committed))
    c.show(c.implies(answered, avoids), "a conflict is avoided")
    c.show(c.implies(avoids, conflict), "nothing is avoided without a conflict")
    traffic = c.all_of(answered, seen.traffic)
    c.show(c.implies(traffic, after == cognition.TRAFFIC_CONFLICT), "traffic before zones")
    c.show(c.implies(avoids, c.use(mode_takes, after)), "ICAROUS has to have it")
    c.show(c.implies(avoids, c.negation(c.use(mode_lets_go, after))), "and keeps it")
