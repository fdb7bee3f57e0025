"""The horizontal volume does not depend on where north is: position and velocity turned by one angle give
the same verdict."""

from itertools import pairwise

from cratous.core.kernel import Vec2
from cratous.core.well_clear import horizontal_decision, horizontal_violation
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v, by = c.vector("s"), c.vector("v"), c.vector("by")
    dthr, tthr = c.reals("dthr tthr")
    c.premise(dthr >= 0)
    c.premise(tthr >= 0)
    # cosine and sine of the angle
    c.premise(by.x * by.x + by.y * by.y == 1)
    p, q = (Vec2(w.x * by.x - w.y * by.y, w.x * by.y + w.y * by.x) for w in (s, v))
    c.opaque(horizontal_decision)
    for at, speed in ((s, v), (p, q)):
        c.lemma(
            "well_clear_horizontal_violation_is_its_definition", s=at, v=speed, dthr=dthr, tthr=tthr
        )
    here = c.use(horizontal_violation, s, v, dthr, tthr)
    turned = c.use(horizontal_violation, p, q, dthr, tthr)
    for one, other in pairwise(c.calls(horizontal_decision)):
        c.congruence(horizontal_decision, one, other)
    c.show(c.same(here, turned), "the kernel does not")
    c.show(
        c.same(
            c.define(well_clear.horizontal_violation, s, v, dthr, tthr),
            c.define(well_clear.horizontal_violation, p, q, dthr, tthr),
        ),
        "the definition does not",
    )
