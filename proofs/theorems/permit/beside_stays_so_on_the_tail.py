"""Where a piece is taken to be beside a tube, so is what is left of it after any part has been flown."""

from cratous.core.kernel import Vec2
from cratous.core.permit.pieces import beside_during, growth_after
from cratous.core.well_clear import dips_to_zero
from cratous.proofs.claim import Claim
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    start, rate, gain, d, k = c.reals("start rate gain d k")
    growth = motion.Growth(start, rate, gain)
    c.premise(c.all_of(start >= 0, rate >= 0, gain >= 0))
    c.premise(c.all_of(k >= 0, k <= d))
    c.opaque(dips_to_zero)
    beside = c.use(beside_during, s, v, growth, d)
    left = c.use(growth_after, growth, k)
    there, rest = Vec2(s.x + k * v.x, s.y + k * v.y), d - k
    after = c.use(beside_during, there, v, left, rest)
    (a, b, e), (p, q, r) = (
        (
            v.x * v.x + v.y * v.y - chord * chord,
            2 * (at.x * v.x + at.y * v.y - g.start_m * chord),
            at.x * at.x + at.y * at.y - g.start_m * g.start_m,
        )
        for at, g, chord in (
            (s, growth, rate + d * gain),
            (there, left, left.rate_m_s + rest * left.gain_m_s2),
        )
    )
    vertex = c.when(p > 0, (0 - q) / (2 * c.when(p > 0, p, p - p + 1)), p - p)
    c.step(c.implies(p > 0, 2 * p * vertex + q == 0), "the closest approach")
    tube = {"start": start, "rate": rate, "gain": gain}
    for t in (d - d, rest, vertex):
        inside = c.all_of(t >= 0, t <= rest)
        c.lemma(
            "permit_chord_of_the_tail_is_no_higher", when=inside, s=s, v=v, d=d, k=k, t=t, **tube
        )
    c.lemma(
        "permit_parabola_above_another_dips_no_sooner",
        a=a, b=b, c=e, p=p, q=q, r=r, h=d, gone=k, vertex=vertex,
    )  # fmt: skip
    c.show(c.implies(beside, after))
