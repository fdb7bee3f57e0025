"""The assumption that a certificate begins as it is offered. Decided by the kernel `in_time`."""

from __future__ import annotations

from cratous.core.authority.timeliness import in_time
from cratous.services.assumptions.observed import Message, Record
from cratous.spec.mission import Mission


class OfferWatch:
    """Offers that are taken begin at their instant."""

    def __init__(self, mission: Mission) -> None:
        none = "" if mission.instances else "no vehicle has an ICAROUS instance"
        self._others = 0
        self._record = Record("offers", 0, (in_time,), none, waits="no certificate was offered")

    def message(self, message: Message) -> None:
        """A change of what is in hand."""
        body = message.body
        if message.kind != "HandState" or body.Change.name != "Offered":
            return
        now = in_time(body.Sigma, message.time_ms, 0)
        self._others += not now
        self._record.see(self._others)
        text = f"certificate {body.ID} begins at {body.Sigma / 1000:.2f} s"
        self._record.check(now, message.time_ms, body.VehicleID, text)

    def end(self, at_ms: int) -> None:
        """Nothing is open."""

    def records(self) -> dict[str, Record]:
        """See `Watch`."""
        return {"offers begin at once": self._record}
