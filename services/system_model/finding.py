"""A misfit: an event that is no step of the model, or the absence of a required one."""

from __future__ import annotations

from typing import NamedTuple


class Finding(NamedTuple):
    """seq: log number of the first event that does not fit, or at which one is missing; time_ms:
    its time [ms]; vehicle_id: 0 for none; what: the event; expected, got: in words.
    """

    seq: int
    time_ms: int
    vehicle_id: int
    what: str
    expected: str
    got: str

    @property
    def text(self) -> str:
        """The finding as one line of text."""
        vehicle = f", vehicle {self.vehicle_id}" if self.vehicle_id else ""
        place = f"message {self.seq} at {self.time_ms / 1000:.2f} s{vehicle}"
        return f"{place}: {self.what}: expected {self.expected}; got {self.got}"


class Misfit(Exception):
    """Raised by a part of the model if the log does not fit; the replay adds the position in the log."""

    def __init__(self, what: str, expected: str, got: str) -> None:
        super().__init__(what)
        self.what, self.expected, self.got = what, expected, got
