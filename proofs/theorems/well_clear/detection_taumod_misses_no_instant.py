"""If the kernel says that well clear by taumod holds during [B, T] of straight flight, then at no
instant of [B, T] is it lost, for every relative state in space and all thresholds not below zero,
vertically by TCOA or VMOD."""

from cratous.core.kernel import Vec2
from cratous.core.well_clear import (
    horizontal_interval_taumod,
    horizontal_violation_within,
    layer_window,
    violation_during_taumod,
)
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    sz, vz, dthr, zthr, tthr, tcoa, vmod = c.reals("sz vz dthr zthr tthr tcoa vmod")
    begin, end, t = c.reals("begin end t")
    for threshold in (dthr, zthr, tthr, tcoa, vmod):
        c.premise(threshold >= 0)
    c.premise(begin <= t)
    c.premise(t <= end)
    c.opaque(
        horizontal_interval_taumod,
        horizontal_violation_within,
        layer_window,
        well_clear.horizontal_violation,
        well_clear.layer_violation,
    )
    limits = (dthr, zthr, tthr, tcoa, vmod)
    detected = c.use(violation_during_taumod, s, v, sz, vz, *limits, begin, end)
    up = {"sz": sz + begin * vz, "vz": vz, "zthr": zthr, "tcoa": tcoa, "vmod": vmod}
    c.lemma("well_clear_layer_window_is_exact", h=end - begin, t=t - begin, **up)
    k, first, last = c.use(layer_window, sz + begin * vz, vz, zthr, tcoa, vmod, end - begin)
    since = (t - begin) * k - first
    inside = c.all_of(since >= 0, since <= last - first)
    at = Vec2(
        (s.x + begin * v.x) * k + first * v.x,
        (s.y + begin * v.y) * k + first * v.y,
    )
    flat = {"s": at, "v": v, "dthr": dthr * k, "tthr": tthr * k}
    length = last - first
    c.lemma(
        "well_clear_horizontal_interval_taumod_is_exact",
        when=inside,
        begin=first - first,
        end=length,
        t=since,
        **flat,
    )
    c.lemma("well_clear_horizontal_detection_taumod_is_the_interval", when=inside, h=length, **flat)
    there = Vec2(s.x + t * v.x, s.y + t * v.y)
    c.lemma("well_clear_horizontal_violation_scales", s=there, v=v, dthr=dthr, tthr=tthr, k=k)
    lost = c.define(well_clear.violation_taumod_at, s, v, sz, vz, *limits, t)
    c.show(c.implies(lost, detected))
