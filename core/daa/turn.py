"""Turning in steps, in algebraic form: a step turns the velocity by a fixed angle.

Definitions: `spec.daa.meaning`. The angle is given by its cosine c and sine s with c^2 + s^2 = 1, so
no kernel calls a trigonometric function. Positive s turns right (x east, y north).
"""

from cratous.core.kernel import Vec2, kernel


@kernel(implements="daa.meaning.is_turned")
def turned(v: Vec2, c: float, s: float) -> Vec2:
    """The velocity v [m/s] turned to the right by the angle with cosine c and sine s."""
    return Vec2(v.x * c + v.y * s, v.y * c - v.x * s)


@kernel(implements="daa.meaning.is_arc")
def turn_offset(v: Vec2, w: Vec2) -> Vec2:
    """Where a turn from velocity v to velocity w leads, times the turn rate (right positive).

    Divided by the turn rate [rad/s] it is the offset of the position [m].
    """
    return Vec2(v.y - w.y, w.x - v.x)
