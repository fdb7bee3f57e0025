"""Whatever happens in any number of events (heartbeats of ICAROUS, any number of intruders met, commands, SETMOD lines late,
twice or forged, reports of the gate that were ever sent, items that begin), on an item UxAS counts no more takeovers than
one for each intruder that is met, one for each permit that did not last, by a surprise or by its end, one for each offer
that was withdrawn and each takeover because of no intruder, and those that it had not heard of as the item began."""

from typing import Any

from cratous.proofs.claim import Claim
from cratous.proofs.methods.counting import (
    after_event,
    any_counted,
    any_event,
    each_event,
    first_counted,
)
from cratous.proofs.methods.runs import Beside, Items, along_items
from cratous.spec.authority.gate import may_command
from cratous.spec.system import clear, counting


def claim(c: Claim) -> None:
    event = any_event(c)

    def goal(state: list[Any]) -> Any:
        return c.define(counting.few, state[0].tally)

    def invariant(state: list[Any]) -> Any:
        gate, cycle, end, suspended, tally = state[0]
        turns = c.define(counting.take_turns, gate, tally.made)
        ahead = c.any_of(
            end.epoch != gate.epoch,
            c.same(end.active, c.negation(c.define(may_command, gate, 0))),
        )
        believed = c.all_of(
            tally.known >= 0,
            end.epoch + c.when(end.active, 1, 0) == 2 * tally.known,
            end.epoch <= gate.epoch,
            ahead,
            c.same(suspended, end.active),
        )
        so_far = c.all_of(
            tally.heard <= tally.known - tally.made_then + tally.before,
            tally.before >= 0,
            tally.open >= 0,
            tally.made - tally.made_then
            <= c.define(counting.met, tally) + tally.others + tally.withdrawn,
        )
        together = c.define(clear.understood, cycle, gate)
        return c.all_of(
            c.implies(tally.counted, c.all_of(together, turns, believed, so_far)), goal(state)
        )

    def after(state: list[Any]) -> Any:
        return after_event(c, state[0], event)

    along_items(
        c,
        [],
        item=Items((), each_event(c, event), (event,)),
        invariant=invariant,
        goal=goal,
        text="counted",
        beside=[Beside(first_counted(), any_counted(c), after)],
    )
