"""Whatever happens to a vehicle in any number of events (heartbeats of its ICAROUS, commands to its gate, of whoever and
whenever they were sent, certificates that are offered and begin at once or later, news), it obeys any one zone at any
instant after the last one: while UxAS flies it, where the leg that it is beside, of the last command that the gate let through, was
checked against the zone with a margin and the vehicle is no farther from it; while ICAROUS does, until the certificate in hand,
which knows of the zone, expires, as a surprise or another manoeuvre makes it do at once."""

from typing import Any

from cratous.proofs.claim import Claim
from cratous.proofs.methods.fences import after_turn, any_fencing, any_turn, each_turn, no_fencing
from cratous.proofs.methods.happenings import Asked
from cratous.proofs.methods.runs import Beside, Items, along_items
from cratous.spec.authority import gate as authority
from cratous.spec.permit import hand as permit
from cratous.spec.system import fenced as system


def claim(c: Claim) -> None:
    asked = Asked(c.integer("reserve"), c.integer("known_as"), c.integer("at"))
    c.premise(asked.reserve >= 0)
    what = any_turn(c)

    def obeyed(state: list[Any]) -> Any:
        gate, hand, known = state[0]
        knows = hand.knowledge >= asked.known_as
        so = c.define(system.is_fenced, gate, known, knows, hand.expiry_ms, asked.at)
        return c.implies(c.all_of(known.counted, known.in_order), so)

    def invariant(state: list[Any]) -> Any:
        gate, hand, known = state[0]
        certificate = c.define(permit.certified, hand.expiry_ms, known.hand, known.now_ms, asked.at)
        together = c.all_of(
            c.define(authority.well_formed, gate),
            c.define(system.checked, known.way),
            c.implies(hand.knowledge >= asked.known_as, certificate),
        )
        return c.all_of(c.implies(c.all_of(known.counted, known.in_order), together), obeyed(state))

    def after(state: list[Any]) -> Any:
        return after_turn(c, state[0], what, asked)

    along_items(
        c,
        [],
        item=Items((), each_turn(c, what, asked), (what,)),
        invariant=invariant,
        goal=obeyed,
        text="obeyed",
        beside=[Beside(no_fencing(), any_fencing(c), after)],
    )
