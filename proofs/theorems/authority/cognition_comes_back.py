"""From every mode but those of a landing, if ICAROUS has the vehicle and
nothing else is the case, the vehicle is on its way back at the same heartbeat; when UxAS has it then, on its plan, the
mode is nominal at the next one."""

from cratous.core.authority.cognition import Conditions, decide, mode_lets_go, mode_takes
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_conditions
from cratous.spec.authority import cognition


def claim(c: Claim) -> None:
    before, seen = any_conditions(c)
    flies = c.all_of(before >= cognition.NOMINAL, before < cognition.LAND)
    clear = c.negation(
        c.any_of(
            seen.landed, seen.descends, seen.departs, seen.traffic, seen.fence, seen.alone,
            seen.merges,
        )
    )  # fmt: skip
    c.premise(c.all_of(flies, clear))
    after = c.use(decide, before, seen)
    back = c.any_of(after == cognition.RETURN_TO_PATH, after == cognition.NEXT_WAYPOINT)
    c.show(c.implies(seen.has, back), "it is on its way back")
    c.show(c.implies(seen.has, c.use(mode_lets_go, after)), "and may be offered")
    uxas = c.negation(seen.has)
    on_plan = c.all_of(uxas, c.negation(seen.deviates))
    no = False
    none = Conditions(no, no, no, no, no, no, no, no, no, no, no, no)
    c.show(c.use(decide, after, none) == cognition.NOMINAL, "then it is nominal")
    c.show(c.implies(on_plan, after == cognition.NOMINAL), "at once under UxAS")
    c.show(c.implies(uxas, c.negation(c.use(mode_takes, after))), "which ICAROUS leaves it to")
