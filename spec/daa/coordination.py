"""Implicit coordination: two aircraft that do not communicate choose compatible sides.

Relative state is ownship minus intruder: s [m], v [m/s], horizontal, x east, y north; sz, vz up. The intruder sees
the same with all signs reversed. A side is 1 or -1. Horizontally it says on which side of the relative flight path
the other is passed: 1 the right; both aircraft choose the same. Vertically it says who goes above: 1 the ownship; the
two choose opposite values. A new velocity is repulsive if it turns to its side and either keeps the other farther
away than before or separates from it faster. Sources: Narkawicz and Munoz, "State-Based Implicit Coordination and
Applications", NASA/TP-2011-217067; Narkawicz, Munoz and Dutle, "Coordination Logic for Repulsive Resolution
Maneuvers", AIAA 2016.
"""

from cratous.spec.well_clear import Plane, dot, position, time_of_closest_approach, within


def to_side(side: int, amount: float) -> float:
    """Convert an amount to the right, or up, into an amount to the given side; a side below 0 counts as -1, any other
    as 1.
    """
    if side < 0:
        return -amount
    return amount


def right_hand(v: Plane) -> Plane:
    """A vector turned to the right by 90 degrees."""
    return Plane(v.y, -v.x)


def on_the_side(s: Plane, v: Plane, side: int) -> float:
    """The intruder's offset to that side of the relative path v, times the relative speed; negative: it is on the
    other side. Straight flight does not change it.
    """
    return to_side(side, dot(right_hand(v), Plane(-s.x, -s.y)))


def horizontal_side(s: Plane, v: Plane) -> int:
    """The side on which the intruder is passed if both fly straight; head-on, the right (1)."""
    if on_the_side(s, v, 1) >= 0:
        return 1
    return -1


def turned_away(v: Plane, w: Plane, side: int) -> float:
    """Positive: w is turned away from that side of v by less than 180 degrees; negative: towards it."""
    return to_side(side, dot(right_hand(w), v))


def repels(s: Plane, v: Plane, w: Plane, side: int) -> bool:
    """The relative velocity w in place of v, which passes on that side, stays on it, and: if v converges, w is turned
    away; otherwise w separates faster and is not turned back.
    """
    if on_the_side(s, v, side) < 0 or on_the_side(s, w, side) <= 0:
        return False
    if dot(s, v) < 0:
        return turned_away(v, w, side) > 0
    if v.x == 0 and v.y == 0:
        return dot(s, w) >= 0
    return dot(s, w) > dot(s, v) and turned_away(v, w, side) >= 0


def in_cylinder_at(
    s: Plane, v: Plane, sz: float, vz: float, radius: float, half: float, t: float
) -> bool:
    """After t seconds of straight flight the intruder is within a cylinder about the ownship."""
    height = sz + t * vz
    return within(position(s, v, t), radius) and -half <= height and height <= half


def height_that_decides(s: Plane, v: Plane, sz: float, vz: float, enters: bool) -> float:
    """The value whose sign decides who goes above: the relative altitude now, if it does not change or the cylinder
    would be entered; that at the closest approach, if this is still to come; without one, or if both are at the same
    place, the relative climb rate. enters: whether the cylinder would be entered.
    """
    if vz == 0:
        return sz
    if s.x == 0 and s.y == 0 and sz == 0:
        return vz
    if enters:
        return sz
    if v.x == 0 and v.y == 0:
        return vz
    if dot(s, v) <= 0:
        return sz + time_of_closest_approach(s, v) * vz
    return sz


def vertical_side(height: float, first: bool) -> int:
    """The higher aircraft goes above; at equal height, the one whose id is first."""
    if height == 0:
        return 1 if first else -1
    return 1 if height > 0 else -1


def repels_vertically(v: Plane, vz: float, w: Plane, wz: float, side: int) -> bool:
    """The relative velocity (w, wz) in place of (v, vz) climbs faster to that side, per unit of time and per distance
    along v.
    """
    if to_side(side, wz) <= to_side(side, vz):
        return False
    return to_side(side, wz * dot(v, v)) >= to_side(side, vz * dot(w, v))


def apart_at(s: Plane, v: Plane, t: float) -> float:
    """The square of the horizontal distance after t seconds of straight flight [m^2]."""
    p = position(s, v, t)
    return dot(p, p)


def more_urgent(size: float, time: float, other_size: float, other_time: float) -> bool:
    """The aircraft that comes nearer is more urgent, and at equal distance the earlier one; but of two that enter the
    cylinder (size 1 or less) the earlier one, and of two equally early the nearer one.
    """
    if (size <= 1) != (other_size <= 1):
        return size <= 1
    if size <= 1:
        return time < other_time or (time == other_time and size < other_size)
    return size < other_size or (size == other_size and time < other_time)
