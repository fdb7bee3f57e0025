"""Where the fix at which vehicles merge lies on a vehicle's route."""

from __future__ import annotations

from collections.abc import Sequence

from cratous.core.avoidance.way_ahead import near_line
from cratous.core.kernel import Vec2
from cratous.core.routing.polylines import Track
from cratous.services.flight.chain import Chain
from cratous.spec.mission import Position
from cratous.spec.mission.merging import Merging


def comes_before(merging: Merging, chain: Chain) -> bool:
    """Whether the present task lies in the coordination zone, and the route after it passes the fix."""
    item = chain.item
    if item is None or not passes(merging, item.path, merging.coordination_m):
        return False
    place = item.path[-1]
    for following in chain.items[chain.k + 1 :]:
        if passes(merging, (place, *following.transit, *following.path), merging.entry_m):
            return True
        place = following.path[-1]
    return False


def passes(merging: Merging, points: Sequence[Position], within_m: float) -> bool:
    """Whether a line comes within a distance [m] of the fix, seen from above."""
    track, fix = Track(tuple(points), 0.0), Vec2(merging.north_m, merging.east_m)
    near = track.at(track.nearest(Position(*fix, 0.0), 0.0, track.length_m).s_m)
    return near_line(Vec2(near.north_m, near.east_m), fix, fix, within_m)
