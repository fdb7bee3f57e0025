"""BatchSummaryService: how long each vehicle would take to each task, and whether it violates a
zone.

BatchSummaryRequest -> a TaskAutomationRequest for each task and vehicle, as a trial ->
TaskAutomationResponse -> BatchSummaryResponse, when all have been answered. A vehicle without a
plan for a task gets a summary with no waypoints and times of -1. Zones outside the operating region
that a plan violates are named (kernel `leg_ok`), whether or not they are active.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.core.contracts.checklists import free_after, list_complete, owns
from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.services.bus import Envelope
from cratous.services.loading.polygons import hard_zones
from cratous.services.uxas.message_source import MessageSource
from cratous.spec.errors import CratousError
from cratous.spec.mission import Position, ZoneKind

REQUEST = "afrl.impact.BatchSummaryRequest"
RESPONSE = "uxas.messages.task.TaskAutomationResponse"
AT_ONCE = 16


class Batch(NamedTuple):
    """A request, the first id of its block, (task, vehicle) by id from there on, and the answers."""

    request: Any
    first: int
    pairs: tuple[tuple[int, int], ...]
    answers: tuple[tuple[int, Any], ...] = ()

    @property
    def complete(self) -> bool:
        """True iff all trials have been answered."""
        have = {number for number, _ in self.answers}
        return list_complete([(self.first + k in have,) for k in range(len(self.pairs))])


class Batches(NamedTuple):
    """The next free id, and the requests in progress."""

    free: int = 1
    open: tuple[Batch, ...] = ()


Step = tuple[Batches, Iterable[Any]]


class BatchSummaryService:
    """Summaries from trial plans."""

    name = "BatchSummaryService"
    subscribes: tuple[str, ...] = (REQUEST, RESPONSE)
    knows = ("EntityConfiguration", "EntityState", "KeepOutZone")

    def __init__(self, source: MessageSource) -> None:
        self._source = source

    def start(self) -> Batches:
        return Batches()

    def handle(self, state: Batches, envelope: Envelope, now_ms: int) -> Step:
        body = envelope.body
        if envelope.topic == REQUEST:
            return self._ask(state, body)
        for k, batch in enumerate(state.open):
            if not owns(batch.first, len(batch.pairs), body.ResponseID):
                continue
            others = state.open[:k], state.open[k + 1 :]
            batch = batch._replace(answers=(*batch.answers, (body.ResponseID, body)))
            if batch.complete:
                return state._replace(open=(*others[0], *others[1])), [self._summary(batch)]
            return state._replace(open=(*others[0], batch, *others[1])), ()
        return state, ()

    def _ask(self, state: Batches, request: Any) -> Step:
        vehicles = list(request.Vehicles) or self._source.world.ids("configuration")
        pairs = tuple((t, v) for t in request.TaskList for v in vehicles)
        batch = Batch(request, state.free, pairs)
        if batch.complete:
            return state, [self._summary(batch)]
        trials = [
            lmcp.new(
                "TaskAutomationRequest",
                RequestID=state.free + k,
                SandBoxRequest=True,
                OriginalRequest=lmcp.new(
                    "AutomationRequest",
                    EntityList=[vehicle],
                    TaskList=[task],
                    OperatingRegion=request.OperatingRegion,
                ),
            )
            for k, (task, vehicle) in enumerate(pairs)
        ]
        free = free_after(state.free, len(pairs))
        return Batches(free, (*state.open, batch)[-AT_ONCE:]), trials

    def _summary(self, batch: Batch) -> Any:
        answers = dict(batch.answers)
        tasks: dict[int, list[Any]] = {task: [] for task in batch.request.TaskList}
        for k, (task, vehicle) in enumerate(batch.pairs):
            tasks[task].append(
                self._vehicle(batch.request, task, vehicle, answers[batch.first + k])
            )
        return lmcp.new(
            "BatchSummaryResponse",
            ResponseID=batch.request.RequestID,
            Summaries=[
                lmcp.new("TaskSummary", TaskID=task, PerformingVehicles=found)
                for task, found in tasks.items()
            ],
        )

    def _vehicle(self, request: Any, task: int, vehicle: int, answer: Any) -> Any:
        commands = answer.OriginalResponse.MissionCommandList
        points = list(commands[0].WaypointList) if commands else []
        to, on = _times_ms(self._source.world.get("state", vehicle), points, task)
        zones = self._meets(request.OperatingRegion, vehicle, points)
        return lmcp.new(
            "VehicleSummary",
            VehicleID=vehicle,
            DestinationTaskID=task,
            TimeToArrive=to,
            TimeOnTask=on,
            ConflictsWithROZ=bool(zones),
            ROZIDs=zones,
            WaypointList=points,
            FirstWaypoint=points[0].Number if points else 0,
        )

    def _meets(self, region: int, vehicle: int, points: list[Any]) -> list[int]:
        """Ids of the keep-out zones that a plan violates."""
        world = self._source.world
        outs = [z.ZoneID for z in world.of("zone") if type(z).__name__ == "KeepOutZone"]
        if not points or not outs:
            return []
        try:
            places = self._source.among(vehicle, outs)
            path = [
                Position(*places.projection.to_local(w.Latitude, w.Longitude), w.Altitude)
                for w in points
            ]
            zones = hard_zones([z for z in places.mission.zones if z.kind is ZoneKind.KEEP_OUT])
        except CratousError:
            return outs  # a zone that cannot be checked is not reported as respected
        return [zone.id for zone in zones if first_bad_leg(path, (zone,)) is not None]


def _times_ms(state: Any, points: list[Any], task: int) -> tuple[int, int]:
    """Time to the task's first waypoint and from there to its last [ms], at the planned speeds."""
    if not points or state is None:
        return -1, -1
    from pyproj import Geod

    geod, before = Geod(ellps="WGS84"), state.Location
    to = on = 0.0
    begun = False
    for waypoint in points:
        metres = geod.inv(before.Longitude, before.Latitude, waypoint.Longitude, waypoint.Latitude)[
            2
        ]
        spent = 1000 * metres / waypoint.Speed if waypoint.Speed else 0.0
        if begun:
            on += spent
        else:
            to += spent
        begun = begun or task in waypoint.AssociatedTasks
        before = waypoint
    return round(to), round(on)
