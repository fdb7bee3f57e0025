"""One vehicle's chain of tasks in flight: the present item, its phase, and progress on the present track.

Phases: TRANSIT to the start pose of a task, WAIT on a circle through that pose, TASK, DONE (loitering at the
end). In each phase the vehicle flies one track; passing the end of the track triggers the next transition.
The instant of passing is interpolated on the flown positions to the millisecond.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Container
from dataclasses import dataclass, field
from enum import IntEnum
from typing import NamedTuple

from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.routing.dubins import polyline_length_m
from cratous.core.routing.polylines import Track, circle_points
from cratous.services.flight.dynamics import AirState
from cratous.spec import executive
from cratous.spec.mission import Position, Vehicle, Zone
from cratous.spec.mission.plan import Hold, PlanItem, Pose
from cratous.spec.records import replace

ROUTE_MARGIN = 1.1
"""Routes made in flight use turns of this many times the tightest radius."""


LAP_LEGS = 72
"""Number of legs of the polyline that approximates one lap of a hold."""
CLIMB_LAPS = 100
"""Most laps in which a loiter climbs; a slower climb ends below the wanted altitude."""


class Phase(IntEnum):
    """Phase of a chain, with the codes of `spec.executive`."""

    TRANSIT, WAIT, TASK, DONE = executive.TRANSIT, executive.WAIT, executive.TASK, executive.DONE


class Leg(NamedTuple):
    """ICAROUS's interventions on the way to an item and on the item's path.

    takeovers: count; under_ms: time under ICAROUS before its present takeover; taken_ms: when it last took
    over; because: the reason for that; task_id: task of the item, None after the last item.
    """

    takeovers: int = 0
    under_ms: int = 0
    taken_ms: int = 0
    because: str = ""
    task_id: int | None = None

    def taken(self, now_ms: int) -> Leg:
        """The leg after ICAROUS has taken the vehicle over."""
        return self._replace(takeovers=self.takeovers + 1, taken_ms=now_ms)

    def given_back(self, now_ms: int, free_ms: int = 0) -> Leg:
        """The leg after UxAS has the vehicle again. free_ms: part of that time that was not avoidance [ms]."""
        return self._replace(under_ms=max(0, self.flown_ms(True, now_ms) - free_ms))

    def flown_ms(self, suspended: bool, now_ms: int) -> int:
        """Time flown under ICAROUS on this leg [ms]. suspended: whether ICAROUS has the vehicle now."""
        return self.under_ms + (now_ms - self.taken_ms if suspended else 0)

    def begun_anew(self, now_ms: int) -> Leg:
        """The leg to the same item with its counts reset; the time under ICAROUS counts from now_ms."""
        return Leg(0, 0, now_ms, self.because, self.task_id)

    def to(self, task_id: int | None, now_ms: int) -> Leg:
        """The leg to the item of a task. For the same task the counts are kept, since re-planning does not
        resolve the conflict; for another they are reset.
        """
        if task_id == self.task_id:
            return self
        return self.begun_anew(now_ms)._replace(task_id=task_id)


@dataclass(frozen=True)
class Chain:
    """Where one vehicle is in its plan. Immutable: each method returns the chain that results.

    s_m: progress on `track`, measured at since_ms. join_m: arc length on `track` at which the planned path
    resumes after an interruption; base_m: arc length of the task's path at join_m. away: the task's path has
    been left and not yet rejoined. unlinked: the vehicle is not heard. leg: ICAROUS's interventions on it.
    told_version: the route_version last sent to ICAROUS, -1 for none. holds: pose of an operator's hold;
    `track` leads there, and the phase is DONE. left: the chain as it was when that hold interrupted it; None
    once another plan is in force.
    """

    vehicle: Vehicle
    items: tuple[PlanItem, ...]
    k: int
    phase: Phase
    track: Track
    speed_m_s: float
    s_m: float = 0.0
    since_ms: int = 0
    offset_m: float = 0.0
    join_m: float = 0.0
    base_m: float = 0.0
    version: int = 0
    route_version: int = 0
    told_version: int = -1
    suspended: bool = False
    unlinked: bool = False
    away: bool = False
    leg: Leg = field(default_factory=Leg)
    holds: Pose | None = None
    left: Chain | None = None

    def by_plan(self) -> Chain:
        """The chain on which the vehicle resumes: the interrupted one if its item is still the present one."""
        return self if self.left is None or self.left.k != self.k else self.left

    @property
    def item(self) -> PlanItem | None:
        """The present item; None when all are flown."""
        return self.items[self.k] if self.k < len(self.items) else None

    def next_k(self, failed: Container[int]) -> int:
        """Index of the next item whose task has not failed."""
        k = self.k + 1
        while k < len(self.items) and self.items[k].task_id in failed:
            k += 1
        return k

    def measure(self, state: AirState, now_ms: int, dt_s: float) -> tuple[Chain, int | None]:
        """The chain with its progress updated, and when the end of the track was passed [ms]; None if it was
        not.
        """
        window = 2 * state.speed_m_s * max(dt_s, (now_ms - self.since_ms) / 1000) + 1
        near = self.track.nearest(state.position, self.s_m, window + abs(self.offset_m))
        before_m, before_ms = self.s_m, self.since_ms
        after = replace(self, s_m=near.s_m, since_ms=now_ms, offset_m=near.offset_m)
        if near.s_m < self.track.length_m:
            return after, None
        if before_m >= self.track.length_m:
            return after, before_ms
        share = (self.track.length_m - before_m) / (near.s_m - before_m)
        return after, min(now_ms, before_ms + math.ceil(share * (now_ms - before_ms) - 1e-6))

    def enter(self, phase: Phase, track: Track, at_ms: int) -> Chain:
        """The chain in a phase that begins on a new track at at_ms [ms]."""
        return replace(
            self,
            phase=phase,
            track=track,
            s_m=0.0,
            since_ms=at_ms,
            offset_m=0.0,
            join_m=0.0,
            base_m=0.0,
            away=False,
            version=self.version + 1,
            route_version=self.route_version + 1,
        )

    def path_flown_m(self) -> float:
        """Length of the task's path that has been flown [m]; 0 outside the task."""
        if self.phase is not Phase.TASK:
            return 0.0
        return self.base_m + max(0.0, self.s_m - self.join_m)

    def served(self) -> float:
        """Flown fraction of the task's path, 0 to 1; 0 outside the task."""
        item = self.item
        if item is None or self.phase is not Phase.TASK:
            return 0.0
        length = polyline_length_m(item.path)
        return min(1.0, self.path_flown_m() / length) if length > 0 else 1.0

    def left_m(self) -> float:
        """Remaining length of the present track [m]."""
        return max(0.0, self.track.length_m - self.s_m)


def transit_track(item: PlanItem, here: Position) -> Track:
    """The planned transit to the start pose of an item."""
    start = start_pose(item)
    points = item.transit or (here,)
    return Track(points, start.heading_rad)


def start_pose(item: PlanItem) -> Pose:
    """Start pose of an item's path: its first point, in the direction of its first horizontal leg."""
    path = item.path
    for a, b in itertools.pairwise(path):
        if math.hypot(b.north_m - a.north_m, b.east_m - a.east_m) > 1e-6:
            return Pose(*path[0], math.atan2(b.east_m - a.east_m, b.north_m - a.north_m))
    return Pose(*path[0], item.end_heading_rad)


def tangent_hold(pose: Pose, radius_m: float, zones: tuple[Zone, ...]) -> Hold | None:
    """A circle tangent to the pose, of the radius or 1.5 times it, right or left, that breaks no zone; else
    None.
    """
    for factor in (1.0, 1.5):
        for clockwise in (True, False):
            side = 1 if clockwise else -1
            r = radius_m * factor
            hold = Hold(
                pose.north_m - side * r * math.sin(pose.heading_rad),
                pose.east_m + side * r * math.cos(pose.heading_rad),
                pose.alt_m,
                r,
                clockwise,
            )
            lap = lap_points(hold, Position(*pose[:3]))
            if first_bad_leg(lap, zones) is None:
                return hold
    return None


def lap_points(hold: Hold, start: Position) -> tuple[Position, ...]:
    """One lap of a hold, from a point on it back to that point."""
    centre = (hold.north_m, hold.east_m)
    return circle_points(centre, hold.radius_m, hold.clockwise, start, LAP_LEGS)


def raised(lap: tuple[Position, ...], to_m: float, slope: float) -> tuple[Position, ...]:
    """At most CLIMB_LAPS laps that climb towards to_m [m] with at most `slope` metres of altitude per metre
    flown.
    """
    points, alt, last = [lap[0]], lap[0].alt_m, lap[0]
    to_m = min(to_m, alt + CLIMB_LAPS * slope * polyline_length_m(lap))
    while alt < to_m - 1e-6:
        for p in lap[1:]:
            leg_m = math.hypot(p.north_m - last.north_m, p.east_m - last.east_m)
            alt = min(to_m, alt + slope * leg_m)
            points.append(p._replace(alt_m=alt))
            last = p
    return tuple(points)


def final_loiter(
    pose: Pose, radius_m: float, layer_m: float, slope: float, zones: tuple[Zone, ...]
) -> Track:
    """A lap at the end of a chain, raised by layer_m [m] where the zones and the climb limit allow it.

    Requires that some circle at the pose keeps the zones (AssertionError otherwise).
    """
    hold = tangent_hold(pose, radius_m, zones)
    assert hold is not None
    lap = lap_points(hold, Position(*pose[:3]))
    if layer_m > 0 and slope > 0:
        high = raised(lap, pose.alt_m + layer_m, slope)
        if first_bad_leg(high, zones) is None:
            return Track(high)
    return Track(lap)


def with_hold(item: PlanItem, radius_m: float, zones: tuple[Zone, ...]) -> PlanItem:
    """The item with a hold at its start pose: its own, else one that keeps the zones, if there is one."""
    if item.hold is not None:
        return item
    return replace(item, hold=tangent_hold(start_pose(item), radius_m, zones))
