"""With the same thresholds the horizontal volumes are nested: the circle lies in the volume with
plain tau, this in the one with tcpa, this in the one with tau_mod, and this in the one with tep."""

from cratous.core import well_clear as kernels
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_in_the_plane
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v, dthr, tthr = any_in_the_plane(c)
    circle = c.define(well_clear.within, s, dthr)
    plain = c.use(kernels.horizontal_violation_tau, s, v, dthr, tthr)
    tcpa = c.use(kernels.horizontal_violation_tcpa, s, v, dthr, tthr)
    modified = c.use(kernels.horizontal_violation, s, v, dthr, tthr)
    tep = c.use(kernels.horizontal_violation_tep, s, v, dthr, tthr)
    c.show(c.implies(circle, plain), "the circle in tau")
    c.show(c.implies(plain, tcpa), "tau in tcpa")
    c.show(c.implies(tcpa, modified), "tcpa in tau_mod")
    c.show(c.implies(modified, tep), "tau_mod in tep")
