"""If a volume of any kind is violated at some instant of [0, T] of flight that is straight over ground, at whatever
height and climb rate, then the kernel says so of one that is at the other's height and stays there."""

from cratous.core.daa.volume import in_conflict
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_loss, by_name
from cratous.proofs.methods.kinds import TAUMOD, TCPA, TEP
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    kind = c.integer("kind")
    s, v, sz, vz, limits = any_loss(c)
    t, end = c.reals("t end")
    c.premise(t >= 0)
    c.premise(t <= end)
    for volume in (TAUMOD, TCPA, TEP):
        c.opaque(volume.space.during, volume.meant.at)
    size = by_name(limits)
    c.lemma("daa_volume_is_widest_at_a_height", s=s, v=v, sz=sz, vz=vz, t=t, **size)
    level = {"s": s, "v": v, "sz": 0, "vz": 0, "begin": 0, "end": end, "t": t}
    c.lemma("daa_conflict_misses_no_instant", kind=kind, **level, **size)
    found = c.use(in_conflict, kind, s, v, 0, 0, limits, 0, end)
    lost = c.define(daa_meaning.violated_at, kind, s, v, sz, vz, limits, t)
    c.show(c.implies(lost, found))
