"""After each heartbeat under UxAS and each handback it is as defined which takeovers, surprises and ends of permits
an intruder counts, and whether ICAROUS takes over because of it."""

from cratous.core.permit.encounter import (
    Encounter,
    encounter_looked,
    encounter_resumed,
    encounter_watched,
)
from cratous.proofs.claim import Claim
from cratous.proofs.methods.takeovers import any_encounter
from cratous.spec.permit import encounter as permit


def claim(c: Claim) -> None:
    before, other = any_encounter(c, ""), any_encounter(c, "other_")
    allowed, foreseen, acts = (c.boolean(name) for name in ("allowed", "foreseen", "other_acts"))
    now, expiry = c.integer("now"), c.integer("until")

    def only(holds: object, after: Encounter) -> None:
        c.show(c.implies(holds, c.same(other, after)), "and it can be no other")

    looked = c.use(encounter_looked, before, allowed, now)
    c.show(c.define(permit.is_after_look, before, allowed, now, looked), "a look")
    only(c.define(permit.is_after_look, before, allowed, now, other), looked)

    watched = c.use(encounter_watched, before, foreseen)
    right = c.define(permit.is_after_watch, before, foreseen, watched.encounter, watched.acts)
    c.show(right, "a heartbeat")
    another = c.define(permit.is_after_watch, before, foreseen, other, acts)
    same = c.all_of(c.same(other, watched.encounter), c.same(acts, watched.acts))
    c.show(c.implies(another, same), "and it can be no other")

    resumed = c.use(encounter_resumed, before, allowed, expiry)
    c.show(c.define(permit.is_after_handback, before, allowed, expiry, resumed), "a handback")
    only(c.define(permit.is_after_handback, before, allowed, expiry, other), resumed)
