"""The speed of the simulator: dynamics and messages (packed LMCP) of 2 and 50 aircraft, one core.

    python bench/simulator.py SCENARIO.xml      a scenario with at least one aircraft

The aircraft of the scenario are copied under other ids, with their commands.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Any

from cratous.services.simulator.scenario import read
from cratous.services.simulator.server import frame_payload
from cratous.services.simulator.world import Event, World

SECONDS = 120.0
GOALS = {2: 1000, 50: 50}


def copies(events: list[Event], count: int) -> list[Event]:
    """The events of the scenario's first aircraft, for `count` copies of them."""
    first = next(e.body.ID for e in events if type(e.body).__name__ == "AirVehicleConfiguration")
    return [
        event._replace(body=_named(event.body, first, k + 1))
        for event in events
        for k in range(count)
        if first in (getattr(event.body, "ID", None), getattr(event.body, "VehicleID", None))
    ]


def _named(body: Any, first: int, number: int) -> Any:
    field = "ID" if getattr(body, "ID", None) == first else "VehicleID"
    return body.copy(**{field: number})


def main(path: str) -> int:
    """Print the speed as a multiple of real time; returns 1 if a target is missed."""
    events, missed = read(Path(path)).events, 0
    for count, goal in GOALS.items():
        world = World(copies(events, count), 1e9)
        began_s = time.process_time()
        told = 0
        while world.time_s < SECONDS:
            told += sum(len(frame_payload(body)) for body in world.tick())
        rate = world.time_s / (time.process_time() - began_s)
        missed += rate < goal
        print(f"{count:3} aircraft: {rate:6.0f} times real time (goal {goal}), {told} bytes told")
    return int(missed > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
