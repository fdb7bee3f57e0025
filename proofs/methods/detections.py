"""Theorems on detecting a well-clear volume in [B, T], stated alike for tau_mod, tcpa and tep.

Each function states one of them; the theorems give it the kernels and definitions of their volume.
Names: `horizontal_*` and `violation_*` are kernels (in the plane, in space), `meant_*` definitions,
`lemmas` the names of the theorems that it rests on, which are of the same volume.
"""

from __future__ import annotations

from typing import Any

from cratous.core.kernel import Vec2
from cratous.core.well_clear import layer_window
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_instants, any_state, any_thresholds
from cratous.spec import well_clear


def detection_has_a_witness(
    c: Claim,
    lemmas: tuple[str, ...],
    horizontal_during: Any,
    horizontal_interval: Any,
    violation_during: Any,
    meant_horizontally: Any,
    meant_at: Any,
) -> None:
    """Where a volume is detected in [B, T], the first instant of the horizontal span in the window violates it."""
    flat_detection, flat_lies_within, flat_is_exact, flat_scales = lemmas
    s, v, sz, vz = any_state(c)
    limits = any_thresholds(c)
    dthr, zthr, tthr, tcoa, vmod = limits
    begin, end, t = c.reals("begin end t")
    c.opaque(
        horizontal_interval,
        horizontal_during,
        layer_window,
        meant_horizontally,
        well_clear.layer_violation,
    )
    detected = c.use(violation_during, s, v, sz, vz, limits, begin, end)
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
    c.lemma(flat_detection, when=some, h=length, **flat)
    zero = first - first
    span = {"begin": zero, "end": length, **flat}
    c.lemma(flat_lies_within, when=some, **span)
    scaled, until = c.use(horizontal_interval, at, v, dthr * k, tthr * k, zero, length)
    found = c.all_of(some, scaled <= until)
    # the instant, named by the equation that defines it
    c.premise(c.implies(k > 0, k * (t - begin) == first + scaled))
    c.lemma(flat_is_exact, when=found, t=scaled, **span)
    c.lemma("well_clear_layer_window_is_exact", when=found, t=t - begin, **window)
    there = Vec2(s.x + t * v.x, s.y + t * v.y)
    c.lemma(
        flat_scales,
        when=found,
        s=there,
        v=v,
        dthr=dthr,
        tthr=tthr,
        k=k,
    )
    c.congruence(
        meant_horizontally,
        (Vec2(at.x + scaled * v.x, at.y + scaled * v.y), v, dthr * k, tthr * k),
        (Vec2(k * there.x, k * there.y), v, k * dthr, k * tthr),
    )
    lost = c.define(meant_at, s, v, sz, vz, limits, t)
    c.show(c.implies(detected, c.all_of(begin <= t, t <= end, lost)), "lost at the instant")


def detection_is_the_interval(
    c: Claim,
    lemmas: tuple[str, ...],
    horizontal_interval: Any,
    violation_during: Any,
    violation_interval: Any,
    meant_at: Any,
) -> None:
    """A volume is detected in [B, T] exactly where the span of its interval is not empty."""
    has_a_witness, is_exact, ends_violate, misses_none = lemmas
    s, v, sz, vz = any_state(c)
    limits = any_thresholds(c)
    dthr, zthr, tthr, tcoa, vmod = limits
    begin, end, witness = c.reals("begin end witness")
    c.opaque(
        horizontal_interval,
        layer_window,
        violation_during,
        violation_interval,
        meant_at,
    )
    detected = c.use(violation_during, s, v, sz, vz, limits, begin, end)
    first, last = c.use(violation_interval, s, v, sz, vz, limits, begin, end)
    values = {
        "s": s, "v": v, "sz": sz, "vz": vz, "begin": begin, "end": end,
        "dthr": dthr, "zthr": zthr, "tthr": tthr, "tcoa": tcoa, "vmod": vmod,
    }  # fmt: skip
    # the instant that stands for a detection, named by the equation that defines it
    k, low, high = c.use(layer_window, sz + begin * vz, vz, zthr, tcoa, vmod, end - begin)
    at = Vec2(
        (s.x + begin * v.x) * k + low * v.x,
        (s.y + begin * v.y) * k + low * v.y,
    )
    scaled, _ = c.use(horizontal_interval, at, v, dthr * k, tthr * k, low - low, high - low)
    c.premise(c.implies(k > 0, k * (witness - begin) == low + scaled))
    c.lemma(has_a_witness, t=witness, **values)
    c.lemma(is_exact, when=detected, t=witness, **values)
    c.lemma(ends_violate, **values)
    c.lemma(misses_none, when=first <= last, t=first, **values)
    c.show(c.same(detected, first <= last))


def detection_misses_no_instant(
    c: Claim,
    lemmas: tuple[str, ...],
    horizontal_during: Any,
    horizontal_interval: Any,
    violation_during: Any,
    meant_horizontally: Any,
    meant_at: Any,
) -> None:
    """Where no volume is detected in [B, T], no instant of it violates the volume."""
    flat_is_exact, flat_detection, flat_scales = lemmas
    s, v, sz, vz = any_state(c)
    limits = any_thresholds(c)
    dthr, zthr, tthr, tcoa, vmod = limits
    begin, t, end = any_instants(c, "begin t end")
    c.opaque(
        horizontal_interval,
        horizontal_during,
        layer_window,
        meant_horizontally,
        well_clear.layer_violation,
    )
    detected = c.use(violation_during, s, v, sz, vz, limits, begin, end)
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
        flat_is_exact,
        when=inside,
        begin=first - first,
        end=length,
        t=since,
        **flat,
    )
    c.lemma(flat_detection, when=inside, h=length, **flat)
    there = Vec2(s.x + t * v.x, s.y + t * v.y)
    c.lemma(flat_scales, s=there, v=v, dthr=dthr, tthr=tthr, k=k)
    lost = c.define(meant_at, s, v, sz, vz, limits, t)
    c.show(c.implies(lost, detected))


def horizontal_detection_is_the_interval(
    c: Claim,
    horizontal_during: Any,
    horizontal_interval: Any,
) -> None:
    """The horizontal detection over [0, h] says yes exactly where the span over it is not empty."""
    s, v = c.vector("s"), c.vector("v")
    dthr, tthr, h = c.reals("dthr tthr h")
    for nonnegative in (dthr, tthr, h):
        c.premise(nonnegative >= 0)
    detected = c.use(horizontal_during, s, v, dthr, tthr, h)
    first, last = c.use(horizontal_interval, s, v, dthr, tthr, h - h, h)
    c.show(c.same(detected, first <= last))
