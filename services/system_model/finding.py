"""What does not fit: an event that is no step of the model, or one that had to come and did not."""

from __future__ import annotations

from typing import NamedTuple


class Finding(NamedTuple):
    """seq: place in the log of the first event that does not fit, or at which one is missing; time_ms:
    its time [ms]; vehicle_id: 0 for none; what: the event; expected, got: in words."""

    seq: int
    time_ms: int
    vehicle_id: int
    what: str
    expected: str
    got: str

    @property
    def text(self) -> str:
        """On one line, for people."""
        vehicle = f", vehicle {self.vehicle_id}" if self.vehicle_id else ""
        place = f"message {self.seq} at {self.time_ms / 1000:.2f} s{vehicle}"
        return f"{place}: {self.what}: expected {self.expected}; got {self.got}"


class Misfit(Exception):
    """Raised by a part of the model when the log does not fit it; the replay adds the place in the log."""

    def __init__(self, what: str, expected: str, got: str) -> None:
        super().__init__(what)
        self.what, self.expected, self.got = what, expected, got
