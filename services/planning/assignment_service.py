"""AssignmentTreeBranchBoundService: from the cost matrix to who does what, or why nobody can."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.core.assignment import START, Assignment, assign
from cratous.services.bus import Envelope
from cratous.services.planning import reasons
from cratous.services.planning.desk import Desk, status


class Assigned(NamedTuple):
    """Results by request id: the assignment, or the reasons why there is none."""

    found: dict[int, Assignment]
    failed: dict[int, tuple[str, ...]]


class AssignmentTreeBranchBoundService:
    """AssignmentCostMatrix -> TaskAssignmentSummary, or an error status with the reasons.

    In the summary TimeThreshold is the instant at which the task starts, so that a later
    departure becomes a wait; TimeTaskCompleted is its end (ms after mission start).
    """

    name = "AssignmentTreeBranchBoundService"
    subscribes: tuple[str, ...] = ("uxas.messages.task.AssignmentCostMatrix",)

    def __init__(self, desk: Desk) -> None:
        self._desk = desk

    def start(self) -> Assigned:
        return Assigned({}, {})

    def handle(
        self, state: Assigned, envelope: Envelope, now_ms: int
    ) -> tuple[Assigned, Iterable[Any]]:
        matrix = envelope.body
        key = matrix.CorrespondingAutomationRequestID
        inputs = self._desk.inputs(key)
        times: dict[tuple[int, int, int], int] = {}
        for row in matrix.CostMatrix:
            before = (row.IntialTaskID, row.IntialTaskOption)
            times[
                inputs.vehicle_index[row.VehicleID],
                START if before == (0, 0) else inputs.index[before],
                inputs.index[row.DestinationTaskID, row.DestinationTaskOption],
            ] = row.TimeToGo

        def travel_ms(vehicle: int, before: int, to: int) -> int | None:
            return times.get((vehicle, before, to))

        problem = inputs.problem(travel_ms)
        result = assign(problem)
        if result.placed is None:
            why = reasons.why_none(
                inputs.mission,
                inputs.wanted,
                inputs.options,
                inputs.dropped,
                inputs.routes,
                problem,
                result.exhausted and inputs.all_branches,
            )
            failed = {**state.failed, key: why}
            return state._replace(failed=failed), [
                status(key, "Error", [("reason", text) for text in why])
            ]
        listed = [
            lmcp.new(
                "TaskAssignment",
                TaskID=inputs.options[placed.candidate].task_id,
                OptionID=inputs.options[placed.candidate].option_id,
                AssignedVehicle=inputs.mission.vehicles[placed.vehicle].id,
                TimeThreshold=placed.start_ms,
                TimeTaskCompleted=placed.end_ms,
            )
            for placed in result.placed
        ]
        summary = lmcp.new(
            "TaskAssignmentSummary",
            CorrespondingAutomationRequestID=key,
            OperatingRegion=matrix.OperatingRegion,
            TaskList=listed,
        )
        proof = "yes" if result.exhausted and inputs.all_branches else "no"
        facts = [
            ("cost_ms", str(result.cost)),
            ("nodes", str(result.nodes)),
            ("exhausted", proof),
        ]
        found = {**state.found, key: result}
        return state._replace(found=found), [status(key, "Information", facts), summary]
