"""Logs of messages for tests: written, read, copied into other formats; a disk that is full."""

from __future__ import annotations

import resource
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from cratous.bridge import lmcp
from cratous.services.logs.entry import Entry
from cratous.services.logs.export import export
from cratous.services.logs.selection import Selection
from cratous.services.logs.source import open_log
from cratous.services.logs.store import LogStore

STATE = "afrl.cmasi.AirVehicleState"
UNKNOWN = b"LMCP\0\0\0\x0f\x01NOBODY\0\0\0\0\0\x07\0\x01\0\0\0\0"


def state(vehicle: int, k: int) -> object:
    place = lmcp.new("Location3D", Latitude=45.0 + k / 1000, Longitude=-120.0, Altitude=700.0)
    return lmcp.new(
        "AirVehicleState", ID=vehicle, Time=500 * k, Location=place, Airspeed=22.5, Mode="Loiter"
    )


def entries() -> Iterator[Entry]:
    """States of two vehicles as bytes, a command as JSON, an envelope, and a type nobody knows."""
    seq = 0
    for k in range(6):
        for vehicle in (400, 500):
            body = lmcp.binary.pack(state(vehicle, k))
            yield Entry(seq, 500 * k, "sim", STATE, body, None, None, "100", "66")
            seq += 1
    command = lmcp.new("MissionCommand", CommandID=7, VehicleID=400, FirstWaypoint=1)
    yield Entry(seq, 3000, "uxas", "afrl.cmasi.MissionCommand", lmcp.to_json(command))
    status = lmcp.new(
        "ServiceStatus", Info=[lmcp.new("KeyValuePair", Key="ä <&> €", Value='"quoted", 1')]
    )
    yield Entry(
        seq + 1, 3100, "uxas", "afrl.cmasi.ServiceStatus", lmcp.binary.pack(status),
        "eid100.sid5", "ground", "100", "7",
    )  # fmt: skip
    report = lmcp.new("WeatherReport", WindSpeed=float("nan"))
    yield Entry(seq + 2, 3200, "w", "afrl.cmasi.WeatherReport", lmcp.to_json(report))
    yield Entry(seq + 3, 3300, "other", "unknown.NOBODY.7", UNKNOWN)


def write(path: Path, made: list[Entry], **meta: object) -> Path:
    with LogStore(path, every_s=None, **meta) as store:
        for entry in made:
            store.keep(entry)
    return path


def read(path: Path, selection: Selection | None = None) -> list[Entry]:
    with open_log(path) as source:
        return list(source.entries(selection))


def copy(log: Path, name: str, form: str, **options: bool) -> Path:
    target = log.with_name(name)
    with open_log(log) as source:
        export(source, target, form, **options)
    return target


@contextmanager
def full_disk(limit_bytes: int) -> Iterator[None]:
    """Files of this process may not grow beyond limit_bytes: a disk that is full.

    Not a fixture: pytest itself must be able to write between the phases of a test.
    """
    old = resource.getrlimit(resource.RLIMIT_FSIZE)
    ignored = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit_bytes, old[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, old)
        signal.signal(signal.SIGXFSZ, ignored)
