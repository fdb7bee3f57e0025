"""Plan, fly and judge the crossing, with the entries into kernels counted by the interpreter's profiler too.

Run in an interpreter of its own: CPython 3.11 may stand still where a profiler is set among other threads.
"""

from __future__ import annotations

import json
import sys
from collections import Counter
from pathlib import Path
from types import CodeType
from typing import Any

from cratous.core import ledger
from cratous.core.kernel import REGISTRY, Fold, qualified
from cratous.core.readings import exact as exact_reading
from cratous.core.readings.machine.compiled import Reading
from cratous.services.certify.evidence import Calls, counted
from cratous.services.cli import job
from cratous.services.flight.loop import fly
from cratous.services.loading import load
from cratous.services.logs.log import LogWriter
from cratous.services.monitor import Monitor

CROSSING = Path(__file__).parents[2] / "examples" / "crossing" / "mission.yaml"


def flown(folder: Path) -> str:
    """Plan, fly and judge the crossing; the digest of its log."""
    mission, bus = load(CROSSING), job.new_bus()
    with LogWriter(folder / "log.sqlite") as writer:
        bus.tap(writer.tap)
        plan, _ = job.plan_and_check(mission, bus)
        monitor = Monitor(mission, plan)
        bus.tap(monitor.tap)
        fly(mission, plan, bus)
        monitor.verdicts()
        return writer.digest()


def profiled(folder: Path) -> tuple[dict[str, Any], Counter[str], str]:
    """The counts of a flight, those of registered functions that the interpreter's profiler gives, and its digest."""
    ledger.load_all()
    codes = {
        e.function.__code__: name
        for name, e in REGISTRY.items()
        if not isinstance(e.function, Fold)
    }
    loops = {Fold.__call__.__code__: "self", Reading.__call__.__code__: "self"}
    scalar = exact_reading.exact.__code__
    seen: Counter[str] = Counter()
    looped = next(c for c in Calls.looped.__code__.co_consts if isinstance(c, CodeType))
    inside = 0

    def profile(frame: Any, event: str, _arg: Any) -> None:
        nonlocal inside
        code = frame.f_code
        if code is looped and event in ("call", "return"):
            if event == "call":
                seen[qualified(frame.f_locals["function"])] += 1
            inside += 1 if event == "call" else -1
        elif event != "call" or inside:
            return
        elif code in codes:
            seen[codes[code]] += 1
        elif code in loops:
            read = frame.f_locals["self"]
            seen[qualified(read if isinstance(read, Fold) else read.function)] += 1
        elif code is scalar:
            seen[qualified(frame.f_locals["function"])] += 1

    with counted() as calls:
        sys.setprofile(profile)
        try:
            digest = flown(folder)
        finally:
            sys.setprofile(None)
    return calls.data(), Counter({name: n for name, n in seen.items() if name in REGISTRY}), digest


if __name__ == "__main__":
    data, seen, digest = profiled(Path(sys.argv[1]))
    print(json.dumps([data, dict(seen), digest]))
