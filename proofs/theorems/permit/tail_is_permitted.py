"""The tail of a permitted trajectory is permitted: what is permitted against an intruder is permitted against it
from every instant on, for every number of pieces."""

from typing import Any

from cratous.core.kernel import Vec2
from cratous.core.permit.pieces import Flight, permitted, permitted_from, piece_clear
from cratous.proofs.claim import Claim
from cratous.proofs.methods.meetings import any_meeting
from cratous.proofs.methods.runs import along_items
from cratous.proofs.methods.trajectories import (
    any_piece,
    as_item,
    asked,
    by_name,
    later,
    only_grows,
)


def claim(c: Claim) -> None:
    gone = c.real("gone")
    meeting, piece = any_meeting(c), any_piece(c)
    c.opaque(piece_clear)

    def seen(flight: Any, flown: Any) -> Any:
        place = (flight.north_m, flight.east_m, flight.up_m, flight.time_s)
        return asked(c, meeting, piece, place, flown)

    def invariant(state: list[Any]) -> Any:
        whole, part = state
        same = c.same(
            (whole.north_m, whole.east_m, whole.up_m, whole.time_s),
            (part.north_m, part.east_m, part.up_m, part.time_s),
        )
        return c.all_of(same, whole.time_s >= 0, c.implies(whole.clear, part.clear))

    def known(state: list[Any]) -> None:
        whole, part = state
        time = whole.time_s
        flown, its = (
            c.when(gone - f.time_s >= 0, gone - f.time_s, f.time_s - f.time_s) for f in state
        )
        begun = seen(whole, time - time)
        only_grows(c, meeting, time)
        c.lemma(
            "permit_piece_that_is_clear_has_a_clear_tail",
            when=time + piece.duration_s >= gone,
            k=flown,
            **by_name(begun),
        )
        at, rel, z, wrel, tube, margins, _ = begun
        shifted = (
            Vec2(at.x + flown * rel.x, at.y + flown * rel.y), rel, z + flown * wrel, wrel,
            later(c, tube, flown), margins, piece.duration_s - flown,
        )  # fmt: skip
        c.congruence(piece_clear, shifted, tuple(seen(whole, flown)))
        c.congruence(piece_clear, tuple(seen(part, its)), tuple(seen(whole, flown)))

    names = ("whole", "part")
    states = [Flight(c.boolean(n), *c.reals(f"{n}_n {n}_e {n}_u {n}_t")) for n in names]
    along_items(
        c,
        [(permitted, states[0], (meeting,)), (permitted_from, states[1], (meeting, gone))],
        item=as_item(c, piece),
        invariant=invariant,
        known=known,
        goal=lambda results: c.implies(results[0], results[1]),
        text="the tail",
    )
