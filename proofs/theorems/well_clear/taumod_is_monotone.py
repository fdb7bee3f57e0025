"""Well clear by taumod is monotone in every threshold: greater DTHR, ZTHR, TTHR, TCOA or VMOD, one or
several of them, never make a violation vanish."""

from cratous.core.well_clear import horizontal_violation, layer_violation, violation_taumod
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    sz, vz = c.reals("sz vz")
    names = "dthr zthr tthr tcoa vmod"
    small, great = c.reals(names), c.reals(" ".join(name + "2" for name in names.split()))
    for low, high in zip(small, great, strict=True):
        c.premise(low >= 0)
        c.premise(low <= high)
    c.opaque(horizontal_violation, layer_violation)
    before = c.use(violation_taumod, s, v, sz, vz, *small)
    after = c.use(violation_taumod, s, v, sz, vz, *great)
    (dthr, zthr, tthr, tcoa, vmod), (dthr2, zthr2, tthr2, tcoa2, vmod2) = small, great
    c.lemma(
        "well_clear_horizontal_taumod_is_monotone",
        s=s, v=v, dthr=dthr, tthr=tthr, dthr2=dthr2, tthr2=tthr2,
    )  # fmt: skip
    c.lemma(
        "well_clear_vertical_volume_is_monotone",
        sz=sz, vz=vz, zthr=zthr, tcoa=tcoa, vmod=vmod, zthr2=zthr2, tcoa2=tcoa2, vmod2=vmod2,
    )  # fmt: skip
    c.show(c.implies(before, after))
