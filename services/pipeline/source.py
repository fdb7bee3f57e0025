"""Interface to what the services of the pipeline know: from messages, or from a mission's exact inputs.

The services are the same for both. A source gives known objects by id and the inputs of a request; everything
else goes by messages.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

from cratous.services.bus import Envelope
from cratous.services.pipeline.coordinates import RequestPlaces
from cratous.services.pipeline.outside import Outside
from cratous.services.planning.inputs import Inputs


class Known(Protocol):
    """Known objects by id; sorts are configuration, state, task, zone, region, point, line, area, mission."""

    def has(self, sort: str, number: int) -> bool:
        """Whether an object of a sort has this id."""

    def get(self, sort: str, number: int) -> Any:
        """The newest message about the id, None if there is none."""

    def ids(self, sort: str) -> list[int]:
        """The ids of a sort."""


class Source(Protocol):
    """Facts for the services of one process or one mission."""

    subscribes: tuple[str, ...]
    """Types of the messages that it needs to receive."""

    @property
    def world(self) -> Known:
        """The known objects by id."""

    @property
    def outside(self) -> Outside | None:
        """How plans are sent out; None if the mission's own simulation flies paths and views as planned."""

    def hear(self, envelope: Envelope, now_ms: int) -> None:
        """Process a message of one of these types."""

    def inputs(self, request: Any, where: str) -> Inputs:
        """The inputs of a UniqueAutomationRequest; BadInput or NoPlan if it cannot be planned."""

    def conditions(self, request_id: int, pairs: Sequence[Any]) -> None:
        """Set the SpeedAltPairs for a request that a validator is about to publish."""

    def surroundings(self, vehicle: int, region: int) -> RequestPlaces:
        """The frame and zones of a region for one vehicle. BadInput if something is unknown."""

    def asks(self, service: str) -> bool:
        """Whether a task has to ask this service before it offers its options."""
