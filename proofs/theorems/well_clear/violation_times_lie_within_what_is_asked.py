"""The first and last instant of a loss that the kernels tell lie in the span [B, T] that they were
asked about: for every state and all thresholds not below zero, also where nothing is lost in it."""

from cratous.core.well_clear import (
    violation_times_taumod,
    violation_times_tcpa,
    violation_times_tep,
)
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_loss
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v, sz, vz, limits = any_loss(c)
    begin, end = c.reals("begin end")
    c.premise(begin <= end)
    kernels = {
        "tau_mod": violation_times_taumod,
        "tcpa": violation_times_tcpa,
        "tep": violation_times_tep,
    }
    for name, kernel in kernels.items():
        times = c.use(kernel, s, v, sz, vz, limits, begin, end)
        c.show(c.define(well_clear.in_span, begin, end, times.first_s), f"first, {name}")
        c.show(c.define(well_clear.in_span, begin, end, times.last_s), f"last, {name}")
