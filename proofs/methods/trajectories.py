"""Theorems on trajectories of any number of segments past one intruder, for all segments and for those remaining."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from cratous.core.kernel import Fold, Vec2
from cratous.core.permit.pieces import Flight, Growth, Margins, Meeting, Piece, Tube, piece_clear
from cratous.proofs.claim import Claim
from cratous.proofs.methods.meetings import (
    any_meeting,
    any_offs,
    margins_by_name,
    offs_by_name,
    tube_by_name,
)
from cratous.proofs.methods.runs import Items, along_items
from cratous.spec.permit import motion


class Asked(NamedTuple):
    """The arguments of the kernel that checks a segment."""

    s: Vec2
    v: Vec2
    sz: Any
    vz: Any
    tube: Tube
    margins: Margins
    d: Any


def any_piece(c: Claim) -> Piece:
    """An arbitrary segment of a trajectory: velocity `v` and `vz`, `duration`, and `rho` about the reference."""
    return Piece(c.vector("v"), c.real("vz"), c.real("duration"), c.real("rho"))


def as_item(c: Claim, piece: Piece) -> Items:
    """The segment as an arbitrary item of a trajectory: its duration and its rho are not negative."""
    return Items(tuple(piece), c.all_of(piece.duration_s >= 0, piece.rho_m >= 0))


def asked(c: Claim, meeting: Meeting, piece: Piece, place: tuple[Any, ...], flown: Any) -> Asked:
    """The arguments of the kernel for a segment after `flown` seconds of it; place: how far the reference has moved
    when the segment begins, north, east and up, and the time then."""
    north, east, up, begin = place
    v, vz, duration, rho = piece
    time = begin + flown
    north, east, up = north + flown * v.x, east + flown * v.y, up + flown * vz
    return Asked(
        Vec2(meeting.s.x + north - time * meeting.w.x, meeting.s.y + east - time * meeting.w.y),
        Vec2(v.x - meeting.w.x, v.y - meeting.w.y),
        meeting.sz + up - time * meeting.wz,
        vz - meeting.wz,
        later(c, Tube(meeting.wide, meeting.high), time),
        Margins(meeting.radius_m, meeting.half_height_m, rho),
        duration - flown,
    )


def later(c: Claim, tube: Tube, time: Any) -> Tube:
    """The same tube, with time counted from the given time on."""
    wide, high = (Growth(*c.define(motion.later, growth, time)) for growth in tube)
    return Tube(wide, high)


def by_name(question: Asked) -> dict[str, Any]:
    """The arguments under the names that theorems on segments use, for lemmas."""
    state = {"s": question.s, "v": question.v, "sz": question.sz, "vz": question.vz}
    return {
        **state,
        "d": question.d,
        **tube_by_name(question.tube),
        **margins_by_name(question.margins),
    }


def only_grows(c: Claim, meeting: Meeting, time: Any) -> None:
    """Steps: at a time that is not negative no radius or rate of the tube is smaller than at the start."""
    for growth in (meeting.wide, meeting.high):
        faster = time * growth.gain_m_s2
        c.step(c.all_of(faster >= 0, time * growth.rate_m_s >= 0), "no growth below 0")
        c.step(time * faster >= 0, "nor what it adds")


def is_not_hit(
    c: Claim, permitted: Fold[Any], at: Any, flown: Callable[[Any], Any], *context: Any
) -> None:
    """A permitted trajectory does not enter the cylinder at the instant `at`, for any deviations of both aircraft.
    flown(begin): the part [s] of a segment starting then that is over and so not checked; context: further
    arguments of the fold."""
    meeting, offs, piece = any_meeting(c), any_offs(c), any_piece(c)
    c.opaque(piece_clear, motion.enters_at)

    def invariant(state: list[Any]) -> Any:
        flight, way = state
        place = (flight.north_m, flight.east_m, flight.up_m, flight.time_s)
        same = c.same(place, (way.north, way.east, way.up, way.time))
        return c.all_of(same, way.time >= 0, c.implies(flight.clear, c.negation(way.hit)))

    def known(state: list[Any]) -> None:
        flight, way = state
        place = (flight.north_m, flight.east_m, flight.up_m, flight.time_s)
        mine = asked(c, meeting, piece, place, flown(flight.time_s))
        begun = asked(c, meeting, piece, (way.north, way.east, way.up, way.time), flown(way.time))
        c.congruence(piece_clear, tuple(mine), tuple(begun))
        begin = way.time + flown(way.time)
        t = at - begin
        inside = c.all_of(t >= 0, at - way.time <= piece.duration_s)
        only_grows(c, meeting, begin)
        c.lemma(
            "permit_piece_clear_is_not_hit",
            when=inside,
            t=t,
            **by_name(begun),
            **offs_by_name(offs),
        )

    start = motion.Way(False, 0, 0, 0, 0)
    way = motion.Way(c.boolean("hit"), *c.reals("w_north w_east w_up w_time"))
    model = Fold("way", "permit.motion.way_step", motion.way_step, start, motion.way_result)
    flight = Flight(c.boolean("clear"), *c.reals("north east up time"))
    along_items(
        c,
        [(permitted, flight, (meeting, *context))],
        item=as_item(c, piece),
        invariant=invariant,
        known=known,
        goal=lambda results: c.implies(results[0], c.negation(results[1])),
        text="no hit",
        models=[(model, way, (meeting, offs, at))],
    )
