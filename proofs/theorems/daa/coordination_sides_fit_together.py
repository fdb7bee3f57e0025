"""Two aircraft, each with its own view of one encounter, choose the same horizontal side and opposite
vertical ones: in every state, also where a tie must be broken, whatever the cylinder, if one id is first. Begin, end and
closest name instants (when heights are within the half height, and the closest approach)."""

from cratous.core.daa.coordination import enters_cylinder, horizontal_side, vertical_side
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    sz, vz, radius, half = c.reals("sz vz radius half")
    first = c.boolean("first")
    c.premise(radius >= 0)
    c.premise(half >= 0)
    begin, end, closest = c.reals("begin end closest")
    vv, sv = v.x * v.x + v.y * v.y, s.x * v.x + s.y * v.y
    c.premise(c.implies(vv > 0, vv * closest + sv == 0))
    c.premise(c.implies(vz > 0, c.all_of(begin * vz == 0 - half - sz, end * vz == half - sz)))
    c.premise(c.implies(vz < 0, c.all_of(begin * vz == half - sz, end * vz == 0 - half - sz)))
    back = (Vec2(0 - s.x, 0 - s.y), Vec2(0 - v.x, 0 - v.y), 0 - sz, 0 - vz)
    mine, theirs = c.use(horizontal_side, s, v), c.use(horizontal_side, back[0], back[1])
    c.show(mine == theirs, "the same hand")
    c.show(c.any_of(mine == 1, mine == -1), "a side")
    c.opaque(enters_cylinder)
    c.lemma(
        "daa_coordination_both_see_the_cylinder_entered",
        s=s, v=v, sz=sz, vz=vz, radius=radius, half=half, begin=begin, end=end, closest=closest,
    )  # fmt: skip
    enters = c.use(enters_cylinder, s, v, sz, vz, radius, half)
    seen = c.use(enters_cylinder, *back, radius, half)
    together = c.all_of(s.x == 0, s.y == 0, sz == 0)
    above = c.use(vertical_side, sz, vz, vv, sv, together, enters, first)
    r, w, z, u = back
    ww, rw = w.x * w.x + w.y * w.y, r.x * w.x + r.y * w.y
    there = c.all_of(r.x == 0, r.y == 0, z == 0)
    below = c.use(vertical_side, z, u, ww, rw, there, seen, c.negation(first))
    c.show(above == 0 - below, "one above, one below")
    c.show(c.any_of(above == 1, above == -1), "above or below")
