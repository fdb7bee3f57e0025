"""G2: whether well clear between a protected vehicle and another aircraft is ever lost. Exact,
between samples too.

Well clear (modified tau) is lost at an instant if, for the relative position s and velocity v,
- horizontally |s| <= DTHR; or s.v < 0, the closest approach on straight flight is within DTHR, and
  0 <= (DTHR^2 - |s|^2) / (s.v) <= TTHR; and
- vertically |h| <= ZTHR; or 0 <= -h / h' <= TCOA.

On a leg v is constant. With q(t) = |s + t v|^2 and d(t) = (s + t v).v = q'(t) / 2, the horizontal
condition holds from the lower root of q + TTHR d - DTHR^2 to the upper root of q - DTHR^2 if the
course comes within DTHR, and never otherwise: before the closest approach d < 0, so (DTHR^2 - q) /
d <= TTHR means q + TTHR d <= DTHR^2, which |s| <= DTHR implies there. Whether the vertical
condition's interval, whose ends are rational, meets that one is decided by signs at those ends: no
root is computed.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from cratous.judge.ground import on_ground
from cratous.judge.log import State
from cratous.judge.mission import Mission, Volume
from cratous.judge.tracks import Track
from cratous.judge.verdict import HOLDS, UNKNOWN, VIOLATED, Row, doubted, seconds

ROUND = 2.0**-50
"""Upper bound of the relative rounding error of a difference of differences."""
SUMS = 1e-14
"""Upper bound of the relative rounding error of a sum of a few such products."""
NMAC = (152.4, 30.48)
"""Near mid-air collision: 500 ft and 100 ft. Reported, not judged: the mission defines well clear."""


@dataclass
class Pair:
    """Observations of two aircraft."""

    checks: int = 0
    covered_ms: int = 0
    lost_ms: int | None = None
    last_ms: int = 0
    nearest_m: float = math.inf
    nearest_ms: int = 0
    collision_ms: int | None = None


def clear_by_far(a0: State, a1: State, b0: State, b1: State, volume: Volume) -> bool:
    """Whether well clear is certainly never lost on the leg, in doubles with allowance for
    rounding.

    A loss needs |s| <= DTHR + TTHR |v| at an instant: from q + TTHR d <= DTHR^2 and |d| <= |s| |v|.
    """
    h = (a1.time_ms - a0.time_ms) / 1000
    n0, e0 = a0.north_m - b0.north_m, a0.east_m - b0.east_m
    n1, e1 = a1.north_m - b1.north_m, a1.east_m - b1.east_m
    moved = math.hypot(n1 - n0, e1 - e0)
    size = (
        abs(a0.north_m) + abs(b0.north_m) + abs(a1.north_m) + abs(b1.north_m)
        + abs(a0.east_m) + abs(b0.east_m) + abs(a1.east_m) + abs(b1.east_m)
    )  # fmt: skip
    moved = (moved + size * ROUND) * (1 + 1e-9)
    reach = (volume.dthr_m + (volume.tthr_s / h + 1) * moved) * (1 + 1e-9) + 1e-9
    if math.hypot(n0, e0) > reach:
        return True
    z0, z1 = a0.alt_m - b0.alt_m, a1.alt_m - b1.alt_m
    size = abs(a0.alt_m) + abs(b0.alt_m) + abs(a1.alt_m) + abs(b1.alt_m)
    climbed = (abs(z1 - z0) + size * ROUND) * (1 + 1e-9)
    reach = (volume.zthr_m + (volume.tcoa_s / h + 1) * climbed) * (1 + 1e-9) + 1e-9
    return abs(z0) > reach


def clear_by_course(a0: State, a1: State, b0: State, b1: State, volume: Volume) -> bool:
    """Whether well clear is certainly never lost on the leg by `lost_within`, in doubles with
    allowance for rounding.

    The course passes outside DTHR; or at the start they are outside DTHR and diverge; or at the end
    `soon` is still above 0 and falls, so that its lower root is later.
    """
    h = (a1.time_ms - a0.time_ms) / 1000
    n0, e0 = a0.north_m - b0.north_m, a0.east_m - b0.east_m
    n1, e1 = a1.north_m - b1.north_m, a1.east_m - b1.east_m
    dn, de = n1 - n0, e1 - e0
    slip = ROUND * (
        abs(a0.north_m) + abs(b0.north_m) + abs(a1.north_m) + abs(b1.north_m)
        + abs(a0.east_m) + abs(b0.east_m) + abs(a1.east_m) + abs(b1.east_m)
    )  # fmt: skip
    aside, off = _of_products(n0, de, -e0, dn, slip)
    if abs(aside) - off > volume.dthr_m * (math.hypot(dn, de) + 2 * slip) * (1 + 1e-9):
        return True
    along, off = _of_products(n0, dn, e0, de, slip)
    if along > off and math.hypot(n0, e0) > (volume.dthr_m + 2 * slip) * (1 + 1e-9):
        return True
    ahead, off = _of_products(n1, dn, e1, de, slip)
    apart, apart_off = _of_products(n1, n1, e1, e1, slip)
    way, way_off = _of_products(dn, dn, de, de, slip)
    dd, longer, tthr = volume.dthr_m**2, volume.tthr_s / h, volume.tthr_s
    soon = apart - apart_off + longer * (ahead - off) - dd
    rise = 2 * h * (ahead + off) + tthr * (way + way_off)
    return soon > SUMS * (apart + longer * abs(ahead) + dd) and rise < -SUMS * (
        2 * h * abs(ahead) + tthr * way
    )


def _of_products(a: float, b: float, c: float, d: float, slip: float) -> tuple[float, float]:
    """a b + c d, and an upper bound of its error if each of the four has an error of at most `slip`."""
    size = abs(a) + abs(b) + abs(c) + abs(d) + slip
    return a * b + c * d, 2 * slip * size + ROUND * (abs(a * b) + abs(c * d)) + 1e-200


def lost_on_leg(a0: State, a1: State, b0: State, b1: State, volume: Volume) -> bool:
    """Whether well clear is lost at an instant of the leg, including its ends. Exact."""
    span = Fraction(a1.time_ms - a0.time_ms, 1000)
    s = [Fraction(a0[k]) - Fraction(b0[k]) for k in (1, 2, 3)]
    v = [(Fraction(a1[k]) - Fraction(b1[k]) - s[k - 1]) / span for k in (1, 2, 3)]
    return lost_within(s, v, span, volume)


def lost_within(s: list[Fraction], v: list[Fraction], span: Fraction, volume: Volume) -> bool:
    """The same from relative position and velocity (north, east, up), for 0 <= t <= span."""
    dthr, zthr, tthr, tcoa = map(Fraction, volume)
    times = _vertical(s[2], v[2], zthr, tcoa, span)
    if times is None:
        return False
    first, last = times
    vv, sv = v[0] * v[0] + v[1] * v[1], s[0] * v[0] + s[1] * v[1]
    ss, dd = s[0] * s[0] + s[1] * s[1], dthr * dthr
    if vv == 0:
        return ss <= dd
    if (ss - dd) * vv > sv * sv:
        return False  # the course never comes within DTHR

    def apart(t: Fraction) -> Fraction:
        return vv * t * t + 2 * sv * t + ss - dd

    # the horizontal condition holds from the lower root of `soon` to the upper root of `apart`
    def soon(t: Fraction) -> Fraction:
        return apart(t) + tthr * (sv + vv * t)

    after_lower = soon(last) <= 0 or 2 * vv * last + 2 * sv + tthr * vv >= 0
    before_upper = apart(first) <= 0 or vv * first + sv <= 0
    return after_lower and before_upper


def _vertical(
    sz: Fraction, vz: Fraction, zthr: Fraction, tcoa: Fraction, span: Fraction
) -> tuple[Fraction, Fraction] | None:
    """The interval of the leg in which the vertical condition holds; None if it never does."""
    zero = Fraction(0)
    if vz == 0:
        return (zero, span) if abs(sz) <= zthr else None
    level = -sz / vz
    first = max(zero, level - max(tcoa, zthr / abs(vz)))
    last = min(span, level + zthr / abs(vz))
    return (first, last) if first <= last else None


def rows(mission: Mission, flown: dict[int, Track]) -> Iterator[Row]:
    """One row for each protected vehicle and each other aircraft, of the mission or of the log.
    Legs of mission vehicles with both ends on the ground are not checked.
    """
    protected = mission.protected
    for own in protected:
        others = [i for i in sorted(flown) if i != own and not (i in protected and i < own)]
        for other in others:
            yield _row(own, other, flown, mission)
        if len(flown) == 1:
            subject = ("pair", str(own))
            note = "the mission and the log know of no other aircraft"
            yield Row("G2", subject, f"well clear of {own}", HOLDS, note)


def _row(own: int, other: int, flown: dict[int, Track], mission: Mission) -> Row:
    subject = ("pair", *map(str, sorted((own, other))))
    item = f"well clear of {own} and {other}"
    ours = [number for number in (own, other) if number in mission.vehicles]
    grounds = set[int]().union(*(on_ground(mission, n, flown[n]) for n in ours))
    pair = _watch(flown[own], flown[other], mission.volume, grounds)
    doubt = flown[own].doubt or flown[other].doubt or _unmatched(flown[own], flown[other], pair)
    note = f"nearest {pair.nearest_m:.1f} m at {seconds(pair.nearest_ms)} within ZTHR of altitude"
    if pair.nearest_m == math.inf:
        note = "never within ZTHR of altitude at a sample"
    if pair.collision_ms is not None:
        note += (
            f"; near mid-air collision (within 152.4 m and 30.48 m) at {seconds(pair.collision_ms)}"
        )
    if pair.lost_ms is not None:
        note = f"lost from {seconds(pair.lost_ms)}, last at {seconds(pair.last_ms)}; {note}"
        return Row("G2", subject, item, VIOLATED, note, pair.lost_ms, pair.checks)
    if not pair.checks:
        if doubt:
            return Row("G2", subject, item, UNKNOWN, doubt)
        if pair.covered_ms:
            note = "one of them was on the ground as long as both were logged: nothing was asked"
            return Row("G2", subject, item, UNKNOWN, note)
        return Row("G2", subject, item, HOLDS, "never in the air together")
    row = Row("G2", subject, item, HOLDS, note, pair.nearest_ms, pair.checks)
    return doubted(row, doubt)


def _watch(one: Track, two: Track, volume: Volume, grounds: set[int]) -> Pair:
    """Check every leg that both have flown over the same time span, except those that begin at
    times in `grounds`.
    """
    pair = Pair()
    place = {time: k for k, time in enumerate(two.times)}
    a, b = one.states, two.states
    measured = -1  # index of the last measured state of `one`
    for i in range(len(a) - 1):
        j = place.get(a[i].time_ms)
        if j is None:
            continue
        if i != measured and a[i].time_ms not in grounds:
            _measure(pair, a[i], b[j], volume)
        if j + 1 == len(b) or b[j + 1].time_ms != a[i + 1].time_ms:
            continue
        pair.covered_ms += a[i + 1].time_ms - a[i].time_ms
        if a[i].time_ms in grounds:
            continue
        pair.checks += 1
        legs = a[i], a[i + 1], b[j], b[j + 1]
        _measure(pair, a[i + 1], b[j + 1], volume)
        measured = i + 1
        if a[i].time_ms in one.unknown or a[i].time_ms in two.unknown:
            lost = _lost_at(a[i], b[j], volume) or _lost_at(a[i + 1], b[j + 1], volume)
        else:
            clear = clear_by_far(*legs, volume) or clear_by_course(*legs, volume)
            lost = not clear and lost_on_leg(*legs, volume)
        if lost:
            pair.last_ms = a[i].time_ms
            if pair.lost_ms is None:
                pair.lost_ms = a[i].time_ms
    return pair


def _lost_at(a: State, b: State, volume: Volume) -> bool:
    """Whether well clear is lost by the two positions alone, for any velocities."""
    s = [Fraction(a[k]) - Fraction(b[k]) for k in (1, 2, 3)]
    return lost_within(s, [Fraction(0)] * 3, Fraction(0), volume)


def _unmatched(one: Track, two: Track, pair: Pair) -> str:
    """Why the two were not compared throughout the time that both were in the air."""
    if not one.times or not two.times:
        return ""
    first, last = max(one.times[0], two.times[0]), min(one.times[-1], two.times[-1])
    if last > first and pair.covered_ms < last - first:
        return f"they were logged at different instants, for {last - first - pair.covered_ms} ms"
    if last == first and not pair.checks:
        return f"they were in the air together at one logged instant only, {seconds(first)}"
    return ""


def _measure(pair: Pair, a: State, b: State, volume: Volume) -> None:
    above, apart = abs(a.alt_m - b.alt_m), math.hypot(a.north_m - b.north_m, a.east_m - b.east_m)
    if above <= volume.zthr_m and apart < pair.nearest_m:
        pair.nearest_m, pair.nearest_ms = apart, a.time_ms
    if pair.collision_ms is None and apart <= NMAC[0] and above <= NMAC[1]:
        pair.collision_ms = a.time_ms
