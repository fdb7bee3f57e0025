"""Theorems on when a well-clear volume is violated, for tau_mod, tcpa and tep.

Each function states one theorem for any of these volumes.
"""

from __future__ import annotations

from cratous.core.well_clear import times_vertical, vertical_interval
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import (
    any_in_the_plane,
    any_instants,
    any_loss,
    by_name,
)
from cratous.proofs.methods.kinds import Volume
from cratous.spec import well_clear


def horizontal_interval_is_exact(c: Claim, volume: Volume) -> None:
    """An instant of [B, T] violates the horizontal volume exactly if it lies in the span."""
    s, v, dthr, tthr = any_in_the_plane(c)
    begin, t, end = any_instants(c, "begin t end")
    span = c.use(volume.flat.interval, s, v, dthr, tthr, begin, end)
    violated = c.define(volume.meant.flat_at, s, v, dthr, tthr, t)
    c.show(c.same(violated, c.define(well_clear.in_span, *span, t)))


def horizontal_interval_lies_within(c: Claim, volume: Volume) -> None:
    """A span that is not empty lies within [B, T]; an empty one is from 1 to 0."""
    s, v, dthr, tthr = any_in_the_plane(c)
    begin, end = c.reals("begin end")
    first, last = c.use(volume.flat.interval, s, v, dthr, tthr, begin, end)
    within = c.all_of(begin <= first, last <= end)
    c.show(c.implies(first <= last, within), "within [B, T]")
    c.show(c.implies(first > last, c.all_of(first == 1, last == 0)), "one empty span")
    c.show(c.implies(begin > end, first > last), "nothing where B is after T")


def interval_ends_violate(c: Claim, volume: Volume) -> None:
    """The first and the last instant of a span violate the volume; an empty span is from 1 to 0."""
    s, v, sz, vz, limits = any_loss(c)
    dthr, zthr, tthr, tcoa, vmod = limits
    begin, end = c.reals("begin end")
    c.opaque(
        volume.flat.interval,
        vertical_interval,
        volume.meant.flat_at,
        well_clear.layer_violation_at,
    )
    state = {"s": s, "v": v, "sz": sz, "vz": vz, "begin": begin, "end": end}
    size = by_name(limits)
    first, last = c.use(volume.space.interval, s, v, sz, vz, limits, begin, end)
    up = {"sz": sz, "vz": vz, "zthr": zthr, "tcoa": tcoa, "vmod": vmod}
    c.lemma("well_clear_vertical_interval_lies_within", begin=begin, end=end, **up)
    low, high = c.use(vertical_interval, sz, vz, zthr, tcoa, vmod, begin, end)
    flat = {"s": s, "v": v, "dthr": dthr, "tthr": tthr, "begin": low, "end": high}
    c.lemma(f"well_clear_horizontal_interval_{volume.name}_lies_within", **flat)
    within = c.all_of(begin <= first, last <= end)
    c.show(c.implies(first <= last, within), "within [B, T]")
    c.show(c.implies(first > last, c.all_of(first == 1, last == 0)), "one empty span")
    for name, t in (("first", first), ("last", last)):
        c.lemma(
            f"well_clear_interval_{volume.name}_is_exact", when=first <= last, t=t, **state, **size
        )
        arguments = (s, v, sz, vz, limits, t)
        lost = c.define(volume.meant.at, *arguments)
        c.show(c.implies(first <= last, lost), f"lost at the {name} instant")


def interval_is_exact(c: Claim, volume: Volume) -> None:
    """An instant of [B, T] violates the volume exactly if it lies in the span."""
    s, v, sz, vz, limits = any_loss(c)
    dthr, zthr, tthr, tcoa, vmod = limits
    begin, t, end = any_instants(c, "begin t end")
    c.opaque(
        volume.flat.interval,
        vertical_interval,
        volume.meant.flat_at,
        well_clear.layer_violation_at,
    )
    span = c.use(volume.space.interval, s, v, sz, vz, limits, begin, end)
    up = {"sz": sz, "vz": vz, "zthr": zthr, "tcoa": tcoa, "vmod": vmod}
    c.lemma("well_clear_vertical_interval_is_exact", begin=begin, end=end, t=t, **up)
    first, last = c.use(vertical_interval, sz, vz, zthr, tcoa, vmod, begin, end)
    flat = {"s": s, "v": v, "dthr": dthr, "tthr": tthr, "begin": first, "end": last}
    inside = c.define(well_clear.in_span, first, last, t)
    c.lemma(f"well_clear_horizontal_interval_{volume.name}_is_exact", when=inside, t=t, **flat)
    c.lemma(f"well_clear_horizontal_interval_{volume.name}_lies_within", **flat)
    arguments = (s, v, sz, vz, limits, t)
    lost = c.define(volume.meant.at, *arguments)
    c.show(c.same(lost, c.define(well_clear.in_span, *span, t)))


def times_are_exact(c: Claim, volume: Volume) -> None:
    """If an instant of [B, T] violates, the violating instants are those from the first to the last time."""
    s, v, sz, vz, limits = any_loss(c)
    begin, end, some, t = c.reals("begin end some t")
    for instant in (some, t):
        c.premise(c.all_of(begin <= instant, instant <= end))
    c.opaque(volume.space.interval, volume.space.times, volume.meant.at)
    size = by_name(limits)
    state = {"s": s, "v": v, "sz": sz, "vz": vz, "begin": begin, "end": end}
    for instant in (some, t):
        c.lemma(f"well_clear_interval_{volume.name}_is_exact", t=instant, **state, **size)
    c.lemma(f"well_clear_times_{volume.name}_are_the_interval", **state, **size)
    c.premise(c.define(volume.meant.at, s, v, sz, vz, limits, some))
    times = c.use(volume.space.times, s, v, sz, vz, limits, begin, end)
    lost = c.define(volume.meant.at, s, v, sz, vz, limits, t)
    c.show(c.same(lost, c.define(well_clear.in_span, *times, t)))


def times_are_the_interval(c: Claim, volume: Volume) -> None:
    """Where a span is not empty, its ends are the first and last time."""
    s, v, sz, vz, limits = any_loss(c)
    dthr, zthr, tthr, tcoa, vmod = limits
    begin, end = c.reals("begin end")
    up = c.use(vertical_interval, sz, vz, zthr, tcoa, vmod, begin, end)
    plain = c.use(times_vertical, sz, vz, zthr, tcoa, vmod, begin, end)
    c.show(c.implies(up.first_s <= up.last_s, c.same(plain, up)), "vertical")
    flat = c.use(volume.flat.interval, s, v, dthr, tthr, begin, end)
    plain = c.use(volume.flat.times, s, v, dthr, tthr, begin, end)
    c.show(c.implies(flat.first_s <= flat.last_s, c.same(plain, flat)), "horizontal")
    span = c.use(volume.space.interval, s, v, sz, vz, limits, begin, end)
    times = c.use(volume.space.times, s, v, sz, vz, limits, begin, end)
    c.show(c.implies(span.first_s <= span.last_s, c.same(times, span)), "in space")
