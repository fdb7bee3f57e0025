"""What forbids a way: traffic, zones, or nothing."""

from __future__ import annotations

from typing import NamedTuple


class Forbidden(NamedTuple):
    """traffic, zone: whether traffic, or a zone, forbids a way; where both do it may be said of one alone.
    intruder_id: an aircraft that does, 0 if not determined.
    """

    traffic: bool
    zone: bool
    intruder_id: int = 0

    @property
    def free(self) -> bool:
        """Whether nothing forbids it."""
        return not (self.traffic or self.zone)


FREE = Forbidden(False, False)
BY_ZONE = Forbidden(False, True)


def by_traffic(intruder_id: int = 0) -> Forbidden:
    """Forbidden by traffic alone. intruder_id: the aircraft, 0 if not determined."""
    return Forbidden(True, False, intruder_id)
