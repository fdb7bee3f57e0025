"""The assumption that what was found clear is clear when it is flown. Decided by `cylinder_violation`, `obeys` and `in_time`.

What ICAROUS looked at is not in the log. What it concluded is: that UxAS may fly on up to the next heartbeat, and until when
the certificate in hand is permitted. Neither may be followed by a place in the mission's own cylinder about an aircraft that
it sees, nor, with a certificate, by one that breaks a zone. Where one is, the premises of the theorem were not all so: this
one, unless another one was broken before.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from cratous.core.authority.gate import gate_accepts
from cratous.core.authority.timeliness import in_time
from cratous.core.kernel import Vec2
from cratous.core.readings.exact import exact
from cratous.core.well_clear import cylinder_violation
from cratous.services.assumptions.authority import UNTOUCHED, has_it, reported
from cratous.services.assumptions.link import NO_INSTANCE
from cratous.services.assumptions.observed import ANY_LATER, Message, Record, Watch
from cratous.services.mission.known_zones import zones_of
from cratous.services.mission.zones import exact_leg_ok
from cratous.spec.mission import FaultySimulation, Mission, Position

NEAR = 0.5
"""From this share of the cylinder on the kernel is asked: 1 is at its wall."""
IN_HAND = ("Offered", "Known", "Left")
"""Changes of a hand that say until when it is permitted."""


class Place(NamedTuple):
    """Where an aircraft is, and when; stands: one of ours, which is on the ground."""

    time_ms: int
    at: Position
    stands: bool


class InHand(NamedTuple):
    """Of the certificate: when it was offered, and until when it is permitted [ms]."""

    since_ms: int = 0
    until_ms: int = 0


class PermittedWatch:
    """Each vehicle with an ICAROUS, against each aircraft that it sees. others: the watches of how all are flown."""

    kinds = ("GateState", "HandState", "Heartbeat", "SensedState", "TruthState")

    def __init__(self, mission: Mission, others: Sequence[Watch]) -> None:
        self._volume, self._others = mission.daa.well_clear, others
        self._senses = mission.sensing is not None
        self._gates = dict.fromkeys(mission.instances, UNTOUCHED)
        self._hands = dict.fromkeys(mission.instances, InHand())
        self._mission, self._ours = mission, frozenset(v.id for v in mission.vehicles)
        self._beat_ms = dict.fromkeys(mission.instances, -1)
        self._period_ms = mission.simulation.heartbeat_ms
        self._places: dict[int, Place] = {}
        self._since_ms: dict[int, int] = {}
        self._sensed = set[tuple[int, int]]()
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
        """Who commands, what is in hand, a heartbeat, what is sensed, or where an aircraft is."""
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
        if kind == "GateState":
            self._gates[number] = reported(body)
        elif kind == "HandState" and body.Change.name in IN_HAND:
            since_ms = now_ms if body.Change.name == "Offered" else self._hands[number].since_ms
            self._hands[number] = InHand(since_ms, body.Expiry)
        elif kind == "Heartbeat" and body.Direction.name == "Up":
            self._beat_ms[number] = now_ms

    def _here(self, body: Any) -> None:
        """With each place, against the others of the same instant."""
        number, speeds = body.VehicleID, (body.VelocityNorth, body.VelocityEast, body.VelocityDown)
        stands = number in self._ours and not any(speeds)
        place = Place(body.Time, Position(body.North, body.East, body.Altitude), stands)
        before, self._places[number] = self._places.get(number), place
        self._since_ms.setdefault(number, body.Time)
        if number in self._gates:
            self._against_zones(number, before or place, place)
            pairs = [(number, other) for other in self._places if other != number]
        else:
            pairs = []
        pairs += [(own, number) for own in self._gates if own != number and own in self._places]
        for own, other in pairs:
            if in_time(self._places[own].time_ms, self._places[other].time_ms, 0):
                self._pair(own, other)

    def _pair(self, own: int, other: int) -> None:
        here, there = self._places[own], self._places[other]
        # who rolls, stands or has landed is not kept clear of
        if here.stands or there.stands or not self._is_seen(own, other):
            return
        said = self._said(own, here.time_ms)
        if not said:
            return
        volume, (a, b) = self._volume, (here.at, there.at)
        north, east, up = b.north_m - a.north_m, b.east_m - a.east_m, b.alt_m - a.alt_m
        beside = math.hypot(north, east)
        share = min(_share(volume.dthr_m, beside), _share(volume.zthr_m, abs(up)))
        self._record.see(share)
        if not share <= NEAR and self._hit(north, east, up):
            where = f"is {beside:.4g} m beside and {abs(up):.4g} m above or below aircraft {other}"
            self._found(own, here.time_ms, where, said)

    def _against_zones(self, own: int, before: Place, here: Place) -> None:
        """What was flown since the last sample with a certificate that knew of the zones."""
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
                    said = f"a certificate is in hand until {until_ms / 1000:.2f} s"
                    self._found(own, before.time_ms, f"breaks zone {bound.zone.id}", said)

    def _hit(self, north: float, east: float, up: float) -> bool:
        if not all(map(math.isfinite, (north, east, up))):
            return False  # no place: others say so
        volume = self._volume
        return bool(exact(cylinder_violation, Vec2(north, east), up, volume.dthr_m, volume.zthr_m))

    def _found(self, own: int, now_ms: int, what: str, said: str) -> None:
        before = next((name for name, one in self._of_others() if one.broken is not None), "")
        if before:
            if not self._record.gaps:
                after = f"at {now_ms / 1000:.2f} s, after {before!r} was broken"
                self._record.gaps.append(f"vehicle {own} {what} {after}")
            return
        self._record.check(False, now_ms, own, f"vehicle {own} {what}, though {said}")

    def _of_others(self) -> list[tuple[str, Record]]:
        return [one for watch in self._others for one in watch.records().items()]

    def _is_seen(self, own: int, other: int) -> bool:
        """Whether it was seen at the last heartbeat, or before."""
        if self._senses:
            return (own, other) in self._sensed
        return in_time(self._since_ms[other], self._beat_ms[own], ANY_LATER)

    def _said(self, own: int, now_ms: int) -> str:
        """What was concluded of this instant, "" for nothing."""
        beat_ms = self._beat_ms[own]
        if has_it(self._gates[own]):
            until_ms = self._hands[own].until_ms
            if in_time(until_ms, now_ms, ANY_LATER):
                return ""
            return f"a certificate is in hand until {until_ms / 1000:.2f} s"
        if not (in_time(0, beat_ms, ANY_LATER) and in_time(beat_ms, now_ms, self._period_ms)):
            return ""
        return f"at the heartbeat of {beat_ms / 1000:.2f} s ICAROUS left it to UxAS"

    def end(self, at_ms: int) -> None:
        """Nothing is open."""

    def records(self) -> dict[str, Record]:
        """See `Watch`."""
        return {"permitted as offered": self._record}


def _share(size_m: float, off_m: float) -> float:
    """How much of the cylinder's size is left, at most 1e6: 1 at the wall, more inside."""
    return min(size_m / max(off_m, 1e-9), 1e6)
