"""G5 of a flight that ended in the declared safe state: that each vehicle circled as it is said to.

A vehicle that ICAROUS has at the end (with `link_loss`, also one that is said to circle), and that is neither on the
ground nor after a declared failure, has to have been said to circle (`LinkLossState`) for the last `safe_state_after_ms` of the mission. Its
positions in that time have to lie in a circle of the turn radius at the speed that it flew, at most its greatest, and
its legs have to keep the zones. Positions that fit in none violate it; where neither is shown, or it was not observed
throughout, it is unknown.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

from cratous.core.authority.gate import ICAROUS, gate_accepts
from cratous.core.authority.link_loss import LOITER, OVER
from cratous.core.authority.timeliness import in_time, lasted
from cratous.core.geofence.distance import edge_against
from cratous.core.kernel import qualified
from cratous.core.routing.dubins import turn_radius_m
from cratous.services.assumptions.authority import reported
from cratous.services.mission.landing import on_failure_of
from cratous.services.mission.zone_times import zones_of
from cratous.services.mission.zones import exact_leg_ok
from cratous.services.monitor.completion import comes_near
from cratous.services.monitor.landing import Down
from cratous.services.monitor.observation import Ending, Presence
from cratous.services.monitor.required_rows import circle_item
from cratous.services.monitor.samples import Sample
from cratous.spec.mission import Mission, Position, Vehicle
from cratous.spec.mission.guarantees import Kind, Outcome, Verdict

SAFE_STATE = "safe state"
"""The outcome of a flight that is judged here; a test compares it with the executive's."""
WIDER = 1.1
"""A circle is flown this much wider than the tightest turn."""
MARGIN_M = 20.0
"""How far a vehicle may be outside of it [m]."""
DIRECTIONS_RAD = tuple(k * math.pi / 8 for k in range(8))
"""Directions in which the extent of a flown path is measured."""
DECIDE: tuple[Any, ...] = (lasted, edge_against)
KERNELS = tuple(qualified(kernel) for kernel in DECIDE)


@dataclass
class Seen:
    """State of one vehicle. icarous: whether ICAROUS has it; circles_ms: since when it is said to circle [ms], None if it
    is not; failed: it has declared a failure; flown: its samples in that time.
    """

    icarous: bool = False
    circles_ms: int | None = None
    failed: bool = False
    flown: deque[Sample] = field(default_factory=deque)


class SafeStateWatch:
    """Watches vehicles with an ICAROUS instance; without rows unless the flight ends in the safe state."""

    def __init__(self, mission: Mission, presence: Presence) -> None:
        self._mission, self._presence = mission, presence
        self._seen = {number: Seen() for number in sorted(mission.instances)}
        self._stays_ms = mission.bridge_times.safe_state_after_ms
        self._end_ms: int | None = None
        self._down: Mapping[int, Down] = {}

    def gate(self, body: Any) -> None:
        """Process a GateState: who commands a vehicle."""
        if seen := self._seen.get(body.VehicleID):
            gate = reported(body)
            seen.icarous = gate_accepts(gate, ICAROUS, gate.epoch)

    def state(self, body: Any) -> None:
        """Process a LinkLossState: what a vehicle flies by itself."""
        if seen := self._seen.get(body.VehicleID):
            circles = int(body.Mode) in (LOITER, OVER)
            since_ms = body.Time if seen.circles_ms is None else seen.circles_ms
            seen.circles_ms = since_ms if circles else None

    def declared(self, body: Any) -> None:
        """Process a FailureState: what follows is judged in the row on the failure."""
        seen = self._seen.get(body.VehicleID)
        if seen is not None and on_failure_of(self._mission) is not None:
            seen.failed = True

    def step(self, before: dict[int, Sample], after: dict[int, Sample]) -> None:
        """Take in the samples of two successive instants."""
        for number in self._seen.keys() & after.keys():
            flown = self._seen[number].flown
            if not flown and number in before:
                flown.append(before[number])
            flown.append(after[number])
            while not in_time(flown[0].time_ms, flown[-1].time_ms, self._stays_ms):
                flown.popleft()

    def end(self, body: Any, down: Mapping[int, Down]) -> None:
        """Process MissionEnd. down: vehicles at rest on the ground."""
        self._end_ms = body.Time if body.Outcome == SAFE_STATE else None
        self._down = down

    def verdicts(self) -> list[Verdict]:
        """One verdict for each vehicle that is said to be in the safe state; for every one if none is."""
        if self._end_ms is None:
            return []
        rest = {number for number, down in self._down.items() if down.good or down.began}
        # where the mission asks for it, one that UxAS has may circle too
        asked = self._mission.link_loss is not None
        seen = self._seen.items()
        there = ((n, s) for n, s in seen if s.icarous or (asked and s.circles_ms is not None))
        away = {n: s for n, s in there if not s.failed and n not in rest}
        nobody = "" if away else "the flight ended in the safe state, and ICAROUS had no vehicle"
        those = away or self._seen
        return [self._verdict(n, s, self._end_ms, nobody) for n, s in those.items()]

    def _verdict(self, number: int, seen: Seen, end_ms: int, nobody: str) -> Verdict:
        flown = [s for s in seen.flown if lasted(end_ms - self._stays_ms, s.time_ms, 0)]
        reach_m = _reach_m(self._mission.vehicle(number), flown)
        text = nobody or _not_said(seen, end_ms, self._stays_ms) or self._fault(flown, reach_m)
        since_ms, outcome, margin = seen.circles_ms, Outcome.VIOLATED, None
        if not text:
            doubt = self._presence.unseen(
                number, (end_ms - self._stays_ms, end_ms), Ending(end_ms, True)
            )
            far_m = _farthest_m(flown)
            middle = _middle(flown)
            inside = all(comes_near(s, s, middle, reach_m) for s in flown)
            outcome = Outcome.HOLDS if inside and not doubt else Outcome.UNKNOWN
            margin = reach_m - far_m if outcome is Outcome.HOLDS else None
            text = (
                doubt
                or f"in the last {self._stays_ms / 1000:g} s within {far_m:.1f} m of one place"
            )
            text += f"; a circle of {reach_m:.1f} m is allowed"
        note = text if since_ms is None else f"{text}; said to circle from {since_ms / 1000:.2f} s"
        return Verdict(
            "G5", circle_item(number), outcome, Kind.OBSERVED, note,
            time_ms=end_ms if outcome is Outcome.VIOLATED else None, vehicles=(number,),
            margin=margin, unit="" if margin is None else "m", checks=len(flown),
            kernels=KERNELS,
        )  # fmt: skip

    def _fault(self, flown: Sequence[Sample], reach_m: float) -> str:
        """Why a path is in no circle of this radius, or breaks a zone; empty if nothing shows that."""
        for one, two in (_ends(flown, rad) for rad in DIRECTIONS_RAD if flown):
            if not comes_near(one, one, two.position, 2 * reach_m):
                at = f"{one.time_ms / 1000:.2f} s and {two.time_ms / 1000:.2f} s"
                far_m = math.dist(one.position[:2], two.position[:2])
                return (
                    f"its places at {at} are {far_m:.1f} m apart: in no circle of {reach_m:.1f} m"
                )
        for before, after in pairwise(flown):
            if not in_time(before.time_ms, after.time_ms, self._presence.step_ms):
                continue
            for bound in zones_of(self._mission, after.time_ms):
                leg = before.position, after.position
                if bound.binds(before.time_ms) and not exact_leg_ok(*leg, bound.zone):
                    return f"it broke zone {bound.zone.id} at {before.time_ms / 1000:.2f} s"
        return ""


def _not_said(seen: Seen, end_ms: int, stays_ms: int) -> str:
    """Why a vehicle was not said to be in the safe state; empty if it was."""
    if seen.circles_ms is None or not lasted(seen.circles_ms, end_ms, stays_ms):
        return f"it was not said to circle for {stays_ms / 1000:g} s when the flight ended"
    return ""


def _reach_m(vehicle: Vehicle, flown: Sequence[Sample]) -> float:
    """Radius of the circle in which a vehicle has to stay [m]."""
    fast_m_s = max(
        (
            1000 * math.dist(a.position[:2], b.position[:2]) / max(b.time_ms - a.time_ms, 1)
            for a, b in pairwise(flown)
        ),
        default=0.0,
    )
    fast_m_s = min(fast_m_s, vehicle.max_speed_m_s)
    try:
        radius_m = max(turn_radius_m(fast_m_s, vehicle.max_bank_rad), 0.0)
    except ZeroDivisionError:  # what cannot bank flies no circle
        radius_m = 0.0
    return WIDER * radius_m + MARGIN_M


def _middle(flown: Sequence[Sample]) -> Position:
    """The middle of the extents of a path; the origin for none."""
    if not flown:
        return Position(0.0, 0.0, 0.0)
    axes = [[s.position[k] for s in flown] for k in range(2)]
    north, east = ((min(axis) + max(axis)) / 2 for axis in axes)
    return flown[0].position._replace(north_m=north, east_m=east)


def _farthest_m(flown: Sequence[Sample]) -> float:
    middle = _middle(flown)[:2]
    return max((math.dist(s.position[:2], middle) for s in flown), default=0.0)


def _ends(flown: Sequence[Sample], direction_rad: float) -> tuple[Sample, Sample]:
    """The samples of a path farthest back and ahead in a direction."""
    north, east = math.cos(direction_rad), math.sin(direction_rad)
    ranked = sorted(flown, key=lambda s: s.position[0] * north + s.position[1] * east)
    return ranked[0], ranked[-1]
