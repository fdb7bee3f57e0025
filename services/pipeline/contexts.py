"""What each request means to the services of a pipeline, kept for the newest ones.

A service of the pipeline works from messages alone. What follows from a UniqueAutomationRequest and
what is known when it comes (mission, zones, options) is a function of both; it is computed when first
asked for, so that services of one process do not compute it twice. In another process the same
messages give the same. A service that stands on it names in `knows` what it reads there. Frame: the
mission's, from the source.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from cratous.services.bus import Envelope
from cratous.services.pipeline.places import RequestPlaces
from cratous.services.pipeline.source import Known, Source
from cratous.services.pipeline.status import status
from cratous.services.planning.inputs import Inputs
from cratous.services.planning.mission_assign import Found
from cratous.services.planning.options import Dropped
from cratous.spec.errors import BadInput, CratousError, NoPlan

UNIQUE = "uxas.messages.task.UniqueAutomationRequest"
KEPT = 8
"""Requests whose meaning is kept."""


class Context:
    """One UniqueAutomationRequest and the mission that it asks for.

    offered: tasks whose options were computed here; withheld: by task, options that it did not offer, and why; assigned: what the search has found here;
    error: why the request ended without a plan.
    """

    def __init__(self, request: Any, inputs: Inputs, places: RequestPlaces) -> None:
        self.request, self.inputs, self.places = request, inputs, places
        self.offered: set[int] = set()
        self.withheld: dict[int, tuple[Dropped, ...]] = {}
        self.assigned: Found | None = None
        self.error: CratousError | None = None

    @property
    def vehicles(self) -> list[int]:
        """The vehicles that it is for; no EntityList means all that are known."""
        return [vehicle.id for vehicle in self.inputs.mission.vehicles]

    @property
    def region(self) -> int:
        """The operating region, 0 for none."""
        return int(self.request.OriginalRequest.OperatingRegion)

    def usual_speed_m_s(self, vehicle: int) -> float:
        """How fast a vehicle flies where no task asks for more [m/s]."""
        return self.inputs.mission.vehicle(vehicle).speed_m_s


class Contexts:
    """A service without a part of its own: hears the world, and each request as it is published."""

    name = "WorldState"

    def __init__(self, source: Source) -> None:
        self.source = source
        self.subscribes: tuple[str, ...] = (*source.subscribes, UNIQUE)
        self._found: dict[int, Context | CratousError] = {}
        self._told: list[int] = []
        self._expected: Inputs | None = None

    @property
    def world(self) -> Known:
        """What is known by id."""
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
        """What a request means with what is known now; an error if it means nothing."""
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
        # the same request again: what was computed for it holds
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
        """A request that may come: what is made for it until then, the one that comes takes over where it fits."""
        if self._expected is not None:
            inputs.take_over(self._expected)
        self._expected = inputs

    def put(self, request: Any, context: Context) -> None:
        """A request that is about to be published means what was found for it."""
        self._found[request.RequestID] = Context(request, context.inputs, context.places)

    def of(self, request_id: int) -> Context:
        """The context of a request; BadInput if it is unknown, or what is wrong with it."""
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
        """When the vehicles of a request set off, 0 if nothing else is known."""
        found = self._found.get(request_id)
        return found.inputs.now_ms if isinstance(found, Context) else 0

    def refused(self, request_id: int) -> bool:
        """True if a request means nothing that could be planned."""
        return isinstance(self._found.get(request_id), CratousError)

    def refusal(self, request_id: int) -> list[Any]:
        """The message about a refused request, returned the first time only."""
        found = self._found.get(request_id)
        if not isinstance(found, CratousError) or request_id in self._told:
            return []
        self._told = [*self._told, request_id][-KEPT:]
        return [self.fail(request_id, found)]

    def fail(self, request_id: int, error: CratousError) -> Any:
        """The status that ends a request with the reasons of an error."""
        found = self._found.get(request_id)
        if isinstance(found, Context):
            found.error = error
        return status(request_id, "Error", [("reason", text) for text in reasons_of(error)])

    def error(self, request_id: int) -> CratousError | None:
        """Why a request ended here without a plan; None if no service here ended it."""
        found = self._found.get(request_id)
        return found if found is None or isinstance(found, CratousError) else found.error

    def for_routes(self, region: int, vehicle: int) -> RequestPlaces:
        """The frame, zones and vehicles for routes of a vehicle in a region.

        Those of the newest request that has both; else as the world is now. BadInput if unknown.
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
