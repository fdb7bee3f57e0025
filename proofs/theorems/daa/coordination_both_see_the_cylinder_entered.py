"""Whether two aircraft will be in one cylinder is for the kernel the same seen from either of them."""

from cratous.core.daa.coordination import enters_cylinder
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_cylinder
from cratous.spec.daa import coordination as daa_coordination

EXACT = "daa_coordination_cylinder_is_entered_exactly"


def claim(c: Claim) -> None:
    s, v, sz, vz, radius, half = any_cylinder(c)
    begin, end, closest = c.reals("begin end closest")
    vv, sv = v.x * v.x + v.y * v.y, s.x * v.x + s.y * v.y
    c.premise(c.implies(vv > 0, vv * closest + sv == 0))
    # when the heights are within half of each other
    c.premise(c.implies(vz > 0, c.all_of(begin * vz == 0 - half - sz, end * vz == half - sz)))
    c.premise(c.implies(vz < 0, c.all_of(begin * vz == half - sz, end * vz == 0 - half - sz)))
    ours = {"s": s, "v": v, "sz": sz, "vz": vz}
    theirs = {
        "s": Vec2(0 - s.x, 0 - s.y), "v": Vec2(0 - v.x, 0 - v.y), "sz": 0 - sz, "vz": 0 - vz,
    }  # fmt: skip
    size = {"radius": radius, "half": half}
    times = {"begin": begin, "end": end, "closest": closest}
    c.opaque(enters_cylinder, daa_coordination.in_cylinder_at)
    for t in (vz - vz, begin, end, closest):
        c.lemma("daa_coordination_cylinder_looks_the_same", t=t, **ours, **size)
        for view in (ours, theirs):
            # the lemma is about pairs that climb against each other
            asked = c.all_of(t >= 0, c.negation(vz == 0))
            c.lemma(EXACT, when=asked, t=t, **times, **view, **size)
    mine = c.use(enters_cylinder, *ours.values(), radius, half)
    c.show(c.same(mine, c.use(enters_cylinder, *theirs.values(), radius, half)))
