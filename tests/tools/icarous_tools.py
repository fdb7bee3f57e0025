"""What the tests of ICAROUS share: a volume, an ability, a course, an intruder head on."""

from __future__ import annotations

from cratous.core.avoidance.manoeuvre import Ability, Motion
from cratous.core.avoidance.prediction import Intruder, buffered
from cratous.services.mission.frames import Projection
from cratous.spec.mission import Frame, Position, Velocity, WellClear

VOLUME = WellClear(150.0, 30.0, 15.0, 0.0)
WIDE = buffered(VOLUME, 1.25)
ABILITY = Ability(0.26, 15.0, 33.0, 4.0, 1.0, 60.0)
NORTH = Motion(Position(0.0, 0.0, 300.0), 0.0, 22.0, 0.0)
PROJECTION = Projection(Frame(45.0, -121.0, 0.0))


def head_on(distance_m: float, vid: int = 9, cooperates: bool = False) -> Intruder:
    return Intruder(vid, Position(distance_m, 0.0, 300.0), Velocity(-22.0, 0.0, 0.0), cooperates)
