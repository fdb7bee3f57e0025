"""Whether protected vehicles fly in real time on one core, with bands for each once a second.

    python bench/protected_vehicles.py [--vehicles 50] [--seconds 30] [--no-bands]

Half of the vehicles fly east and half north, on lanes that cross at one altitude, each to its own destination; each
has an ICAROUS instance behind the bridge, and a detection service of UxAS that computes its bands against all others.
The flight is that of `cratous run` and `cratous serve`: bus, sockets, log, heartbeats twice a second. Measured is the
CPU time of the process: per second of flight, and per heartbeat with everything it triggers; a heartbeat that takes
more than its period would be late even on an idle core. Planning, which precedes the flight, is reported separately
and not counted, nor is a flight of two seconds in which everything is compiled or loaded.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from cratous.bridge import lmcp
from cratous.services.bus import Bus, Envelope
from cratous.services.flight.loop import fly
from cratous.services.logs.message_logger import MessageLogger
from cratous.services.pipeline.plan import make_plan
from cratous.services.uxas.daidalus.detection import DaidalusDetection
from cratous.spec.daa.presets import preset
from cratous.spec.mission import Daa, Frame, Mission, Position, Task, TaskKind, Vehicle, WellClear
from cratous.spec.mission.plan import Plan

APART_M = 600.0
BANDS_MS = 1000
SPEED_M_S = 22.0


class Figures(NamedTuple):
    """CPU seconds per second of flight; times of its heartbeats [ms]: mean, 95th percentile, maximum; number of
    heartbeats longer than their period; bands sent; takeovers."""

    share: float
    mean_ms: float
    p95_ms: float
    most_ms: float
    late: int
    beats: int
    bands: int
    takeovers: int


def mission(count: int) -> Mission:
    """`count` vehicles on crossing lanes, the first half eastward."""
    vehicles, tasks = [], []
    for k in range(count):
        lane, first = APART_M * (k % ((count + 1) // 2)), k < (count + 1) // 2
        back, goal = -1000.0, 9000.0
        here = (lane, back) if first else (back, lane)
        there = (lane, goal) if first else (goal, lane)
        heading = np.pi / 2 if first else 0.0
        vehicles.append(
            Vehicle(
                id=k + 1,
                label=f"v{k + 1}",
                position=Position(*here, 300.0),
                heading_rad=float(heading),
                speed_m_s=SPEED_M_S,
                min_speed_m_s=15.0,
                max_speed_m_s=33.0,
                max_bank_rad=float(np.radians(30.0)),
                max_climb_m_s=5.0,
                protected=True,
            )
        )
        tasks.append(
            Task(
                k + 1, TaskKind.MUST_FLY, f"t{k + 1}", (Position(*there, 300.0),), eligible=(k + 1,)
            )
        )
    return Mission(
        name="lanes that cross",
        source="",
        frame=Frame(37.1, -76.4),
        vehicles=tuple(vehicles),
        tasks=tuple(tasks),
        daa=Daa(WellClear(150.0, 30.0, 15.0, 0.0)),
        instances=tuple(range(1, count + 1)),
    )


def say(text: str) -> None:
    """Print the current step, with the CPU time so far."""
    print(f"{time.process_time():7.1f} s of CPU: {text}", flush=True)


def measured(count: int, seconds: float, bands: bool) -> Figures:
    """Plan, fly two seconds, then fly `seconds`."""
    whole = mission(count)
    say(f"planning {count} vehicles")
    plan = make_plan(whole)
    say("the first two seconds of flight, not counted")
    flown(whole, plan, 2.0, bands, lambda _now_ms, _text: None)
    say(f"{seconds:g} s of flight")
    return flown(
        whole, plan, seconds, bands, lambda now_ms, text: say(f"{now_ms / 1000:g} s {text}")
    )


def flown(
    whole: Mission, plan: Plan, seconds: float, bands: bool, tell: Callable[[int, str], None]
) -> Figures:
    """Fly for `seconds`, with a log in a temporary folder; tell(time [ms], status text) is called now and then."""
    count = len(whole.vehicles)
    limited = replace(whole.simulation, limit_ms=round(1000 * seconds))
    whole = replace(whole, simulation=limited)
    beat_ms, spent = limited.heartbeat_ms, list[float]()
    with tempfile.TemporaryDirectory() as folder:
        bus, found, begun = Bus(lmcp.full_names), [0], [0, time.process_time()]
        logger = MessageLogger(Path(folder), clock="virtual")
        bus.tap(logger.tap)
        parameters = preset("do_365b").parameters
        for k in range(count if bands else 0):
            bus.add(DaidalusDetection(f"bands {k + 1}", k + 1, parameters, BANDS_MS))

        def tap(envelope: Envelope) -> None:
            found[0] += type(envelope.body).__name__ == "WellClearViolationIntervals"
            if envelope.time_ms // beat_ms > begun[0]:  # the first message of the next heartbeat
                now_s = time.process_time()
                spent.append(1000 * (now_s - begun[1]))
                begun[:] = envelope.time_ms // beat_ms, now_s

        bus.tap(tap)
        first_s = time.process_time()
        begun[1] = first_s
        result = fly(whole, plan, bus, progress=tell)
        total_s = time.process_time() - first_s
        logger.close()
    times = np.array(spent)
    return Figures(
        total_s / (result.end_ms / 1000),
        float(times.mean()),
        float(np.percentile(times, 95)),
        float(times.max()),
        int((times > beat_ms).sum()),
        len(times),
        found[0],
        result.takeovers,
    )


def main() -> int:
    """Print the figures; returns 1 if a second of flight takes more than a second, or a heartbeat more than its
    period."""
    asked = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    asked.add_argument("--vehicles", type=int, default=50)
    asked.add_argument("--seconds", type=float, default=30.0)
    asked.add_argument("--no-bands", action="store_true")
    how = asked.parse_args()
    got = measured(how.vehicles, how.seconds, not how.no_bands)
    print(f"{how.vehicles} protected vehicles, {how.seconds:g} s, {got.takeovers} takeovers:")
    print(
        f"  {100 * got.share:.0f} % of a core (goal 100), {1 / got.share:.2f} s of flight a second of CPU; "
        f"{got.bands} bands"
    )
    print(f"  heartbeat: mean {got.mean_ms:.0f}, 95 % {got.p95_ms:.0f}, most {got.most_ms:.0f} ms")
    print(f"  late: {got.late} of {got.beats}")
    return int(got.share > 1 or got.late > 0)


if __name__ == "__main__":
    sys.exit(main())
