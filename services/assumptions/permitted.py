"""The assumption that what was found clear is clear when flown. Decided by `cylinder_violation`,
`obeys` and `in_time`.

The inputs of ICAROUS's checks are not in the log, but the conclusions are: that UxAS may fly on
until the next heartbeat, and until when the certificate in hand is valid. While either applies, no
position may lie in the mission's own cylinder about an aircraft that it sees nor, with a
certificate, violate a zone. Otherwise the premises of the theorem were not all true: this one,
unless another was broken before.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from cratous.core.authority.gate import epoch_given, gate_accepts
from cratous.core.authority.timeliness import in_time
from cratous.core.avoidance.way_ahead import near_line
from cratous.core.kernel import Vec2
from cratous.core.readings.exact import exact
from cratous.core.well_clear import cylinder_violation
from cratous.services.assumptions.authority import UNTOUCHED, has_it, reported
from cratous.services.assumptions.link import NO_INSTANCE
from cratous.services.assumptions.observations import ANY_LATER, Message, Record, Watch
from cratous.services.mission.zone_times import zones_of
from cratous.services.mission.zones import exact_leg_ok
from cratous.spec.mission import FaultySimulation, Mission, Position

NEAR = 0.5
"""Ratio of cylinder size to distance from which the kernel is called; 1 is on its surface."""
FAR = 1.001
"""Multiple of DTHR, over the greatest ratio so far, beyond which rounding in doubles cannot matter."""
HERE = Vec2(0.0, 0.0)
SEEN = "flown as looked at"
"""The assumption whose watch notes gaps in the observation of aircraft."""
IN_HAND = ("Offered", "Known", "Left")
"""Certificate changes that state until when it is valid."""


class Place(NamedTuple):
    """Position of an aircraft at an instant; stands: a mission vehicle on the ground."""

    time_ms: int
    at: Position
    stands: bool


class InHand(NamedTuple):
    """The certificate in force: when it was offered, and until when flying is permitted [ms]."""

    since_ms: int = 0
    until_ms: int = 0


class PermittedWatch:
    """Checks each vehicle with an ICAROUS against each aircraft that it sees. others: the other motion watches."""

    kinds = ("AuthorityChange", "GateState", "HandState", "Heartbeat", "SensedState", "TruthState")

    def __init__(self, mission: Mission, others: Sequence[Watch]) -> None:
        self._volume, self._others = mission.daa.well_clear, others
        self._senses = mission.sensing is not None
        self._gates = dict.fromkeys(mission.instances, UNTOUCHED)
        self._hands = dict.fromkeys(mission.instances, InHand())
        self._taken, self._handed = set[int](), set[int]()
        """Vehicles that ICAROUS has commanded, and those with reported certificate changes."""
        self._mission, self._ours = mission, frozenset(v.id for v in mission.vehicles)
        self._beat_ms = dict.fromkeys(mission.instances, -1)
        self._period_ms = mission.simulation.heartbeat_ms
        self._places: dict[int, Place] = {}
        self._of_instant: dict[int, dict[int, Place]] = {}
        """Newest position of each aircraft, by time and then by number."""
        self._since_ms: dict[int, int] = {}
        self._sensed = set[tuple[int, int]]()
        self._met: dict[int, set[int]] = {number: set() for number in mission.instances}
        """For each instance the aircraft known to be present at its last heartbeat."""
        self._permits: dict[int, tuple[int, bool]] = {}
        """For each instance the cached time and answer of `_is_permitted`, until something changes."""
        none = "" if mission.instances else NO_INSTANCE
        if mission.instances and isinstance(mission.simulation, FaultySimulation):
            none = "with faults of the bridge the log does not say at which heartbeats ICAROUS has looked"
        kernels = (cylinder_violation, gate_accepts, in_time)
        self._record = Record(
            "of the cylinder",
            1.0,
            kernels,
            none,
            waits="nothing that ICAROUS has looked at was seen",
        )

    def message(self, message: Message) -> None:
        """Process one message: commander, certificate, heartbeat, sensed state or true state."""
        kind, now_ms, _, body = message
        if self._record.unseen or kind not in self.kinds:
            return
        if kind == "TruthState":
            self._here(body)
            return
        if kind == "SensedState":
            self._sensed.add((body.ObserverID, body.VehicleID))
            return
        number = body.VehicleID
        if number not in self._gates:
            return
        self._permits.pop(number, None)
        if kind == "GateState":
            self._gates[number] = reported(body)
            if has_it(self._gates[number]):
                self._taken.add(number)
        elif kind == "AuthorityChange":
            if not self._record.gaps and not epoch_given(self._gates[number], body.Epoch):
                told = f"nothing reported its gate in epoch {body.Epoch}"
                self._record.gaps.append(f"at {now_ms / 1000:.2f} s {told}, of vehicle {number}")
        elif kind == "HandState":
            self._handed.add(number)
            if body.Change.name not in IN_HAND:
                return
            since_ms = now_ms if body.Change.name == "Offered" else self._hands[number].since_ms
            self._hands[number] = InHand(since_ms, body.Expiry)
        elif kind == "Heartbeat" and body.Direction.name == "Up":
            if not in_time(self._beat_ms[number], now_ms, ANY_LATER):
                self._met[number].clear()
            self._beat_ms[number] = now_ms

    def _here(self, body: Any) -> None:
        """Compare a new position with the others of the same instant."""
        number, speeds = body.VehicleID, (body.VelocityNorth, body.VelocityEast, body.VelocityDown)
        stands = number in self._ours and not any(speeds)
        place = Place(body.Time, Position(body.North, body.East, body.Altitude), stands)
        before, self._places[number] = self._places.get(number), place
        self._since_ms.setdefault(number, body.Time)
        if number in self._gates:
            self._against_zones(number, before or place, place)
        there = self._of_instant.setdefault(place.time_ms, {})
        if before is not None and not in_time(before.time_ms, place.time_ms, 0):
            left = self._of_instant[before.time_ms]
            del left[number]
            if not left:
                del self._of_instant[before.time_ms]
        # vehicles rolling, standing or landed are not kept clear of
        hits: dict[int, list[tuple[int, str]]] = {}
        for other, its in () if place.stands else there.items():
            if other != number and not its.stands:
                hit = self._pair(number, other, place, its)
                if hit:
                    hits[other] = hit
        there[number] = place
        for other in self._places if hits else ():
            for own, where in hits.get(other, ()):
                self._found(own, place.time_ms, where)

    def _pair(self, one: int, other: int, here: Place, there: Place) -> list[tuple[int, str]]:
        """For two aircraft flying at one instant: the vehicles with a conclusion whose cylinder is
        violated, with a description.
        """
        told = self._told(one, other, here.time_ms) + self._told(other, one, here.time_ms)
        if not told:
            return []
        volume, (a, b) = self._volume, (here.at, there.at)
        north, east, up = b.north_m - a.north_m, b.east_m - a.east_m, b.alt_m - a.alt_m
        most = min(self._record.extreme or 0.0, NEAR)
        if most > 0 and not near_line(Vec2(north, east), HERE, HERE, FAR * volume.dthr_m / most):
            # less than the greatest ratio so far, and than the threshold for calling the kernel
            self._record.see_again(0.0, len(told))
            return []
        beside = math.hypot(north, east)
        share = min(_share(volume.dthr_m, beside), _share(volume.zthr_m, abs(up)))
        self._record.see(share)
        self._record.see_again(share, len(told) - 1)
        if share <= NEAR or not self._hit(north, east, up):
            return []
        apart = f"is {beside:.4g} m beside and {abs(up):.4g} m above or below aircraft"
        return [(own, f"{apart} {off}") for own, off in told]

    def _told(self, own: int, other: int, now_ms: int) -> tuple[tuple[int, int], ...]:
        """The pair (own, other) if a conclusion of own about other applies now; else empty."""
        if own not in self._gates:
            return ()
        asked_ms, is_so = self._permits.get(own, (None, False))
        if asked_ms is None or not in_time(asked_ms, now_ms, 0):
            is_so = self._is_permitted(own, now_ms)
            self._permits[own] = now_ms, is_so
        return ((own, other),) if is_so and self._is_seen(own, other) else ()

    def _against_zones(self, own: int, before: Place, here: Place) -> None:
        """Check flight since the last sample under a certificate against the zones that it took into account."""
        since_ms, until_ms = self._hands[own]
        flown = has_it(self._gates[own]) and in_time(since_ms, before.time_ms, ANY_LATER)
        if not flown or here.stands or in_time(until_ms, here.time_ms, ANY_LATER):
            return
        if not all(map(math.isfinite, (*before.at, *here.at))):
            return
        for bound in zones_of(self._mission, since_ms - self._period_ms):
            if bound.binds(before.time_ms):
                self._record.see(None)
                if not exact_leg_ok(before.at, here.at, bound.zone):
                    self._found(own, before.time_ms, f"breaks zone {bound.zone.id}")

    def _hit(self, north: float, east: float, up: float) -> bool:
        if not all(map(math.isfinite, (north, east, up))):
            return False  # invalid position, reported by other watches
        volume = self._volume
        return bool(exact(cylinder_violation, Vec2(north, east), up, volume.dthr_m, volume.zthr_m))

    def _found(self, own: int, now_ms: int, what: str) -> None:
        before = next((name for name, one in self._of_others() if one.broken is not None), "")
        if before:
            if not self._record.gaps:
                after = f"at {now_ms / 1000:.2f} s, after {before!r} was broken"
                self._record.gaps.append(f"vehicle {own} {what} {after}")
            return
        self._record.check(False, now_ms, own, f"vehicle {own} {what}, though {self._said(own)}")

    def _of_others(self) -> list[tuple[str, Record]]:
        return [one for watch in self._others for one in watch.records().items()]

    def _is_seen(self, own: int, other: int) -> bool:
        """Whether `other` was seen at the last heartbeat of `own`, or before."""
        if self._senses:
            return (own, other) in self._sensed
        met = self._met[own]
        if other not in met and in_time(self._since_ms[other], self._beat_ms[own], ANY_LATER):
            met.add(other)
        return other in met

    def _is_permitted(self, own: int, now_ms: int) -> bool:
        """Whether ICAROUS has concluded that this instant is clear."""
        if has_it(self._gates[own]):
            return not in_time(self._hands[own].until_ms, now_ms, ANY_LATER)
        beat_ms = self._beat_ms[own]
        return in_time(0, beat_ms, ANY_LATER) and in_time(beat_ms, now_ms, self._period_ms)

    def _said(self, own: int) -> str:
        """The last conclusion, in words."""
        if has_it(self._gates[own]):
            return f"a certificate is in hand until {self._hands[own].until_ms / 1000:.2f} s"
        return f"at the heartbeat of {self._beat_ms[own] / 1000:.2f} s ICAROUS left it to UxAS"

    def end(self, at_ms: int) -> None:
        """Adopt the gaps of the motion watch: unobserved aircraft were not compared here either."""
        self._record.gaps += [
            gap for name, one in self._of_others() if name == SEEN for gap in one.gaps
        ]
        self._record.gaps += [
            f"vehicle {number} was under ICAROUS, and nothing was said of a certificate in its hand"
            for number in sorted(self._taken - self._handed)
        ]

    def records(self) -> dict[str, Record]:
        """The observations so far, by name of the assumption (see `Watch`)."""
        return {"permitted as offered": self._record}


def _share(size_m: float, off_m: float) -> float:
    """Ratio of the cylinder's size to the distance, at most 1e6: 1 on the surface, more inside."""
    return min(size_m / max(off_m, 1e-9), 1e6)
