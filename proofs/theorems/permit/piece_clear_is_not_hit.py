"""A piece of flight that is taken to be clear of an intruder does not enter its cylinder at any instant of the
piece, whatever place the vehicle has within rho of its reference and the intruder in its tube, horizontally
and in altitude, however fast the tube grows."""

from cratous.core.permit.pieces import above_during, beside_during, piece_clear
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_state
from cratous.proofs.methods.meetings import about, any_guard, clear_is_not_hit, growth_by_name
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    s, v, sz, vz = any_state(c)
    tube, margins, offs = any_guard(c)
    d, t = c.reals("d t")
    c.premise(c.all_of(t >= 0, t <= d))
    c.opaque(above_during, beside_during, motion.reached_at, motion.levelled_at, motion.enters_at)
    clear = c.use(piece_clear, s, v, sz, vz, tube, margins, d)
    around, layer = about(tube, margins)
    named = growth_by_name(layer)
    c.lemma("permit_above_is_exact", sz=sz, vz=vz, d=d, t=t, **named)
    c.lemma("permit_above_is_exact", sz=0 - sz, vz=0 - vz, d=d, t=t, **named)
    wider = growth_by_name(around)
    c.lemma("permit_beside_misses_no_instant", s=s, v=v, d=d, t=t, **wider)
    clear_is_not_hit(c, clear, (s, v, sz, vz), (tube, margins, offs), t)
