"""A hold that is taken to be clear of an intruder for ever does not enter its cylinder at any instant from now on,
whatever place the vehicle has within rho of its reference and the intruder in its tube."""

from cratous.core.permit.for_ever import above_for_ever, beside_for_ever, hold_clear
from cratous.core.permit.pieces import Growth
from cratous.proofs.claim import Claim
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    sz, vz, rho, radius, half, t = c.reals("sz vz rho radius half t")
    wide = Growth(*c.reals("wide_start wide_rate wide_gain"))
    high = Growth(*c.reals("high_start high_rate high_gain"))
    own, other = (motion.Off(*c.reals(f"{n}_x {n}_y {n}_z")) for n in ("own", "other"))
    for growth in (wide, high):
        c.premise(c.all_of(growth.start_m >= 0, growth.rate_m_s >= 0, growth.gain_m_s2 >= 0))
    c.premise(c.all_of(rho >= 0, radius >= 0, half >= 0))
    c.premise(t >= 0)
    c.opaque(
        above_for_ever, beside_for_ever, motion.reached_at, motion.levelled_at, motion.enters_at
    )
    clear = c.use(hold_clear, s, v, sz, vz, wide, high, radius, half, rho)
    around = Growth(wide.start_m + radius + rho, wide.rate_m_s, wide.gain_m_s2)
    layer = Growth(high.start_m + half + rho, high.rate_m_s, high.gain_m_s2)
    named = {"start": layer.start_m, "rate": layer.rate_m_s, "gain": layer.gain_m_s2, "t": t}
    for z, w in ((sz, vz), (0 - sz, 0 - vz)):
        c.lemma("permit_above_for_ever_has_no_instant", sz=z, vz=w, **named)
    wider = {"start": around.start_m, "rate": around.rate_m_s, "gain": around.gain_m_s2, "t": t}
    c.lemma("permit_beside_for_ever_has_no_instant", s=s, v=v, **wider)
    hit = c.define(motion.hit_at, s, v, sz, vz, own, other, rho, wide, high, radius, half, t)
    tubes = {
        "wide_start": wide.start_m, "wide_rate": wide.rate_m_s, "wide_gain": wide.gain_m_s2,
        "high_start": high.start_m, "high_rate": high.rate_m_s, "high_gain": high.gain_m_s2,
    }  # fmt: skip
    offs = {"own_x": own.x, "own_y": own.y, "own_z": own.z}
    others = {"other_x": other.x, "other_y": other.y, "other_z": other.z}
    size = {"rho": rho, "radius": radius, "half": half}
    c.lemma(
        "permit_entered_is_near", s=s, v=v, sz=sz, vz=vz, t=t, **size, **tubes, **offs, **others
    )
    c.show(c.implies(clear, c.negation(hit)))
