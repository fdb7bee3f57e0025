"""How a flight in processes ends: what UxAS has told of its tasks and vehicles, and what the kernels make of it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from cratous.core.authority.link_loss import LOITER, OVER, RETURN
from cratous.core.authority.timeliness import lasted
from cratous.core.executive.steps import ends_in_safe_state
from cratous.services.flight.executive import SAFE_STATE
from cratous.spec.mission.plan import Plan, in_part_of

CIRCLES = (LOITER, OVER)
LIMIT = "limit"


@dataclass
class Ending:
    """What has been told. safe_ms: how long a vehicle circles without the link until it is in the safe state [ms];
    complete, failed: tasks, the latter with reasons; away: vehicles that ICAROUS has; circling: vehicles without the
    link, with since when [ms]; returning: those on their way to the place to circle at; unheard: those
    whose ICAROUS UxAS does not hear.
    """

    plan: Plan
    safe_ms: int
    complete: set[int] = field(default_factory=set)
    failed: dict[int, str] = field(default_factory=dict)
    away: set[int] = field(default_factory=set)
    circling: dict[int, int] = field(default_factory=dict)
    returning: set[int] = field(default_factory=set)
    unheard: set[int] = field(default_factory=set)

    def heard(self, body: Any) -> None:
        """Process a message of UxAS's bus, with times of the mission."""
        kind = type(body).__name__
        if kind == "TaskComplete":
            self.complete.add(body.TaskID)
        elif kind == "AuthorityChange":
            {"ICAROUS": self.away.add, "UxAS": self.away.discard}[body.Owner.name](body.VehicleID)
        elif kind == "LinkLossState":
            (self.returning.add if int(body.Mode) == RETURN else self.returning.discard)(
                body.VehicleID
            )
            if int(body.Mode) in CIRCLES:
                self.circling.setdefault(body.VehicleID, body.Time)
            else:
                self.circling.pop(body.VehicleID, None)
        elif kind == "BridgeStatus":
            (self.unheard.discard if body.Alive else self.unheard.add)(body.VehicleID)
        elif kind == "ServiceStatus":
            said = {pair.Key: pair.Value for pair in body.Info}
            if said.get("TaskID", "").isdigit():
                self.failed[int(said["TaskID"])] = said.get("reason", "it ends undone")

    @property
    def asked(self) -> set[int]:
        """The tasks of the plan."""
        return {item.task_id for item in self.plan.items}

    @property
    def left(self) -> set[int]:
        """The tasks that UxAS has not told as complete."""
        return self.asked - self.complete

    def outcome(self, now_ms: int, late: bool) -> str:
        """How the mission has ended, "" while it has not. late: the limit is reached."""
        # one that circles or returns without the link flies its plan no more, whoever has it
        away = self.away | self.circling.keys() | self.returning
        if self.left <= self.failed.keys() and not away:
            in_part = self.asked & {one.task_id for one in in_part_of(self.plan)}
            return "failed" if self.left or in_part else "complete"
        if late:
            return LIMIT
        safe = self._safe(now_ms)
        todo = self.left - self.failed.keys()
        working = {one.vehicle_id for one in self.plan.items if one.task_id in todo} - set(safe)
        ends = ends_in_safe_state(len(working), len(away), len(safe), 0)
        return SAFE_STATE if ends else ""

    def why(self, task: int, outcome: str, now_ms: int) -> str:
        """Why a task that has not ended is not served."""
        if outcome != SAFE_STATE:
            return self.failed.get(task, f"not served when the flight ended ({outcome})")
        text = "not served when the flight ended in the declared safe state"
        for vehicle in self._safe(now_ms):
            since_s = self.circling[vehicle] / 1000
            text += f"; vehicle {vehicle} circles without the link since {since_s:.2f} s"
        return self.failed.get(task, text)

    def _safe(self, now_ms: int) -> list[int]:
        since: Iterable[tuple[int, int]] = sorted(self.circling.items())
        return [vehicle for vehicle, ms in since if lasted(ms, now_ms, self.safe_ms)]
