"""The moving zones of a mission, and legs against them: exact, in the frame in which the zone stands still.

Seen from the zone, a leg flown from one instant to another is another straight leg, and the kernels for standing
polygons decide on it (theorem `geofence_seen_from_a_moving_polygon_it_stands`).
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any, NamedTuple

from cratous.core.geofence.motion import seen_from
from cratous.core.kernel import Vec2, qualified
from cratous.services.mission.zones import deciding, exact_leg_keeps, exact_leg_ok
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission, MovingZone, Position, SweptZone, Zone, ZoneKind

Leg = tuple[Position, Position]


def moving_zones(mission: Mission) -> tuple[MovingZone, ...]:
    """All moving zones of a mission, each once."""
    later = (change.zone for change in mission.changes if change.zone is not None)
    swept = (zone for zone in (*mission.zones, *later) if isinstance(zone, SweptZone))
    return tuple(dict.fromkeys(zone.moving for zone in swept))


def standing(zone: MovingZone) -> Zone:
    """The zone in its own frame, where its vertices are those at from_ms."""
    return Zone(zone.id, ZoneKind.KEEP_OUT, zone.vertices, zone.floor_m, zone.ceiling_m)


def seen_exactly(at: Position, time_ms: int, zone: MovingZone) -> Position:
    """A position at an instant in the zone's frame, on rationals."""
    numbers: Any = [Fraction(x) for x in (at.north_m, at.east_m, *zone.velocity_m_s)]
    gone_s: Any = Fraction(time_ms - zone.from_ms, 1000)
    north_m, east_m = seen_from(Vec2(*numbers[:2]), Vec2(*numbers[2:]), gone_s)
    return Position(north_m, east_m, at.alt_m)


def seen(at: Position, time_ms: int, zone: MovingZone) -> Position:
    """The same in doubles: for display only."""
    return Position(*(float(x) for x in seen_exactly(at, time_ms, zone)))


def exact_moving_leg_ok(
    p: Position, q: Position, times_ms: tuple[int, int], zone: MovingZone
) -> bool:
    """Whether a straight leg, flown from the first to the second of two instants, keeps out of the zone where that
    is then; exact.
    """
    ends = [seen_exactly(at, time_ms, zone) for at, time_ms in zip((p, q), times_ms, strict=True)]
    return exact_leg_ok(ends[0], ends[1], standing(zone))


def moving_disc_ok(
    centre: Position, radius_m: float, times_ms: tuple[int, int], zone: MovingZone
) -> bool:
    """Whether a standing disc keeps out of the zone, where that is, from the first to the second instant; exact, but
    True too little: the radius counts in altitude as well.
    """
    p, q = (seen_exactly(centre, time_ms, zone) for time_ms in times_ms)
    return exact_leg_keeps(p, q, standing(zone), radius_m)


class Now(NamedTuple):
    """A moving zone at an instant, and for a while after it [ms]."""

    zone: MovingZone
    at_ms: int
    for_ms: int

    @property
    def id(self) -> int:
        """The zone's id."""
        return self.zone.id

    def kept_by(self, leg: Leg, flown: Leg, margin_m: float) -> bool:
        """Whether the part of a leg beside a flown segment keeps clear of the zone by a margin [m] all the while; exact,
        with a bound on how far the zone moves meanwhile. What lies ahead and behind is not flown meanwhile.
        """
        north_m_s, east_m_s = map(Fraction, self.zone.velocity_m_s)
        wide: Any = Fraction(margin_m) + Fraction(self.for_ms, 1000) * (
            abs(north_m_s) + abs(east_m_s)
        )
        p, q = (seen_exactly(at, self.at_ms, self.zone) for at in _beside(leg, flown))
        return exact_leg_keeps(p, q, standing(self.zone), wide)


def _beside(leg: Leg, flown: Leg) -> Leg:
    """The part of a leg from which the points of a flown segment are nearest, a metre longer at either end; rational."""
    (pn, pe, _), (qn, qe, _) = leg
    north, east = qn - pn, qe - pe
    square = north * north + east * east
    if not square:
        return leg
    at = [((f.north_m - pn) * north + (f.east_m - pe) * east) / square for f in flown]
    spare = 1 / math.sqrt(square)
    ends = [Fraction(min(max(t, 0.0), 1.0)) for t in (min(at) - spare, max(at) + spare)]
    (an, ae, aa), (bn, be, ba) = (map(Fraction, point) for point in leg)
    parts: Any = [(an + t * (bn - an), ae + t * (be - ae), aa + t * (ba - aa)) for t in ends]
    return Position(*parts[0]), Position(*parts[1])


def refuse_moving(mission: Mission, what: str) -> None:
    """BadInput for a mission with moving zones; what: for which they are not supported, in words."""
    for zone in moving_zones(mission):
        raise BadInput(
            f"zone {zone.id} moves, which {what}",
            where=mission.source,
            item="zones",
            expected="zones that stand",
            got=f"a velocity of {zone.velocity_m_s[0]:g} m/s north, {zone.velocity_m_s[1]:g} m/s east",
        )


def moving_deciding(zone: MovingZone) -> tuple[str, ...]:
    """The driver and the kernels that decide `exact_moving_leg_ok`."""
    return (*deciding(standing(zone)), qualified(seen_from))
