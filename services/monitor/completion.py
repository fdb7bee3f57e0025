"""G3: every chosen task was flown to its end and served; what search sensors really saw."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from cratous.services.monitor.samples import Sample
from cratous.services.sensor import seen_by_tracks
from cratous.spec.guarantees import Kind, Outcome, Verdict
from cratous.spec.mission import Mission, Position, TaskKind
from cratous.spec.plan import Plan

SERVED = 0.99
"""A search is served when the footprints covered at least this fraction of its line or point."""


@dataclass
class Doing:
    """What has been seen of one task."""

    vehicle: int = 0
    active: bool = False
    complete_ms: int | None = None
    failed: str = ""
    tracks: list[list[Position]] = field(default_factory=list)


class CompletionWatch:
    """Completion and service of every chosen task."""

    def __init__(self, mission: Mission, plan: Plan) -> None:
        self._mission = mission
        self._tasks = {item.task_id: Doing(item.vehicle_id) for item in plan.items}
        self._outcome: str | None = None
        self._end_ms: int | None = None

    def progress(self, body: Any) -> None:
        """A task changed its phase."""
        doing = self._tasks.get(body.TaskID)
        if doing is None:
            return
        doing.vehicle = body.VehicleID
        phase = body.Phase.name
        if phase == "Active" and not doing.active:
            doing.tracks.append([])
        doing.active = phase == "Active"
        if phase == "Complete":
            doing.complete_ms = body.Time
        elif phase == "Failed":
            doing.failed = body.Note or "failed"

    def step(self, before: dict[int, Sample], after: dict[int, Sample]) -> None:
        """Remember where the sensor was while a task was active."""
        for doing in self._tasks.values():
            if doing.active and doing.vehicle in before and doing.vehicle in after:
                track = doing.tracks[-1]
                if not track:
                    track.append(before[doing.vehicle].position)
                track.append(after[doing.vehicle].position)

    def end(self, body: Any) -> None:
        """The mission ended."""
        self._outcome, self._end_ms = body.Outcome, body.Time

    def coverage(self, task_id: int) -> float | None:
        """Fraction of a search task's line or point that the footprints covered; None if no search."""
        task, doing = self._mission.task(task_id), self._tasks[task_id]
        if task.kind not in (TaskKind.LINE_SEARCH, TaskKind.POINT_SEARCH):
            return None
        cameras = self._mission.vehicle(doing.vehicle).cameras
        tracks = [track for track in doing.tracks if len(track) > 1]
        if not tracks or not cameras:
            return 0.0
        terrain = self._mission.frame.terrain_m
        return max(seen_by_tracks(tracks, task, camera, terrain) for camera in cameras)

    def verdicts(self) -> list[Verdict]:
        """One verdict a task, and one on the mission's end."""
        found = [self._task_verdict(task) for task in sorted(self._tasks)]
        good = self._outcome == "complete"
        seconds = (self._end_ms or 0) / 1000
        note = f"mission ended {self._outcome!r} after {seconds:.2f} s"
        outcome = Outcome.HOLDS if good else Outcome.VIOLATED
        if self._outcome is None:
            note, outcome = "the messages stop before the mission ends", Outcome.UNKNOWN
        found.append(
            Verdict("G3", "end of mission", outcome, Kind.OBSERVED, note, self._end_ms, checks=1)
        )
        return found

    def _task_verdict(self, task: int) -> Verdict:
        doing = self._tasks[task]
        covered = self.coverage(task)
        outcome, margin = Outcome.HOLDS, None
        note = "flown to its end"
        if doing.complete_ms is None:
            outcome = Outcome.VIOLATED if self._outcome is not None else Outcome.UNKNOWN
            note = doing.failed or "not flown to its end"
        if covered is not None:
            margin = 100 * (covered - SERVED)
            note += f"; the footprint covered {100 * covered:.2f} % of it"
            if covered < SERVED and outcome is Outcome.HOLDS:
                outcome = Outcome.VIOLATED
        return Verdict(
            "G3",
            f"task {task} served",
            outcome,
            Kind.OBSERVED,
            note,
            time_ms=doing.complete_ms,
            vehicles=(doing.vehicle,),
            margin=margin,
            unit="% of the search" if margin is not None else "",
            checks=1,
            method="locate on footprints" if covered is not None else "",
        )
