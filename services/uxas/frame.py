"""The host that each service receives when created, and the clock of the host's loop."""

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
    """Milliseconds since the start: of the machine's clock, or from entity states.

    With Test_SimulationTime on the bus, time is discrete: it stays at 0 until a state gives
    another, and never decreases. A jump of more than an hour, or back by more than ten seconds
    (another simulation, an absolute date), does not count as elapsed time: the clock continues from
    its value, and later times count from the new origin.
    """

    LEAP_MS = 3_600_000
    BACK_MS = 10_000

    def __init__(self, monotonic: Callable[[], float] = time.monotonic) -> None:
        self._monotonic = monotonic
        self._zero_s = monotonic()
        self.discrete = False
        self._told_ms = 0
        self._heard_ms = 0  # the last time reported by a state, whatever its origin

    def real_s(self) -> float:
        """Seconds of the machine's clock since the start."""
        return self._monotonic() - self._zero_s

    def now_ms(self) -> int:
        """The time seen by the services [ms]."""
        return self._told_ms if self.discrete else int(1000 * self.real_s())

    def tell(self, time_ms: int) -> bool:
        """Process the time of a state [ms]; False if it was a jump."""
        step = time_ms - self._heard_ms
        if step in range(-self.BACK_MS, 1):
            return True  # states of several vehicles arrive one after the other
        self._heard_ms = time_ms
        if step not in range(1, self.LEAP_MS + 1):
            return False
        self._told_ms += step
        return True


@dataclass
class Host:
    """The process that contains a service: bus, loggers, clock, and identity.

    shared: objects common to the services of a process (world state, ids), by name.
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
        """Queue a message from outside. With Test_SimulationTime a state takes effect at its own
        time, and messages received before it at the previous time, however many arrive at once.
        """
        if self.clock.discrete and STATE in lmcp.full_names(envelope.body):
            self.bus.run_until(self.clock.now_ms())
            self.tell(envelope.body, "Test_SimulationTime")
            self.bus.run_until(self.clock.now_ms())
        self.bus.put(envelope)

    def tell(self, body: Any, name: str) -> None:
        """Pass the time of a state to the clock; a jump is logged. name: of the reporting service."""
        if not self.clock.tell(body.Time):
            self.log(
                "WARN",
                f"{name}: time leaps to {body.Time} ms in the state of {body.ID}; the clock goes on from "
                "where it stands",
            )

    def identity(self, service_id: int, group: str = "") -> Identity:
        """The wire identity of a service of this process."""
        return Identity(self.entity_id, service_id, group)
