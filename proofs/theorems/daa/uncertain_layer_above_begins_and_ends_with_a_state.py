"""The span of an altitude known to be on one side is no longer than it has to be: at its first instant,
and at its last, some altitude and climb rate within their bounds violate the layer."""

from typing import Any

from cratous.core.daa.uncertainty import layer_above
from cratous.core.well_clear.interval import vertical_interval
from cratous.proofs.claim import Claim
from cratous.spec import well_clear
from cratous.spec.daa import meaning as daa_meaning

NAMES = ("sz", "vz", "zthr", "tcoa", "vmod", "begin", "end")


def claim(c: Claim) -> None:
    low, high, slow, fast = c.reals("low high slow fast")
    zthr, tcoa, vmod, end = c.reals("zthr tcoa vmod end")
    for least in (zthr, tcoa, vmod, low):
        c.premise(least >= 0)
    c.premise(low <= high)
    c.premise(slow <= fast)
    violates = well_clear.layer_violation_at
    c.opaque(vertical_interval, violates)
    limits = (zthr, tcoa, vmod)
    first, last = c.use(layer_above, low, high, slow, fast, *limits, end)

    def exact(args: tuple[Any, ...], when: Any, t: Any) -> None:
        values = dict(zip(NAMES, args, strict=True))
        c.lemma("well_clear_vertical_interval_is_exact", when=when, t=t, **values)

    sizes = {"zthr": zthr, "tcoa": tcoa, "vmod": vmod}

    def layer(z: Any, w: Any, t: Any, t0: Any) -> None:
        c.lemma("daa_layer_is_crossed_within_it", sz=z, vz=w, t=t, t0=t0, **sizes)

    def may(z: Any, w: Any, t: Any) -> Any:
        violated = c.define(violates, z, w, *limits, t)
        return c.all_of(low <= z, z <= high, slow <= w, w <= fast, violated)

    # from the lowest altitude at the slowest rate, from the highest towards the ownship
    states = ((low, slow), (high, c.when(fast <= 0, fast, 0)))
    for number, (args, (z, w)) in enumerate(zip(c.calls(vertical_interval), states, strict=False)):
        c.lemma("well_clear_vertical_interval_lies_within", **dict(zip(NAMES, args, strict=True)))
        begins, ends = c.use(vertical_interval, *args)
        for t, reached in ((begins, first), (ends, last)):
            exact(args, begins <= ends, t)
            c.congruence(violates, (z, w, *limits, t), (z, w, *limits, reached))
        if number == 0:  # who has come in by T and is above co-altitude is in
            layer(z, w, end, begins)
        if number == 1:  # who was at co-altitude by T was in
            level = c.define(daa_meaning.level_at, z, w)
            exact(args, c.all_of(level >= 0, level <= end), level)
            layer(z, w, level, level)
            # where it leaves, who falls fastest has come in
            c.lemma(
                "daa_uncertain_layer_above_misses_no_instant", when=c.all_of(begins <= ends, slow < 0),
                low=low, high=high, slow=slow, fast=fast, z=z, w=w, t=ends, end=end, **sizes,
            )  # fmt: skip
    c.show(c.implies(first <= last, c.any_of(*[may(z, w, first) for z, w in states])), "first")
    # where at T some are below co-altitude already and some still above, one between is there
    least = c.when(fast <= 0, fast, 0)
    below, above = low + slow * end, high + least * end
    share = c.define(daa_meaning.share_of, below, above)
    z, w = low + share * (high - low), slow + share * (least - slow)
    between = c.all_of(below <= 0, above >= 0, slow <= least)
    c.step(c.implies(between, z + w * end == 0), "one between is at co-altitude")
    c.step(c.implies(between, c.all_of(low <= z, z <= high)), "its altitude")
    c.step(c.implies(between, c.all_of(slow <= w, w <= least)), "its climb rate")
    layer(z, w, end, end)
    for z0, w0 in ((z, w), (low, slow)):
        c.congruence(violates, (z0, w0, *limits, end), (z0, w0, *limits, last))
    reached = c.any_of(*[may(z0, w0, last) for z0, w0 in (*states, (z, w))])
    c.show(c.implies(first <= last, reached), "last")
    c.show(c.implies(first > last, c.all_of(first == 1, last == 0)), "one empty span")
