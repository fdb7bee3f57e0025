"""Where a volume of any kind is violated, at whatever height and climb rate, it is violated by one that is at the other's
height and stays there, everything else being the same: by definition at each instant, and so the kernels say now."""

from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_loss
from cratous.proofs.methods.kinds import TAUMOD, TCPA, TEP


def claim(c: Claim) -> None:
    s, v, sz, vz, limits = any_loss(c)
    t = c.real("t")
    for volume in (TAUMOD, TCPA, TEP):
        c.opaque(volume.meant.flat_at, volume.flat.now)
        lost = c.define(volume.meant.at, s, v, sz, vz, limits, t)
        level = c.define(volume.meant.at, s, v, 0, 0, limits, t)
        c.show(c.implies(lost, level), f"the definition, {volume.name}")
        now = c.use(volume.space.now, s, v, sz, vz, limits)
        beside = c.use(volume.space.now, s, v, 0, 0, limits)
        c.show(c.implies(now, beside), f"the kernel, {volume.name}")
