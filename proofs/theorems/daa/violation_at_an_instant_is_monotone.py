"""At every instant of straight flight, well clear by modified tau that is lost with some thresholds is
lost with greater ones."""

from cratous.core.kernel import Vec2
from cratous.core.well_clear import horizontal_violation, layer_violation
from cratous.core.well_clear.thresholds import Thresholds
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_nested_thresholds, any_state
from cratous.proofs.methods.volumes import both_parts_grow
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v, sz, vz = any_state(c)
    t = c.real("t")
    small, great = any_nested_thresholds(c)
    c.opaque(
        horizontal_violation,
        layer_violation,
        well_clear.horizontal_violation,
        well_clear.layer_violation,
    )
    there, up = Vec2(s.x + t * v.x, s.y + t * v.y), sz + t * vz
    both_parts_grow(c, "well_clear_horizontal_taumod_is_monotone", (there, v, up, vz), small, great)
    for d, z, tt, tc, vm in (small, great):
        c.lemma("well_clear_horizontal_violation_is_its_definition", s=there, v=v, dthr=d, tthr=tt)
        c.lemma(
            "well_clear_layer_violation_is_its_definition",
            sz=up, vz=vz, zthr=z, tcoa=tc, vmod=vm,
        )  # fmt: skip
    c.show(
        c.implies(
            c.use(horizontal_violation, there, v, small.dthr_m, small.tthr_s),
            c.use(horizontal_violation, there, v, great.dthr_m, great.tthr_s),
        ),
        "horizontally",
    )
    before = c.define(well_clear.violation_taumod_at, s, v, sz, vz, Thresholds(*small), t)
    after = c.define(well_clear.violation_taumod_at, s, v, sz, vz, Thresholds(*great), t)
    c.show(c.implies(before, after))
