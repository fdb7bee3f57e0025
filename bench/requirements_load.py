"""The cost of user-defined requirements: many at once, over long times, and in the report of a long run.

    python bench/requirements_load.py                a hundred requirements over ten vehicles that report at 10 Hz
    python bench/requirements_load.py --samples 10000000     memory over this many samples of one requirement
    python bench/requirements_load.py --report RUN   the time of `cratous certify RUN` with ten requirements

CPU time of one core; the states of the vehicles are LMCP messages, read as from a log.
"""

from __future__ import annotations

import argparse
import resource
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from table import on_one_core

from cratous.bridge import lmcp
from cratous.services.logs.entry import Entry
from cratous.services.requirements import language
from cratous.services.requirements.evaluation import Evaluation
from cratous.services.requirements.traces import rows_of_messages, wanted_of
from cratous.services.requirements.watch import Watch

TOPIC = "afrl.cmasi.AirVehicleState"
VEHICLES, FORMULAS, HZ, SECONDS = 10, 100, 10, 60
OF_ONE = (
    "altitude_{v} >= 90 m",
    "airspeed_{v} >= 35 kn and airspeed_{v} <= 68 kn",
    "roll_{v} > 25 deg implies eventually within 1 min roll_{v} <= 25 deg",
    "historically within 10 s altitude_{v} >= 80 m",
    "once within 2 min airspeed_{v} >= 20 m/s",
    "altitude_{v} < 200 m implies always within 5 s airspeed_{v} >= 18 m/s",
    "altitude_{v} >= 50 m since within 10 min airspeed_{v} >= 1 m/s",
    "eventually within 30 s roll_{v} <= 30 deg",
    "airspeed_{v} <= 40 m/s until within 20 s altitude_{v} >= 100 m",
    "not (altitude_{v} < 100 m and roll_{v} > 30 deg)",
)
"""Requirements for each vehicle."""


def text(vehicles: int = VEHICLES, kinds: tuple[str, ...] = OF_ONE) -> str:
    """The text of a requirements file: each kind for each vehicle."""
    lines = ["trace every 100 ms gap 1 s"]
    for v in range(1, vehicles + 1):
        for name, unit, field in (
            ("altitude", "m", "Location.Altitude"), ("airspeed", "m/s", "Airspeed"), ("roll", "deg", "Roll"),
        ):  # fmt: skip
            lines.append(f"signal {name}_{v}: {unit} from AirVehicleState[ID={v}].{field} hold 2 s")
        lines += [f"requirement R{v}.{k}: {one.format(v=v)}" for k, one in enumerate(kinds)]
    return "\n".join(lines) + "\n"


def entries(seconds: int, apart_ms: int) -> Iterator[Entry]:
    """States of all vehicles at 10 Hz; apart_ms: time offset between successive vehicles [ms]."""
    for k in range(seconds * HZ):
        for v in range(1, VEHICLES + 1):
            time_ms = k * 1000 // HZ + (v - 1) * apart_ms
            place = lmcp.new("Location3D", Latitude=45.0, Longitude=-120.0, Altitude=300.0 + k % 7)
            state = lmcp.new(
                "AirVehicleState", ID=v, Airspeed=22.0, Roll=float(k % 40 - 10), Location=place
            )
            yield Entry(k * VEHICLES + v, time_ms, "", TOPIC, lmcp.binary.pack(state))


def share(apart_ms: int) -> float:
    """CPU seconds per second of flight, for reading and judging the messages."""
    spec = language.read(text())
    watching = Watch(spec)
    there = list(entries(SECONDS, apart_ms))
    begun = time.process_time()
    rows = rows_of_messages(there, wanted_of(spec, watching.needed))
    taken = sum(1 for _ in watching.rows(rows))
    spent = time.process_time() - begun
    assert taken >= SECONDS * HZ
    return spent / SECONDS


def memory_mb() -> float:
    """Peak memory of this process so far [MB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3


def long_watch(samples: int) -> None:
    """Print the memory after a tenth of the samples, and after all of them."""
    formula = (
        language.read(
            "trace every 1 s\nsignal a, b: bool\nrequirement R: a implies eventually within 1000 s b"
        )
        .requirements[0]
        .formula
    )
    assert not isinstance(formula, Exception)
    evaluation = Evaluation(formula, blames=True)
    for k in range(samples):
        evaluation.sample(k * 10**9, {"a": float(k % 50 == 0), "b": float(k % 900 == 0)})
        if k + 1 in (samples // 10, samples):
            print(f"{k + 1:,} samples: {memory_mb():.1f} MB, {time.process_time():.0f} s of CPU")


def report(run: Path) -> None:
    """Print the time of `cratous certify RUN --requirements FILE` on a copy of a run's folder."""
    import shutil

    from cratous.services.cli import main

    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(shutil.copytree(run, Path(scratch) / "run"))
        file = Path(scratch) / "own.req"
        file.write_text(text(kinds=OF_ONE[:1]))
        for words in (["certify", folder], ["certify", folder, "--requirements", file]):
            begun, wall = time.process_time(), time.time()
            main([str(word) for word in words])
            print(f"{(words[2:] and 'with') or 'without'} requirements: {time.process_time() - begun:.1f} s of CPU, "
                  f"{time.time() - wall:.1f} s", file=sys.stderr)  # fmt: skip


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--samples", type=int)
    parser.add_argument("--report", type=Path)
    asked = parser.parse_args()
    on_one_core()
    if asked.samples:
        long_watch(asked.samples)
    elif asked.report:
        report(asked.report)
    else:
        for apart_ms in (0, 10):
            said = "at one instant" if apart_ms == 0 else f"{apart_ms} ms apart"
            print(
                f"{FORMULAS} requirements, {VEHICLES} vehicles at {HZ} Hz, {said}: {100 * share(apart_ms):.2f} % of a core"
            )
