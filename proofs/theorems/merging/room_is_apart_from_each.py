"""A slot found to have room is apart from those granted to each of the other vehicles, of any number; a slot found to
have none is not apart from one of them."""

from typing import Any

from cratous.core.merging.grants import has_room, room_beside
from cratous.proofs.claim import Claim
from cratous.proofs.methods.runs import Beside, Items, along_items
from cratous.spec.merging import grants

MOST = 1 << 60


def claim(c: Claim) -> None:
    request, time, marked = c.whole("request"), c.whole("time"), c.boolean("marked")
    asked, separation = c.integer("asked"), c.integer("separation")
    c.premise(c.all_of(asked >= 0, asked <= MOST, separation >= 0, separation <= MOST))
    each = c.all_of(request >= 0, request <= MOST, time >= 0, time <= MOST)
    so_far, r, t = c.boolean("so_far"), c.integer("r"), c.integer("t")
    one = c.use(room_beside, so_far, r, t, asked, separation)
    meant = c.define(grants.all_leave_room, so_far, r, t, asked, separation)
    c.premise(c.all_of(t >= 0, t <= MOST))
    c.show(c.same(one, meant), "one more is its definition")

    def after(state: list[Any]) -> Any:
        _, (of_marked, none_against) = state
        leaves = c.define(grants.leaves_room, request, time, asked, separation)
        return (c.all_of(of_marked, c.implies(marked, leaves)), c.all_of(none_against, leaves))

    def invariant(state: list[Any]) -> Any:
        room, (of_marked, none_against) = state
        return c.all_of(c.implies(room, of_marked), c.implies(none_against, room))

    along_items(
        c,
        [(has_room, c.boolean("room"), (asked, separation))],
        item=Items((request, time), each, (marked,)),
        invariant=invariant,
        goal=invariant,
        text="room",
        beside=[Beside((True, True), (c.boolean("of_marked"), c.boolean("none_against")), after)],
    )
