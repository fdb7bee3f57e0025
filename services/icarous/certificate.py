"""A certificate: the manoeuvre that is flown and the hold that ends it, with what they are clear of and until when.

What is permitted is decided by the proved kernels behind `core.permit.remainder`: the buffered cylinder about each
intruder that was seen, straight on or along its told way; half of what the buffer leaves is for how far an intruder may
be off that, the rest for the vehicle, and what a turn may be off by more (`core.avoidance.drift`) is added. A part
of it that is over does not count any more: the rest is permitted too, and against one that was not known the
rest is asked alone.
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
"""A velocity that is commanded is the certificate's if they differ by less, horizontally and in climb [m/s]."""


class Track(NamedTuple):
    """An intruder as it was seen at an instant [ms], and is taken to fly from then on."""

    seen_ms: int
    seen: Intruder


class Certificate(NamedTuple):
    """offer: what it is to the hand, `core.permit.hand`; pieces: the manoeuvre from offer.sigma_ms on, one turn to one
    velocity; hold: the circle after it, None where there is none that is permitted; hold_m: no farther from its middle
    is the vehicle there [m]; off_m, rise_m: no farther off the pieces, and no farther off in height, also in the hold
    [m]; rho_m: as much of that as the buffer has no room for [m]; tracks: whom it allows for."""

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
        """How long the manoeuvre takes, up to the hold [ms]."""
        last = self.pieces[-1]
        return math.floor(1000 * (last.start_s + last.duration_s))

    @property
    def middle(self) -> Position:
        """The middle of the hold; where the manoeuvre ends, if there is none."""
        if self.hold is None:
            return after(self.pieces[-1], self.pieces[-1].duration_s)
        return Position(self.hold.north_m, self.hold.east_m, self.hold.alt_m)

    def age_s(self, now_ms: int) -> float:
        """How long it has been flown [s]."""
        return (now_ms - self.offer.sigma_ms) / 1000

    def turns_into_hold(self, now_ms: int) -> bool:
        """Whether the manoeuvre is over."""
        return lasted(self.offer.sigma_ms, now_ms, self.pieces_ms)

    def velocity(self, now_ms: int) -> Velocity:
        """What is steered for at an instant of the manoeuvre: the velocity at its end, and the climb of its piece."""
        age_s, v = self.age_s(now_ms), self.pieces[-1].velocity
        return v._replace(down_m_s=rest_of(self.pieces, age_s)[0].velocity.down_m_s)

    def steers(self, commanded: Velocity, now_ms: int) -> bool:
        """Whether a velocity that is commanded is the one of the manoeuvre, at an instant of it."""
        if self.turns_into_hold(now_ms):
            return False
        v = self.velocity(now_ms)
        beside = Vec2(commanded.north_m_s - v.north_m_s, commanded.east_m_s - v.east_m_s)
        climb = Vec2(commanded.down_m_s - v.down_m_s, 0.0)
        return bool(disc_within(beside, 0.0, SAME_M_S) and disc_within(climb, 0.0, SAME_M_S))

    def is_on_it(self, place: Position, now_ms: int) -> bool:
        """Whether a vehicle at a place is as near to what is flown then as was allowed for."""
        if self.turns_into_hold(now_ms):
            holds = self.hold is not None
            return holds and _near(self.middle, place, self.hold_m, self.rise_m)
        here = rest_of(self.pieces, self.age_s(now_ms))[0].position
        return _near(here, place, self.off_m, self.rise_m)

    def knows(self, other: Intruder, now_ms: int, daa: Daa) -> bool:
        """Whether it allows for an intruder that is seen now: it is one of the tracks, where that leads."""
        track = next((one for one in self.tracks if one.seen.id == other.id), None)
        if track is None:
            return False
        told = later(track.seen, (now_ms - track.seen_ms) / 1000).position
        return keeps_to(told, other.position, daa)

    def allows_for(self, intruder_id: int) -> bool:
        """Whether it allows for an intruder, wherever that may be now."""
        return any(one.seen.id == intruder_id for one in self.tracks)

    def with_track(self, other: Intruder, now_ms: int) -> Certificate:
        """The same, which allows for an intruder as it is seen now."""
        others = tuple(one for one in self.tracks if one.seen.id != other.id)
        return self._replace(tracks=(*others, Track(now_ms, other)))

    def permits(self, other: Intruder, now_ms: int, daa: Daa) -> bool:
        """Whether what is left of it is permitted against an intruder that is seen now."""
        age_s, volume = self.age_s(now_ms), buffered(daa.well_clear, daa.buffer)
        left = () if self.turns_into_hold(now_ms) else rest_of(self.pieces, age_s)
        return way_permits(left, other, volume, self.rho_m) and self.hold_is_permitted(
            other, now_ms, daa
        )

    def hold_is_permitted(self, other: Intruder, now_ms: int, daa: Daa) -> bool:
        """Whether what is left of its hold is: without what is flown before it."""
        standing, volume = self._standing(now_ms), buffered(daa.well_clear, daa.buffer)
        return standing is None or hold_permits(standing, other, volume, self.hold_m, self.rise_m)

    def _standing(self, now_ms: int) -> Piece | None:
        """What is left of the hold, until it all expires, as a piece that begins that much later than now."""
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
