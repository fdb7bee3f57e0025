"""What a service gets when it is made: the host. And the clock that the host's loop follows."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from cratous.bridge import lmcp
from cratous.services.bus import Bus, Envelope, Identity
from cratous.services.uxas.logs import Logs

STATE = "afrl.cmasi.EntityState"


class Clock:
    """Milliseconds since the start: of the machine, or as the entities' states tell.

    With Test_SimulationTime on the bus time is discrete: it stands at 0 until a state says
    otherwise, and never goes back. A leap of more than an hour, or back by more than ten seconds
    (another simulation, an absolute date), is no time that passes: the clock goes on from where it
    stands, and what follows counts from the new origin.
    """

    LEAP_MS = 3_600_000
    BACK_MS = 10_000

    def __init__(self, monotonic: Callable[[], float] = time.monotonic) -> None:
        self._monotonic = monotonic
        self._zero_s = monotonic()
        self.discrete = False
        self._told_ms = 0
        self._heard_ms = 0  # the time that a state told last, whatever its origin

    def real_s(self) -> float:
        """Seconds of the machine since the start."""
        return self._monotonic() - self._zero_s

    def now_ms(self) -> int:
        """The time that the services see [ms]."""
        return self._told_ms if self.discrete else int(1000 * self.real_s())

    def tell(self, time_ms: int) -> bool:
        """A state says what time it is [ms]; False if that was a leap."""
        step = time_ms - self._heard_ms
        if step in range(-self.BACK_MS, 1):
            return True  # the states of several vehicles come one after the other
        self._heard_ms = time_ms
        if step not in range(1, self.LEAP_MS + 1):
            return False
        self._told_ms += step
        return True


@dataclass
class Host:
    """The process that a service lives in: bus, loggers, clock, who and where it is.

    shared: what services of one process have in common (what is known, ids given), by name.
    """

    bus: Bus
    log: Logs
    clock: Clock
    entity_id: int
    entity_type: str
    config: Path
    root: dict[str, Any] = field(default_factory=dict)
    shared: dict[str, Any] = field(default_factory=dict)
    say: Callable[[str], None] = print

    def arrived(self, envelope: Envelope) -> None:
        """Queue a message from outside. With Test_SimulationTime a state comes at the time that it tells, and
        what has come before it at the time before, however many come at once."""
        if self.clock.discrete and STATE in lmcp.full_names(envelope.body):
            self.bus.run_until(self.clock.now_ms())
            self.tell(envelope.body, "Test_SimulationTime")
            self.bus.run_until(self.clock.now_ms())
        self.bus.put(envelope)

    def tell(self, body: Any, name: str) -> None:
        """A state tells the clock what time it is; a leap is logged. name: of the service that says so."""
        if not self.clock.tell(body.Time):
            self.log(
                "WARN",
                f"{name}: time leaps to {body.Time} ms in the state of {body.ID}; the clock goes on from "
                "where it stands",
            )

    def identity(self, service_id: int, group: str = "") -> Identity:
        """The wire identity of a service of this process."""
        return Identity(self.entity_id, service_id, group)
