"""Every horizontal volume is symmetric: with tau_mod, tcpa, tep and plain tau, now and over [B, T],
the intruder's verdict and instants are the ownship's, for every relative state and all thresholds."""

from cratous.core.kernel import Vec2
from cratous.core.well_clear import (
    horizontal_interval_taumod,
    horizontal_interval_tcpa,
    horizontal_interval_tep,
    horizontal_violation,
    horizontal_violation_tau,
    horizontal_violation_tcpa,
    horizontal_violation_tep,
)
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_in_the_plane

NOW = (
    horizontal_violation, horizontal_violation_tcpa, horizontal_violation_tep,
    horizontal_violation_tau,
)  # fmt: skip
SPANS = (horizontal_interval_taumod, horizontal_interval_tcpa, horizontal_interval_tep)


def claim(c: Claim) -> None:
    s, v, dthr, tthr = any_in_the_plane(c)
    begin, end = c.reals("begin end")
    back_s, back_v = Vec2(0 - s.x, 0 - s.y), Vec2(0 - v.x, 0 - v.y)
    for kernel in NOW:
        ours, theirs = (c.use(kernel, p, w, dthr, tthr) for p, w in ((s, v), (back_s, back_v)))
        c.show(c.same(ours, theirs), kernel.__name__)
    for spans in SPANS:
        ours, theirs = (
            c.use(spans, p, w, dthr, tthr, begin, end) for p, w in ((s, v), (back_s, back_v))
        )
        c.show(c.same(ours, theirs), spans.__name__)
