"""One value more is counted if it reaches the level, and only then; it never lowers the count, a greater value
never counts less, and a higher level is never reached more often: M of N is monotone in the values and
antitone in M. One step; a count is made of these, one for each value."""

from cratous.core.daa.history import count_reached, enough
from cratous.proofs.claim import Claim
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    count, value, level, higher = (c.integer(n) for n in ("count", "value", "level", "higher"))
    low, high, better = c.integer("low"), c.integer("high"), c.integer("better")
    m, more = c.integer("m"), c.integer("more")
    c.premise(level <= higher)
    c.premise(high <= low)
    c.premise(value <= better)
    c.premise(m <= more)
    one = c.use(count_reached, count, value, level)
    c.show(one == c.define(daa_meaning.reached, count, value, level), "definition")
    c.show(c.all_of(one >= count, one <= count + 1), "monotone in the number of values")
    c.show(one <= c.use(count_reached, count, better, level), "monotone in the value")
    both = (c.use(count_reached, low, value, level), c.use(count_reached, high, value, higher))
    c.show(both[1] <= both[0], "antitone in the level")
    c.show(c.implies(c.use(enough, low, more), c.use(enough, low, m)), "antitone in M")
    c.show(c.implies(c.use(enough, high, m), c.use(enough, low, m)), "monotone in the count")
