"""Permits of the route after a handback, intruder by intruder.

At a handback the whole announced route is checked against each intruder for which ICAROUS has taken over: the
buffered cylinder, and the mission's own volume, against straight flight of the intruder. Half of the buffer's
margin allows for the intruder's deviation, the rest for the vehicle's (`docs/proofs/assumptions.md`). While
the intruder stays within that, the route is permitted and ICAROUS does not take over for it, unless a loss of
the mission's own volume, or one in the final hold, is predicted. When the intruder leaves its line, or
another route is announced, the check is repeated: the new route is permitted as well, or the permit ends as a
surprise. The kernels of `core.permit.encounter` count the takeovers.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from cratous.core.avoidance.manoeuvre import way_along
from cratous.core.avoidance.prediction import Intruder, Piece, buffered, later, meets
from cratous.core.permit.encounter import (
    Encounter,
    encounter_looked,
    encounter_resumed,
    encounter_watched,
)
from cratous.core.permit.remainder import way_permits
from cratous.services.icarous.deviation import keeps_to
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous.pace import pace_of
from cratous.services.icarous.route_end import Ahead
from cratous.services.icarous.state import Config, Met, State
from cratous.services.icarous.traffic_monitor import Threat
from cratous.spec.mission import Daa
from cratous.spec.records import replace

NONE = Encounter(0, 0, 0, False, False, 0)
"""An intruder for which ICAROUS has never taken over."""
OFF_LINE = "it does not fly as predicted"
OTHER_WAY = "another way was told, which is not permitted"
ITS_WAY = "it flies another way than was told, and the own way is not permitted against that"
UNFORESEEN = "a loss is predicted that was not as control went back"
NOT_FREE = "the way was not permitted as control went back"
ENDED = "what was permitted had ended"


def resumed(config: Config, state: State, sensed: Sensed, in_turn: frozenset[int]) -> State:
    """UxAS has the vehicle again: determine which intruders its route is permitted against, and until when."""
    seen = {other.id: other for other in sensed.intruders}
    pieces = _whole(state, sensed)
    until_ms = sensed.now_ms + math.floor(1000 * sum(piece.duration_s for piece in pieces))
    after = []
    for met in state.met:
        other = seen.get(met.intruder_id)
        straight = None if met.intruder_id in in_turn else other
        allowed = straight is not None and _permitted(pieces, straight, config.daa)
        one = encounter_resumed(met.encounter, allowed, until_ms)
        why = met.why if allowed or one == met.encounter else NOT_FREE
        after.append(_made(met.intruder_id, one, straight, state, sensed, why))
    return replace(state, met=tuple(after))


def looked(config: Config, state: State, sensed: Sensed, ahead: Ahead) -> State:
    """Re-check the permits at a heartbeat under UxAS and keep those that still hold. ahead: the route
    predicted now.
    """
    seen = {other.id: other for other in sensed.intruders}
    after = []
    own = ahead._replace(volumes=(config.daa.well_clear,))
    for met in state.met:
        other = seen.get(met.intruder_id) if met.encounter.permitted else None
        now, allowed = met, True
        if other is not None:
            on_line = _on_line(met, other, sensed.now_ms, config.daa)
            its_way = state.told.way_of(met.intruder_id)
            same = met.way == state.told.waypoints
            if not (on_line and same and met.its_way == its_way):
                allowed = _permitted(_whole(state, sensed), other, config.daa)
                why = OFF_LINE if not on_line else ITS_WAY if same else OTHER_WAY
                now = _made(met.intruder_id, met.encounter, other, state, sensed, why)
            if allowed and own.first_s(other) is not None:
                allowed, now = False, now._replace(why=UNFORESEEN)
        one = encounter_looked(met.encounter, allowed, sensed.now_ms)
        why = ENDED if one.ended > met.encounter.ended else now.why
        after.append(now._replace(encounter=one, why=met.why if one.permitted else why))
    return replace(state, met=tuple(after))


def _made(
    intruder_id: int,
    encounter: Encounter,
    other: Intruder | None,
    state: State,
    sensed: Sensed,
    why: str,
) -> Met:
    """The record of an intruder against which the present route was checked now."""
    told = state.told
    its_way = told.way_of(intruder_id)
    return Met(intruder_id, encounter, other, sensed.now_ms, told.waypoints, why, its_way)


def _whole(state: State, sensed: Sensed) -> tuple[Piece, ...]:
    """The announced route from here to its end."""
    told = state.told
    pace = pace_of(told, sensed) if state.paces(sensed.now_ms) else None
    return way_along(sensed.motion, told.waypoints[told.next_index :], math.inf, pace=pace).pieces


def acting(state: State, found: Sequence[Threat]) -> tuple[Threat, ...]:
    """The threats that ICAROUS acts on: those that require own action and have no permit."""
    met = {one.intruder_id: one.encounter for one in state.met}
    return tuple(
        threat
        for threat in found
        if encounter_watched(met.get(threat.intruder_id, NONE), threat.ours_to_act).acts
    )


def taken_over(state: State, intruder_id: int) -> State:
    """The state after a takeover because of an intruder."""
    before = state.find(intruder_id) or Met(intruder_id, NONE)
    after = before._replace(encounter=encounter_watched(before.encounter, True).encounter)
    others = [one for one in state.met if one.intruder_id != intruder_id]
    return replace(state, met=tuple(sorted((*others, after))))


def told_why(state: State, intruder_id: int) -> str:
    """Why ICAROUS takes over again because of an intruder, in words; "" if it is the first time."""
    met = state.find(intruder_id)
    return f"; again, since {met.why}" if met is not None and met.why else ""


def _permitted(pieces: Sequence[Piece], other: Intruder, daa: Daa) -> bool:
    """Whether the route keeps the buffered cylinder and the mission's own volume clear of the intruder in
    straight flight.
    """
    return keeps_volume(pieces, other, daa) and way_is_clear(pieces, other, daa)


def keeps_volume(pieces: Sequence[Piece], other: Intruder, daa: Daa) -> bool:
    """Whether the route keeps the mission's own volume clear of the intruder: a fast check."""
    return not meets(pieces, other, daa.well_clear)


def way_is_clear(pieces: Sequence[Piece], other: Intruder, daa: Daa) -> bool:
    """Whether the route keeps the buffered cylinder clear of the intruder."""
    return way_permits(pieces, other, buffered(daa.well_clear, daa.buffer))


def _on_line(met: Met, other: Intruder, now_ms: int, daa: Daa) -> bool:
    """Whether the intruder is within half of the buffer's margin of its prediction."""
    if met.predicted is None:
        return False
    told = later(met.predicted, (now_ms - met.made_ms) / 1000)
    return keeps_to(told.position, other.position, daa, told.spread, other.spread)
