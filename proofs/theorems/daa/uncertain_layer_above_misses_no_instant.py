"""Whatever altitude on one side and climb rate within their bounds are the true ones: an instant of
[0, T] at which they violate the layer lies in the span."""

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
    z, w, t = c.reals("z w t")
    for least in (zthr, tcoa, vmod, low):
        c.premise(least >= 0)
    for one, next_ in ((low, z), (z, high), (slow, w), (w, fast)):
        c.premise(one <= next_)
    c.premise(t >= 0)
    c.premise(t <= end)
    c.opaque(vertical_interval)
    span = c.use(layer_above, low, high, slow, fast, zthr, tcoa, vmod, end)
    violated = c.define(well_clear.layer_violation_at, z, w, zthr, tcoa, vmod, t)
    falling = c.all_of(w <= 0, slow < 0)

    def exact(args: tuple[Any, ...], instant: Any) -> None:
        within = c.all_of(instant >= 0, instant <= end)
        values = dict(zip(NAMES, args, strict=True))
        c.lemma("well_clear_vertical_interval_is_exact", when=within, t=instant, **values)

    # from the lowest altitude at the slowest rate, from the highest towards the ownship
    for number, args in enumerate(c.calls(vertical_interval)):
        c.lemma("well_clear_vertical_interval_lies_within", **dict(zip(NAMES, args, strict=True)))
        exact(args, t)
        if number == 0:  # who falls fastest is in the layer at t, or was at co-altitude before
            exact(args, c.when(low + slow * t >= 0, t, c.define(daa_meaning.level_at, low, slow)))
            exact(args, t - t)  # who does not fall was in it all the time
        if number == 1:  # who falls slowest has not left at t
            exact(args, c.use(vertical_interval, *args).first_s)
    found = c.define(well_clear.in_span, *span, t)
    c.show(c.implies(c.all_of(violated, c.negation(falling)), found), "not falling")
    c.show(c.implies(c.all_of(violated, falling), found), "falling")
