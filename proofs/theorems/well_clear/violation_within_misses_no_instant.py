"""If the kernel says that well clear holds during [0, h] of straight flight, then at no instant of
[0, h] is it lost, for every relative state in space and all thresholds not below zero."""

from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.proofs.methods.predictions import any_prediction
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    (s, v, sz, vz), limits, h, predicted, (k, first, last) = any_prediction(c)
    dthr, zthr, tthr, tcoa = limits
    t = c.real("t")
    c.premise(c.all_of(t >= 0, t <= h))
    c.lemma("well_clear_vertical_window_is_exact", sz=sz, vz=vz, zthr=zthr, tcoa=tcoa, h=h, t=t)
    inside = c.all_of(first <= t * k, t * k <= last)
    at = Vec2(s.x * k + first * v.x, s.y * k + first * v.y)
    c.lemma(
        "well_clear_horizontal_violation_within_misses_no_instant",
        when=inside,
        s=at,
        v=v,
        dthr=dthr * k,
        tthr=tthr * k,
        h=last - first,
        t=t * k - first,
    )
    there = Vec2(s.x + t * v.x, s.y + t * v.y)
    c.lemma("well_clear_horizontal_violation_scales", s=there, v=v, dthr=dthr, tthr=tthr, k=k)
    lost = c.define(well_clear.violation_at, s, v, sz, vz, limits, t)
    c.show(c.implies(lost, predicted))
