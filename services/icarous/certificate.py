"""A certificate: the manoeuvre being flown and the hold that ends it, with the intruders it is permitted
against and its expiry.

The proved kernels behind `core.permit.remainder` decide what is permitted: the buffered cylinder around each
intruder seen, in straight flight or along its announced route. Half of the buffer's margin allows for the
intruder's deviation, the rest for the vehicle's; a turn's larger drift (`core.avoidance.drift`) is added. The
remainder of a permitted certificate is permitted too, so against a newly seen intruder only the remainder is
checked.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from cratous.core.authority.timeliness import lasted
from cratous.core.avoidance.prediction import (
    STANDING,
    Intruder,
    Piece,
    after,
    buffered,
    later,
    rest_of,
)
from cratous.core.kernel import Vec2
from cratous.core.permit.hand import Offer
from cratous.core.permit.remainder import hold_permits, way_permits
from cratous.core.permit.tubes import disc_within
from cratous.services.icarous.deviation import keeps_to
from cratous.spec.mission import Daa, Position, Velocity
from cratous.spec.mission.plan import Hold

SAME_M_S = 0.001
"""A commanded velocity follows the certificate if it differs by less than this, horizontally and in climb
[m/s].
"""


class Track(NamedTuple):
    """An intruder as seen at seen_ms [ms], from which its flight is predicted."""

    seen_ms: int
    seen: Intruder


class Certificate(NamedTuple):
    """offer: its identity and times for the hand, see `core.permit.hand`; pieces: the manoeuvre from
    offer.sigma_ms on, a turn to one velocity; hold: the circle after it, None if none is permitted;
    hold_m: radius of the disc around the hold's centre that contains the vehicle [m]; off_m, rise_m:
    largest horizontal and vertical deviation from the pieces, rise_m also in the hold [m]; rho_m: the part
    of these that exceeds the buffer's margin [m]; tracks: intruders it allows for.
    """

    offer: Offer
    pieces: tuple[Piece, ...]
    hold: Hold | None
    hold_m: float
    off_m: float
    rise_m: float
    rho_m: float
    tracks: tuple[Track, ...]

    @property
    def pieces_ms(self) -> int:
        """Duration of the manoeuvre up to the hold [ms]."""
        last = self.pieces[-1]
        return math.floor(1000 * (last.start_s + last.duration_s))

    @property
    def middle(self) -> Position:
        """The centre of the hold; without one, the end of the manoeuvre."""
        if self.hold is None:
            return after(self.pieces[-1], self.pieces[-1].duration_s)
        return Position(self.hold.north_m, self.hold.east_m, self.hold.alt_m)

    def age_s(self, now_ms: int) -> float:
        """Time since it began [s]."""
        return (now_ms - self.offer.sigma_ms) / 1000

    def turns_into_hold(self, now_ms: int) -> bool:
        """Whether the manoeuvre is over."""
        return lasted(self.offer.sigma_ms, now_ms, self.pieces_ms)

    def velocity(self, now_ms: int) -> Velocity:
        """The velocity to command at an instant of the manoeuvre: horizontally that at its end, with the
        climb of the present piece.
        """
        age_s, v = self.age_s(now_ms), self.pieces[-1].velocity
        return v._replace(down_m_s=rest_of(self.pieces, age_s)[0].velocity.down_m_s)

    def steers(self, commanded: Velocity, now_ms: int) -> bool:
        """Whether a commanded velocity is that of the manoeuvre at an instant."""
        if self.turns_into_hold(now_ms):
            return False
        v = self.velocity(now_ms)
        beside = Vec2(commanded.north_m_s - v.north_m_s, commanded.east_m_s - v.east_m_s)
        climb = Vec2(commanded.down_m_s - v.down_m_s, 0.0)
        return bool(disc_within(beside, 0.0, SAME_M_S) and disc_within(climb, 0.0, SAME_M_S))

    def is_on_it(self, place: Position, now_ms: int) -> bool:
        """Whether a vehicle at a place is within the certificate's allowed deviation at an instant."""
        if self.turns_into_hold(now_ms):
            holds = self.hold is not None
            return holds and _near(self.middle, place, self.hold_m, self.rise_m)
        here = rest_of(self.pieces, self.age_s(now_ms))[0].position
        return _near(here, place, self.off_m, self.rise_m)

    def knows(self, other: Intruder, now_ms: int, daa: Daa) -> bool:
        """Whether it allows for an intruder and that intruder is where its track predicts it."""
        track = next((one for one in self.tracks if one.seen.id == other.id), None)
        if track is None:
            return False
        told = later(track.seen, (now_ms - track.seen_ms) / 1000).position
        return keeps_to(told, other.position, daa)

    def allows_for(self, intruder_id: int) -> bool:
        """Whether it allows for an intruder, regardless of the intruder's position."""
        return any(one.seen.id == intruder_id for one in self.tracks)

    def with_track(self, other: Intruder, now_ms: int) -> Certificate:
        """The certificate with an intruder's track replaced by its present state."""
        others = tuple(one for one in self.tracks if one.seen.id != other.id)
        return self._replace(tracks=(*others, Track(now_ms, other)))

    def permits(self, other: Intruder, now_ms: int, daa: Daa) -> bool:
        """Whether the remainder of it is permitted against an intruder seen now."""
        age_s, volume = self.age_s(now_ms), buffered(daa.well_clear, daa.buffer)
        left = () if self.turns_into_hold(now_ms) else rest_of(self.pieces, age_s)
        return way_permits(left, other, volume, self.rho_m) and self.hold_is_permitted(
            other, now_ms, daa
        )

    def hold_is_permitted(self, other: Intruder, now_ms: int, daa: Daa) -> bool:
        """Whether the remainder of its hold is permitted, without the manoeuvre before it."""
        standing, volume = self._standing(now_ms), buffered(daa.well_clear, daa.buffer)
        return standing is None or hold_permits(standing, other, volume, self.hold_m, self.rise_m)

    def _standing(self, now_ms: int) -> Piece | None:
        """The remainder of the hold until expiry, as a stationary piece timed from now; None if nothing
        remains.
        """
        offer = self.offer
        begin_ms = max(offer.sigma_ms + self.pieces_ms, now_ms)
        if self.hold is None or lasted(offer.expiry_ms, begin_ms, 0):
            return None
        start_s, left_s = (begin_ms - now_ms) / 1000, (offer.expiry_ms - begin_ms) / 1000
        return Piece(start_s, left_s, self.middle, STANDING)


def _near(middle: Position, place: Position, wide_m: float, high_m: float) -> bool:
    beside = Vec2(place.north_m - middle.north_m, place.east_m - middle.east_m)
    above = Vec2(place.alt_m - middle.alt_m, 0.0)
    return bool(disc_within(beside, 0.0, wide_m) and disc_within(above, 0.0, high_m))
