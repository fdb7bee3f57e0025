"""AutomationDiagramDataService: writes for each planned request a folder with its objects and a
diagram.

The folder is `AutomationDiagramDataService/0001_AutomationDiagram_ID0100` (an unused number, the
entity id) below the data folder. It contains, named as in UxAS: the state of each vehicle, the
tasks with the places that they refer to, the zones of the operating region, and the response, one
XML file each; and `AutomationDiagram.svg`, in place of UxAS's plotting scripts.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.core.files.whole_file import PART, Workspace, sync
from cratous.services.bus import Envelope, Wake
from cratous.services.pipeline.status import status
from cratous.services.pipeline.world import World
from cratous.services.uxas.diagram_picture import picture
from cratous.spec.errors import BadInput

SERVICE_TYPE = "AutomationDiagramDataService"
REQUEST = "uxas.messages.task.UniqueAutomationRequest"
RESPONSE = "uxas.messages.task.UniqueAutomationResponse"
AT_ONCE = 1000
_NUMBERED = re.compile(r"(\d{4,9})_.*")
_REFERENCES = {
    "SearchAreaID": ("area", "AreaOfInterest"),
    "LineID": ("line", "LineOfInterest"),
    "SearchLocationID": ("point", "PointOfInterest"),
    "WatchedEntityID": ("state", "WatchedEntity"),
    "BlockedEntityID": ("state", "BlockedEntity"),
    "SupportedEntityID": ("state", "SupportedEntity"),
}
"""Objects that a task may refer to by id: kind of object, and prefix of its file name."""


class Pairs(NamedTuple):
    """The newest AT_ONCE unanswered requests by id, and the answered ones still to be written."""

    asked: dict[int, Any]
    answered: tuple[tuple[Any, Any], ...] = ()


class AutomationDiagramDataService:
    """Writes automation diagrams; publishes only a ServiceStatus when a file cannot be written."""

    subscribes: tuple[str, ...] = (REQUEST, RESPONSE)

    def __init__(self, name: str, world: World, folder: Path, entity_id: int) -> None:
        """world: state received in messages; folder: output folder, created when first needed."""
        self.name, self._world, self._entity = name, world, entity_id
        self._folder = folder / SERVICE_TYPE

    def start(self) -> Pairs:
        return Pairs({})

    def handle(self, state: Pairs, envelope: Envelope, now_ms: int) -> tuple[Pairs, Iterable[Any]]:
        """Match responses with requests; files are written after the response has been delivered."""
        body = envelope.body
        if envelope.topic == REQUEST:
            newest = [*state.asked.items(), (body.RequestID, body)][-AT_ONCE:]
            return state._replace(asked=dict(newest)), ()
        asked = dict(state.asked)
        request = asked.pop(body.ResponseID, None)
        if request is None:
            return state, ()
        return Pairs(asked, (*state.answered, (request, body))), [Wake(0)]

    def wake(self, state: Pairs, key: None, now_ms: int) -> tuple[Pairs, Iterable[Any]]:
        """Write the answered requests; returns status messages for failures."""
        said = []
        for request, response in state.answered:
            try:
                self._write(request, response)
            except OSError as error:
                what = f"{error.filename or self._folder}: {error.strerror or error}"
                said.append(status(response.ResponseID, "Error", [(SERVICE_TYPE, what)]))
            except BadInput as error:  # XML cannot represent every text of a message
                said.append(status(response.ResponseID, "Error", [(SERVICE_TYPE, str(error))]))
        return state._replace(answered=()), said

    def stop(self, state: Pairs) -> None:
        """When the service stops, write all remaining answered requests."""
        self.wake(state, None, 0)

    def files(self, request: Any, response: Any) -> dict[str, Any]:
        """The objects written for a request and its response, by file name."""
        found = dict(self._states(request))
        for number in request.OriginalRequest.TaskList:
            task = self._world.get("task", number)
            if task is None:
                continue
            found[f"Task_Id_{number}.xml"] = task
            for field, (sort, name) in _REFERENCES.items():
                other = getattr(task, field, 0)
                if other > 0 and self._world.get(sort, other) is not None:
                    found[f"{name}_Id_{other}.xml"] = self._world.get(sort, other)
        region = self._world.get("region", request.OriginalRequest.OperatingRegion)
        for kind in ("KeepIn", "KeepOut") if region is not None else ():
            for number in getattr(region, f"{kind}Areas"):
                if self._world.get("zone", number) is not None:
                    found[f"Zone{kind}_Id_{number}.xml"] = self._world.get("zone", number)
        found[f"UniqueAutomationResponse_Id_{response.ResponseID}.xml"] = response
        return found

    def _states(self, request: Any) -> Iterator[tuple[str, Any]]:
        """The state from which each vehicle was planned: from the request, otherwise the newest."""
        given = {state.EntityID: state for state in request.PlanningStates}
        for number in request.OriginalRequest.EntityList or sorted(self._world.ids("state")):
            known = self._world.get("state", number)
            if number in given:
                known = lmcp.new(
                    "EntityState",
                    ID=number,
                    Location=given[number].PlanningPosition,
                    Heading=given[number].PlanningHeading,
                )
            if known is not None:
                yield f"EntityState_Id_{number}.xml", known

    def _write(self, request: Any, response: Any) -> None:
        files = self.files(request, response)
        self._folder.mkdir(parents=True, exist_ok=True)
        space = Workspace(self._folder, "diagram", PART)
        try:
            whole = space.path / "whole"
            whole.mkdir()
            for name, body in files.items():
                (whole / name).write_text(lmcp.xml.dumps(body), encoding="utf-8")
            drawn = picture(files, f"Request {response.ResponseID}")
            (whole / "AutomationDiagram.svg").write_text(drawn, encoding="utf-8")
            for path in whole.iterdir():
                sync(path)
            whole.rename(self._folder / self._free())
            sync(self._folder)
        finally:
            space.remove()

    def _free(self) -> str:
        """The next number, as in UxAS: the greatest existing one plus one."""
        there = [m for name in os.listdir(self._folder) if (m := _NUMBERED.fullmatch(name))]
        number = 1 + max((int(match[1]) for match in there), default=0)
        return f"{number:04d}_AutomationDiagram_ID{self._entity:04d}"
