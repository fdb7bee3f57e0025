"""If the kernel says that well clear by tep is lost during [B, T] of straight flight, then it is
lost at an instant of [B, T] that can be named: the first one of the horizontal span within the
vertical window."""

from cratous.core.kernel import Vec2
from cratous.core.well_clear import (
    horizontal_interval_tep,
    horizontal_violation_within_tep,
    layer_window,
    violation_during_tep,
)
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    sz, vz, dthr, zthr, tthr, tcoa, vmod = c.reals("sz vz dthr zthr tthr tcoa vmod")
    begin, end, t = c.reals("begin end t")
    for threshold in (dthr, zthr, tthr, tcoa, vmod):
        c.premise(threshold >= 0)
    c.opaque(
        horizontal_interval_tep,
        horizontal_violation_within_tep,
        layer_window,
        well_clear.horizontal_violation_tep,
        well_clear.layer_violation,
    )
    limits = (dthr, zthr, tthr, tcoa, vmod)
    detected = c.use(violation_during_tep, s, v, sz, vz, *limits, begin, end)
    c.show(c.implies(begin > end, c.negation(detected)), "nothing where B is after T")
    up = {"sz": sz + begin * vz, "vz": vz, "zthr": zthr, "tcoa": tcoa, "vmod": vmod}
    runs = begin <= end
    window = {"h": end - begin, **up}
    c.lemma("well_clear_layer_window_is_exact", when=runs, t=begin - begin, **window)
    k, first, last = c.use(layer_window, sz + begin * vz, vz, zthr, tcoa, vmod, end - begin)
    at = Vec2(
        (s.x + begin * v.x) * k + first * v.x,
        (s.y + begin * v.y) * k + first * v.y,
    )
    flat = {"s": at, "v": v, "dthr": dthr * k, "tthr": tthr * k}
    length = last - first
    some = c.all_of(runs, first <= last)
    c.lemma("well_clear_horizontal_detection_tep_is_the_interval", when=some, h=length, **flat)
    zero = first - first
    span = {"begin": zero, "end": length, **flat}
    c.lemma("well_clear_horizontal_interval_tep_lies_within", when=some, **span)
    scaled, until = c.use(horizontal_interval_tep, at, v, dthr * k, tthr * k, zero, length)
    found = c.all_of(some, scaled <= until)
    # the instant, named by the equation that defines it
    c.premise(c.implies(k > 0, k * (t - begin) == first + scaled))
    c.lemma("well_clear_horizontal_interval_tep_is_exact", when=found, t=scaled, **span)
    c.lemma("well_clear_layer_window_is_exact", when=found, t=t - begin, **window)
    there = Vec2(s.x + t * v.x, s.y + t * v.y)
    c.lemma(
        "well_clear_horizontal_violation_tep_scales",
        when=found,
        s=there,
        v=v,
        dthr=dthr,
        tthr=tthr,
        k=k,
    )
    c.congruence(
        well_clear.horizontal_violation_tep,
        (Vec2(at.x + scaled * v.x, at.y + scaled * v.y), v, dthr * k, tthr * k),
        (Vec2(k * there.x, k * there.y), v, k * dthr, k * tthr),
    )
    lost = c.define(well_clear.violation_tep_at, s, v, sz, vz, *limits, t)
    c.show(c.implies(detected, c.all_of(begin <= t, t <= end, lost)), "lost at the instant")
