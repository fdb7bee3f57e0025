"""G3: every requested task was flown to its end and served; coverage of searches by the sensors.

A search is judged by the footprints in its vehicle's own states. Where true positions of the
vehicle are missing, nothing shows that it was there, so the search is not reported as served.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from cratous.core.executive.steps import completes
from cratous.core.geofence.distance import FARTHER, edge_against
from cratous.core.kernel import Vec2, qualified
from cratous.core.routing.dubins import turn_radius_m
from cratous.core.schedule.rows import row_holds
from cratous.core.tasks.coverage_steps import enough_seen
from cratous.core.tasks.service import Watched as Seen
from cratous.core.tasks.service import service_verdict
from cratous.core.tasks.stations import in_ring
from cratous.services.monitor.coverage import CoverageWatch
from cratous.services.monitor.landing import Down
from cratous.services.monitor.observation import Ending, Presence
from cratous.services.monitor.required_rows import END, Watched, served_item
from cratous.services.monitor.samples import Sample
from cratous.services.monitor.serviceability import prospects
from cratous.spec.constraint_rows import AFTER_END
from cratous.spec.executive import COMPLETE, FAILED_FLIGHT
from cratous.spec.mission import AREAS, SEARCHES, Loiter, Mission, Position, Task, TaskKind
from cratous.spec.mission.guarantees import Kind, Outcome, Verdict
from cratous.spec.mission.plan import Plan

SERVED = 0.99
"""Fraction of a search from which the kernel `enough_seen` counts it as served: zero of the margin."""
OUTCOMES = (Outcome.VIOLATED, Outcome.HOLDS, Outcome.UNKNOWN)
"""Meaning of the verdict codes of `service_verdict`, by index."""
BANK_RESERVE = 1.1
"""A loiter without a radius is flown this much wider than the vehicle's tightest turn."""
CAPTURE_M = 50.0
"""A point is flown through within this distance, and a loiter kept within it of its circle [m]."""


@dataclass
class Doing:
    """Observed progress of one task. flown_by: vehicle that began it, at began_ms; near_ms: time
    spent within the required distance of its point.
    """

    vehicle: int = 0
    flown_by: set[int] = field(default_factory=set)
    began_ms: int = 0
    active: bool = False
    complete_ms: int | None = None
    failed: str = ""
    near_ms: int = 0
    touched: bool = False
    too_near: bool = False
    judged_near: bool = False


class CompletionWatch:
    """Watches completion and service of every requested task. `presence`: observation spans of each
    aircraft; down: vehicles on the ground.
    """

    def __init__(
        self, mission: Mission, plan: Plan, presence: Presence, down: Mapping[int, Down]
    ) -> None:
        self._down = down
        self._mission, self._coverage = mission, CoverageWatch(mission)
        self._presence = presence
        self._kinds = {task.id: task for task in mission.tasks}
        self._vehicles = {vehicle.id: vehicle for vehicle in mission.vehicles}
        self._step_ms = mission.simulation.step_ms
        planned = {item.task_id: item.vehicle_id for item in plan.items}
        self._tasks = {task.id: Doing(planned.get(task.id, 0)) for task in mission.tasks}
        self.accepted = frozenset(planned)
        self._outcome: str | None = None
        self._end_ms: int | None = None

    def accept(self, chosen: frozenset[int]) -> None:
        """Another plan is flown from now on: `chosen` are its tasks and those already done."""
        self.accepted = chosen

    def done(self) -> frozenset[int]:
        """Tasks that were flown to their end."""
        return frozenset(t for t, doing in self._tasks.items() if doing.complete_ms is not None)

    def progress(self, body: Any) -> None:
        """Process a change of a task's phase."""
        doing = self._tasks.get(body.TaskID)
        if doing is None:
            return
        doing.vehicle = body.VehicleID
        phase = body.Phase.name
        doing.active = phase == "Active"
        if doing.active:
            doing.began_ms = doing.began_ms if doing.flown_by else body.Time
            doing.flown_by.add(body.VehicleID)
        if phase == "Complete":
            doing.complete_ms = body.Time
        elif phase == "Failed":
            doing.failed = body.Note or "failed"

    def state(self, body: Any) -> None:
        """Process a vehicle state: its sensor footprints count for the tasks that it is performing."""
        active = [t for t, d in self._tasks.items() if d.active and d.vehicle == body.ID]
        self._coverage.state(body, active)

    def step(self, before: dict[int, Sample], after: dict[int, Sample]) -> None:
        """Accumulate the time near the point of each active must-fly or loiter task during this step."""
        for number, doing in self._tasks.items():
            task, who = self._kinds[number], doing.vehicle
            if not doing.active or who not in before or who not in after:
                continue
            if task.standoff_m or task.kind in (TaskKind.MUST_FLY, TaskKind.LOITER):
                doing.judged_near = True
            if task.standoff_m:
                leg = before[who], after[who]
                doing.too_near |= comes_near(*leg, task.points[0], task.standoff_m)
            if task.kind in (TaskKind.MUST_FLY, TaskKind.LOITER):
                reach = CAPTURE_M + self._size_m(task, who)
                if comes_near(before[who], after[who], centre_of(task), reach):
                    doing.touched = True
                    doing.near_ms += after[who].time_ms - before[who].time_ms

    def _size_m(self, task: Task, vehicle: int) -> float:
        """How far a loiter reaches from its centre [m]; 0 for the point of a must-fly task."""
        if task.kind is not TaskKind.LOITER:
            return 0.0
        who = self._vehicles[vehicle]
        loiter = task.loiter or Loiter(task.points[0], task.radius_m)
        radius = loiter.radius_m or BANK_RESERVE * turn_radius_m(who.speed_m_s, who.max_bank_rad)
        if loiter.shape == "figure_eight":
            return radius + max(loiter.length_m / 2, radius)
        return radius + (loiter.length_m / 2 if loiter.shape == "racetrack" else 0.0)

    def end(self, body: Any) -> None:
        """Process MissionEnd: the messages are complete."""
        self._outcome, self._end_ms = body.Outcome, body.Time

    def verdicts(self, seen: Watched) -> list[Verdict]:
        """One verdict for each requested task, and one on the mission's end."""
        found = [self._task_verdict(task, seen) for task in sorted(seen.tasks)]
        return [*found, self._end_verdict()]

    def _end_verdict(self) -> Verdict:
        if self._outcome is None or self._end_ms is None:
            note = "the messages stop before the mission ends"
            return Verdict("G3", END, Outcome.UNKNOWN, Kind.OBSERVED, note, checks=1)
        told = COMPLETE if self._outcome == "complete" else FAILED_FLIGHT
        # the last step of a flight may begin before its limit and end after it
        limit_ms = self._mission.simulation.limit_ms + self._step_ms
        good = completes(told, self._end_ms, limit_ms)
        return Verdict(
            "G3",
            END,
            Outcome.HOLDS if good else Outcome.VIOLATED,
            Kind.OBSERVED,
            f"mission ended {self._outcome!r} after {self._end_ms / 1000:.2f} s",
            self._end_ms,
            checks=1,
            method="completes",
            kernels=(qualified(completes),),
        )

    def _task_verdict(self, task: int, seen: Watched) -> Verdict:
        doing = self._tasks[task]
        covered = self._coverage.fraction(task)
        missed, unseen = self._missed(task), self._unseen(task)
        short = covered is not None and not self._coverage.served(task)
        ended, over = doing.complete_ms is not None, self._outcome is not None
        told = service_verdict(Seen(ended, over, bool(unseen), short, doing.too_near, bool(missed)))
        outcome, margin = OUTCOMES[told], None
        note = "flown to its end" if ended else doing.failed or "not flown to its end"
        if covered is not None:
            margin = 100 * (covered - SERVED)
            note += f"; the footprint covered {100 * covered:.2f} % of it"
        if missed and (doing.too_near or (ended and not short)):
            note = missed
        if unseen and outcome is Outcome.UNKNOWN:
            note = unseen if covered is None else f"{unseen}; else: {note}"
        evidence = None
        if outcome is Outcome.VIOLATED:
            could, evidence = prospects(self._mission, self._kinds[task], seen.end_ms, self._down)
            note = f"{note}; {could}"
        return Verdict(
            "G3",
            served_item(task),
            outcome,
            Kind.OBSERVED,
            note,
            time_ms=doing.complete_ms,
            vehicles=(doing.vehicle,) if doing.vehicle else (),
            margin=margin,
            unit="% of the search" if margin is not None else "",
            checks=1,
            method=_method(self._kinds[task]),
            kernels=self._kernels(task),
            evidence=evidence,
        )

    def _kernels(self, task: int) -> tuple[str, ...]:
        """The kernels that decided about a task."""
        doing, kind = self._tasks[task], self._kinds[task].kind
        asked: list[Callable[..., Any]] = [edge_against] if doing.judged_near else []
        if kind is TaskKind.LOITER and doing.touched and not doing.too_near:
            asked.append(row_holds)
        if task in self._coverage.looked:
            asked.append(in_ring)
        if kind in SEARCHES:
            asked.append(enough_seen)
        seen = self._coverage.kernels.get(task)
        return (*([seen] if seen is not None else []), *map(qualified, [*asked, service_verdict]))

    def _unseen(self, number: int) -> str:
        """Observation gaps in the flight of a completed task, in words; empty if none."""
        doing = self._tasks[number]
        if doing.complete_ms is None:
            return ""
        span, ending = (doing.began_ms, doing.complete_ms), Ending(doing.complete_ms, over=True)
        gaps = (self._presence.unseen(v, span, ending) for v in sorted(doing.flown_by))
        return next(filter(None, gaps), "") or self._not_sharp(number)

    def _not_sharp(self, number: int) -> str:
        """Why the resolution at which a task was seen is unknown; empty if known or not required."""
        flyers = [self._vehicles[v] for v in self._tasks[number].flown_by if v in self._vehicles]
        known = all(camera.pixels for flyer in flyers for camera in flyer.cameras)
        if not max(self._kinds[number].gsd_m, 0.0) or known:
            return ""
        return "how many pixels its camera has is not known"

    def _missed(self, number: int) -> str:
        """Why a must-fly or loiter task is not served; empty if nothing is missing."""
        task, doing = self._kinds[number], self._tasks[number]
        if doing.too_near:
            return f"came within the standoff of {task.standoff_m:g} m"
        if task.kind in (TaskKind.MUST_FLY, TaskKind.LOITER) and not doing.touched:
            return f"its point was never within {CAPTURE_M:g} m of what the task asks"
        # the first and the last step of a loiter are not counted in full
        need_ms = task.duration_ms - 2 * self._step_ms
        near_ms = doing.near_ms
        enough = row_holds(AFTER_END, near_ms, near_ms, 0, need_ms, 0)
        if task.kind is TaskKind.LOITER and not enough:
            return f"loitered {doing.near_ms / 1000:.2f} of {task.duration_ms / 1000:.2f} s"
        return ""


def _method(task: Task) -> str:
    if task.kind in AREAS:
        return "square_within on footprints"
    return "locate on footprints" if task.kind in SEARCHES else "edge_against"


def centre_of(task: Task) -> Position:
    """The point of a must-fly task, or the centre of a loiter."""
    return task.loiter.centre if task.loiter is not None else task.points[0]


def comes_near(before: Sample, after: Sample, point: Position, reach_m: float) -> bool:
    """True iff the leg comes within reach_m of the point, horizontally (kernel `edge_against`)."""
    a, b, p = (_exact(one) for one in (before.position, after.position, point))
    exact: Any = Fraction
    nearest = edge_against(p, a, b, exact(reach_m))
    return nearest != FARTHER


def _exact(point: Position) -> Vec2:
    exact: Any = Fraction
    return Vec2(exact(point[0]), exact(point[1]))
