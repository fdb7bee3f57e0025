"""A day of simulated traffic through bus and message logger: no message lost, constant memory.

    python bench/day_of_traffic.py [--hours 24] [--vehicles 10] [--folder FOLDER] [--keep]

Each vehicle sends its state twice a second (24 h, 10 vehicles: 1,728,000 messages of
afrl.cmasi.AirVehicleState). A second service subscribes to them and answers once an hour, so that the
bus has deliveries to make. Afterwards the log is read again: every vehicle and time once, the digest, and
every hundredth message decoded and compared.
"""

from __future__ import annotations

import argparse
import math
import resource
import tempfile
import time
from pathlib import Path
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.services.bus import Bus
from cratous.services.logs.entry import to_object
from cratous.services.logs.message_logger import MessageLogger
from cratous.services.logs.sqlite_log import SqliteLog

STEP_MS = 500
PAGE_KB = resource.getpagesize() / 1024
HOUR_MS = 3_600_000


class Figures(NamedTuple):
    """The figures of a run; memory is resident [MB], rates are messages per second of CPU time."""

    sent: int
    logged: int
    cpu_s: float
    wall_s: float
    per_cpu_s: float
    memory_start_mb: float
    memory_tenth_mb: float
    memory_end_mb: float
    memory_peak_mb: float
    file_mb: float
    wal_peak_mb: float
    verify_cpu_s: float


class Hourly:
    """Counts states; sends a ServiceStatus for each hour of a vehicle's states."""

    name = "hourly"
    subscribes = ("afrl.cmasi.EntityState",)

    def start(self) -> int:
        return 0

    def handle(self, state: int, envelope: Any, now_ms: int) -> tuple[int, list[Any]]:
        said = [] if now_ms % HOUR_MS else [lmcp.new("ServiceStatus", PercentComplete=1.0)]
        return state + 1, said


def state_of(vehicle: int, time_ms: int) -> Any:
    """The state of a vehicle, on a circle of its own."""
    angle = time_ms / 1000 * 22.0 / 5000 + vehicle
    place = lmcp.new(
        "Location3D",
        Latitude=45.0 + 0.045 * math.sin(angle),
        Longitude=-120.0 + 0.1 * vehicle + 0.064 * math.cos(angle),
        Altitude=700.0 + 10 * vehicle,
        AltitudeType="MSL",
    )
    return lmcp.new(
        "AirVehicleState",
        ID=vehicle,
        Time=time_ms,
        Location=place,
        Heading=math.degrees(angle) % 360 - 180,
        Airspeed=22.0,
        Mode="Waypoint",
        CurrentWaypoint=time_ms // 60_000,
        AssociatedTasks=[1000 + vehicle],
    )


def resident_mb() -> float:
    """Memory of this process now."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * PAGE_KB / 1024


def traffic(folder: Path, hours: float, vehicles: int) -> Figures:
    """Run, then check the log; SystemExit if anything is missing or wrong."""
    bus = Bus(lmcp.full_names)
    bus.add(Hourly())
    logger = MessageLogger(folder, clock="virtual")
    bus.tap(logger.tap)
    path, steps = logger.log.path, int(hours * HOUR_MS / STEP_MS)
    wal = path.with_name(path.name + "-wal")
    before, tenth, wal_peak = resident_mb(), 0.0, 0
    cpu, wall, sent = time.process_time(), time.perf_counter(), 0
    for step in range(steps):
        bus.now_ms = step * STEP_MS
        for vehicle in range(vehicles):
            bus.publish(state_of(vehicle, bus.now_ms), "sim")
        sent += bus.run()
        if step == steps // 10:
            tenth = resident_mb()
        if step % 1000 == 0:
            wal_peak = max(wal_peak, wal.stat().st_size)
    logger.close()
    cpu, wall, end = time.process_time() - cpu, time.perf_counter() - wall, resident_mb()
    check = time.process_time()
    logged = verify(path, steps, vehicles)
    if logged != sent:
        raise SystemExit(f"{sent} messages were delivered, {logged} are in the log")
    return Figures(
        sent,
        logged,
        cpu,
        wall,
        sent / cpu,
        before,
        tenth,
        end,
        resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
        path.stat().st_size / 1e6,
        wal_peak / 1e6,
        time.process_time() - check,
    )


def verify(path: Path, steps: int, vehicles: int) -> int:
    """Check the content of the log; returns the number of messages."""
    count = states = 0
    with SqliteLog(path) as log:
        log.verify()
        if log.holes() or log.gaps() or log.closing() is None:
            raise SystemExit("the log is not whole")
        for entry in log.entries():
            count += 1
            if entry.topic != "afrl.cmasi.AirVehicleState":
                continue
            step, vehicle = divmod(states, vehicles)
            states += 1
            if entry.time_ms != step * STEP_MS:
                raise SystemExit(f"{entry.place}: {entry.time_ms} ms, not {step * STEP_MS}")
            # the codec rounds fields to 32 bits, so the comparison is with the rounded values
            if count % 100 == 0:
                wanted = lmcp.binary.unpack(lmcp.binary.pack(state_of(vehicle, entry.time_ms)))
                if to_object(entry) != wanted:
                    raise SystemExit(f"{entry.place} is not what was sent")
    if states != steps * vehicles:
        raise SystemExit(f"{states} states, not {steps * vehicles}")
    return count


def rows() -> list[tuple[str, float, str, float]]:
    """(what, CPU ns each, bound, ns each): twenty minutes of the day, compared with real time."""
    with tempfile.TemporaryDirectory() as folder:
        figures = traffic(Path(folder), 1 / 3, 10)
    what = "message through bus and logger, 10 vehicles at 2 Hz, log checked"
    return [(what, 1e9 / figures.per_cpu_s, "bar: as fast as they are said", 1e9 / 20)]


def main() -> None:
    """Print the figures of one run."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--hours", type=float, default=24.0)
    options.add_argument("--vehicles", type=int, default=10)
    options.add_argument("--folder", type=Path)
    options.add_argument("--keep", action="store_true", help="keep the log")
    given = options.parse_args()
    with tempfile.TemporaryDirectory(dir=given.folder) as made:
        folder = given.folder if given.keep and given.folder else Path(made)
        figures = traffic(folder, given.hours, given.vehicles)
    for name, value in figures._asdict().items():
        print(f"{name:16} {value:,.1f}" if isinstance(value, float) else f"{name:16} {value:,}")


if __name__ == "__main__":
    main()
