"""Places of aircraft off their trajectory, and the definition of being hit."""

from __future__ import annotations

import math
from collections.abc import Iterable
from fractions import Fraction
from typing import NamedTuple

from hypothesis import strategies as st

from cratous.core.kernel import Vec2
from cratous.core.permit.pieces import Growth, Meeting, Piece
from cratous.spec.permit import motion

ROUND = [(0.0, 0.0), *[(math.cos(k * math.pi / 4), math.sin(k * math.pi / 4)) for k in range(8)]]
"""No way off, and as far off as is possible in eight directions."""


class Encounters(NamedTuple):
    """Strategies for a trajectory and an intruder, and for the numbers that they are made of."""

    places: st.SearchStrategy[Fraction]
    speeds: st.SearchStrategy[Fraction]
    small: st.SearchStrategy[Fraction]
    rates: st.SearchStrategy[Fraction]
    growths: st.SearchStrategy[Growth]
    pieces: st.SearchStrategy[list[Piece]]
    meetings: st.SearchStrategy[Meeting]

    @property
    def vectors(self) -> st.SearchStrategy[Vec2]:
        return st.builds(Vec2, self.places, self.places)

    @property
    def velocities(self) -> st.SearchStrategy[Vec2]:
        return st.builds(Vec2, self.speeds, self.speeds)


def encounters(
    place_m: int, speed_m_s: int, parts: int, gains: st.SearchStrategy[Fraction], dthr_m: int
) -> Encounters:
    """Up to a place [m], a speed [m/s] and a distance of well clear [m], in steps of 1/parts."""
    places = st.fractions(-place_m, place_m, max_denominator=parts)
    speeds = st.fractions(-speed_m_s, speed_m_s, max_denominator=parts)
    small = st.fractions(0, 30, max_denominator=parts)
    rates = st.fractions(0, 2, max_denominator=parts)
    growths = st.builds(Growth, small, rates, gains)
    vectors, velocities = st.builds(Vec2, places, places), st.builds(Vec2, speeds, speeds)
    times = st.fractions(0, 20, max_denominator=4)
    pieces = st.lists(st.builds(Piece, velocities, speeds, times, small), min_size=1, max_size=4)
    meetings = st.builds(
        Meeting, vectors, places, velocities, speeds, growths, growths,
        st.fractions(0, dthr_m, max_denominator=4), st.fractions(0, 60, max_denominator=4),
    )  # fmt: skip
    return Encounters(places, speeds, small, rates, growths, pieces, meetings)


def off(direction: tuple[float, float], wide: Fraction, high: Fraction) -> motion.Off:
    """A place as far off as is possible, a little inside so that the sine's rounding is no matter."""
    x, y = (Fraction(part) * Fraction(999, 1000) for part in direction)
    return motion.Off(wide * x, wide * y, high)  # type: ignore[arg-type]


def hit(
    pieces: Iterable[Piece], meeting: Meeting, own: motion.Off, other: motion.Off, at: object
) -> bool:
    """The definition's fold."""
    way = motion.Way(False, 0, 0, 0, 0)
    for piece in pieces:
        way = motion.way_step(way, *piece, meeting, motion.Offs(own, other), at)  # type: ignore[arg-type]
    return motion.way_result(way)
