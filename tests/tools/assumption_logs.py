"""One flight with traffic, its log changed by hand, and what the watches of the assumptions say of that."""

from __future__ import annotations

import copy
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

from flight_tools import meeting
from tampering import Log

from cratous.bridge import lmcp
from cratous.services.bus import Bus, Envelope
from cratous.services.flight.loop import fly
from cratous.services.monitor import Monitor
from cratous.services.pipeline.plan import make_plan
from cratous.spec.mission import Mission, Simulation

LIMIT_MS = 400_000
Change = Callable[[Log], None]


@cache
def flown(mission: Mission) -> tuple[Envelope, ...]:
    bus, log = Bus(lmcp.full_names), list[Any]()
    bus.tap(log.append)
    fly(mission, make_plan(mission), bus)
    return tuple(log)


WHOLE = replace(meeting(), simulation=Simulation(limit_ms=LIMIT_MS))
"""It ends long before its limit."""


planned = cache(make_plan)


def judged(mission: Mission, messages: Log) -> dict[str, dict[str, Any]]:
    monitor = Monitor(mission, planned(mission))
    for one in messages:
        monitor.tap(one)
    return {row["name"]: row for row in monitor.assumptions()}


def tampered(change: Change) -> dict[str, dict[str, Any]]:
    log = [copy.copy(one) for one in flown(WHOLE)]
    change(log)
    return judged(WHOLE, log)
