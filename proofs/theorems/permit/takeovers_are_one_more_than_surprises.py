"""Because of one intruder ICAROUS takes over at most once, and once more for each permit that did not last, by a
surprise or by its end: so it is at the start, and what it rests on stays so after each look, each heartbeat under
UxAS and each handback, in any order. While the way is permitted against the intruder it does not take over."""

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
    before = any_encounter(c, "")
    allowed, foreseen = c.boolean("allowed"), c.boolean("foreseen")
    now, expiry = c.integer("now"), c.integer("until")
    first = Encounter(0, 0, 0, False, False, 0)
    c.show(c.define(permit.owed, first), "nothing is owed at the start")
    c.premise(c.define(permit.owed, before))
    c.show(c.define(permit.bounded, before), "at most one more")
    looked = c.use(encounter_looked, before, allowed, now)
    c.show(c.define(permit.owed, looked), "after a look")
    watched = c.use(encounter_watched, before, foreseen)
    c.show(c.define(permit.owed, watched.encounter), "after a heartbeat")
    resumed = c.use(encounter_resumed, before, allowed, expiry)
    c.show(c.define(permit.owed, resumed), "after a handback")
    again = c.use(encounter_watched, looked, foreseen)
    lasts = c.all_of(before.permitted, allowed, now < before.expiry_ms)
    c.show(c.implies(lasts, c.negation(again.acts)), "not while it is permitted")
    c.show(c.implies(again.acts, again.encounter.takeovers == before.takeovers + 1), "each counts")
