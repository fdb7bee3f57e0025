"""Groups true states into steps: the positions of all aircraft at two successive instants."""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.spec.mission import Position


class Sample(NamedTuple):
    """One aircraft at one instant, in the mission frame."""

    time_ms: int
    position: Position
    heading_rad: float
    ours: bool
    sequence: int


Step = tuple[dict[int, Sample], dict[int, Sample]]


class Sampler:
    """Collects the states of one instant; a state with a later time completes the step."""

    def __init__(self, ours: frozenset[int]) -> None:
        self._ours = ours
        self._before: dict[int, Sample] = {}
        self._now: dict[int, Sample] = {}
        self._sequence = 0

    def add(self, body: Any) -> list[Step]:
        """Add one TruthState; returns the step that it completes, if any."""
        done = []
        if self._now and body.Time != next(iter(self._now.values())).time_ms:
            done = self.flush()
        position = Position(body.North, body.East, body.Altitude)
        ours = body.VehicleID in self._ours
        self._now[body.VehicleID] = Sample(body.Time, position, body.Heading, ours, self._sequence)
        return done

    def flush(self) -> list[Step]:
        """Complete the current instant."""
        if not self._now:
            return []
        step = (self._before, self._now)
        self._before, self._now = self._now, {}
        self._sequence += 1
        return [step] if step[0] else []
