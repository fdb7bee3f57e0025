"""Places of aircraft off their trajectory, and the definition of being hit."""

from __future__ import annotations

import math
from collections.abc import Iterable
from fractions import Fraction

from cratous.core.permit.pieces import Meeting, Piece
from cratous.spec.permit import motion

ROUND = [(0.0, 0.0), *[(math.cos(k * math.pi / 4), math.sin(k * math.pi / 4)) for k in range(8)]]
"""No way off, and as far off as is possible in eight directions."""


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
