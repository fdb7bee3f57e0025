"""A hold that is taken to be clear of an intruder for ever does not enter its cylinder at any instant from now on,
whatever place the vehicle has within rho of its reference and the intruder in its tube."""

from cratous.core.permit.for_ever import above_for_ever, beside_for_ever, hold_clear
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_state
from cratous.proofs.methods.meetings import about, any_guard, clear_is_not_hit, growth_by_name
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    s, v, sz, vz = any_state(c)
    tube, margins, offs = any_guard(c)
    t = c.real("t")
    c.premise(t >= 0)
    c.opaque(
        above_for_ever, beside_for_ever, motion.reached_at, motion.levelled_at, motion.enters_at
    )
    clear = c.use(hold_clear, s, v, sz, vz, tube, margins)
    around, layer = about(tube, margins)
    named = growth_by_name(layer)
    for z, w in ((sz, vz), (0 - sz, 0 - vz)):
        c.lemma("permit_above_for_ever_has_no_instant", sz=z, vz=w, t=t, **named)
    wider = growth_by_name(around)
    c.lemma("permit_beside_for_ever_has_no_instant", s=s, v=v, t=t, **wider)
    clear_is_not_hit(c, clear, (s, v, sz, vz), (tube, margins, offs), t)
