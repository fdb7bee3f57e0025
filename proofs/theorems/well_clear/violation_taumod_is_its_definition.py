"""The combined kernel for taumod says that well clear is lost exactly when the horizontal volume and the
vertical one, by TCOA or VMOD, are violated at once."""

from cratous.core.well_clear import violation_taumod
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    sz, vz, dthr, zthr, tthr, tcoa, vmod = c.reals("sz vz dthr zthr tthr tcoa vmod")
    for threshold in (dthr, zthr, tthr, tcoa, vmod):
        c.premise(threshold >= 0)
    limits = (dthr, zthr, tthr, tcoa, vmod)
    c.opaque(well_clear.horizontal_violation, well_clear.layer_violation)
    lost = c.define(well_clear.violation_taumod_at, s, v, sz, vz, *limits, sz - sz)
    c.lemma("well_clear_horizontal_violation_is_its_definition", s=s, v=v, dthr=dthr, tthr=tthr)
    c.lemma(
        "well_clear_layer_violation_is_its_definition",
        sz=sz, vz=vz, zthr=zthr, tcoa=tcoa, vmod=vmod,
    )  # fmt: skip
    c.show(c.same(c.use(violation_taumod, s, v, sz, vz, *limits), lost))
