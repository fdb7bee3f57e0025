"""With the same thresholds the volumes in space are nested: cylinder in tcpa, tcpa in tau_mod,
tau_mod in tep, now."""

from cratous.core import well_clear as kernels
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_loss


def claim(c: Claim) -> None:
    s, v, sz, vz, limits = any_loss(c)
    dthr, zthr, tthr, *_ = limits
    c.opaque(
        kernels.horizontal_violation,
        kernels.horizontal_violation_tau,
        kernels.horizontal_violation_tcpa,
        kernels.horizontal_violation_tep,
    )
    c.lemma("well_clear_volumes_are_nested", s=s, v=v, dthr=dthr, tthr=tthr)
    state = (s, v, sz, vz, limits)
    inside = c.use(kernels.cylinder_violation, s, sz, dthr, zthr)
    tcpa, modified, tep = (
        c.use(kernel, *state)
        for kernel in (kernels.violation_tcpa, kernels.violation_taumod, kernels.violation_tep)
    )
    c.show(c.implies(inside, tcpa), "the cylinder in tcpa")
    c.show(c.implies(tcpa, modified), "tcpa in tau_mod")
    c.show(c.implies(modified, tep), "tau_mod in tep")
