"""G3: every chosen task was flown to its end and served; what search sensors really saw."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from cratous.services.monitor.coverage import CoverageWatch
from cratous.spec.guarantees import Kind, Outcome, Verdict
from cratous.spec.mission import Mission
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


class CompletionWatch:
    """Completion and service of every chosen task."""

    def __init__(self, mission: Mission, plan: Plan) -> None:
        self._coverage = CoverageWatch(mission)
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
        doing.active = phase == "Active"
        if phase == "Complete":
            doing.complete_ms = body.Time
        elif phase == "Failed":
            doing.failed = body.Note or "failed"

    def state(self, body: Any) -> None:
        """A vehicle's state: what its sensors see counts for the tasks that it is doing."""
        active = [t for t, d in self._tasks.items() if d.active and d.vehicle == body.ID]
        self._coverage.state(body, active)

    def end(self, body: Any) -> None:
        """The mission ended."""
        self._outcome, self._end_ms = body.Outcome, body.Time

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
        covered = self._coverage.fraction(task)
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
