"""If a volume of any kind is violated at some instant of [B, T] of straight flight, then the kernel
that alerting and bands ask says so."""

from cratous.core.daa.volume import in_conflict
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_instants, any_loss, by_name
from cratous.proofs.methods.kinds import TAUMOD, TCPA, TEP
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    kind = c.integer("kind")
    s, v, sz, vz, limits = any_loss(c)
    begin, t, end = any_instants(c, "begin t end")
    for volume in (TAUMOD, TCPA, TEP):
        c.opaque(volume.space.during, volume.meant.at)
    state = {"s": s, "v": v, "sz": sz, "vz": vz, "begin": begin, "end": end, "t": t}
    size = by_name(limits)
    for volume in (TAUMOD, TCPA, TEP):
        c.lemma(f"well_clear_detection_{volume.name}_misses_no_instant", **state, **size)
    found = c.use(in_conflict, kind, s, v, sz, vz, limits, begin, end)
    lost = c.define(daa_meaning.violated_at, kind, s, v, sz, vz, limits, t)
    c.show(c.implies(lost, found))
