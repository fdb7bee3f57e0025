"""One vehicle's chain of tasks in flight: where it is in it, and how far along the present track.

Phases: TRANSIT to the start pose of a task, WAIT on a circle through that pose, TASK, DONE
(loitering at the end). In each the vehicle flies one track, and passing its end is the event that
leads on. Passing is measured on the flown positions, to the millisecond between two steps.
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
"""Ways made in flight turn with the tightest radius times this."""


LAP_LEGS = 72
"""A lap of a hold is flown as a polyline of this many legs."""
CLIMB_LAPS = 100
"""A loiter climbs for at most so many laps: one that climbs too slowly stays lower."""


class Phase(IntEnum):
    """The codes of `spec.executive`."""

    TRANSIT, WAIT, TASK, DONE = executive.TRANSIT, executive.WAIT, executive.TASK, executive.DONE


class Leg(NamedTuple):
    """What ICAROUS did on the way to an item and on its path. takeovers: so many; under_ms: it flew so long
    until taken_ms, when it took over last; because: why it did then; task_id: of the item, None behind the last.
    """

    takeovers: int = 0
    under_ms: int = 0
    taken_ms: int = 0
    because: str = ""
    task_id: int | None = None

    def taken(self, now_ms: int) -> Leg:
        """ICAROUS takes over."""
        return self._replace(takeovers=self.takeovers + 1, taken_ms=now_ms)

    def given_back(self, now_ms: int, free_ms: int = 0) -> Leg:
        """UxAS flies again. free_ms: so much of the time was no avoidance [ms]."""
        return self._replace(under_ms=max(0, self.flown_ms(True, now_ms) - free_ms))

    def flown_ms(self, suspended: bool, now_ms: int) -> int:
        """How long ICAROUS has flown on this leg [ms]. suspended: it does now."""
        return self.under_ms + (now_ms - self.taken_ms if suspended else 0)

    def begun_anew(self, now_ms: int) -> Leg:
        """A leg to the same item on which nothing has happened yet; ICAROUS goes on flying if it does."""
        return Leg(0, 0, now_ms, self.because, self.task_id)

    def to(self, task_id: int | None, now_ms: int) -> Leg:
        """The leg to the item of this task: the same leg, with all that was counted on it, where it is the same
        task, for another plan moves nobody out of the way; otherwise the next one."""
        if task_id == self.task_id:
            return self
        return self.begun_anew(now_ms)._replace(task_id=task_id)


@dataclass(frozen=True)
class Chain:
    """Where one vehicle is in its plan; each method gives the chain as it is afterwards. s_m: progress on `track`, measured at since_ms.

    join_m: arc length on `track` at which the planned path begins again after an interruption;
    base_m: arc length of the task's path that `track` stands for beyond join_m; away: the path
    of the task has been left and is not reached again yet; unlinked: its vehicle is not heard; leg: what ICAROUS did on it; told_version: the route_version that
    ICAROUS was told, -1 for none; holds: where an operator has the vehicle circle: `track` leads there then, and
    the phase is DONE; left: the chain as it was when it left its item for that, None behind another plan.
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
        """The chain that is flown on by when its vehicle resumes: where it was left, if that is the same item still."""
        return self if self.left is None or self.left.k != self.k else self.left

    @property
    def item(self) -> PlanItem | None:
        """The present item, or None when all are flown."""
        return self.items[self.k] if self.k < len(self.items) else None

    def next_k(self, failed: Container[int]) -> int:
        """Index of the item after the present one, those of failed tasks left out."""
        k = self.k + 1
        while k < len(self.items) and self.items[k].task_id in failed:
            k += 1
        return k

    def measure(self, state: AirState, now_ms: int, dt_s: float) -> tuple[Chain, int | None]:
        """With the progress up to date; and the instant at which the end was passed, if it was."""
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
        """In a phase that begins on a new track at an instant."""
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
        """How much of the task's path has been flown [m]; 0 outside the task."""
        if self.phase is not Phase.TASK:
            return 0.0
        return self.base_m + max(0.0, self.s_m - self.join_m)

    def served(self) -> float:
        """How much of the task's path has been flown, as a fraction."""
        item = self.item
        if item is None or self.phase is not Phase.TASK:
            return 0.0
        length = polyline_length_m(item.path)
        return min(1.0, self.path_flown_m() / length) if length > 0 else 1.0

    def left_m(self) -> float:
        """Length still to fly on the present track [m]."""
        return max(0.0, self.track.length_m - self.s_m)


def transit_track(item: PlanItem, here: Position) -> Track:
    """The way to the start pose of an item."""
    start = start_pose(item)
    points = item.transit or (here,)
    return Track(points, start.heading_rad)


def start_pose(item: PlanItem) -> Pose:
    """Where and in which direction the item's own path begins."""
    path = item.path
    for a, b in itertools.pairwise(path):
        if math.hypot(b.north_m - a.north_m, b.east_m - a.east_m) > 1e-6:
            return Pose(*path[0], math.atan2(b.east_m - a.east_m, b.north_m - a.north_m))
    return Pose(*path[0], item.end_heading_rad)


def tangent_hold(pose: Pose, radius_m: float, zones: tuple[Zone, ...]) -> Hold | None:
    """A circle that touches the pose, to the right or left, wide or wider, that obeys the zones."""
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
    """One lap of a hold from a point on it back to that point."""
    centre = (hold.north_m, hold.east_m)
    return circle_points(centre, hold.radius_m, hold.clockwise, start, LAP_LEGS)


def raised(lap: tuple[Position, ...], to_m: float, slope: float) -> tuple[Position, ...]:
    """At most CLIMB_LAPS laps that climb from the lap's altitude towards to_m [m], with at most `slope` metres of
    altitude per metre flown."""
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
    """A lap at the end of a chain, raised by layer_m where the zones and the climb allow it.

    A circle at the pose has to keep the zones.
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
    """The item with a hold to wait on at its start pose, if it has none and one can be flown."""
    if item.hold is not None:
        return item
    return replace(item, hold=tangent_hold(start_pose(item), radius_m, zones))
