"""The kernel for tcpa that neither divides nor takes roots says `lost during [B, T]` exactly when
the interval kernel's span is not empty: so it is exactly when some instant of [B, T] violates, and
the first instant of the span is one."""

from cratous.core.kernel import Vec2
from cratous.core.well_clear import (
    horizontal_interval_tcpa,
    layer_window,
    violation_during_tcpa,
    violation_interval_tcpa,
)
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    sz, vz, dthr, zthr, tthr, tcoa, vmod = c.reals("sz vz dthr zthr tthr tcoa vmod")
    begin, end, witness = c.reals("begin end witness")
    for threshold in (dthr, zthr, tthr, tcoa, vmod):
        c.premise(threshold >= 0)
    c.opaque(
        horizontal_interval_tcpa,
        layer_window,
        violation_during_tcpa,
        violation_interval_tcpa,
        well_clear.violation_tcpa_at,
    )
    limits = (dthr, zthr, tthr, tcoa, vmod)
    detected = c.use(violation_during_tcpa, s, v, sz, vz, *limits, begin, end)
    first, last = c.use(violation_interval_tcpa, s, v, sz, vz, *limits, begin, end)
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
    scaled, _ = c.use(horizontal_interval_tcpa, at, v, dthr * k, tthr * k, low - low, high - low)
    c.premise(c.implies(k > 0, k * (witness - begin) == low + scaled))
    c.lemma("well_clear_detection_tcpa_has_a_witness", t=witness, **values)
    c.lemma("well_clear_interval_tcpa_is_exact", when=detected, t=witness, **values)
    c.lemma("well_clear_interval_tcpa_first_and_last_violate", **values)
    c.lemma("well_clear_detection_tcpa_misses_no_instant", when=first <= last, t=first, **values)
    c.show(c.same(detected, first <= last))
