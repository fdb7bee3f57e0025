"""Whether the ownship's predicted flight meets a zone within its turn-back time."""

from __future__ import annotations

from cratous.core.avoidance.manoeuvre import Ability, Motion
from cratous.core.avoidance.prediction import Piece
from cratous.core.avoidance.resolution import first_zone_s, turn_back_s
from cratous.spec.mission import Zone


def zone_ahead_s(
    now: Motion, ability: Ability, pieces: tuple[Piece, ...], zones: tuple[Zone, ...]
) -> float | None:
    """When a zone is met [s from now], if that is sooner than the turn-back time; else None.

    pieces: the predicted flight; only its part within the turn-back time is checked, since beyond it there is
    still time to turn.
    """
    if not zones:
        return None
    horizon_s = turn_back_s(now, ability)
    near = []
    for piece in pieces:
        if piece.start_s >= horizon_s:
            break
        near.append(piece._replace(duration_s=min(piece.duration_s, horizon_s - piece.start_s)))
    return first_zone_s(near, zones, horizon_s)
