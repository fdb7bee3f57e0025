"""Implicit coordination: which side, and which new velocities keep to it.

Definitions: `spec.daa.coordination`. Relative state is ownship minus intruder, x east, y north, z up. Both aircraft
of a pair call these kernels, each with its own signs: they agree on the horizontal side, and choose opposite vertical
ones. What is proved of it: `cratous prove --only 'daa_coordination*' -v`.
"""

from cratous.core.kernel import Vec2, driver, kernel
from cratous.core.well_clear.during import within_during


@kernel(implements="daa.coordination.horizontal_side")
def horizontal_side(s: Vec2, v: Vec2) -> int:
    """1: the intruder is passed on the right of the relative flight path, or head-on; -1: on the left."""
    if v.x * s.y >= v.y * s.x:
        return 1
    return -1


@kernel(implements="daa.coordination.repels")
def repels(s: Vec2, v: Vec2, w: Vec2, side: int) -> bool:
    """True iff the relative velocity w [m/s] instead of v repels: it goes to the side, and away."""
    before = s.x * v.y - s.y * v.x
    after = s.x * w.y - s.y * w.x
    turn = w.x * v.y - w.y * v.x
    if side < 0:
        before = 0 - before
        after = 0 - after
        turn = 0 - turn
    if before > 0 or after >= 0:
        return False
    rate = s.x * v.x + s.y * v.y
    new_rate = s.x * w.x + s.y * w.y
    if rate < 0:
        return turn < 0
    if v.x == 0 and v.y == 0:
        return new_rate >= 0
    return new_rate > rate and turn <= 0


@kernel(implements="daa.coordination.in_cylinder_at", nonnegative=("radius_m", "half_m"))
def enters_cylinder(s: Vec2, v: Vec2, sz: float, vz: float, radius_m: float, half_m: float) -> bool:
    """True iff the two are within a cylinder [m] of each other now or later; for vz not 0, else False."""
    if vz == 0:
        return False
    w = abs(vz)
    z = sz
    if vz < 0:
        z = 0 - sz
    # in scaled time z grows with rate 1
    first = max(0 - half_m - z, 0)
    last = half_m - z
    if first > last:
        return False
    at = Vec2(s.x * w + first * v.x, s.y * w + first * v.y)
    return within_during(at, v, radius_m * w, last - first)


@kernel(implements="daa.coordination.vertical_side")
def side_of(high: float, low: float, first: bool) -> int:
    """1 if high is above low, -1 if below; at equal height decided by whose id is first."""
    if high > low:
        return 1
    if high < low:
        return -1
    if first:
        return 1
    return -1


@kernel(implements="daa.coordination.height_that_decides")
def vertical_side(
    sz: float, vz: float, vv: float, sv: float, together: bool, enters: bool, first: bool
) -> int:
    """1: the ownship goes above the intruder, -1: below it.

    On invariants: relative altitude [m] and climb rate [m/s], |v|^2, s.v; together: whether the two are at the same
    place; enters: whether a cylinder that must not be entered on the way to the other side would be
    (`enters_cylinder`); first: whether the own id is first of the two (equal heights).
    """
    if vz == 0:
        return side_of(sz, 0, first)
    if together:
        return side_of(vz, 0, first)
    if enters:
        return side_of(sz, 0, first)
    if vv == 0:
        return side_of(vz, 0, first)
    if sv > 0:
        return side_of(sz, 0, first)
    # the altitude at the closest approach, times |v|^2
    return side_of(sz * vv, sv * vz, first)


@kernel(implements="daa.coordination.repels_vertically")
def repels_vertically(v: Vec2, vz: float, w: Vec2, wz: float, side: int) -> bool:
    """True iff the relative velocity (w, wz) [m/s] instead of (v, vz) repels vertically."""
    along = wz * (v.x * v.x + v.y * v.y) - vz * (w.x * v.x + w.y * v.y)
    faster = wz - vz
    if side < 0:
        along = 0 - along
        faster = 0 - faster
    return faster > 0 and along >= 0


@kernel(implements="daa.coordination.more_urgent")
def more_urgent(size: float, time_s: float, other_size: float, other_time_s: float) -> bool:
    """True iff an intruder is more urgent than another; size: of the least cylinder that both enter in straight
    flight, in cylinders (squared); time_s: when [s].
    """
    if size <= 1:
        if other_size > 1:
            return True
        return time_s < other_time_s or (time_s == other_time_s and size < other_size)
    return size < other_size or (size == other_size and time_s < other_time_s)


@driver(checked_by=("repels", "repels_vertically"))
def step_is_repulsive(own, k, step_s, other, side, side_z):
    """Whether step k of one side repels an intruder in straight flight.

    own: as in `core.daa.steps.safe_steps`; other: (6,) state now; side, side_z: to keep to, 0: none. If steps take no
    time (step_s 0), each is checked by itself. Otherwise the present flight, step 0, is always allowed, and of each
    later step these are checked: its velocity against the mean one of the segment before it, that of the segment
    after it against both; and of the first segment, its velocity against the present one.
    """
    if step_s > 0 and k == 0:
        return True
    u, v, w = other[3], other[4], other[5]
    now = Vec2(own[0, 6] - u, own[0, 7] - v)
    now_z = own[0, 5] - w
    s0 = Vec2(own[0, 0] - other[0], own[0, 1] - other[1])
    at = Vec2(own[k, 3] - u, own[k, 4] - v)
    at_z = own[k, 5] - w
    if step_s == 0:
        return (side == 0 or repels(s0, now, at, side)) and (
            side_z == 0 or repels_vertically(now, now_z, at, at_z, side_z)
        )
    t = k * step_s
    s = Vec2(own[k, 0] - other[0] - u * t, own[k, 1] - other[1] - v * t)
    before = Vec2(own[k - 1, 8] - u, own[k - 1, 9] - v)
    before_z = own[k - 1, 10] - w
    after = Vec2(own[k, 8] - u, own[k, 9] - v)
    after_z = own[k, 10] - w
    if side != 0:
        if k == 1 and not repels(s0, now, before, side):
            return False
        if not (
            repels(s, before, at, side)
            and repels(s, at, after, side)
            and repels(s, before, after, side)
        ):
            return False
    if side_z != 0:
        if k == 1 and not repels_vertically(now, now_z, before, before_z, side_z):
            return False
        return (
            repels_vertically(before, before_z, at, at_z, side_z)
            and repels_vertically(at, at_z, after, after_z, side_z)
            and repels_vertically(before, before_z, after, after_z, side_z)
        )
    return True
