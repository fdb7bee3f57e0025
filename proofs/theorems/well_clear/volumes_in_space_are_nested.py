"""With the same thresholds the volumes in space are nested: cylinder in tcpa, tcpa in tau_mod,
tau_mod in tep, now."""

from cratous.core.well_clear import (
    cylinder_violation,
    horizontal_violation,
    horizontal_violation_tau,
    horizontal_violation_tcpa,
    horizontal_violation_tep,
    violation_taumod,
    violation_tcpa,
    violation_tep,
)
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_state, any_thresholds


def claim(c: Claim) -> None:
    s, v, sz, vz = any_state(c)
    limits = any_thresholds(c)
    dthr, zthr, tthr, *_ = limits
    c.opaque(
        horizontal_violation,
        horizontal_violation_tau,
        horizontal_violation_tcpa,
        horizontal_violation_tep,
    )
    c.lemma("well_clear_volumes_are_nested", s=s, v=v, dthr=dthr, tthr=tthr)
    state = (s, v, sz, vz, limits)
    inside = c.use(cylinder_violation, s, sz, dthr, zthr)
    tcpa, modified, tep = (
        c.use(kernel, *state) for kernel in (violation_tcpa, violation_taumod, violation_tep)
    )
    c.show(c.implies(inside, tcpa), "the cylinder in tcpa")
    c.show(c.implies(tcpa, modified), "tcpa in tau_mod")
    c.show(c.implies(modified, tep), "tau_mod in tep")
