"""If the kernel says that well clear holds during [0, h] of straight flight, then at no instant of
[0, h] is it lost, for every relative state in space and all thresholds not below zero."""

from cratous.core.kernel import Vec2
from cratous.core.well_clear import horizontal_violation_within, vertical_window, violation_within
from cratous.core.well_clear.thresholds import StandardThresholds
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    sz, vz, dthr, zthr, tthr, tcoa, h, t = c.reals("sz vz dthr zthr tthr tcoa h t")
    for nonnegative in (dthr, zthr, tthr, tcoa, t):
        c.premise(nonnegative >= 0)
    c.premise(t <= h)
    c.opaque(
        horizontal_violation_within,
        vertical_window,
        well_clear.horizontal_violation,
        well_clear.vertical_violation_at,
    )
    limits = StandardThresholds(dthr, zthr, tthr, tcoa)
    predicted = c.use(violation_within, s, v, sz, vz, limits, h)
    k, first, last = c.use(vertical_window, sz, vz, zthr, tcoa, h)
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
