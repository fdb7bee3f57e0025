"""The planning inputs of each request for the services of a pipeline; the newest are kept.

A service of the pipeline works from messages alone. The inputs (mission, zones, options) are a function of a
UniqueAutomationRequest and of what is known when it arrives; they are computed on first use and shared by the
services of one process. In another process the same messages give the same inputs. A service that depends on
them declares in `knows` what it reads. Frame: the mission's, from the source.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from cratous.services.bus import Envelope
from cratous.services.pipeline.coordinates import RequestPlaces
from cratous.services.pipeline.source import Known, Source
from cratous.services.pipeline.status import status
from cratous.services.planning.inputs import Inputs
from cratous.services.planning.mission_assign import Found
from cratous.services.planning.options import Dropped
from cratous.spec.errors import BadInput, CratousError, NoPlan

UNIQUE = "uxas.messages.task.UniqueAutomationRequest"
KEPT = 8
"""Number of requests whose context is kept."""


class Context:
    """One UniqueAutomationRequest and the mission that it asks for.

    offered: tasks whose options were computed here; withheld: by task, options not offered, and why;
    assigned: assignment found here; error: why the request ended without a plan.
    """

    def __init__(self, request: Any, inputs: Inputs, places: RequestPlaces) -> None:
        self.request, self.inputs, self.places = request, inputs, places
        self.offered: set[int] = set()
        self.withheld: dict[int, tuple[Dropped, ...]] = {}
        self.assigned: Found | None = None
        self.error: CratousError | None = None

    @property
    def vehicles(self) -> list[int]:
        """The vehicles of the request; an empty EntityList means all known ones."""
        return [vehicle.id for vehicle in self.inputs.mission.vehicles]

    @property
    def region(self) -> int:
        """The operating region, 0 for none."""
        return int(self.request.OriginalRequest.OperatingRegion)

    def usual_speed_m_s(self, vehicle: int) -> float:
        """Speed of a vehicle unless a task requires another [m/s]."""
        return self.inputs.mission.vehicle(vehicle).speed_m_s


class Contexts:
    """A passive service: it records the world and opens the context of each published request."""

    name = "WorldState"

    def __init__(self, source: Source) -> None:
        self.source = source
        self.subscribes: tuple[str, ...] = (*source.subscribes, UNIQUE)
        self._found: dict[int, Context | CratousError] = {}
        self._told: list[int] = []
        self._expected: Inputs | None = None

    @property
    def world(self) -> Known:
        """The known objects by id."""
        return self.source.world

    def start(self) -> None:
        return None

    def handle(self, state: None, envelope: Envelope, now_ms: int) -> tuple[None, Iterable[Any]]:
        if envelope.topic == UNIQUE:
            self.open(envelope.body, f"message {envelope.seq}")
        else:
            self.source.hear(envelope, now_ms)
        return state, ()

    def open(self, request: Any, where: str) -> Context | CratousError:
        """The context of a request from present knowledge; the error if it cannot be planned."""
        found = self._found.get(request.RequestID)
        if isinstance(found, Context) and found.request == request:
            return found
        try:
            made: Context | CratousError = self._context(request, where)
        except CratousError as error:
            made = error
        self._found.pop(request.RequestID, None)
        self._told = [number for number in self._told if number != request.RequestID]
        self._found[request.RequestID] = made
        while len(self._found) > KEPT:
            self._found.pop(next(iter(self._found)))
        return made

    def _context(self, request: Any, where: str) -> Context:
        inputs = self.source.inputs(request, where)
        # a repeated request reuses what was computed for it
        same = (k for k in self._found.values() if isinstance(k, Context) and k.inputs == inputs)
        known = next(same, None)
        if known is not None:
            inputs, places = known.inputs, known.places
        else:
            places = RequestPlaces(inputs.mission, inputs.finder)
            for found in reversed(self._found.values()):
                if isinstance(found, Context):
                    inputs.take_over(found.inputs)
            if self._expected is not None:
                inputs.take_over(self._expected)
        inputs.check_starts()
        if not inputs.wanted:
            raise NoPlan(("no branch of the relations has a task",))
        return Context(request, inputs, places)

    def expect(self, inputs: Inputs) -> None:
        """Announce a request that may come: what is computed for it is reused as far as it fits."""
        if self._expected is not None:
            inputs.take_over(self._expected)
        self._expected = inputs

    def put(self, request: Any, context: Context) -> None:
        """Bind a request that is about to be published to the context found for it."""
        self._found[request.RequestID] = Context(request, context.inputs, context.places)

    def of(self, request_id: int) -> Context:
        """The context of a request. BadInput if it is unknown; raises the request's own error if it has one."""
        found = self._found.get(request_id)
        if found is None:
            raise BadInput(
                "no such request is being planned here",
                item="RequestID",
                expected=", ".join(map(str, self._found)) or "none is",
                got=str(request_id),
            )
        if isinstance(found, CratousError):
            raise found
        return found

    def begin_ms(self, request_id: int) -> int:
        """Departure time of a request's vehicles [ms]; 0 if unknown."""
        found = self._found.get(request_id)
        return found.inputs.now_ms if isinstance(found, Context) else 0

    def refused(self, request_id: int) -> bool:
        """Whether a request cannot be planned."""
        return isinstance(self._found.get(request_id), CratousError)

    def refusal(self, request_id: int) -> list[Any]:
        """The message about a refused request, returned the first time only."""
        found = self._found.get(request_id)
        if not isinstance(found, CratousError) or request_id in self._told:
            return []
        self._told = [*self._told, request_id][-KEPT:]
        return [self.fail(request_id, found)]

    def fail(self, request_id: int, error: CratousError) -> Any:
        """Record an error as the end of a request; returns the status with its reasons."""
        found = self._found.get(request_id)
        if isinstance(found, Context):
            found.error = error
        return status(request_id, "Error", [("reason", text) for text in reasons_of(error)])

    def error(self, request_id: int) -> CratousError | None:
        """Why a request ended here without a plan; None if no service here ended it."""
        found = self._found.get(request_id)
        return found if found is None or isinstance(found, CratousError) else found.error

    def for_routes(self, region: int, vehicle: int) -> RequestPlaces:
        """Frame, zones and vehicles for the routes of a vehicle in a region.

        From the newest request that has both, else from the present world. BadInput if unknown.
        """
        for found in reversed(self._found.values()):
            if (
                isinstance(found, Context)
                and found.region == region
                and vehicle in found.inputs.vehicle_index
            ):
                return found.places
        return self.source.surroundings(vehicle, region)


def reasons_of(error: CratousError) -> tuple[str, ...]:
    """The reasons of an error in the user's terms, one text each."""
    if isinstance(error, NoPlan):
        return tuple(error.reasons)
    problems = getattr(error, "problems", (error,))
    return tuple(str(problem) for problem in problems)
