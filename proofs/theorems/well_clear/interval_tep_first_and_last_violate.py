"""A span of the kernel for tep that is not empty lies within [B, T], and well clear is lost at its
first instant and at its last; an empty one is from 1 to 0, always."""

from cratous.core.well_clear import (
    horizontal_interval_tep,
    vertical_interval,
    violation_interval_tep,
)
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    sz, vz, dthr, zthr, tthr, tcoa, vmod = c.reals("sz vz dthr zthr tthr tcoa vmod")
    begin, end = c.reals("begin end")
    for threshold in (dthr, zthr, tthr, tcoa, vmod):
        c.premise(threshold >= 0)
    c.opaque(
        horizontal_interval_tep,
        vertical_interval,
        well_clear.horizontal_violation_tep_at,
        well_clear.layer_violation_at,
    )
    state = {"s": s, "v": v, "sz": sz, "vz": vz, "begin": begin, "end": end}
    limits = {"dthr": dthr, "zthr": zthr, "tthr": tthr, "tcoa": tcoa, "vmod": vmod}
    first, last = c.use(
        violation_interval_tep, s, v, sz, vz, dthr, zthr, tthr, tcoa, vmod, begin, end
    )
    up = {"sz": sz, "vz": vz, "zthr": zthr, "tcoa": tcoa, "vmod": vmod}
    c.lemma("well_clear_vertical_interval_lies_within", begin=begin, end=end, **up)
    low, high = c.use(vertical_interval, sz, vz, zthr, tcoa, vmod, begin, end)
    flat = {"s": s, "v": v, "dthr": dthr, "tthr": tthr, "begin": low, "end": high}
    c.lemma("well_clear_horizontal_interval_tep_lies_within", **flat)
    within = c.all_of(begin <= first, last <= end)
    c.show(c.implies(first <= last, within), "within [B, T]")
    c.show(c.implies(first > last, c.all_of(first == 1, last == 0)), "one empty span")
    for name, t in (("first", first), ("last", last)):
        c.lemma("well_clear_interval_tep_is_exact", when=first <= last, t=t, **state, **limits)
        arguments = (s, v, sz, vz, dthr, zthr, tthr, tcoa, vmod, t)
        lost = c.define(well_clear.violation_tep_at, *arguments)
        c.show(c.implies(first <= last, lost), f"lost at the {name} instant")
