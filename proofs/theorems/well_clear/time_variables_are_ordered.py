"""Outside DTHR, converging, on a course that comes within it, the time variables are ordered:
0 < tep <= tau_mod <= tcpa <= tau; and there each kernel says `violated` exactly when TTHR is at least
its own time variable."""

from cratous.core import well_clear as kernels
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_in_the_plane
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v, dthr, tthr = any_in_the_plane(c)
    c.premise(c.negation(c.define(well_clear.within, s, dthr)))
    c.premise(c.define(well_clear.passes_within, s, v, dthr))
    tep = c.define(well_clear.time_of_entry, s, v, dthr)
    modified = c.define(well_clear.tau_mod, s, v, dthr)
    tcpa = c.define(well_clear.time_of_closest_approach, s, v)
    plain = c.define(well_clear.tau, s, v)
    for kernel, time in (
        (kernels.horizontal_violation, modified),
        (kernels.horizontal_violation_tcpa, tcpa),
        (kernels.horizontal_violation_tep, tep),
        (kernels.horizontal_violation_tau, plain),
    ):
        c.show(c.same(c.use(kernel, s, v, dthr, tthr), time <= tthr), kernel.__name__)
    c.show(modified <= tcpa, "tau_mod <= tcpa")
    c.show(tcpa <= plain, "tcpa <= tau")
    c.show(tep > 0, "0 < tep")
    c.show(tep <= modified, "tep <= tau_mod")
