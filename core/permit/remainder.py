"""Whether a vehicle may fly a path to its end, and hold there: permission by traffic and by zones.

The hold is a stationary disc. Intruders are assumed to fly straight, as everywhere in prediction: their tubes are as
wide as the uncertainty of their states, with zero width for exact ones. The proved kernels keep the closed cylinder
of the volume clear; the caller has to check that the path also keeps the volume's time thresholds.
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Sequence

from cratous.core.avoidance.extent import reached_until
from cratous.core.avoidance.prediction import (
    EXACT,
    STANDING,
    Intruder,
    Piece,
    Spread,
    around,
    later,
    meetings,
)
from cratous.core.geofence.distance import comes_within
from cratous.core.geofence.planar import edges_of, keep_in_leg_ok, keep_out_leg_ok, locate
from cratous.core.kernel import Vec2, driver
from cratous.core.permit.pieces import (
    Growth,
    Margins,
    Meeting,
    Tube,
    above_during,
    permitted,
    piece_clear,
)
from cratous.core.permit.whole_numbers import Moving, in_whole_numbers
from cratous.core.readings.exact import exact
from cratous.spec.mission import Position, WellClear, Zone, ZoneKind

STEADY = Growth(0.0, 0.0, 0.0)
"""The tube of an intruder without deviation from its prediction."""


def hold_at(place: Position, start_s: float, horizon_s: float) -> Piece:
    """A hold about a place, from start_s until horizon_s [s]."""
    return Piece(start_s, horizon_s - start_s, place, STANDING)


def meeting(start: Position, other: Intruder, volume: WellClear) -> Meeting:
    """The intruder when a trajectory begins at `start`, and the cylinder of a volume to keep clear."""
    p, w, volume = other.position, other.velocity, around(volume, other)
    return Meeting(
        Vec2(start.north_m - p.north_m, start.east_m - p.east_m),
        start.alt_m - p.alt_m,
        Vec2(w.north_m_s, w.east_m_s),
        -w.down_m_s,
        *tube_of(other.spread),
        volume.dthr_m,
        volume.zthr_m,
    )


def tube_of(spread: Spread) -> Tube:
    """An intruder's spread as a tube; for a spread that does not stop growing."""
    if spread == EXACT:
        return Tube(STEADY, STEADY)
    return Tube(
        Growth(spread.wide_m, spread.wide_m_s, 0.0), Growth(spread.high_m, spread.high_m_s, 0.0)
    )


def moving(piece: Piece, rho_m: float) -> Moving:
    """A segment of a predicted path as one of a trajectory."""
    v = piece.velocity
    return Vec2(v.north_m_s, v.east_m_s), -v.down_m_s, piece.duration_s, rho_m


@driver(checked_by=("piece_clear", "above_during"))
def hold_permits(
    hold: Piece, other: Intruder, volume: WellClear, hold_m: float, rise_m: float
) -> bool:
    """True only if a hold, during its duration, keeps the closed cylinder of a volume clear of an intruder in
    straight flight. ValueError if it is not stationary.

    hold_m, rise_m: greatest horizontal and vertical distance of the vehicle from the centre of the hold [m], >= 0.
    """
    if hold.velocity != STANDING:
        raise ValueError("a hold does not stand")
    if other.way and out_of_reach_of(hold, other, volume.dthr_m + hold_m):
        return True
    return all(
        _hold_permits(part, straight_on, volume, hold_m, rise_m)
        for run, straight_on in meetings((hold,), other)
        for part in run
    )


def out_of_reach_of(hold: Piece, other: Intruder, radius_m: float) -> bool:
    """True only if an intruder on a path comes nowhere within a radius of a place [m] until a hold there ends: a bound
    on where the path leads by then, with a metre for rounding.
    """
    until_s = hold.start_s + hold.duration_s
    met = reached_until(other.way, until_s)
    if met is None or not until_s < math.inf:
        return False
    (south, north, west, east), _ = met
    far_n = max(south - hold.position.north_m, hold.position.north_m - north, 0.0)
    far_e = max(west - hold.position.east_m, hold.position.east_m - east, 0.0)
    off_m = other.hold_m + other.spread.after(until_s).wide_m
    return math.hypot(far_n, far_e) > 1 + radius_m + off_m


def _hold_permits(
    hold: Piece, other: Intruder, volume: WellClear, hold_m: float, rise_m: float
) -> bool:
    """`hold_permits` for an intruder in straight flight."""
    met = meeting(hold.position, later(other, hold.start_s), volume)
    # stationary: 0 minus the other's velocity, which is free of rounding
    v = Vec2(0.0 - met.w.x, 0.0 - met.w.y)
    margins = Margins(met.radius_m, met.half_height_m, hold_m)
    tube = Tube(met.wide, met.high)
    if exact(piece_clear, met.s, v, met.sz, -met.wz, tube, margins, hold.duration_s):
        return True
    layer = met.high._replace(start_m=volume.zthr_m + rise_m + met.high.start_m)
    if exact(above_during, met.sz, -met.wz, layer, hold.duration_s):
        return True
    return bool(exact(above_during, -met.sz, met.wz, layer, hold.duration_s))


@driver(checked_by=("permitted",))
def way_permits(
    pieces: Sequence[Piece], other: Intruder, volume: WellClear, rho_m: float = 0.0
) -> bool:
    """True only if a path, from its first segment to its last, keeps the closed cylinder of a volume clear of an
    intruder in straight flight. rho_m: bound on the vehicle's deviation from the path, also in altitude [m], >= 0.

    A path without segments is permitted, wherever the intruder is, because it has no duration. The caller has to
    check what is flown after it (`hold_permits`).
    """
    if not pieces:
        return True
    return all(
        _run_permits(run, later(straight_on, run[0].start_s), volume, rho_m)
        for run, straight_on in meetings(pieces, other)
    )


def _run_permits(pieces: Sequence[Piece], other: Intruder, volume: WellClear, rho_m: float) -> bool:
    """`way_permits` for an intruder in straight flight, observed as the first segment begins."""
    met = meeting(pieces[0].position, other, volume)
    moved = [moving(piece, rho_m) for piece in pieces]
    with contextlib.suppress(OverflowError, ValueError):  # not finite: the reading says which
        moved, met = in_whole_numbers(moved, met)
    return bool(exact(permitted, moved, met))


@driver(checked_by=("locate", "comes_within", "keep_out_leg_ok", "keep_in_leg_ok"))
def zones_permit(place: Position, zones: Sequence[Zone], hold_m: float) -> bool:
    """True iff the disc of radius hold_m [m] about a position, at its altitude, obeys every zone. ValueError if one
    has padding.
    """
    centre, alt = Vec2(place.north_m, place.east_m), place.alt_m
    for zone in zones:
        if zone.padding_m != 0:
            raise ValueError(f"zone {zone.id}: padding must be turned into vertices first")
        edges = edges_of(zone.vertices)
        where = exact(locate, edges, centre)
        near = exact(comes_within, edges, centre, centre, hold_m)
        holds = keep_out_leg_ok if zone.kind is ZoneKind.KEEP_OUT else keep_in_leg_ok
        if not holds(where, near, alt, alt, zone.floor_m, zone.ceiling_m):
            return False
    return True
