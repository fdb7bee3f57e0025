"""The horizontal volume with tcpa does not depend on the unit of length or time: position, DTHR and TTHR
scaled by the same positive factor give the same verdict."""

from cratous.core.kernel import Vec2
from cratous.core.well_clear import horizontal_violation_tcpa
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    dthr, tthr, k = c.reals("dthr tthr k")
    c.premise(dthr >= 0)
    c.premise(tthr >= 0)
    c.premise(k > 0)
    scaled = Vec2(k * s.x, k * s.y)
    c.lemma(
        "well_clear_horizontal_violation_tcpa_is_its_definition", s=s, v=v, dthr=dthr, tthr=tthr
    )
    c.lemma(
        "well_clear_horizontal_violation_tcpa_is_its_definition",
        s=scaled,
        v=v,
        dthr=k * dthr,
        tthr=k * tthr,
    )
    near = c.use(horizontal_violation_tcpa, s, v, dthr, tthr)
    far = c.use(horizontal_violation_tcpa, scaled, v, k * dthr, k * tthr)
    c.show(c.same(near, far), "the kernel does not")
    c.show(
        c.same(
            c.define(well_clear.horizontal_violation_tcpa, s, v, dthr, tthr),
            c.define(well_clear.horizontal_violation_tcpa, scaled, v, k * dthr, k * tthr),
        ),
        "the definition does not",
    )
