"""What is permitted is not hit: the kernels against the definition at many instants and places."""

from __future__ import annotations

from fractions import Fraction

from hypothesis import example, given, settings
from hypothesis import strategies as st
from permit_tools import ROUND, encounters, hit, off

from cratous.core.kernel import Vec2
from cratous.core.permit.pieces import (
    Growth,
    Meeting,
    Piece,
    above_during,
    beside_during,
    growth_after,
    permitted,
    reach_after,
)
from cratous.core.permit.tubes import disc_within, tube_within
from cratous.core.readings.exact import exact
from cratous.core.readings.machine.compiled import compiled
from cratous.spec.permit import motion

ANY = encounters(2000, 40, 8, st.fractions(0, 1, max_denominator=8), 300)


@settings(max_examples=80, deadline=None)
@given(ANY.pieces, ANY.meetings, st.data())
def test_what_is_permitted_is_not_hit(
    pieces: list[Piece], meeting: Meeting, data: st.DataObject
) -> None:
    if not permitted(pieces, meeting):
        return
    assert exact(permitted, pieces, meeting)
    whole = sum((piece.duration_s for piece in pieces), Fraction(0))
    for _ in range(6):
        at = whole * data.draw(st.fractions(0, 1, max_denominator=16))
        rho = max(piece.rho_m for piece in pieces)
        one, two = data.draw(st.sampled_from(ROUND)), data.draw(st.sampled_from(ROUND))
        side = data.draw(st.sampled_from([Fraction(-1), Fraction(1)]))
        own = off(one, side * rho, side * rho)
        wide, high = reach_after(meeting.wide, at), reach_after(meeting.high, at)
        side = data.draw(st.sampled_from([Fraction(-1), Fraction(1)]))
        other = off(two, side * wide, side * high)
        assert not hit(pieces, meeting, own, other, at)


def test_both_verdicts_occur() -> None:
    steady = Growth(0, 0, 0)
    flight = [Piece(Vec2(22.0, 0.0), 0.0, 60.0, 5.0)]
    far, near = (
        Meeting(Vec2(-1000.0, east), 0.0, Vec2(0.0, 0.0), 0.0, steady, steady, 150.0, 30.0)
        for east in (155.5, 154.5)
    )
    assert permitted(flight, far)
    assert not permitted(flight, near)
    # stopping before it is permitted, and so is passing above
    assert permitted([Piece(Vec2(22.0, 0.0), 0.0, 40.0, 5.0)], near)
    assert permitted(flight, near._replace(sz=35.5))
    assert not permitted(flight, near._replace(sz=34.5))
    # a tube that grows reaches it
    assert not permitted(flight, far._replace(wide=Growth(0.0, 0.0, 0.5)))
    assert not permitted(flight, far._replace(wide=Growth(0.5, 0.0, 0.0)))


@settings(max_examples=100, deadline=None)
@given(ANY.vectors, ANY.velocities, ANY.small, ANY.rates, st.fractions(0, 60, max_denominator=4))
@example(Vec2(20, 0), Vec2(0, 0), Fraction(10), Fraction(1), Fraction(10))
def test_beside_is_exact_where_the_radius_grows_steadily(
    s: Vec2, v: Vec2, start: Fraction, rate: Fraction, d: Fraction
) -> None:
    growth = Growth(start, rate, 0)
    apart = lambda t: (s.x + t * v.x) ** 2 + (s.y + t * v.y) ** 2 - (start + t * rate) ** 2  # noqa: E731
    a = v.x * v.x + v.y * v.y - rate * rate
    instants = [Fraction(0), d, *[d * k / 64 for k in range(65)]]
    if a > 0:
        vertex = -(s.x * v.x + s.y * v.y - start * rate) / a
        instants.append(min(max(vertex, Fraction(0)), d))
    assert beside_during(s, v, growth, d) == (min(apart(t) for t in instants) > 0)


@settings(max_examples=100, deadline=None)
@given(ANY.places, ANY.speeds, ANY.growths, st.fractions(0, 60, max_denominator=4))
def test_above_is_exact(sz: Fraction, vz: Fraction, growth: Growth, d: Fraction) -> None:
    least = min(sz + t * vz - reach_after(growth, t) for t in (d * k / 32 for k in range(33)))
    assert above_during(sz, vz, growth, d) == (least > 0)


@settings(max_examples=100, deadline=None)
@given(ANY.growths, ANY.small, ANY.small)
def test_growth_is_counted_on(growth: Growth, t: Fraction, more: Fraction) -> None:
    assert reach_after(growth_after(growth, t), more) == reach_after(growth, t + more)


@settings(max_examples=100, deadline=None)
@given(
    ANY.vectors,
    ANY.velocities,
    ANY.growths,
    ANY.growths,
    ANY.small,
    ANY.small,
    st.sampled_from(ROUND),
)
@example(Vec2(0, 0), Vec2(0, 0), Growth(1, 0, 0), Growth(1, 0, 0), Fraction(3), Fraction(9), (1, 0))
def test_a_nested_tube_stays_nested(
    s: Vec2, v: Vec2, new: Growth, old: Growth, age: Fraction, t: Fraction, way: tuple[float, float]
) -> None:
    s, v = Vec2(s.x / 100, s.y / 100), Vec2(v.x / 40, v.y / 40)
    if tube_within(s, v, new, old, age):
        wide = reach_after(new, t) * Fraction(999, 1000)
        o = motion.Plane(Fraction(way[0]) * wide, Fraction(way[1]) * wide)  # type: ignore[arg-type]
        assert motion.in_tube_at(s, v, o, new, old, age, t)  # type: ignore[arg-type]


def test_discs() -> None:
    assert disc_within(Vec2(3.0, 4.0), 5.0, 10.0)
    assert not disc_within(Vec2(3.0, 4.0), 5.001, 10.0)
    assert not disc_within(Vec2(0.0, 0.0), 2.0, 1.0)
    many = compiled(disc_within)([3.0, 3.0], [4.0, 4.0], [5.0, 6.0], 10.0)
    assert many.tolist() == [True, False]
