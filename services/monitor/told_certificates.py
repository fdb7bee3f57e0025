"""What a log tells of an ICAROUS's certificates, as the rule for failures needs it.

An ICAROUS that has a vehicle answers at each heartbeat: with a certificate, which the hand takes (`Offered`) or not
(`Refused`), or with a lack, of which the first after the takeover or after a certificate taken is logged (`Missing`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from cratous.core.authority.timeliness import in_time

FOUND = ("Offered", "Refused")


@dataclass
class Certificates:
    """expiry_ms, surprises: of the hand; found: a certificate was found since ICAROUS took the vehicle; last: surprises
    at that time; since_ms: since when none is found, None while one is; answered: at the last check it was to answer,
    and whether it did; said: it did; lacks: the vehicle logs no further lack.
    """

    expiry_ms: int = 0
    surprises: int = 0
    found: bool = False
    last: int = 0
    since_ms: int | None = None
    answered: bool = True
    said: bool = False
    lacks: bool = False
    needed: bool = True

    @property
    def lack(self) -> tuple[bool, int]:
        """Whether none is found, and since when [ms], 0 if one is."""
        return self.since_ms is not None, self.since_ms or 0

    @property
    def surprised(self) -> bool:
        """Whether something became known since the last certificate, or there was none since the takeover."""
        return not self.found or self.surprises != self.last

    def held(self, taken: bool, at_check: bool) -> None:
        """Process a `GateState`. taken: ICAROUS has taken the vehicle; at_check: at the time of the last check, so that
        it has to answer that one.
        """
        if taken:
            self.lacks = False
        if taken and at_check:
            self.answered = self.said

    def changed(self, body: Any, checked_ms: int) -> None:
        """Process a `HandState`. checked_ms: time of the last check: what comes at that time is its answer."""
        kind = body.Change.name
        if kind != "Refused":
            self.expiry_ms = body.Expiry
        self.surprises = body.Surprises
        if kind == "Offered":
            self.lacks = False
        if not in_time(body.Time, checked_ms, 0) or kind not in (*FOUND, "Missing"):
            return
        self.answered = self.said = True
        if kind == "Missing":
            self.lacks = True
        if not self.needed:
            return
        if kind in FOUND:
            self.found, self.last, self.since_ms = True, body.Surprises, None
        elif self.since_ms is None:
            self.since_ms = checked_ms

    def passed(self, checked_ms: int, wrong: list[tuple[int, str]]) -> None:
        """A heartbeat is over: without an answer, a lack that is logged goes on, or must be one of those not logged."""
        if self.answered or self.since_ms is not None or not self.needed:
            return
        if self.lacks:
            self.since_ms = checked_ms
        else:
            wrong.append((checked_ms, "neither a certificate nor the lack of one is logged"))

    def began(self, flies: bool, on_ground: bool) -> None:
        """A heartbeat begins. flies: ICAROUS has the vehicle; on_ground: it needs no certificate."""
        self.answered, self.needed, self.said = not flies, not on_ground, False
        if on_ground:
            self.since_ms = None
        elif not flies:
            self.found, self.since_ms = False, None
