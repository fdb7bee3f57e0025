"""What a way in time is checked against, and the checks themselves, counted.

Zones: `leg_keeps` for every chord, with a margin. Traffic: `way_permits` for every stretch against the tube of every
intruder, and `meets` for the volumes with time thresholds. Bounds on distance and speed only skip calls whose answer
they imply. The count of calls is the budget of a search: it does not depend on the machine's speed.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from cratous.core.avoidance.extent import fastest
from cratous.core.avoidance.prediction import Intruder, Piece, after, later, legs_of, meets
from cratous.core.geofence.clearance import leg_keeps
from cratous.core.permit.remainder import way_permits
from cratous.spec.mission import Position, WellClear, Zone, ZoneKind

NEAR_S = 1.0
"""Positions of intruders are bounded from those at whole multiples of this time [s]."""
ROUNDING_M = 1.0
"""Added to each bound that skips a call [m]."""
KERNEL, LEG = 5, 2
"""A check by exact kernels costs as much as so many others: of a segment against a tube, of a leg against a zone."""


class Scene(NamedTuple):
    """zones and the margin to them, horizontally and in altitude [m]; intruders; volume: its closed cylinder is kept clear of each of them;
    volumes: those kept clear with their time thresholds as well.
    """

    zones: tuple[Zone, ...] = ()
    margin_m: float = 0.0
    intruders: tuple[Intruder, ...] = ()
    volume: WellClear = WellClear(0.0, 0.0, 0.0, 0.0)
    volumes: tuple[WellClear, ...] = ()
    rise_m: float = 0.0


@dataclass
class Checks:
    """The checks of one search. calls: of the proved kernels' drivers so far."""

    scene: Scene
    calls: int = 0
    _legs: dict[tuple[Position, Position, float], bool] = field(default_factory=dict)
    _places: dict[int, np.ndarray] = field(default_factory=dict)

    def __post_init__(self) -> None:
        scene = self.scene
        self._keep_ins = [z for z in scene.zones if z.kind is ZoneKind.KEEP_IN]
        self._keep_outs = [z for z in scene.zones if z.kind is not ZoneKind.KEEP_IN]
        corners = [np.array(zone.vertices, float) for zone in self._keep_outs]
        rows = [(*c.min(0), *c.max(0)) for c in corners]
        self._boxes = np.array(rows, float).reshape(-1, 4)
        reach = [scene.volume.dthr_m] + [v.dthr_m for v in scene.volumes]
        tau_s = max((v.tthr_s for v in scene.volumes), default=0.0)
        legs = [legs_of(other) for other in scene.intruders]
        self._fast = np.array([fastest(one) for one in legs])
        self._tau_s, self._reach_m = tau_s, max(reach)

    def keeps_zones(self, p: Position, q: Position, more_m: float = 0.0) -> bool:
        """Whether the leg from p to q keeps all zones, by the margin and more_m [m]."""
        key = p, q, more_m
        known = self._legs.get(key)
        if known is None:
            known = self._legs[key] = self._keeps(p, q, self.scene.margin_m + more_m)
        return known

    def _keeps(self, p: Position, q: Position, margin_m: float) -> bool:
        self.calls += 1
        near: Sequence[Zone] = ()
        if self._keep_outs:
            off_m, box = margin_m + ROUNDING_M, self._boxes
            meets_box = (
                (box[:, 0] <= max(p.north_m, q.north_m) + off_m)
                & (box[:, 2] >= min(p.north_m, q.north_m) - off_m)
                & (box[:, 1] <= max(p.east_m, q.east_m) + off_m)
                & (box[:, 3] >= min(p.east_m, q.east_m) - off_m)
            )
            near = [self._keep_outs[k] for k in np.flatnonzero(meets_box)]
        for zone in (*near, *self._keep_ins):
            self.calls += LEG
            if not leg_keeps(p, q, zone, margin_m, self.scene.rise_m):
                return False
        return True

    def line_keeps_zones(self, points: Sequence[Position], more_m: float = 0.0) -> bool:
        """Whether every leg of a polyline does."""
        return all(self.keeps_zones(p, q, more_m) for p, q in itertools.pairwise(points))

    def first_met(self, pieces: Sequence[Piece], rho_m: float) -> int | None:
        """The id of an intruder against which a stretch is not permitted; None if there is none. rho_m: bound on the
        vehicle's deviation from the stretch [m].
        """
        scene = self.scene
        if not pieces or not scene.intruders:
            return None
        for k in self._in_reach(pieces, rho_m):
            other = scene.intruders[k]
            self.calls += len(pieces)
            sure = _surely(pieces, other, scene.volume, rho_m) if not other.way else None
            if sure is None:
                self.calls += KERNEL * len(pieces)
                sure = way_permits(pieces, other, scene.volume, rho_m)
            if not sure:
                return other.id
            for volume in scene.volumes:
                self.calls += KERNEL * len(pieces)
                if meets(pieces, other, volume):
                    return other.id
        return None

    def _in_reach(self, pieces: Sequence[Piece], rho_m: float) -> list[int]:
        """Indices of the intruders that a bound on distance and speeds does not rule out."""
        self.calls += KERNEL
        begin_s, last = pieces[0].start_s, pieces[-1]
        end_s = last.start_s + last.duration_s
        own_m_s, at_s = fastest(pieces), (begin_s + end_s) / 2
        here = _at(pieces, at_s)
        tick = round(at_s / NEAR_S)
        if tick not in self._places:
            then = [later(other, tick * NEAR_S) for other in self.scene.intruders]
            rows = [(*one.position[:2], one.hold_m) for one in then]
            self._places[tick] = np.array(rows, float)
        place = self._places[tick]
        wide_m = np.array([o.spread.after(end_s).wide_m for o in self.scene.intruders])
        drift_m = np.array([o.spread.wide_m_s for o in self.scene.intruders]) * self._tau_s
        far = np.hypot(place[:, 0] - here.north_m, place[:, 1] - here.east_m)
        closing = self._fast + own_m_s
        moved = own_m_s * (end_s - begin_s) / 2 + self._fast * ((end_s - begin_s) / 2 + NEAR_S)
        reach = self._reach_m + rho_m + place[:, 2] + wide_m + drift_m + moved
        reach = reach + closing * self._tau_s + ROUNDING_M
        return [int(k) for k in np.flatnonzero(far <= reach)]


def _surely(
    pieces: Sequence[Piece], other: Intruder, volume: WellClear, rho_m: float
) -> bool | None:
    """Whether a stretch is permitted against an intruder in straight flight, where the cylinder is missed or entered
    by so much that rounding does not matter; None where it is near.
    """
    sure = True
    for piece in pieces:
        begin_s, d_s = piece.start_s, piece.duration_s
        there, v, w = later(other, begin_s), piece.velocity, other.velocity
        spread = other.spread.after(begin_s + d_s)
        p, q = piece.position, there.position
        north, east, above = p.north_m - q.north_m, p.east_m - q.east_m, p.alt_m - q.alt_m
        vn, ve, climb = v.north_m_s - w.north_m_s, v.east_m_s - w.east_m_s, w.down_m_s - v.down_m_s
        square = vn * vn + ve * ve
        near_s = 0.0 if square == 0 else min(max(-(north * vn + east * ve) / square, 0.0), d_s)
        far = math.hypot(north + near_s * vn, east + near_s * ve)
        half = volume.zthr_m + rho_m + spread.high_m + ROUNDING_M
        over = above > half and above + d_s * climb > half
        under = -above > half and -above - d_s * climb > half
        if over or under or far > volume.dthr_m + rho_m + spread.wide_m + ROUNDING_M:
            continue
        level = abs(above + near_s * climb) < volume.zthr_m - ROUNDING_M
        if far < volume.dthr_m - ROUNDING_M and level:
            return False
        sure = False
    return True if sure else None


def _at(pieces: Sequence[Piece], t_s: float) -> Position:
    """The position at an instant [s]."""
    for piece in pieces:
        if t_s <= piece.start_s + piece.duration_s:
            return after(piece, max(0.0, t_s - piece.start_s))
    return after(pieces[-1], pieces[-1].duration_s)


def slopes_ok(points: Sequence[Position], speed_m_s: float, max_climb_m_s: float) -> bool:
    """Whether a polyline flown at a ground speed [m/s] needs no more than a climb or descent [m/s]."""
    for p, q in itertools.pairwise(points):
        flown = math.hypot(q.north_m - p.north_m, q.east_m - p.east_m)
        if abs(q.alt_m - p.alt_m) * speed_m_s > max_climb_m_s * flown + 1e-9:
            return False
    return True
