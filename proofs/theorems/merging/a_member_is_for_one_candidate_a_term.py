"""In each term a member votes for at most one candidate, and its term never decreases, whatever candidates and leaders
ask of it, in any terms, order and number, and however often it stands itself."""

from typing import Any

from cratous.core.merging.votes import Seat, seat_asked, seat_stands
from cratous.proofs.claim import Claim
from cratous.proofs.methods.runs import Beside, Items, along_items
from cratous.spec.merging import votes

MOST = 1 << 60


def claim(c: Claim) -> None:
    seat = Seat(c.integer("seat_term"), c.integer("seat_voted"))
    asked, who = c.integer("asked_term"), c.integer("asked_for")
    c.premise(c.all_of(seat.latest >= 0, seat.latest <= MOST, who > 0))
    answer = c.use(seat_asked, seat, asked, who)
    c.show(c.define(votes.is_after_ask, seat, asked, who, answer), "a vote is its definition")
    c.show(answer.seat.latest >= seat.latest, "no term goes back")
    stood = c.use(seat_stands, seat, who)
    next_one = c.define(votes.stands_in, seat, who, stood.seat)
    c.show(c.implies(stood.stands, next_one), "to stand is its definition")
    c.show(c.implies(seat.latest < MOST, stood.stands), "and it does")
    # two candidates and a term; one event: somebody asks, or the member stands
    term, one, other = c.integer("of_term"), c.integer("one"), c.integer("other")
    c.premise(c.all_of(term >= 0, one > 0, other > 0))
    stands, in_term, by = c.boolean("stands"), c.whole("in_term"), c.whole("by")
    each = c.all_of(in_term >= 0, in_term <= MOST, by > 0, by <= MOST)

    def after(state: list[Any]) -> Any:
        at, for_one, for_other = state[0]
        heard, up = c.use(seat_asked, at, in_term, by), c.use(seat_stands, at, by)
        now_at = c.when(stands, up.seat, heard.seat)
        its_term = c.when(stands, up.seat.latest, in_term)
        gives = c.all_of(c.when(stands, up.stands, heard.yes), its_term == term)
        return (
            now_at,
            c.any_of(for_one, c.all_of(gives, by == one)),
            c.any_of(for_other, c.all_of(gives, by == other)),
        )

    def invariant(state: list[Any]) -> Any:
        at, for_one, for_other = state[0]
        passed, here = at.latest > term, at.latest == term
        return c.all_of(
            at.latest >= 0,
            at.latest <= MOST,
            at.voted >= 0,
            at.voted <= MOST,
            c.implies(for_one, c.any_of(passed, c.all_of(here, at.voted == one))),
            c.implies(for_other, c.any_of(passed, c.all_of(here, at.voted == other))),
            c.implies(c.all_of(for_one, for_other), one == other),
        )

    def goal(results: list[Any]) -> Any:
        _, for_one, for_other = results[0]
        return c.implies(c.all_of(for_one, for_other), one == other)

    any_seat = Seat(c.whole("at_term"), c.whole("at_voted"))
    state = (any_seat, c.boolean("for_one"), c.boolean("for_other"))
    along_items(
        c,
        [],
        item=Items((), each, (stands, in_term, by)),
        invariant=invariant,
        goal=goal,
        text="one",
        beside=[Beside((Seat(0, 0), False, False), state, after)],
    )
