"""The end of the way that an instance was told: the hold there is looked at, and nothing beyond it.

UxAS tells the way for farther than is looked, or to its end; there the vehicle loiters. An intruder or a zone
that lies behind the end is in nobody's way, so the way is predicted to the hold, if that is permitted
(`core.permit.remainder`); else straight on, as before.
"""

from __future__ import annotations

from typing import NamedTuple

from cratous.core.avoidance.manoeuvre import Way
from cratous.core.avoidance.prediction import Piece
from cratous.core.avoidance.resolution import Scene
from cratous.core.permit.remainder import hold_at, traffic_permits, zones_permit
from cratous.services.icarous.messages import Sensed
from cratous.spec.mission import WellClear

HOLD_RADII = 2.0
"""A loiter that touches the end of the way is within this many of its radii of it."""


class Ahead(NamedTuple):
    """The way that is predicted, and the volume that it has to keep clear."""

    pieces: tuple[Piece, ...]
    volume: WellClear


def with_hold(way: Way, sensed: Sensed, scene: Scene, own: WellClear, margin: float) -> Ahead:
    """The predicted way, and after its end the hold there; straight on where that is not permitted.

    own: the mission's volume, without buffer; margin: a loiter is flown this much wider than the tightest
    turn. A way that ends in a permitted hold keeps the buffered cylinder to its end; for the times
    that are left before it the mission's own thresholds do.
    """
    if way.beyond is None:
        return Ahead(way.pieces, scene.volume)
    beyond, motion = way.beyond, sensed.motion
    if way.pieces:
        radius_m = margin * motion.speed_m_s / sensed.ability.turn_rate_rad_s
        # the circle, and as far off it as the vehicle flies in a second
        hold_m = HOLD_RADII * radius_m + motion.speed_m_s
        place = beyond.position
        held = (*way.pieces, hold_at(place, beyond.start_s, beyond.start_s + beyond.duration_s))
        free = zones_permit(place, scene.zones, hold_m)
        if free and traffic_permits(held, scene.intruders, scene.volume, 0.0, hold_m):
            return Ahead(held, own)
    return Ahead((*way.pieces, beyond), scene.volume)
