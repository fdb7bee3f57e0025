"""The end of the way that an instance was told: the hold there is looked at, and nothing beyond it.

UxAS tells the way for farther than is looked, or to its end, where the vehicle loiters. The circle that touches
the end, to the right or to the left, is looked at on both sides: each is a disc that stands beside the end, which
proved kernels permit or not. The hold that is flown may be elsewhere: higher, while other vehicles still have
tasks, or at a place near by where a circle keeps the zones (`services.flight.inflight_routes`). That way is told
once it is flown. Zones are not the hold's to watch: UxAS circles where they are kept, or says that it does not.

Straight flight is predicted, and no hold is looked at, where the vehicle is more than 30 m off its path, more than
2 s of flight past the end, or has been told no way (`foresight.predicted`).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from cratous.core.avoidance.manoeuvre import Way, looked_at
from cratous.core.avoidance.prediction import Intruder, Piece, first_violation_s, meets
from cratous.core.avoidance.resolution import Scene
from cratous.core.permit.remainder import hold_at, hold_permits, zones_permit
from cratous.services.icarous.messages import Sensed
from cratous.spec.mission import Position, WellClear, Zone

TURN_MARGIN = 1.1
"""A way back, and a loiter, is made of turns this much wider than the tightest."""
TRACKING_S = 1.0
"""A circle is flown to less than what the vehicle flies in this time [s]."""
WIDEST = 1.5
"""Where a zone is in the way of the circle it is up to so much wider."""


class Hold(NamedTuple):
    """Holding as a segment of flight: a fixed disc of a radius [m] that contains the vehicle."""

    piece: Piece
    radius_m: float


class Beside(NamedTuple):
    """Discs of a radius [m] beside the end of a way that were held against zones, and whether both obey them all."""

    centres: tuple[Position, ...]
    radius_m: float
    zones: tuple[Zone, ...]
    obey: bool


class Ahead(NamedTuple):
    """The way that is predicted, the volumes that it keeps clear, and the holds of which one may end it.

    volumes: each is kept by the way; held: the volume whose cylinder the holds keep clear; rise_m: how far a
    hold may be off its height [m]; beside: what was asked of zones for the holds.
    """

    pieces: tuple[Piece, ...]
    volumes: tuple[WellClear, ...]
    holds: tuple[Hold, ...] = ()
    held: WellClear | None = None
    rise_m: float = 0.0
    beside: Beside | None = None

    def first_s(self, other: Intruder) -> float | None:
        """When the way, or the hold that ends it, first comes too near to an intruder [s], or None."""
        times = [first_violation_s(self.pieces, other, volume) for volume in self.volumes]
        if self.held is not None:
            times += [self._held_s(hold, other, self.held) for hold in self.holds]
        return min((t for t in times if t is not None), default=None)

    def meets(self, other: Intruder) -> bool:
        """Whether the way, or a hold that ends it, comes too near to an intruder: `first_s` without the instant."""
        if any(meets(self.pieces, other, volume) for volume in self.volumes):
            return True
        return self.held is not None and not all(
            hold_permits(hold.piece, other, self.held, hold.radius_m, self.rise_m)
            for hold in self.holds
        )

    def _held_s(self, hold: Hold, other: Intruder, volume: WellClear) -> float | None:
        if hold_permits(hold.piece, other, volume, hold.radius_m, self.rise_m):
            return None
        wide = cylinder(volume.dthr_m + hold.radius_m, volume.zthr_m + self.rise_m)
        found = first_violation_s((hold.piece,), other, wide)
        return hold.piece.start_s if found is None else found


def cylinder(radius_m: float, half_m: float) -> WellClear:
    """A volume without thresholds of time."""
    return WellClear(radius_m, half_m, 0.0, 0.0)


def horizon_s(scene: Scene) -> float:
    """How far a way is followed [s]: thresholds of time reach so far past what is looked at."""
    return scene.lookahead_s + scene.volume.tthr_s


def with_hold(
    way: Way,
    sensed: Sensed,
    scene: Scene,
    own: WellClear,
    margin: float,
    before: Beside | None = None,
) -> Ahead:
    """What is looked at of a predicted way, and where it ends sooner the holds of which one follows.

    way: followed to `horizon_s`; own: the mission's volume, without buffer; margin: a loiter is flown this
    much wider than the tightest turn; before: what was asked of zones last, which is not asked again. A way to its end keeps the buffered cylinder, and the mission's own
    thresholds of time: how long it goes on is known.
    """
    pieces, beyond = looked_at(way, scene.lookahead_s)
    if way.beyond is None:
        return Ahead(pieces, (scene.volume,))
    around = cylinder(scene.volume.dthr_m, scene.volume.zthr_m)
    rise_m = TRACKING_S * sensed.ability.max_climb_m_s
    if beyond is None:
        return Ahead(pieces, (own, around), (), around, rise_m, before)
    holds, beside = _holds(beyond, sensed, scene, margin, before)
    return Ahead(pieces, (own, around), holds, around, rise_m, beside)


def _holds(
    beyond: Piece, sensed: Sensed, scene: Scene, margin: float, before: Beside | None
) -> tuple[tuple[Hold, ...], Beside]:
    """Where the loiter at the end may be. beyond: straight flight from the end on, for the time that is left."""
    motion = sensed.motion
    radius_m = margin * motion.speed_m_s / sensed.ability.turn_rate_rad_s
    off_m = TRACKING_S * motion.speed_m_s
    end, v = beyond.position, beyond.velocity
    heading = math.atan2(v.east_m_s, v.north_m_s)
    until_s = beyond.start_s + beyond.duration_s
    beside = tuple(
        Position(
            end.north_m - side * radius_m * math.sin(heading),
            end.east_m + side * radius_m * math.cos(heading),
            end.alt_m,
        )
        for side in (1, -1)
    )
    disc_m, places = radius_m + off_m, beside
    question = beside, disc_m, scene.zones
    if before is not None and before[:3] == question:
        asked = before
    else:
        obey = all(zones_permit(centre, scene.zones, disc_m) for centre in beside)
        asked = Beside(beside, disc_m, scene.zones, obey)
    if not asked.obey:  # a wider circle, on either side
        places, disc_m = (end,), 2 * WIDEST * radius_m + off_m
    holds = tuple(Hold(hold_at(place, beyond.start_s, until_s), disc_m) for place in places)
    return holds, asked
