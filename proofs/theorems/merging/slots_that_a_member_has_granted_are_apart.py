"""The slots that a member has granted for the present requests of any two vehicles are apart by the separation time,
whatever is proposed to it, by any number of leaders of any terms, lost, late, repeated and in any order, and however
often vehicles make new requests. So are any two such slots with a majority each, as two majorities share a member."""

from typing import Any

from cratous.core.merging.grants import Grant, grant_asked, room_beside
from cratous.proofs.claim import Claim
from cratous.proofs.methods.runs import Beside, Items, along_items
from cratous.spec.merging import grants
from cratous.spec.merging.slots import apart

MOST = 1 << 60
ASKS = 0
OF_OTHER = 1
# the first vehicle asks anew, or the second one does; at anything else a slot is proposed


def claim(c: Claim) -> None:
    separation = c.integer("separation")
    # one slot of each of the two vehicles, for a request of it
    first = Grant(c.integer("first_request"), c.integer("first_time"))
    second = Grant(c.integer("second_request"), c.integer("second_time"))
    c.premise(c.all_of(separation >= 0, separation <= MOST))
    for slot in (first, second):
        c.premise(c.all_of(slot.request > 0, slot.time >= 0, slot.time <= MOST))
    grant, asked = (
        Grant(c.integer("g"), c.integer("g_at")),
        Grant(c.integer("a"), c.integer("a_at")),
    )
    room = c.boolean("any_room")
    answer = c.use(grant_asked, grant, asked, room)
    c.show(c.define(grants.is_after_proposal, grant, asked, room, answer), "it is its definition")
    kind, for_second, others = c.whole("kind"), c.boolean("for_second"), c.boolean("others")
    said = Grant(c.whole("said_request"), c.whole("said_time"))
    each = c.all_of(said.request > 0, said.request <= MOST, said.time >= 0, said.time <= MOST)

    def after(state: list[Any]) -> Any:
        one, two, asks_one, asks_two, has_one, has_two = state[0]
        asks = c.all_of(kind == ASKS, said.request > asks_one)
        asks_too = c.all_of(kind == OF_OTHER, said.request > asks_two)
        proposed = c.all_of(kind != ASKS, kind != OF_OTHER)
        room_one = c.all_of(c.use(room_beside, True, *two, said.time, separation), others)
        room_two = c.all_of(c.use(room_beside, True, *one, said.time, separation), others)
        # nobody proposes for a request that was never made
        to_one = c.all_of(proposed, c.negation(for_second), said.request <= asks_one)
        to_two = c.all_of(proposed, for_second, said.request <= asks_two)
        gets_one = c.use(grant_asked, one, said, room_one)
        gets_two = c.use(grant_asked, two, said, room_two)
        same_one = c.all_of(said.request == first.request, said.time == first.time)
        same_two = c.all_of(said.request == second.request, said.time == second.time)
        return (
            c.when(to_one, gets_one.grant, one),
            c.when(to_two, gets_two.grant, two),
            c.when(asks, said.request, asks_one),
            c.when(asks_too, said.request, asks_two),
            c.any_of(has_one, c.all_of(to_one, gets_one.yes, same_one)),
            c.any_of(has_two, c.all_of(to_two, gets_two.yes, same_two)),
        )

    def both(state: Any) -> Any:
        _, _, asks_one, asks_two, has_one, has_two = state
        now_one = c.define(grants.used, asks_one, first.request, has_one)
        now_two = c.define(grants.used, asks_two, second.request, has_two)
        clear = c.define(apart, first.time, second.time, separation)
        return c.implies(c.all_of(now_one, now_two), clear)

    def invariant(state: list[Any]) -> Any:
        one, two, asks_one, asks_two, has_one, has_two = state[0]

        def last(got: Any, slot: Grant) -> Any:
            same = c.all_of(got.request == slot.request, got.time == slot.time)
            return c.any_of(got.request > slot.request, same)

        there = c.all_of(one.request > 0, two.request > 0)
        bounds = [c.all_of(n >= 0, n <= MOST) for n in (*one, *two, asks_one, asks_two)]
        return c.all_of(
            *bounds,
            one.request <= asks_one,
            two.request <= asks_two,
            c.implies(there, c.define(apart, one.time, two.time, separation)),
            c.implies(has_one, last(one, first)),
            c.implies(has_two, last(two, second)),
            both(state[0]),
        )

    any_grants = [Grant(c.whole(f"{n}_request"), c.whole(f"{n}_time")) for n in ("one", "two")]
    numbers = [c.whole(n) for n in ("asks_one", "asks_two")]
    truths = [c.boolean(n) for n in ("has_one", "has_two")]
    along_items(
        c,
        [],
        item=Items((), each, (kind, for_second, others, said)),
        invariant=invariant,
        goal=lambda results: both(results[0]),
        text="apart",
        beside=[
            Beside(
                (Grant(0, 0), Grant(0, 0), 0, 0, False, False),
                (*any_grants, *numbers, *truths),
                after,
            )
        ],
    )
