"""Theorems on detecting a violation of well clear in [B, T], for the volumes tau_mod, tcpa and tep.

Each function states one theorem for any of these volumes.
"""

from __future__ import annotations

from typing import Any

from cratous.core.kernel import Vec2
from cratous.core.well_clear import layer_window
from cratous.core.well_clear.thresholds import Thresholds
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_instants, any_loss
from cratous.proofs.methods.kinds import Volume
from cratous.spec import well_clear

LAYER = (layer_window, well_clear.layer_violation)
"""The vertical part, which theorems on the whole volume use through lemmas."""


def named_instant(
    c: Claim, volume: Volume, asked: tuple[Any, ...], limits: Thresholds, witness: Any
) -> None:
    """Premise: `witness` is the instant of the detected violation, given by the equation that defines it.

    asked: the state, and begin and end of the window; witness: an arbitrary real.
    """
    s, v, sz, vz, begin, end = asked
    dthr, zthr, tthr, tcoa, vmod = limits
    k, low, high = c.use(layer_window, sz + begin * vz, vz, zthr, tcoa, vmod, end - begin)
    at = Vec2(
        (s.x + begin * v.x) * k + low * v.x,
        (s.y + begin * v.y) * k + low * v.y,
    )
    scaled, _ = c.use(volume.flat.interval, at, v, dthr * k, tthr * k, low - low, high - low)
    c.premise(c.implies(k > 0, k * (witness - begin) == low + scaled))


def detection_has_a_witness(c: Claim, volume: Volume) -> None:
    """Where a volume is detected in [B, T], the first instant of the horizontal span in the window violates it."""
    s, v, sz, vz, limits = any_loss(c)
    dthr, zthr, tthr, tcoa, vmod = limits
    begin, end, t = c.reals("begin end t")
    c.opaque(volume.flat.interval, volume.flat.during, volume.meant.flat, *LAYER)
    detected = c.use(volume.space.during, s, v, sz, vz, limits, begin, end)
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
    c.lemma(
        f"well_clear_horizontal_detection_{volume.name}_is_the_interval",
        when=some,
        h=length,
        **flat,
    )
    zero = first - first
    span = {"begin": zero, "end": length, **flat}
    c.lemma(f"well_clear_horizontal_interval_{volume.name}_lies_within", when=some, **span)
    scaled, until = c.use(volume.flat.interval, at, v, dthr * k, tthr * k, zero, length)
    found = c.all_of(some, scaled <= until)
    # the instant, named by the equation that defines it
    c.premise(c.implies(k > 0, k * (t - begin) == first + scaled))
    c.lemma(f"well_clear_horizontal_interval_{volume.name}_is_exact", when=found, t=scaled, **span)
    c.lemma("well_clear_layer_window_is_exact", when=found, t=t - begin, **window)
    there = Vec2(s.x + t * v.x, s.y + t * v.y)
    c.lemma(
        f"well_clear_{volume.flat.now.__name__}_scales",
        when=found,
        s=there,
        v=v,
        dthr=dthr,
        tthr=tthr,
        k=k,
    )
    c.congruence(
        volume.meant.flat,
        (Vec2(at.x + scaled * v.x, at.y + scaled * v.y), v, dthr * k, tthr * k),
        (Vec2(k * there.x, k * there.y), v, k * dthr, k * tthr),
    )
    lost = c.define(volume.meant.at, s, v, sz, vz, limits, t)
    c.show(c.implies(detected, c.all_of(begin <= t, t <= end, lost)), "lost at the instant")


def detection_is_the_interval(c: Claim, volume: Volume) -> None:
    """A volume is detected in [B, T] exactly where the span of its interval is not empty."""
    s, v, sz, vz, limits = any_loss(c)
    dthr, zthr, tthr, tcoa, vmod = limits
    begin, end, witness = c.reals("begin end witness")
    c.opaque(
        volume.flat.interval,
        layer_window,
        volume.space.during,
        volume.space.interval,
        volume.meant.at,
    )
    detected = c.use(volume.space.during, s, v, sz, vz, limits, begin, end)
    first, last = c.use(volume.space.interval, s, v, sz, vz, limits, begin, end)
    values = {
        "s": s, "v": v, "sz": sz, "vz": vz, "begin": begin, "end": end,
        "dthr": dthr, "zthr": zthr, "tthr": tthr, "tcoa": tcoa, "vmod": vmod,
    }  # fmt: skip
    named_instant(c, volume, (s, v, sz, vz, begin, end), limits, witness)
    c.lemma(f"well_clear_detection_{volume.name}_has_a_witness", t=witness, **values)
    c.lemma(f"well_clear_interval_{volume.name}_is_exact", when=detected, t=witness, **values)
    c.lemma(f"well_clear_interval_{volume.name}_first_and_last_violate", **values)
    c.lemma(
        f"well_clear_detection_{volume.name}_misses_no_instant",
        when=first <= last,
        t=first,
        **values,
    )
    c.show(c.same(detected, first <= last))


def detection_misses_no_instant(c: Claim, volume: Volume) -> None:
    """Where no volume is detected in [B, T], no instant of it violates the volume."""
    s, v, sz, vz, limits = any_loss(c)
    dthr, zthr, tthr, tcoa, vmod = limits
    begin, t, end = any_instants(c, "begin t end")
    c.opaque(volume.flat.interval, volume.flat.during, volume.meant.flat, *LAYER)
    detected = c.use(volume.space.during, s, v, sz, vz, limits, begin, end)
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
        f"well_clear_horizontal_interval_{volume.name}_is_exact",
        when=inside,
        begin=first - first,
        end=length,
        t=since,
        **flat,
    )
    c.lemma(
        f"well_clear_horizontal_detection_{volume.name}_is_the_interval",
        when=inside,
        h=length,
        **flat,
    )
    there = Vec2(s.x + t * v.x, s.y + t * v.y)
    c.lemma(
        f"well_clear_{volume.flat.now.__name__}_scales", s=there, v=v, dthr=dthr, tthr=tthr, k=k
    )
    lost = c.define(volume.meant.at, s, v, sz, vz, limits, t)
    c.show(c.implies(lost, detected))


def horizontal_detection_is_the_interval(c: Claim, volume: Volume) -> None:
    """The horizontal detection over [0, h] says yes exactly where the span over it is not empty."""
    s, v = c.vector("s"), c.vector("v")
    dthr, tthr, h = c.reals("dthr tthr h")
    for nonnegative in (dthr, tthr, h):
        c.premise(nonnegative >= 0)
    detected = c.use(volume.flat.during, s, v, dthr, tthr, h)
    first, last = c.use(volume.flat.interval, s, v, dthr, tthr, h - h, h)
    c.show(c.same(detected, first <= last))
