"""Whatever is free earlier, may start from earlier on and refers to earlier times starts no later: so a
state that is nowhere later than another loses nothing against it, whatever is done next."""

from cratous.core.assignment.steps import earliest_start
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    travel = c.integer("travel")
    free, floor, ref = (c.integer(x) for x in ["free", "floor", "ref"])
    free2, floor2, ref2 = (c.integer(x) for x in ["free2", "floor2", "ref2"])
    for time in (travel, free, floor, ref):
        c.premise(time >= 0)
    c.premise(free2 + travel <= 2**61)
    for one, other in ((free, free2), (floor, floor2), (ref, ref2)):
        c.premise(one <= other)
    first = c.use(earliest_start, free, travel, floor, ref)
    second = c.use(earliest_start, free2, travel, floor2, ref2)
    c.show(first <= second, "it starts no later")
    c.show(c.implies(floor >= free, first >= floor), "starts do not go back")
