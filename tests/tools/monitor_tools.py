"""A mission of two vehicles, messages of its flight, and what the monitor says of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from mission_tools import must_fly, plain_mission, plain_vehicle

from cratous.bridge import lmcp
from cratous.services.monitor import Monitor
from cratous.spec.mission import Mission, Position, Vehicle
from cratous.spec.mission.plan import Plan, PlanItem


@dataclass
class Envelope:
    topic: str
    time_ms: int
    body: Any


def vehicle(number: int, protected: bool = True) -> Vehicle:
    return plain_vehicle(number, Position(0.0, 0.0, 100.0), protected)


def item(task: int, number: int, start: int, end: int) -> PlanItem:
    here = (Position(0.0, 0.0, 100.0),)
    return PlanItem(task, 1, number, here, here, None, 20.0, 0, start, 0, start, end, 0.0)


def mission(**more: Any) -> Mission:
    basis: dict[str, Any] = {
        "vehicles": (vehicle(1), vehicle(2)),
        "tasks": (must_fly(1, (10.0, 5000.0, 100.0)), must_fly(2, (50.0, 10000.0, 100.0))),
        "relations": ".(p1 p2)",
        "instances": (1, 2),
    }
    return plain_mission(**{**basis, **more})


PLAN = Plan(
    "test", (item(1, 1, 0, 1000), item(2, 2, 2000, 3000)), (), (1, 2), 3000, "MINMAX", 1, True
)


def watch(m: Mission, messages: list[tuple[int, Any]], **how: bool) -> dict[str, Any]:
    monitor = Monitor(m, PLAN, **how)
    for time_ms, body in sorted(messages, key=lambda m: m[0]):
        monitor.tap(Envelope(lmcp.full_names(body)[0], time_ms, body))
    return {v.requirement + (":" + v.item if v.item else ""): v for v in monitor.verdicts()}


def truth(number: int, ms: int, north: float, east: float, alt: float = 100.0) -> tuple[int, Any]:
    body = lmcp.new("TruthState", VehicleID=number, Time=ms, North=north, East=east, Altitude=alt)
    return ms, body


def progress(task: int, number: int, ms: int, phase: str) -> tuple[int, Any]:
    name = "cratous.TaskProgress"
    return ms, lmcp.new(name, TaskID=task, VehicleID=number, Time=ms, Phase=phase)


def beats(until: int, every: int = 500) -> list[tuple[int, Any]]:
    return [
        (ms, lmcp.new("Heartbeat", VehicleID=v, Time=ms, Direction=way, Sequence=ms // every))
        for ms in range(0, until + 1, every)
        for v in (1, 2)
        for way in ("Down", "Up")
    ]


def command(ms: int, sender: str, epoch: int, vehicle: int = 1) -> tuple[int, Any]:
    return ms, lmcp.new("GatedCommand", VehicleID=vehicle, Sender=sender, Epoch=epoch)


def done(until: int = 3000) -> list[tuple[int, Any]]:
    return [
        *(command(0, "UxAS", 0, vehicle=v) for v in (1, 2)),
        progress(1, 1, 0, "Active"),
        progress(1, 1, 1000, "Complete"),
        progress(2, 2, 2000, "Active"),
        progress(2, 2, 3000, "Complete"),
        (until, lmcp.new("MissionEnd", Time=until, Outcome="complete")),
    ]


def apart(until: int = 3000) -> list[tuple[int, Any]]:
    return [truth(v, ms, ms / 50, 5000.0 * v) for ms in range(0, until + 1, 250) for v in (1, 2)]
