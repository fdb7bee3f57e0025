"""World state of a UxAS process, from the messages received, for the mission loader.

The world is the newest version of each entity, task, zone and region. A UniqueAutomationRequest
becomes a mission in the world at the time of the request.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace
from typing import Any

from cratous.bridge import lmcp
from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.routing.dubins import pose_after
from cratous.core.routing.visibility import start_point
from cratous.services.bus import Envelope
from cratous.services.loading.conditions import wider
from cratous.services.loading.coordinates import Places
from cratous.services.loading.ground import drives
from cratous.services.loading.uxas import mission_of, surroundings_of
from cratous.services.loading.uxas_cfg import Configuration, Sent
from cratous.services.pipeline.coordinates import RequestPlaces, read_pose
from cratous.services.pipeline.outside import Outside
from cratous.services.pipeline.tasks import TASKS
from cratous.services.pipeline.world import MOST, World
from cratous.services.planning import stages
from cratous.services.planning.inputs import Inputs
from cratous.services.uxas.frame import Host
from cratous.spec.errors import BadInput, CratousError
from cratous.spec.mission import Frame

IMPACT = "afrl.impact.ImpactAutomationRequest"
INITIALISED = "uxas.messages.task.TaskInitialized"
IMPACT_ANSWER = "afrl.impact.ImpactAutomationResponse"
_OF_ZONES = -1  # no region in a message has this id
MOST_OVERRIDDEN = 1000
_FORESEEN = {name.rpartition(".")[2] for name in TASKS} - {"WatchTask"}
"""Task types whose flight options depend on the task alone."""
FORESEEN_MOST = 100
"""Number of tasks, the newest ones, for which options are computed in advance."""


class MessageSource:
    """World state of one process."""

    subscribes: tuple[str, ...] = (*World.subscribes, IMPACT, IMPACT_ANSWER, INITIALISED)

    def __init__(self, host: Host) -> None:
        self.world = World()
        self._host = host
        self._spoken: dict[int, None] = {}  # tasks whose services have announced themselves
        self._frame: Frame | None = None  # of the newest request
        self._overridden: dict[int, Any] = {}  # unanswered, with conditions of their own
        self._told: dict[int, tuple[Any, ...]] = {}  # by RequestID, from this process's validator

    @property
    def outside(self) -> Outside:
        """The vehicles are outside the process."""
        return Outside(self._host.shared.get("separation_m", Outside().separation_m))

    def hear(self, envelope: Envelope, now_ms: int) -> None:
        """Process a message about the world, or a request with conditions of its own."""
        body = envelope.body
        if envelope.topic == IMPACT:
            if body.OverridePlanningConditions:
                kept = {**self._overridden, body.RequestID: body.TrialRequest}
                self._overridden = dict(list(kept.items())[-MOST_OVERRIDDEN:])
        elif envelope.topic == IMPACT_ANSWER:
            self._overridden.pop(body.ResponseID, None)
        elif envelope.topic == INITIALISED:
            self._spoken[body.TaskID] = None
            if len(self._spoken) > MOST:
                self._spoken.pop(next(iter(self._spoken)))
        else:
            if hasattr(body, "TaskID"):  # another task with this id needs a new announcement
                self._spoken.pop(body.TaskID, None)
            self.world.add(body, f"message {envelope.seq} from {envelope.source}", now_ms)

    def asks(self, service: str) -> bool:
        """Whether a service of this name runs on the same bus, so that it can be asked."""
        return service in self._host.bus.names()

    def inputs(self, request: Any, where: str) -> Inputs:
        """A request as a mission; BadInput states its errors."""
        asked = request.OriginalRequest
        pairs = self._conditions(request, where)
        if pairs:
            wrapped = {"TrialRequest": asked, "OverridePlanningConditions": list(pairs)}
            asked = lmcp.new("ImpactAutomationRequest", **wrapped)
        cfg = self._configuration(Sent(asked, where, 0))
        mission = mission_of(cfg, str(self._host.config), self._spoken, self._frame)
        self._frame = mission.frame
        for note in mission.notes:
            self._host.log("INFO", f"request {request.RequestID}: {note}")
        frame = Places(mission.frame)
        given = {
            state.EntityID: read_pose(
                state.PlanningPosition, state.PlanningHeading, frame, where, f"PlanningStates[{k}]"
            )
            for k, state in enumerate(request.PlanningStates)
        }
        poses = stages.start_poses(mission, given)
        starts = {vehicle.id: poses[vehicle.id] for vehicle in mission.vehicles}
        return self._led(Inputs(mission, starts), given)

    def _conditions(self, request: Any, where: str) -> Sequence[Any]:
        """The OverridePlanningConditions of a request, as reported by this process's validator.
        BadInput if the validator is in another process and the request equals one with conditions:
        they cannot be told apart.
        """
        if request.RequestID in self._told:
            return self._told[request.RequestID]
        if any(body == request.OriginalRequest for body in self._overridden.values()):
            raise BadInput(
                "OverridePlanningConditions are not covered where the validator is in another process",
                where=where,
                item="ImpactAutomationRequest",
                expected="speeds and altitudes in the configurations",
            )
        return ()

    def _led(self, inputs: Inputs, given: Collection[int]) -> Inputs:
        """The inputs with each start moved ahead by the plan builder's lead distance, where zones permit."""
        lead_m = self._host.shared.get("lead_m", 0.0)
        if not lead_m:
            return inputs
        starts = dict(inputs.starts)
        for number, pose in inputs.starts.items():
            ahead = pose_after(pose, 0, lead_m, 1.0)
            free = first_bad_leg((start_point(pose), start_point(ahead)), inputs.zones) is None
            if number not in given and not drives(inputs.mission.vehicle(number)) and free:
                starts[number] = ahead
        return Inputs(inputs.mission, starts)

    def conditions(self, request_id: int, pairs: Sequence[Any]) -> None:
        """The validator reports the conditions of a request that it is about to publish."""
        self._told.pop(request_id, None)
        self._told[request_id] = tuple(pairs)
        if len(self._told) > MOST_OVERRIDDEN:
            self._told.pop(next(iter(self._told)))

    def foreseen(self) -> Inputs | None:
        """The inputs of an anticipated request with every aircraft, our newest tasks and the newest
        region.

        None if they are invalid. Its frame is that of the coming request, if objects stay roughly
        where they are.
        """
        flown = {
            state.ID
            for state in self.world.of("state")
            if type(state).__name__ == "AirVehicleState"
        }
        ours = [t.TaskID for t in self.world.of("task") if type(t).__name__ in _FORESEEN]
        body = lmcp.new(
            "AutomationRequest",
            EntityList=sorted(flown & {*self.world.ids("configuration")}),
            TaskList=ours[-FORESEEN_MOST:],
            OperatingRegion=next(reversed(self.world.ids("region")), 0),
        )
        if not body.EntityList or not body.TaskList:
            return None
        cfg = self._configuration(Sent(body, "what may be asked for", 0))
        try:
            mission = mission_of(cfg, str(self._host.config), self._spoken, self._frame)
            inputs = self._led(Inputs(mission, stages.start_poses(mission)), ())
        except CratousError:  # the sender of such a request gets the error
            return None
        self._frame = mission.frame
        return inputs

    def surroundings(self, vehicle: int, region: int) -> RequestPlaces:
        """The frame and zones of a region for one vehicle. BadInput if something is unknown."""
        return self._surroundings(vehicle, region, ())

    def among(self, vehicle: int, zones: list[int]) -> RequestPlaces:
        """The frame and some zones, whatever their region. BadInput if one is unknown."""
        extra = lmcp.new("OperatingRegion", ID=_OF_ZONES, KeepOutAreas=zones)
        return self._surroundings(vehicle, _OF_ZONES, (Sent(extra, "zones", 0),))

    def _surroundings(self, vehicle: int, region: int, more: tuple[Sent, ...]) -> RequestPlaces:
        body = lmcp.new("AutomationRequest", EntityList=[vehicle], OperatingRegion=region)
        cfg = self._configuration(Sent(body, f"routes of vehicle {vehicle}", 0))
        mission = surroundings_of(
            replace(cfg, messages=(*more, *cfg.messages)), str(self._host.config)
        )
        inputs = Inputs(mission, stages.start_poses(mission))
        return RequestPlaces(mission, inputs.finder)

    def _configuration(self, sent: Sent) -> Configuration:
        root = {k: str(v) for k, v in self._host.root.items() if v}
        services = self._host.shared.get("services", ())
        cfg = self.world.configuration(self._host.config, root, services, sent)
        wider_m = self._host.shared.get("turn_offset_m", 0.0)
        return wider(cfg, wider_m) if wider_m else cfg
