"""Whatever happens to a vehicle in any number of events (heartbeats of its ICAROUS, commands to its gate, certificates that
are offered and begin at once or later, news), it is clear, at any instant after the last one, of any one intruder that it
sees: while UxAS may fly it, for as long as the last heartbeat has looked ahead, but no farther than its hard limit, and for
as long as the way is permitted where that is why ICAROUS does not act; while ICAROUS may, until the certificate in hand
expires, as a surprise or another manoeuvre makes it do at once."""

from typing import Any

from cratous.proofs.claim import Claim
from cratous.proofs.methods.happenings import Asked, after_happening, any_happening, each_happening
from cratous.proofs.methods.runs import Beside, Items, along_items
from cratous.proofs.methods.vehicles import any_vehicle, first_vehicle
from cratous.spec.permit import encounter as meeting
from cratous.spec.permit import hand as permit
from cratous.spec.system import clear as system


def claim(c: Claim) -> None:
    asked = Asked(c.integer("reserve"), c.integer("known_as"), c.integer("at"))
    c.premise(asked.reserve >= 0)
    what = any_happening(c)

    def clear(state: list[Any]) -> Any:
        gate, _, _, hand, sure = state[0]
        knows = hand.knowledge >= asked.known_as
        so = c.define(system.is_clear, gate, sure, knows, hand.expiry_ms, asked.at)
        return c.implies(c.all_of(sure.counted, sure.in_order), so)

    def invariant(state: list[Any]) -> Any:
        gate, cycle, met, hand, sure = state[0]
        now, at = sure.now_ms, asked.at
        way = c.define(permit.certified, sure.until_ms, sure.permit, now, at)
        certificate = c.define(permit.certified, hand.expiry_ms, sure.hand, now, at)
        together = c.all_of(
            c.define(system.understood, cycle, gate),
            c.define(system.quiet, cycle, met),
            c.define(meeting.owed, met),
            c.implies(met.permitted, way),
            c.implies(hand.knowledge >= asked.known_as, certificate),
        )
        return c.all_of(c.implies(c.all_of(sure.counted, sure.in_order), together), clear(state))

    def after(state: list[Any]) -> Any:
        return after_happening(c, state[0], what, asked)

    along_items(
        c,
        [],
        item=Items((), each_happening(c, what, asked), (what,)),
        invariant=invariant,
        goal=clear,
        text="clear",
        beside=[Beside(first_vehicle(), any_vehicle(c), after)],
    )
