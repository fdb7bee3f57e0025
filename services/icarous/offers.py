"""The certificate that an instance offers to the actuator gate with each command.

The manoeuvre is followed up to the look-ahead, or to a quarter, half or three quarters of it, and then a
circle to the right or left: the combination that is permitted longest, and of those the longest manoeuvre.
Where no circle is permitted the manoeuvre alone is offered, for as long as it is permitted. Zones are checked
with the drift of the turn and the position uncertainty added, and the disc of the hold at its altitude.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from cratous.core.avoidance.drift import Drift, drift_of
from cratous.core.avoidance.manoeuvre import Way, fly_to, looked_at
from cratous.core.avoidance.prediction import Piece, after
from cratous.core.avoidance.resolution import Choice, Scene, first_zone_s, turn_back_s
from cratous.core.permit.hand import Offer
from cratous.core.permit.remainder import zones_permit
from cratous.services.icarous.certificate import Certificate, Track
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous.route_end import TRACKING_S, TURN_MARGIN
from cratous.spec.mission import Daa
from cratous.spec.mission.plan import Hold

PARTS = (1.0, 0.75, 0.5, 0.25)
"""Shares of the look-ahead for which the manoeuvre is followed."""
HOLDS_S = (600.0, 240.0, 120.0, 60.0, 30.0, 10.0)
"""Durations of the hold, the longest permitted one is used [s]."""


class Refused(NamedTuple):
    """Why a manoeuvre is not permitted. intruder_id: the intruder concerned, 0 for a zone."""

    intruder_id: int
    reason: str


def certified(sensed: Sensed, scene: Scene, choice: Choice, daa: Daa) -> Certificate | Refused:
    """A certificate for the manoeuvre being commanded, or why none can be given."""
    whole = fly_to(sensed.motion, sensed.ability, *choice[1:5], scene.lookahead_s)
    drift = drift_of(sensed.motion, sensed.ability, *choice[1:4], scene.here)
    near_s = turn_back_s(sensed.motion, sensed.ability)
    bare: list[Certificate] = []
    held: list[Certificate] = []
    refused = Refused(0, "")
    for share in PARTS:
        pieces = looked_at(Way(whole, None), share * scene.lookahead_s).pieces
        if first_zone_s(pieces, scene.zones, near_s, drift) is not None:
            refused = Refused(0, "a zone is in the way of the manoeuvre")
            continue
        alone = _with_hold(sensed, pieces, drift, None, daa)
        against = (o.id for o in sensed.intruders if not alone.permits(o, sensed.now_ms, daa))
        if (first := next(against, None)) is not None:
            refused = Refused(first, f"the manoeuvre is not permitted against {first}")
            continue
        bare.append(alone)
        circles = [_with_hold(sensed, pieces, drift, one, daa) for one in _circles(sensed, pieces)]
        longest, *shorter = HOLDS_S
        if found := _held(circles, longest, scene, sensed, daa):
            held += found
            break
        lasting = (_held(circles, hold_s, scene, sensed, daa) for hold_s in shorter)
        held += next((found for found in lasting if found), [])
    # of those that last equally long the first one, whose manoeuvre is longest
    return max(held or bare, key=lambda one: one.offer.expiry_ms, default=refused)


def _with_hold(
    sensed: Sensed, pieces: tuple[Piece, ...], drift: Drift, hold: Hold | None, daa: Daa
) -> Certificate:
    """The certificate that would follow the present hand, begins now, and ends with the manoeuvre."""
    end_s, hand = pieces[-1].start_s + pieces[-1].duration_s, sensed.hand
    room, volume = (daa.buffer - 1) / 2, daa.well_clear
    aside_m = drift.aside_m(end_s)
    rise_m = drift.rise_m(end_s)
    wide_m, high_m = room * volume.dthr_m, room * volume.zthr_m
    speed, disc_m = _speed_m_s(pieces), 0.0
    if hold is not None:
        disc_m = hold.radius_m + TRACKING_S * speed + aside_m
    now_ms = sensed.now_ms
    offer = Offer(hand.id + 1, hand.id, now_ms, hand.knowledge, now_ms + math.floor(1000 * end_s))
    return Certificate(
        offer, pieces, hold, disc_m,
        max(wide_m, aside_m), max(high_m, rise_m), max(0.0, aside_m - wide_m, rise_m - high_m),
        tuple(Track(now_ms, other) for other in sensed.intruders),
    )  # fmt: skip


def _circles(sensed: Sensed, pieces: tuple[Piece, ...]) -> list[Hold]:
    """The circles tangent to the end of a manoeuvre, right and left."""
    last, speed = pieces[-1], _speed_m_s(pieces)
    end, v = after(last, last.duration_s), last.velocity
    heading = math.atan2(v.east_m_s, v.north_m_s)
    # at another speed the same bank angle gives another turn rate
    fast = max(speed, sensed.motion.speed_m_s)
    rate = sensed.ability.turn_rate_rad_s * sensed.motion.speed_m_s / fast
    radius_m = TURN_MARGIN * fast / rate
    return [
        Hold(
            end.north_m - side * radius_m * math.sin(heading),
            end.east_m + side * radius_m * math.cos(heading),
            end.alt_m, radius_m, side > 0,
        )
        for side in (1, -1)
    ]  # fmt: skip


def _speed_m_s(pieces: tuple[Piece, ...]) -> float:
    v = pieces[-1].velocity
    return math.hypot(v.north_m_s, v.east_m_s)


def _held(
    circles: list[Certificate], hold_s: float, scene: Scene, sensed: Sensed, daa: Daa
) -> list[Certificate]:
    """The certificates whose hold is permitted for hold_s [s], extended by that time.

    circles: certificates with the same manoeuvre, which is permitted without a hold (`certified`).
    """
    until_ms = circles[0].offer.expiry_ms + math.floor(1000 * hold_s)
    longer = [c._replace(offer=c.offer._replace(expiry_ms=until_ms)) for c in circles]
    return [
        one
        for one in longer
        if all(one.hold_is_permitted(other, sensed.now_ms, daa) for other in sensed.intruders)
        and zones_permit(one.middle, scene.zones, one.hold_m)
    ]
