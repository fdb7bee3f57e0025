"""The inputs of a permit in units in which every number is an integer: the same verdict, without rationals.

A double is an integer multiple of some power of two. So there are units of time and of length, each a power of two of
a second or a metre, in which all times, velocities and lengths of a path and a meeting are integers. The kernels of
`core.permit.pieces` have no constant with a unit and compare only quantities of one unit, so that no verdict depends
on the units (`tests/permit/test_whole_numbers.py`); integers are as exact as rationals, and much faster.
"""

from __future__ import annotations

from collections.abc import Sequence

from cratous.core.kernel import Vec2
from cratous.core.permit.pieces import Growth, Meeting

Moving = tuple[Vec2, float, float, float]
"""Velocity [m/s], climb [m/s, up], duration [s] and rho [m], as in `core.permit.pieces.Piece`."""


def in_whole_numbers(pieces: Sequence[Moving], met: Meeting) -> tuple[list[Moving], Meeting]:
    """The same segments and meeting in such units. ValueError or OverflowError for a number that is not finite."""
    s, sz, w, wz, wide, high, radius_m, half_m = met
    times = [_ratio(piece[2]) for piece in pieces]
    speeds = [_ratio(v) for one in pieces for v in (*one[0], one[1])]
    speeds += [_ratio(v) for v in (*w, wz, wide.rate_m_s, high.rate_m_s)]
    lengths = [_ratio(piece[3]) for piece in pieces]
    lengths += [_ratio(x) for x in (*s, sz, wide.start_m, high.start_m, radius_m, half_m)]
    gains = [_ratio(wide.gain_m_s2), _ratio(high.gain_m_s2)]
    # binary places: of a length as many as of time and velocity together
    time = max((d.bit_length() for _, d in times), default=1) - 1
    speed = max(d.bit_length() for _, d in speeds) - 1
    length = max(d.bit_length() for _, d in lengths) - 1
    gain = max(d.bit_length() for _, d in gains) - 1
    speed = max(speed, length - time, gain + time)
    t, v = _scaled(times, time), _scaled(speeds, speed)
    x, g = _scaled(lengths, time + speed), _scaled(gains, speed - time)
    count = len(pieces)
    moved: list[Moving] = [
        (Vec2(v[3 * k], v[3 * k + 1]), v[3 * k + 2], t[k], x[k]) for k in range(count)
    ]
    north, east, climb, wide_rate, high_rate = v[3 * count :]
    at_north, at_east, above, wide_start, high_start, radius, half = x[count:]
    return moved, Meeting(
        Vec2(at_north, at_east), above, Vec2(north, east), climb,
        Growth(wide_start, wide_rate, g[0]), Growth(high_start, high_rate, g[1]), radius, half,
    )  # fmt: skip


def _ratio(value: float) -> tuple[int, int]:
    """A double as numerator and denominator, the latter a power of two."""
    return value.as_integer_ratio()


def _scaled(ratios: Sequence[tuple[int, int]], bits: int) -> list[int]:
    """Numbers in units of 2^-bits, which divides each of them."""
    return [n << bits - d.bit_length() + 1 for n, d in ratios]
