"""If the kernel says that well clear is lost during [0, h] of straight flight, then it is lost at an
instant of [0, h] that can be named: an end of the vertical window, the closest approach, or the
instant of least modified-tau margin."""

from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.proofs.methods.predictions import any_prediction
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    (s, v, sz, vz), limits, h, predicted, (k, first, last) = any_prediction(c)
    dthr, zthr, tthr, tcoa = limits
    c.premise(h >= 0)
    window = {"sz": sz, "vz": vz, "zthr": zthr, "tcoa": tcoa, "h": h}
    c.lemma("well_clear_vertical_window_is_exact", t=h - h, **window)

    # the two inner candidates, named by the equations that define them
    at = Vec2(s.x * k + first * v.x, s.y * k + first * v.y)
    vv, sv = v.x * v.x + v.y * v.y, at.x * v.x + at.y * v.y
    closest, least = c.reals("closest least")
    c.premise(c.implies(vv > 0, vv * closest + sv == 0))
    c.premise(c.implies(vv > 0, 2 * vv * least + 2 * sv + tthr * k * vv == 0))
    lost, length = [], last - first
    for number, scaled in enumerate((length - length, length, closest, least)):
        t = c.real(f"t{number}")
        c.premise(k * t == first + scaled)
        inside = c.all_of(t >= 0, t <= h)
        there = Vec2(s.x + t * v.x, s.y + t * v.y)
        c.lemma("well_clear_vertical_window_is_exact", when=inside, t=t, **window)
        c.lemma("well_clear_horizontal_violation_scales", s=there, v=v, dthr=dthr, tthr=tthr, k=k)
        c.congruence(
            well_clear.horizontal_violation,
            (Vec2(at.x + scaled * v.x, at.y + scaled * v.y), v, dthr * k, tthr * k),
            (Vec2(k * there.x, k * there.y), v, k * dthr, k * tthr),
        )
        violated = c.define(well_clear.violation_at, s, v, sz, vz, limits, t)
        lost.append(c.all_of(inside, violated))
        there_at = c.define(well_clear.horizontal_violation_at, at, v, dthr * k, tthr * k, scaled)
        named = c.all_of(predicted, scaled >= 0, scaled <= length, there_at)
        c.step(c.implies(named, lost[-1]), "at the instant whose scaled time it is")
    c.lemma(
        "well_clear_horizontal_violation_within_has_a_witness",
        when=first <= last,
        s=at,
        v=v,
        dthr=dthr * k,
        tthr=tthr * k,
        h=length,
        closest=closest,
        least=least,
    )
    c.show(c.implies(predicted, c.any_of(*lost)))
