"""Once another trajectory is flown, as after a handback, no certificate that was offered before is taken any more: whatever was
in hand then, also if nothing was, and whatever happens afterwards, in any number of events."""

from typing import Any

from cratous.core.permit.hand import LEFT, OFFERED, Offer, hand_after, hand_passed, hand_step
from cratous.proofs.claim import Claim
from cratous.proofs.methods.hands import any_hand, any_hand_event
from cratous.proofs.methods.runs import Beside, Items, along_items
from cratous.proofs.methods.vehicles import counts
from cratous.spec.permit import hand as permit


def claim(c: Claim) -> None:
    hand, reserve, first = any_hand(c), c.integer("reserve"), c.whole("first")
    event = any_hand_event(c, c.whole("now"))
    c.premise(reserve >= 0)
    each = [counts(c, number) for number in (*event.offer, event.now, event.kind)]
    names = ("id", "base", "sigma", "knowledge", "expiry")
    old, then = Offer(*[c.integer(f"old_{name}") for name in names]), c.integer("then")

    def left(state: list[Any]) -> Any:
        """A number above those of all that had been in hand when a trajectory was last left."""
        held, before = state
        return c.when(event.kind == LEFT, held.id + 1, before)

    def invariant(state: list[Any]) -> Any:
        held, since = state
        later = c.any_of(held.id >= since, c.define(permit.is_worn, held))
        return c.all_of(*[counts(c, number) for number in held], later)

    def goal(results: list[Any]) -> Any:
        held, since = results
        present = c.use(hand_passed, held, then)
        after = c.use(hand_step, held, OFFERED, old, False, then, reserve)
        kept = c.all_of(after.id == held.id, after.expiry_ms <= present.expiry_ms)
        return c.implies(old.base < since, kept)

    along_items(
        c,
        [(hand_after, hand, (reserve,))],
        item=Items((event.kind, event.offer, event.permitted, event.now), c.all_of(*each)),
        invariant=invariant,
        goal=goal,
        text="not taken",
        beside=[Beside(0, first, left)],
    )
