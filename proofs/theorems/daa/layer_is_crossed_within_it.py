"""Whoever is at co-altitude violates the layer, who has come into it from above violates it until
co-altitude, and who is above it violates it as one does who is as far below."""

from cratous.core.well_clear import layer_violation
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    sz, vz, zthr, tcoa, vmod, t0, t = c.reals("sz vz zthr tcoa vmod t0 t")
    for threshold in (zthr, tcoa, vmod):
        c.premise(threshold >= 0)
    limits = (zthr, tcoa, vmod)
    now = c.define(well_clear.layer_violation_at, sz, vz, *limits, t)
    then = c.define(well_clear.layer_violation_at, sz, vz, *limits, t0)
    c.show(c.same(c.use(layer_violation, sz + t * vz, vz, *limits), now), "the kernel")
    c.show(c.implies(sz + t * vz == 0, now), "at co-altitude")
    falling = c.all_of(vz <= 0, t0 <= t, sz + t * vz >= 0)
    c.show(c.implies(c.all_of(falling, then), now), "until co-altitude")
    mirrored = c.define(well_clear.layer_violation_at, 0 - sz, 0 - vz, *limits, t)
    c.show(c.same(mirrored, now), "from below as from above")
