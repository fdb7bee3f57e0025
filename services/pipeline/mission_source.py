"""The pipeline's source for a mission: its exact inputs, for the single request made from it.

Messages carry degrees; values read from the mission stay exact alongside.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from cratous.bridge import lmcp
from cratous.services.bus import Envelope
from cratous.services.pipeline.coordinates import RequestPlaces
from cratous.services.planning.inputs import Inputs
from cratous.spec.errors import BadInput


class MissionWorld:
    """The objects of a mission by id, not received as messages."""

    def __init__(self, inputs: Inputs) -> None:
        vehicles = [vehicle.id for vehicle in inputs.mission.vehicles]
        tasks = [task.id for task in inputs.mission.tasks]
        self._ids = {"configuration": vehicles, "state": vehicles, "task": tasks}

    def has(self, sort: str, number: int) -> bool:
        """Whether an object of a sort has this id."""
        return number in self.ids(sort)

    def get(self, sort: str, number: int) -> Any:
        """None: a mission has no messages."""
        return None

    def ids(self, sort: str) -> list[int]:
        """The ids of a sort."""
        return self._ids.get(sort, [])


class MissionSource:
    """The source of one request: the remaining tasks of a mission, from given poses."""

    subscribes: tuple[str, ...] = ()
    outside = None

    def __init__(self, inputs: Inputs) -> None:
        self.world = MissionWorld(inputs)
        self._inputs = inputs
        self.request = lmcp.new(
            "AutomationRequest",
            EntityList=[vehicle.id for vehicle in inputs.mission.vehicles],
            TaskList=list(inputs.wanted),
            TaskRelationships=inputs.mission.relations,
        )

    def hear(self, envelope: Envelope, now_ms: int) -> None:
        """Ignored: messages do not change a mission."""

    def conditions(self, request_id: int, pairs: Sequence[Any]) -> None:
        """Ignored: speeds and altitudes are the mission's."""

    def asks(self, service: str) -> bool:
        """False: options were already checked exactly against the mission's zones and cameras."""
        return False

    def inputs(self, request: Any, where: str) -> Inputs:
        """The mission's inputs; BadInput for another request."""
        if request.OriginalRequest != self.request:
            raise BadInput(
                "this is not the request of the mission",
                where=where,
                item="UniqueAutomationRequest",
                expected=f"tasks {', '.join(map(str, self.request.TaskList))}",
                got=f"tasks {', '.join(map(str, request.OriginalRequest.TaskList))}",
            )
        return self._inputs

    def surroundings(self, vehicle: int, region: int) -> RequestPlaces:
        """BadInput: routes are requested within the mission's request only."""
        raise BadInput(
            "no such vehicle or region in the mission",
            where=self._inputs.mission.source,
            expected="a vehicle of the mission, and region 0",
            got=f"vehicle {vehicle}, region {region}",
        )
