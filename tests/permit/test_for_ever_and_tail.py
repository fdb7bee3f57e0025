"""What is left of a permitted trajectory, and holds that have no end, against the definition at many instants."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from permit_tools import ROUND, encounters, hit, off

from cratous.core.kernel import Vec2
from cratous.core.permit.for_ever import above_for_ever, beside_for_ever, hold_clear
from cratous.core.permit.pieces import (
    Growth,
    Margins,
    Meeting,
    Piece,
    Tube,
    permitted,
    permitted_from,
    reach_after,
)
from cratous.core.readings.exact import exact
from cratous.spec.permit import motion

ANY = encounters(400, 20, 4, st.sampled_from([Fraction(0), Fraction(1, 8)]), 100)
GONE = st.fractions(-5, 60, max_denominator=4)
STEADY = Growth(0.0, 0.0, 0.0)


def left(pieces: list[Piece], meeting: Meeting, gone: Fraction) -> tuple[list[Piece], Meeting]:
    """What is left of the pieces, and the intruder as it is then: cut by hand, not by the kernel."""
    begun, rest = Fraction(0), []
    north = east = up = Fraction(0)
    for piece in pieces:
        flown = min(max(gone - begun, Fraction(0)), piece.duration_s)
        north, east = north + flown * piece.velocity.x, east + flown * piece.velocity.y
        up += flown * piece.climb_m_s
        if begun + piece.duration_s >= gone:
            rest.append(piece._replace(duration_s=piece.duration_s - flown))
        begun += piece.duration_s
    s, w, t = meeting.s, meeting.w, max(gone, Fraction(0))
    there = Vec2(s.x + north - t * w.x, s.y + east - t * w.y)
    wide, high = (
        Growth(reach_after(g, t), g.rate_m_s + 2 * t * g.gain_m_s2, g.gain_m_s2)
        for g in (meeting.wide, meeting.high)
    )
    later = meeting._replace(s=there, sz=meeting.sz + up - t * meeting.wz, wide=wide, high=high)
    return rest, later


@settings(max_examples=100, deadline=None)
@given(ANY.pieces, ANY.meetings, GONE)
def test_from_an_instant_on_is_what_is_left_then(
    pieces: list[Piece], meeting: Meeting, gone: Fraction
) -> None:
    whole = sum((piece.duration_s for piece in pieces), Fraction(0))
    answer = permitted_from(pieces, meeting, gone)
    assert exact(permitted_from, pieces, meeting, gone) == answer
    if permitted(pieces, meeting):
        assert answer
    if gone <= whole:
        assert answer == permitted(*left(pieces, meeting, gone))
    else:
        assert answer  # nothing is left


@settings(max_examples=60, deadline=None)
@given(ANY.pieces, ANY.meetings, GONE, st.data())
def test_what_is_permitted_from_an_instant_on_is_not_hit_after_it(
    pieces: list[Piece], meeting: Meeting, gone: Fraction, data: st.DataObject
) -> None:
    whole = sum((piece.duration_s for piece in pieces), Fraction(0))
    first = max(gone, Fraction(0))
    assume(first <= whole)
    if not permitted_from(pieces, meeting, gone):
        return
    for _ in range(4):
        at = first + (whole - first) * data.draw(st.fractions(0, 1, max_denominator=16))
        rho = max(piece.rho_m for piece in pieces)
        own = off(data.draw(st.sampled_from(ROUND)), rho, rho)
        wide, high = reach_after(meeting.wide, at), reach_after(meeting.high, at)
        other = off(data.draw(st.sampled_from(ROUND)), wide, -high)
        assert not hit(pieces, meeting, own, other, at)


def test_what_is_over_does_not_count() -> None:
    # past the intruder after 1,000 m, which the first 60 s enter
    meeting = Meeting(Vec2(-1000.0, 0.0), 0.0, Vec2(0.0, 0.0), 0.0, STEADY, STEADY, 150.0, 30.0)
    flight = [Piece(Vec2(20.0, 0.0), 0.0, 60.0, 5.0)]
    assert not permitted(flight, meeting)
    assert not permitted_from(flight, meeting, -1.0)
    assert not permitted_from(flight, meeting, 57.75)
    assert permitted_from(flight, meeting, 57.76)
    assert permitted_from(flight, meeting, 61.0)
    # a tube that has grown until then is as wide as it is then
    grown = meeting._replace(wide=Growth(0.0, 0.5, 0.0))
    assert not permitted_from(flight, grown, 59.0)
    assert permitted_from([flight[0]._replace(duration_s=70.0)], grown, 60.0)


@settings(max_examples=150, deadline=None)
@given(ANY.vectors, ANY.velocities, ANY.small, ANY.rates)
@example(Vec2(20, 0), Vec2(1, 0), Fraction(10), Fraction(1))
@example(Vec2(20, 0), Vec2(0, 0), Fraction(20), Fraction(0))
@example(Vec2(20, 0), Vec2(0, 1), Fraction(10), Fraction(1))
@example(Vec2(20, 0), Vec2(-1, 0), Fraction(10), Fraction(1))
@example(Vec2(20, 15), Vec2(-1, 0), Fraction(15), Fraction(0))
def test_beside_for_ever_is_exact(s: Vec2, v: Vec2, start: Fraction, rate: Fraction) -> None:
    def spare(t: Fraction) -> Fraction:
        return (s.x + t * v.x) ** 2 + (s.y + t * v.y) ** 2 - (start + t * rate) ** 2  # type: ignore[return-value]

    a = Fraction(v.x * v.x + v.y * v.y - rate * rate)
    b = Fraction(2 * (s.x * v.x + s.y * v.y - start * rate))
    # every instant that can matter: now, near ones, the closest one, the zero of a line, and very late
    instants = [Fraction(k, 4) for k in range(200)] + [Fraction(10) ** 9]
    instants += [-b / (2 * a)] if a else [-spare(Fraction(0)) / b] if b else []
    least = min(spare(t) for t in instants if t >= 0)
    assert beside_for_ever(s, v, Growth(start, rate, 0)) == (least > 0)
    assert not beside_for_ever(s, v, Growth(start, rate, Fraction(1, 10**6)))  # type: ignore[arg-type]


@settings(max_examples=100, deadline=None)
@given(ANY.places, ANY.speeds, ANY.small, ANY.rates)
@example(Fraction(20), Fraction(1), Fraction(10), Fraction(1))
@example(Fraction(10), Fraction(1), Fraction(10), Fraction(1))
@example(Fraction(20), Fraction(0), Fraction(10), Fraction(1, 4))
def test_above_for_ever_is_exact(
    sz: Fraction, vz: Fraction, start: Fraction, rate: Fraction
) -> None:
    spare = [sz + t * vz - start - t * rate for t in (Fraction(0), Fraction(10) ** 9)]
    assert above_for_ever(sz, vz, Growth(start, rate, 0)) == (min(spare) > 0)  # type: ignore[arg-type]
    assert not above_for_ever(sz, vz, Growth(start, rate, Fraction(1, 10**6)))  # type: ignore[arg-type]


@settings(max_examples=80, deadline=None)
@given(ANY.meetings, ANY.small, st.sampled_from(ROUND), st.sampled_from(ROUND), st.integers(0, 400))
def test_a_hold_that_is_clear_is_never_hit(
    meeting: Meeting,
    rho: Fraction,
    one: tuple[float, float],
    two: tuple[float, float],
    quarters: int,
) -> None:
    s, sz, v, vz, wide, high, radius, half = meeting
    tube, margins = Tube(wide, high), Margins(radius, half, rho)
    if not hold_clear(s, v, sz, vz, tube, margins):
        return
    for t in (Fraction(quarters, 4), Fraction(quarters) * 1000):
        own = off(one, rho, rho)
        other = off(two, reach_after(wide, t), -reach_after(high, t))  # type: ignore[arg-type]
        args = (s, v, sz, vz, motion.Offs(own, other), tube, margins, t)
        assert not motion.hit_at(*args)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("s", "v", "sz", "vz", "wide", "clear"),
    [
        (Vec2(200.0, 0.0), Vec2(0.0, 0.0), 0.0, 0.0, STEADY, True),  # hovers
        (Vec2(155.0, 0.0), Vec2(0.0, 0.0), 0.0, 0.0, STEADY, False),  # 150 m and 5 m, closed
        (Vec2(200.0, 0.0), Vec2(-1.0, 0.0), 0.0, 0.0, STEADY, False),  # comes, however late
        (Vec2(200.0, 0.0), Vec2(1.0, 0.0), 0.0, 0.0, STEADY, True),
        (Vec2(200.0, 156.0), Vec2(-1.0, 0.0), 0.0, 0.0, STEADY, True),  # passes
        (Vec2(200.0, 0.0), Vec2(1.0, 0.0), 0.0, 0.0, Growth(0.0, 1.0, 0.0), True),
        (Vec2(200.0, 0.0), Vec2(1.0, 0.0), 0.0, 0.0, Growth(0.0, 1.01, 0.0), False),
        (Vec2(200.0, 0.0), Vec2(9.0, 0.0), 0.0, 0.0, Growth(0.0, 0.0, 0.001), False),
        (Vec2(0.0, 0.0), Vec2(0.0, 0.0), 36.0, 0.0, STEADY, True),  # above
        (Vec2(0.0, 0.0), Vec2(0.0, 0.0), -36.0, 0.0, STEADY, True),  # below
        (Vec2(0.0, 0.0), Vec2(0.0, 0.0), 36.0, -0.01, STEADY, False),
        (Vec2(0.0, 0.0), Vec2(0.0, 0.0), 35.0, 0.0, STEADY, False),
    ],
)
def test_which_holds_are_clear_for_ever(
    s: Vec2, v: Vec2, sz: float, vz: float, wide: Growth, clear: bool
) -> None:
    around = (Tube(wide, STEADY), Margins(150.0, 30.0, 5.0))
    assert hold_clear(s, v, sz, vz, *around) is clear
    assert exact(hold_clear, s, v, sz, vz, *around) is clear
