"""The end of the announced route: the hold there is checked, and nothing beyond it.

UxAS sends the route for longer than the look-ahead, or to its end, where the vehicle loiters. The circles
tangent to the end on either side are checked: each is a stationary disc, which proved kernels permit or
not. One that is permitted against everybody suffices, beside the end or straight on: if UxAS circles elsewhere, ICAROUS
takes over then. The hold actually flown may be elsewhere: higher, while other vehicles still have tasks, or at a nearby
place where a circle keeps the zones (`services.flight.inflight_routes`); that route is sent once it is flown.
The hold is not checked against zones: UxAS circles where they are kept, or reports a violation. Straight
flight is predicted, without a hold, where the vehicle is more than 30 m off its path, more than 2 s of flight
past the end, or has no route (`foresight.predicted`).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from cratous.core.avoidance.manoeuvre import Way, looked_at
from cratous.core.avoidance.prediction import Intruder, Piece, after, first_violation_s, meets
from cratous.core.avoidance.resolution import Scene, first_zone_s
from cratous.core.permit.remainder import hold_at, hold_permits, zones_permit
from cratous.core.requirements.verdict import reaches
from cratous.services.icarous.messages import Sensed
from cratous.spec.mission import Position, WellClear, Zone

TURN_MARGIN = 1.1
"""Turns of a way back and of a loiter are this much wider than the tightest."""
TRACKING_S = 1.0
"""Tracking error on a circle: less than the distance flown in this time [s]."""
FARTHER = (2.0, 4.0, 6.0)
"""How far past the end a hold is looked for where none is permitted beside it [turn radii]."""
STEP_S = 5.0
"""That way is checked against zones in steps of this [s], without a margin."""
WIDEST = 1.5
"""Where a zone blocks the circle, its radius is up to this many times larger."""


class Hold(NamedTuple):
    """Holding as a segment of flight: a fixed disc of a radius [m] that contains the vehicle."""

    piece: Piece
    radius_m: float


class Beside(NamedTuple):
    """Discs of radius_m [m] beside the end of a route, checked against zones. obey: all of them keep all
    zones.
    """

    centres: tuple[Position, ...]
    radius_m: float
    zones: tuple[Zone, ...]
    obey: bool


class Ahead(NamedTuple):
    """The predicted route, the volumes that it must keep clear, and the candidate holds at its end.

    volumes: each is checked along the route; holds: one that is clear of everybody, else all of them; held: volume whose
    cylinder the holds must keep clear; rise_m: vertical deviation in a hold [m]; beside: result of the zone check for the
    holds; off_plan: the vehicle is off its plan, and predicted straight on.
    """

    pieces: tuple[Piece, ...]
    volumes: tuple[WellClear, ...]
    holds: tuple[Hold, ...] = ()
    held: WellClear | None = None
    rise_m: float = 0.0
    beside: Beside | None = None
    off_plan: bool = False

    def first_s(self, other: Intruder) -> float | None:
        """When the route or a hold at its end first violates a volume of an intruder [s]; None if never."""
        times = [first_violation_s(self.pieces, other, volume) for volume in self.volumes]
        if self.held is not None:
            times += [self._held_s(hold, other, self.held) for hold in self.holds]
        return min((t for t in times if t is not None), default=None)

    def meets(self, other: Intruder) -> bool:
        """Whether the route or a hold at its end violates a volume of an intruder: `first_s` without the
        time.
        """
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
    """A volume without time thresholds."""
    return WellClear(radius_m, half_m, 0.0, 0.0)


def horizon_s(scene: Scene) -> float:
    """How far ahead a route is followed [s]: the look-ahead and TTHR of the volume."""
    return scene.lookahead_s + scene.volume.tthr_s


def with_hold(
    way: Way,
    sensed: Sensed,
    scene: Scene,
    own: WellClear,
    margin: float,
    before: Beside | None = None,
) -> Ahead:
    """The part of a predicted route within the look-ahead, and the candidate holds if it ends sooner.

    way: followed to `horizon_s`; own: the mission's volume, without buffer; margin: radius of the loiter in
    tightest turns; before: the last zone check, reused if it is the same. A route followed to its end must
    keep the buffered cylinder and the mission's own volume clear, since its duration is known.
    """
    pieces, beyond = looked_at(way, scene.lookahead_s)
    if way.beyond is None:
        return Ahead(pieces, (scene.volume,))
    around = cylinder(scene.volume.dthr_m, scene.volume.zthr_m)
    rise_m = TRACKING_S * sensed.ability.max_climb_m_s
    if beyond is None:
        return Ahead(pieces, (own, around), (), around, rise_m, before)
    holds, beside = _holds(beyond, sensed, scene, margin, before)
    free = (hold for hold in holds if _is_free(hold, scene.intruders, around, rise_m))
    one = next(free, None)
    if one is not None:
        return Ahead(pieces, (own, around), (one,), around, rise_m, beside)
    farther = _hold_farther(beyond, sensed, scene, margin, (own, around))
    if farther is not None:
        on, far = farther
        return Ahead((*pieces, on), (own, around), far, around, rise_m, beside)
    return Ahead(pieces, (own, around), holds, around, rise_m, beside)


def _hold_farther(
    beyond: Piece, sensed: Sensed, scene: Scene, margin: float, volumes: tuple[WellClear, ...]
) -> tuple[Piece, tuple[Hold, ...]] | None:
    """A clear way straight on from the end, level, and a hold there that is permitted; no hold if the way lasts longer
    than is looked at; None if there is none. volumes: for the way; the last one for the hold.
    """
    rise_m = TRACKING_S * sensed.ability.max_climb_m_s
    level = beyond._replace(velocity=beyond.velocity._replace(down_m_s=0.0))
    for radii in FARTHER:
        on_s = radii * margin / sensed.ability.turn_rate_rad_s
        left_s = beyond.duration_s - on_s
        on = level if reaches(0.0, left_s) else level._replace(duration_s=on_s)
        if any(meets((on,), other, volume) for other in scene.intruders for volume in volumes):
            return None
        if first_zone_s((on,), scene.zones, STEP_S) is not None:
            return None
        if reaches(0.0, left_s):
            return on, ()
        start_s, there = beyond.start_s + on_s, after(level, on_s)
        later = level._replace(start_s=start_s, duration_s=left_s, position=there)
        holds, beside = _holds(later, sensed, scene, margin, None)
        for hold in holds if beside.obey else ():
            if _is_free(hold, scene.intruders, volumes[-1], rise_m):
                return on, (hold,)
    return None


def _is_free(hold: Hold, intruders: tuple[Intruder, ...], volume: WellClear, rise_m: float) -> bool:
    """Whether a hold keeps the volume clear of all intruders."""
    return all(hold_permits(hold.piece, o, volume, hold.radius_m, rise_m) for o in intruders)


def _holds(
    beyond: Piece, sensed: Sensed, scene: Scene, margin: float, before: Beside | None
) -> tuple[tuple[Hold, ...], Beside]:
    """Candidate loiters at the end. beyond: straight flight from the end on, for the remaining time."""
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
