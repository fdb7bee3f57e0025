"""Implicit coordination: two aircraft that do not talk choose sides that fit together.

Relative state is ownship minus intruder: s [m], v [m/s], horizontal, x east, y north; sz, vz up. The
intruder sees the same with all signs changed. A side is 1 or -1. Horizontally it says on which hand of
the relative flight the other is passed: 1 the right one; both aircraft choose the same. Vertically it
says who goes above: 1 the ownship; the two choose opposite ones. A new velocity repels if it goes to
its side, and keeps the other farther away than before or parts from it faster. Sources: Narkawicz and
Munoz, "State-Based Implicit Coordination and Applications", NASA/TP-2011-217067; Narkawicz, Munoz and
Dutle, "Coordination Logic for Repulsive Resolution Maneuvers", AIAA 2016.
"""

from cratous.spec.well_clear import Plane, dot, position, time_of_closest_approach, within


def to_side(side: int, amount: float) -> float:
    """An amount to the right, or up, as one to that side; any number below 0 is the side -1, any other 1."""
    if side < 0:
        return -amount
    return amount


def right_hand(v: Plane) -> Plane:
    """A vector turned to the right by a right angle."""
    return Plane(v.y, -v.x)


def on_the_side(s: Plane, v: Plane, side: int) -> float:
    """How far to that side of the relative flight v the intruder is, times the speed; below 0: it is on
    the other side. Straight flight does not change it."""
    return to_side(side, dot(right_hand(v), Plane(-s.x, -s.y)))


def horizontal_side(s: Plane, v: Plane) -> int:
    """The side on which the intruder is passed if both fly straight on; head-on, the right one."""
    if on_the_side(s, v, 1) >= 0:
        return 1
    return -1


def turned_away(v: Plane, w: Plane, side: int) -> float:
    """Above 0: w points away from that side of v, by less than half a turn; below 0: towards it."""
    return to_side(side, dot(right_hand(w), v))


def repels(s: Plane, v: Plane, w: Plane, side: int) -> bool:
    """The relative velocity w instead of v, which passes on that side, keeps to it, and: from one that
    converges it is turned away; from one that does not it parts faster, and is not turned back."""
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
    """After t seconds of straight flight the two are in one cylinder."""
    height = sz + t * vz
    return within(position(s, v, t), radius) and -half <= height and height <= half


def height_that_decides(s: Plane, v: Plane, sz: float, vz: float, enters: bool) -> float:
    """Whose sign says who goes above: the relative altitude now, if it does not change or a cylinder
    would be entered; the one at the closest approach, if that is to come; where there is none, or the
    two are in one place, the relative climb rate. enters: whether the cylinder would be entered."""
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
    """Who is higher goes above; of two at one height the one whose id is first."""
    if height == 0:
        return 1 if first else -1
    return 1 if height > 0 else -1


def repels_vertically(v: Plane, vz: float, w: Plane, wz: float, side: int) -> bool:
    """The relative velocity (w, wz) instead of (v, vz) climbs faster to that side, in time, and on the
    way along v."""
    if to_side(side, wz) <= to_side(side, vz):
        return False
    return to_side(side, wz * dot(v, v)) >= to_side(side, vz * dot(w, v))


def apart_at(s: Plane, v: Plane, t: float) -> float:
    """The square of the horizontal distance after t seconds of straight flight [m^2]."""
    p = position(s, v, t)
    return dot(p, p)


def more_urgent(size: float, time: float, other_size: float, other_time: float) -> bool:
    """Who comes nearer is more urgent, and of two as near who does so sooner; but of two that come
    within the cylinder (size 1 or less) who does so sooner, and of two as soon who comes nearer."""
    if (size <= 1) != (other_size <= 1):
        return size <= 1
    if size <= 1:
        return time < other_time or (time == other_time and size < other_size)
    return size < other_size or (size == other_size and time < other_time)
