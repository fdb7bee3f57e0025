"""When a piecewise straight flight first loses well clear of straight-flying traffic.

A trajectory is a sequence of segments of constant velocity. Each segment is checked against each intruder by the
kernel `violation_within`, which is exact over the whole segment: no time between samples is missed. Only the
*instant* of the first violation is found by bisection, to a fraction of the segment, and rounded towards the earlier
side. An intruder known within a spread loses well clear if it may do so anywhere within it (`core.daa.uncertainty`).
"""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

from cratous.core.avoidance.extent import bounds, fastest, reached, reached_until
from cratous.core.daa.uncertainty import LEAST_ERROR, Uncertainty, uncertain_conflict
from cratous.core.kernel import Vec2, driver
from cratous.core.well_clear import StandardThresholds, Thresholds, violation, violation_within
from cratous.spec.mission import Position, Velocity, WellClear

STANDING = Velocity(0.0, 0.0, 0.0)
"""Velocity of the centre of a hold."""


class Piece(NamedTuple):
    """Straight flight: from start_s [s] for duration_s [s], from a position at a velocity."""

    start_s: float
    duration_s: float
    position: Position
    velocity: Velocity


class Spread(NamedTuple):
    """Bounds on an aircraft's deviation from its prediction: wide_m horizontally and high_m in altitude [m], growing
    by wide_m_s and high_m_s per second [m/s] until steady_s [s]. All 0: none.
    """

    wide_m: float = 0.0
    wide_m_s: float = 0.0
    high_m: float = 0.0
    high_m_s: float = 0.0
    steady_s: float = math.inf

    def after(self, t_s: float) -> Spread:
        """The same spread, with time counted from t_s [s] on."""
        if self == EXACT:
            return self
        grows_s = min(t_s, self.steady_s)
        wide, high = self.wide_m + grows_s * self.wide_m_s, self.high_m + grows_s * self.high_m_s
        if t_s >= self.steady_s:
            return Spread(wide, 0.0, high, 0.0)
        return Spread(wide, self.wide_m_s, high, self.high_m_s, self.steady_s - t_s)


EXACT = Spread()
"""No deviation from the prediction."""


class Intruder(NamedTuple):
    """Another aircraft, as observed now; cooperates: it too is flown by an ICAROUS instance of this system.

    way: its assumed path from now on, without gaps; () is straight flight. After it the intruder stays within hold_m
    [m] of the path's end. spread: bounds on its deviation, with the own vehicle at its assumed position.
    """

    id: int
    position: Position
    velocity: Velocity
    cooperates: bool = False
    way: tuple[Piece, ...] = ()
    hold_m: float = 0.0
    spread: Spread = EXACT


def buffered(volume: WellClear, buffer: float) -> WellClear:
    """The same volume with every threshold multiplied by `buffer` (>= 1)."""
    return WellClear(
        volume.dthr_m * buffer,
        volume.zthr_m * buffer,
        volume.tthr_s * buffer,
        volume.tcoa_s * buffer,
    )


def straight(p: Position, v: Velocity, start_s: float, duration_s: float) -> Piece:
    """One segment of straight flight."""
    return Piece(start_s, duration_s, p, v)


def after(piece: Piece, t_s: float) -> Position:
    """The position t_s after the segment's start."""
    (north, east, alt), (north_s, east_s, down_s) = piece.position, piece.velocity
    return Position(north + north_s * t_s, east + east_s * t_s, alt - down_s * t_s)


def legs_of(other: Intruder) -> tuple[Piece, ...]:
    """The straight flights that an intruder is assumed to fly; the last one has no end, and is
    stationary for a hold.
    """
    if not other.way:
        return (Piece(0.0, math.inf, other.position, other.velocity),)
    last = other.way[-1]
    end_s = last.start_s + last.duration_s
    return (*other.way, Piece(end_s, math.inf, after(last, last.duration_s), STANDING))


def later(other: Intruder, t_s: float) -> Intruder:
    """The intruder t_s [s] from now, if it flies as assumed."""
    if not other.way:
        begun = straight(other.position, other.velocity, 0.0, math.inf)
        return other._replace(position=after(begun, t_s), spread=other.spread.after(t_s))
    rest = [leg for leg in legs_of(other) if leg.start_s + leg.duration_s > t_s]
    first = rest[0]
    gone_s = t_s - first.start_s
    begun = Piece(t_s, first.duration_s - gone_s, after(first, gone_s), first.velocity)
    # straight flight and hold, the last leg, are no part of the way
    left = (begun, *rest[1:-1]) if rest[1:] else ()
    way = tuple(leg._replace(start_s=leg.start_s - t_s) for leg in left)
    spread = other.spread.after(t_s)
    return other._replace(position=begun.position, velocity=begun.velocity, way=way, spread=spread)


def rest_of(pieces: Sequence[Piece], t_s: float) -> tuple[Piece, ...]:
    """The rest of the segments t_s [s] after they begin, at 0, counted from then; their end if they are over."""
    begun = []
    for piece in [p for p in pieces if p.start_s + p.duration_s > t_s] or pieces[-1:]:
        gone_s = min(max(t_s - piece.start_s, 0.0), piece.duration_s)
        start_s = max(piece.start_s - t_s, 0.0)
        place = after(piece, gone_s)
        begun.append(Piece(start_s, piece.duration_s - gone_s, place, piece.velocity))
    return tuple(begun)


def meetings(
    pieces: Sequence[Piece], other: Intruder
) -> Iterator[tuple[tuple[Piece, ...], Intruder]]:
    """The segments divided where the intruder begins another leg, and where its spread stops growing: each group with
    the intruder as it flies then, modelled as flying straight throughout. No instant of the segments is left out, and
    only the dividing instants occur twice.
    """
    if not other.way and other.spread.steady_s == math.inf:
        yield tuple(pieces), other
        return
    for part, met, held_m in _parts(pieces, other):
        run = tuple(_within(piece, part) for piece in met)
        yield run, _straight_on(other, part, held_m)


def _parts(
    pieces: Sequence[Piece], other: Intruder
) -> Iterator[tuple[Piece, Sequence[Piece], float]]:
    """Each straight flight of an intruder that overlaps some segments in time, with these, and the intruder's
    distance from it in a hold [m]. Flights after the last segment are left out.
    """
    steady_s = other.spread.steady_s
    begins = [piece.start_s for piece in pieces]
    ends = [piece.start_s + piece.duration_s for piece in pieces]
    ordered = begins == sorted(begins) and ends == sorted(ends)
    for leg in legs_of(other):
        start_s, duration_s = leg.start_s, leg.duration_s
        if ordered and ends and start_s >= ends[-1]:
            return
        held_m = other.hold_m if other.way and duration_s == math.inf else 0.0
        for part in (leg,) if steady_s == math.inf else _cut(leg, steady_s):
            met = pieces
            if ordered:  # those in the time of the part follow each other
                before_s = part.start_s + part.duration_s
                met = pieces[bisect_right(ends, part.start_s) : bisect_left(begins, before_s)]
            met = [piece for piece in met if _overlap(piece, part)]
            if met:
                yield part, met, held_m


def _straight_on(other: Intruder, part: Piece, held_m: float) -> Intruder:
    """An intruder as it flies in a part, modelled as flying straight throughout."""
    spread = other.spread
    if spread.steady_s != math.inf:
        spread = spread.after(spread.steady_s) if part.start_s >= spread.steady_s else spread
        spread = spread._replace(steady_s=math.inf)
    place = after(part, -part.start_s)
    return Intruder(other.id, place, part.velocity, other.cooperates, (), held_m, spread)


def _cut(leg: Piece, at_s: float) -> tuple[Piece, ...]:
    """A leg, divided in two if an instant [s] lies in it."""
    gone_s = at_s - leg.start_s
    if not 0 < gone_s < leg.duration_s:
        return (leg,)
    first = leg._replace(duration_s=gone_s)
    return first, Piece(at_s, leg.duration_s - gone_s, after(leg, gone_s), leg.velocity)


def around(volume: WellClear, other: Intruder) -> WellClear:
    """The volume about an intruder in a hold, widened by its greatest distance from the centre."""
    return volume if not other.hold_m else replace(volume, dthr_m=volume.dthr_m + other.hold_m)


def _overlap(piece: Piece, leg: Piece) -> bool:
    begins = piece.start_s < leg.start_s + leg.duration_s
    return begins and piece.start_s + piece.duration_s > leg.start_s


def _within(piece: Piece, leg: Piece) -> Piece:
    """The part of a segment that overlaps a leg in time."""
    begins, end = piece.start_s, piece.start_s + piece.duration_s
    start, end = max(begins, leg.start_s), min(end, leg.start_s + leg.duration_s)
    return Piece(start, end - start, after(piece, start - begins), piece.velocity)


def _relative(piece: Piece, other: Intruder, t_s: float) -> tuple[Vec2, Vec2, float, float]:
    """Position and velocity of ownship minus intruder, t_s after the start of the piece."""
    p, v, w = after(piece, t_s), piece.velocity, other.velocity
    at = piece.start_s + t_s
    s = Vec2(
        p.north_m - other.position.north_m - w.north_m_s * at,
        p.east_m - other.position.east_m - w.east_m_s * at,
    )
    sz = p.alt_m - (other.position.alt_m - w.down_m_s * at)
    return (
        s,
        Vec2(v.north_m_s - w.north_m_s, v.east_m_s - w.east_m_s),
        sz,
        w.down_m_s - v.down_m_s,
    )


def out_of_reach(pieces: Sequence[Piece], other: Intruder, volume: WellClear) -> bool:
    """True only if no segment can lose well clear of an intruder in straight flight: a bound on range and closing
    speed.

    A violation needs |s| <= DTHR + TTHR |v|, and |s| shrinks by at most |v| per second.
    """
    first, last = pieces[0], pieces[-1]
    closing = max(math.hypot(p.velocity.north_m_s, p.velocity.east_m_s) for p in pieces)
    closing += math.hypot(other.velocity.north_m_s, other.velocity.east_m_s)
    far = math.hypot(
        first.position.north_m - other.position.north_m,
        first.position.east_m - other.position.east_m,
    )
    reach = last.start_s + last.duration_s + volume.tthr_s
    spread = other.spread.after(last.start_s + last.duration_s)
    off = spread.wide_m + other.spread.wide_m_s * volume.tthr_s
    return far > 1 + volume.dthr_m + off + closing * reach


def ways_out_of_reach(pieces: Sequence[Piece], other: Intruder, volume: WellClear) -> bool:
    """True only if no segment can lose well clear: a bound on the distance between the positions of the segments and
    those of the intruder's legs until they end, and on the closing speed. See `out_of_reach`.
    """
    until_s, own_bounds = reached(pieces)
    if own_bounds is None:
        return False
    way = other.way
    met = reached_until(way, until_s) if way else bounds(legs_of(other), until_s)
    if met is None:  # the pieces are over as the intruder's flight begins
        return True
    (own, own_m_s), (its, its_m_s) = own_bounds, met
    north = max(own[0] - its[1], its[0] - own[1], 0.0)
    east = max(own[2] - its[3], its[2] - own[3], 0.0)
    return math.hypot(north, east) > _reach_m(other, volume, until_s, own_m_s + its_m_s, 0.0)


def _reach_m(
    other: Intruder, volume: WellClear, until_s: float, closing: float, lasts_s: float
) -> float:
    """The distance beyond which no loss occurs within a time [s] at a given greatest closing speed [m/s]; see
    `out_of_reach`.
    """
    spread = other.spread.after(until_s)
    off = spread.wide_m + other.spread.wide_m_s * volume.tthr_s
    return 1 + volume.dthr_m + other.hold_m + off + closing * (lasts_s + volume.tthr_s)


def leg_out_of_reach(
    pieces: Sequence[Piece], leg: Piece, other: Intruder, volume: WellClear
) -> bool:
    """The same for one leg of the intruder and the segments in its time: from the positions of both at the beginning
    of the first of these, they come no nearer than the closing speed allows.
    """
    first, ends_s = min(pieces), max(piece.start_s + piece.duration_s for piece in pieces)
    at_s, until_s = max(first.start_s, leg.start_s), min(ends_s, leg.start_s + leg.duration_s)
    own, its = after(first, at_s - first.start_s), after(leg, at_s - leg.start_s)
    far = math.hypot(own.north_m - its.north_m, own.east_m - its.east_m)
    closing = fastest(pieces) + math.hypot(leg.velocity[0], leg.velocity[1])
    return far > _reach_m(other, volume, until_s, closing, until_s - at_s)


@driver(checked_by=("violation_within", "uncertain_conflict"))
def first_violation_s(
    pieces: Sequence[Piece], other: Intruder, volume: WellClear, halvings: int = 6
) -> float | None:
    """When the first violation begins [s from now], or None if there is none on any segment.

    The instant is early by at most the segment's duration / 2^halvings.
    """
    if not other.way and other.spread.steady_s == math.inf:
        return _first_of_straight(pieces, other, volume, halvings)
    if not pieces or ways_out_of_reach(pieces, other, volume):
        return None
    for part, met, held_m in _parts(pieces, other):
        if leg_out_of_reach(met, part, other, volume):
            continue
        run = tuple(_within(piece, part) for piece in met)
        found = _first_of_straight(run, _straight_on(other, part, held_m), volume, halvings)
        if found is not None:
            return found
    return None


@driver(checked_by=("violation_within", "uncertain_conflict"))
def meets(pieces: Sequence[Piece], other: Intruder, volume: WellClear) -> bool:
    """Whether there is a violation on any segment, whenever it begins."""
    return first_violation_s(pieces, other, volume, halvings=0) is not None


def _first_of_straight(
    pieces: Sequence[Piece], other: Intruder, volume: WellClear, halvings: int
) -> float | None:
    """`first_violation_s` for an intruder in straight flight."""
    volume = around(volume, other)
    if not pieces or out_of_reach(pieces, other, volume):
        return None
    for piece in pieces:
        if not _lost_within(piece, other, volume, piece.duration_s):
            continue
        low, high = 0.0, piece.duration_s
        for _ in range(halvings):
            middle = (low + high) / 2
            if _lost_within(piece, other, volume, middle):
                high = middle
            else:
                low = middle
        return piece.start_s + low
    return None


@driver(checked_by=("violation_within", "uncertain_conflict"))
def _lost_within(piece: Piece, other: Intruder, volume: WellClear, t_s: float) -> bool:
    """Whether the first t_s [s] of a segment lose, or may lose, well clear of an intruder in straight flight."""
    s, v, sz, vz = _relative(piece, other, 0.0)
    spread = other.spread
    if not (spread.wide_m or spread.wide_m_s or spread.high_m or spread.high_m_s):
        return bool(violation_within(s, v, sz, vz, _thresholds(volume), t_s))
    # the spread is that of now: from there the relative flight of this piece would have come
    at_s = piece.start_s
    error = Uncertainty(*(max(LEAST_ERROR, one) for one in (
        spread.wide_m, spread.high_m, spread.wide_m_s, spread.high_m_s
    )))  # fmt: skip
    return bool(
        uncertain_conflict(
            Vec2(s.x - at_s * v.x, s.y - at_s * v.y),
            v,
            sz - at_s * vz,
            vz,
            error,
            Thresholds(*_thresholds(volume), 0.0),
            at_s,
            at_s + t_s,
        )
    )


@driver(checked_by=("violation",))
def violated_s(
    pieces: Sequence[Piece], other: Intruder, volume: WellClear, grid_s: float = 1.0
) -> float:
    """The approximate duration of the loss of well clear [s]: only used to rank manoeuvres that all lose it."""
    if pieces and ways_out_of_reach(pieces, other, volume):
        return 0.0
    lost = 0.0
    for piece, straight_on in ((p, leg) for run, leg in meetings(pieces, other) for p in run):
        count = max(1, math.ceil(piece.duration_s / grid_s))
        for k in range(count):
            s, v, sz, vz = _relative(piece, straight_on, (k + 0.5) * piece.duration_s / count)
            if violation(s, v, sz, vz, *_thresholds(around(volume, straight_on))):
                lost += piece.duration_s / count
    return lost


def _thresholds(volume: WellClear) -> StandardThresholds:
    return StandardThresholds(volume.dthr_m, volume.zthr_m, volume.tthr_s, volume.tcoa_s)
