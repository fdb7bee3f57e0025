"""The span of an uncertain altitude is no longer than it has to be: at its first instant, and at its last,
some altitude and climb rate within the uncertainty violate the layer."""

from typing import Any

from cratous.core.daa.uncertainty import layer_above, layer_span
from cratous.proofs.claim import Claim
from cratous.spec import well_clear
from cratous.spec.daa import meaning as daa_meaning

NAMES = ("low", "high", "slow", "fast", "zthr", "tcoa", "vmod", "end")


def claim(c: Claim) -> None:
    sz, vz, ez, ew, zthr, tcoa, vmod, end = c.reals("sz vz ez ew zthr tcoa vmod end")
    for least in (ez, ew, zthr, tcoa, vmod):
        c.premise(least >= 0)
    violates = well_clear.layer_violation_at
    c.opaque(layer_above, violates, daa_meaning.share_of)
    limits = (zthr, tcoa, vmod)
    first, last = c.use(layer_span, sz, vz, ez, ew, *limits, end)

    def may(state: tuple[Any, Any], t: Any) -> Any:
        off = daa_meaning.Vertical(state[0] - sz, state[1] - vz)
        return c.define(
            daa_meaning.layer_may_be_violated_at,
            daa_meaning.Vertical(sz, vz),
            off,
            daa_meaning.Vertical(ez, ew),
            *limits,
            t,
        )

    low, high, slow, fast = sz - ez, sz + ez, vz - ew, vz + ew
    up, down = (slow, fast), (0 - fast, 0 - slow)
    both = c.all_of(low < 0, high >= 0)
    sides = (
        (1, low >= 0, low, high, *up),
        (-1, high < 0, 0 - high, 0 - low, *down),
        (1, both, low - low, high, *up),
        (-1, both, low - low, 0 - low, *down),
    )
    sizes = {"zthr": zthr, "tcoa": tcoa, "vmod": vmod}
    begun: list[Any] = []
    ended: list[Any] = []
    calls = c.calls(layer_above)
    c.show(len(calls) == 4, "above, below, and on both sides")
    for (sign, there, *bounds), args in zip(sides, calls, strict=False):
        near, far, slowest, fastest = bounds
        least = c.when(fastest <= 0, fastest, 0)
        share = c.define(daa_meaning.share_of, near + slowest * end, far + least * end)
        between = (near + share * (far - near), slowest + share * (least - slowest))
        states = ((near, slowest), (far, least), between)
        c.lemma(
            "daa_uncertain_layer_above_begins_and_ends_with_a_state",
            when=there,
            **dict(zip(NAMES, args, strict=True)),
        )
        begins, ends = c.use(layer_above, *args)
        for t, reached, kept in ((begins, first, begun), (ends, last, ended)):
            for z, w in states if sign < 0 else ():
                c.lemma("daa_layer_is_crossed_within_it", sz=z, vz=w, t=t, t0=t, **sizes)
            some = c.any_of(*[may((sign * z, sign * w), t) for z, w in states])
            c.show(c.implies(c.all_of(there, begins <= ends), some), "on one side")
            kept.append(c.all_of(reached == t, there, begins <= ends))
    c.show(c.implies(first <= last, c.any_of(*begun)), "first, on either side")
    c.show(c.implies(first <= last, c.any_of(*ended)), "last, on either side")
    c.show(c.implies(first > last, c.all_of(first == 1, last == 0)), "one empty span")
