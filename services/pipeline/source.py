"""Where the services of the pipeline know things from: messages, or a mission with its exact inputs.

The services are the same for both. A source answers what is known by id, and what a request means;
everything else goes by messages.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

from cratous.services.bus import Envelope
from cratous.services.pipeline.outside import Outside
from cratous.services.pipeline.places import RequestPlaces
from cratous.services.planning.inputs import Inputs


class Known(Protocol):
    """What is known by id: sorts are configuration, state, task, zone, region, point, line, area, mission."""

    def has(self, sort: str, number: int) -> bool:
        """True if there is an object of a sort with this id."""

    def get(self, sort: str, number: int) -> Any:
        """The newest message about the id, None if there is none."""

    def ids(self, sort: str) -> list[int]:
        """All of a sort."""


class Source(Protocol):
    """Facts for the services of one process or one mission."""

    subscribes: tuple[str, ...]
    """Types of the messages that it wants to hear."""

    @property
    def world(self) -> Known:
        """What is known by id."""

    @property
    def outside(self) -> Outside | None:
        """How plans go out; None: the flight is the mission's own, which flies paths and views as planned."""

    def hear(self, envelope: Envelope, now_ms: int) -> None:
        """A message of one of these types."""

    def inputs(self, request: Any, where: str) -> Inputs:
        """What a UniqueAutomationRequest means; BadInput or NoPlan if it means nothing."""

    def conditions(self, request_id: int, pairs: Sequence[Any]) -> None:
        """SpeedAltPairs under which a request is planned that a validator is about to publish."""

    def surroundings(self, vehicle: int, region: int) -> RequestPlaces:
        """The frame and zones of a region for one vehicle. BadInput if something is unknown."""

    def asks(self, service: str) -> bool:
        """Whether a task has to ask this service before it offers its options."""
