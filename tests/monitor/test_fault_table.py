"""A table of broken flights, each with what must be found: which requirements, when, of whom, and who was in command.

One flight of two vehicles is clean: vehicle 1 is taken over and handed back, both tasks are flown in their order, between
fences. Each kind breaks it in one way. Requirements that a kind does not name must hold.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any, NamedTuple

import pytest
from mission_tools import must_fly
from monitor_tools import (
    PLAN,
    Envelope,
    apart,
    beats,
    command,
    done,
    mission,
    progress,
    truth,
    vehicle,
)

from cratous.bridge import lmcp
from cratous.services.certify.blame import blame_rows
from cratous.services.certify.verdicts import constraint_rows
from cratous.services.monitor import Monitor
from cratous.spec.mission import Change, Mission, Position, Task, TaskKind, Zone, ZoneKind, changes

Messages = list[tuple[int, Any]]
WIDE = Zone(1, ZoneKind.KEEP_IN, ((-900.0, -900.0), (-900.0, 2e4), (900.0, 2e4), (900.0, -900.0)), 0.0, 500.0)  # fmt: skip
THIN = Zone(2, ZoneKind.KEEP_OUT, ((200.0, 0.0), (200.0, 2e4), (200.1, 2e4), (200.1, 0.0)), 0.0, 500.0)  # fmt: skip
CLEAN = mission(zones=(WIDE, THIN))
U, I = "UxAS", "ICAROUS"  # noqa: E741
VIOLATED, UNKNOWN, EXCUSED = "violated", "unknown", "excused"


def gate(
    ms: int, owner: str, epoch: int, offered: bool = False, number: int = 1
) -> tuple[int, Any]:
    body = lmcp.new(
        "GateState", VehicleID=number, Time=ms, Owner=owner, Epoch=epoch, Offered=offered
    )
    return ms, body


def dropped(ms: int, epoch: int) -> tuple[int, Any]:
    return ms, lmcp.new("CommandDropped", VehicleID=1, Time=ms, Epoch=epoch)


def link(ms: int, alive: bool = False) -> tuple[int, Any]:
    return ms, lmcp.new("BridgeStatus", VehicleID=1, Time=ms, Alive=alive, Note="eof")


TAKEN = [gate(600, I, 1), command(600, I, 1)]
BACK = [gate(1800, I, 2, True), command(1900, U, 2), gate(1900, U, 2)]


def flight(
    without: Callable[[Any], bool] = lambda _: False, *more: Any, end_ms: int = 3000
) -> Messages:
    """The clean flight, without some messages and with some more."""
    whole = [*apart(end_ms), *beats(end_ms), *done(end_ms), *TAKEN, *BACK]
    kept = [one for one in whole if not without(one[1])]
    return sorted([*kept, *more], key=lambda one: (one[0], is_a("MissionEnd")(one[1])))


def is_a(kind: str, **wanted: Any) -> Callable[[Any], bool]:
    def found(body: Any) -> bool:
        said = {
            k: getattr(v, "name", v) for k in wanted if (v := getattr(body, k, None)) is not None
        }
        return type(body).__name__ == kind and said == wanted

    return found


def between(kind: str, first_ms: int, last_ms: int, **wanted: Any) -> Callable[[Any], bool]:
    return lambda body: is_a(kind, **wanted)(body) and first_ms <= body.Time <= last_ms


def elsewhere(number: int, *places: tuple[float, ...], end_ms: int = 3000) -> Messages:
    """A vehicle is at other places (ms, north, east, altitude)."""
    instants = {place[0] for place in places}
    gone = lambda body: is_a("TruthState", VehicleID=number)(body) and body.Time in instants  # noqa: E731
    return flight(gone, *(truth(number, int(p[0]), *p[1:]) for p in places), end_ms=end_ms)


def without(kind: str, *more: Any, **wanted: Any) -> Messages:
    return flight(is_a(kind, **wanted), *more)


class Kind(NamedTuple):
    """messages; wanted: verdict by requirement that must not hold; at_ms: when, None: no instant; who: who commanded
    each vehicle that is blamed for the first of them; of: the mission."""

    messages: Messages
    wanted: dict[str, str]
    at_ms: int | None
    who: dict[int, str]
    of: Mission = CLEAN


def other(**changed: Any) -> Mission:
    return replace(CLEAN, **changed)


def tasks(one: Task) -> Mission:
    return other(tasks=(one, CLEAN.tasks[1]))


LATE_ZONE = Zone(
    3, ZoneKind.KEEP_OUT, ((10.0, 4e3), (30.0, 4e3), (30.0, 6e3), (10.0, 6e3)), 0.0, 500.0
)
LINE = (Position(0.0, 5e3, 0.0), Position(100.0, 5e3, 0.0))
TABLE: dict[str, Kind] = {
    "keep-out crossed between two samples":
        Kind(elsewhere(1, (1000, 190, 5e3, 100), (1250, 210, 5e3, 100)), {"G1": VIOLATED}, 1000, {1: I}),
    "keep-out touched at a sample": Kind(elsewhere(1, (2500, 200, 5e3, 100)), {"G1": VIOLATED}, 2250, {1: U}),
    "keep-out entered from above":
        Kind(elsewhere(1, (2250, 200.05, 5e3, 600), (2500, 200.05, 5e3, 400), (2750, 200.05, 5e3, 600)),
             {"G1": VIOLATED}, 2000, {1: U}),
    "keep-in left to the side": Kind(elsewhere(2, (500, -901, 1e4, 100)), {"G1": VIOLATED}, 250, {2: U}),
    "keep-in left upwards": Kind(elsewhere(1, (750, 15, 5e3, 500.0)), {"G1": VIOLATED}, 500, {1: U}),
    "keep-in left downwards": Kind(elsewhere(1, (750, 15, 5e3, 0.0)), {"G1": VIOLATED}, 500, {1: U}),
    "zone that appears is not left":
        Kind(flight(), {"G1": VIOLATED}, 1000, {1: I}, other(changes=(Change(1000, changes.ZONE, zone=LATE_ZONE),))),
    "zone that appears ahead is entered":
        Kind(elsewhere(2, (2500, 20, 5900, 100)), {"G1": VIOLATED, "G2": VIOLATED}, 2250, {2: U},
             other(changes=(Change(2000, changes.ZONE, zone=LATE_ZONE),))),
    "order broken by 1 ms":
        Kind(without("TaskProgress", progress(1, 1, 2001, "Complete"), TaskID=1, Phase="Complete"),
             {"G1": VIOLATED}, 2000, {1: U, 2: U}),
    "task begins before the one that it waits for ends":
        Kind(without("TaskProgress", progress(2, 2, 900, "Active"), TaskID=2, Phase="Active"),
             {"G1": VIOLATED}, 900, {1: I, 2: U}),
    "task begins though the one that it waits for never did":
        Kind(without("TaskProgress", TaskID=1), {"G1": VIOLATED, "G3": VIOLATED}, 2000, {1: U, 2: U}),
    "task ends before it began":
        Kind(without("TaskProgress", progress(2, 2, 1500, "Complete"), TaskID=2, Phase="Complete"),
             {"G1": VIOLATED}, 2000, {1: U, 2: U}),
    "task flown by one that may not":
        Kind(without("TaskProgress", progress(1, 2, 0, "Active"), progress(1, 2, 1000, "Complete"), TaskID=1),
             {"G1": VIOLATED, "G3": VIOLATED}, None, {2: U}, tasks(must_fly(1, (10.0, 5e3, 100.0), eligible=(1,)))),
    "second vehicle on a task of another":
        Kind(flight(lambda _: False, progress(1, 2, 500, "Active")), {"G1": VIOLATED}, None, {1: U, 2: U},
             tasks(must_fly(1, (10.0, 5e3, 100.0), eligible=(1,)))),
    "task beside the choice":
        Kind(flight(lambda _: False, (50, lmcp.new("PlanAccepted", Time=50, Tasks=[1]))), {"G1": VIOLATED}, None, {1: U, 2: U},
             other(relations="+(p1 p2)")),
    "task not completed": Kind(without("TaskProgress", TaskID=2, Phase="Complete"),
                               {"G1": UNKNOWN, "G3": VIOLATED}, None, {1: U, 2: U}),
    "task failed":
        Kind(without("TaskProgress", progress(2, 2, 3000, "Failed"), TaskID=2, Phase="Complete"),
             {"G1": UNKNOWN, "G3": VIOLATED}, None, {1: U, 2: U}),
    "waypoint skipped": Kind(flight(), {"G3": VIOLATED}, 1000, {1: I}, tasks(must_fly(1, (10.0, 5060.0, 100.0)))),
    "line not seen": Kind(flight(), {"G3": VIOLATED}, 1000, {1: I}, tasks(Task(1, TaskKind.LINE_SEARCH, "", LINE))),
    "loiter too short":
        Kind(flight(), {"G3": VIOLATED}, 1000, {1: I},
             tasks(Task(1, TaskKind.LOITER, "", LINE[:1], duration_ms=2000, radius_m=100.0))),
    "mission given up":
        Kind(without("MissionEnd", (3000, lmcp.new("MissionEnd", Time=3000, Outcome="time limit"))), {"G3": VIOLATED}, 3000, {1: U, 2: U}),
    "well clear lost between two samples":
        Kind(elsewhere(2, (1000, 20, 5300, 100), (1250, 25, 4700, 100)), {"G2": VIOLATED}, 750, {1: I, 2: U}),
    "well clear lost by time alone":
        Kind(elsewhere(2, *((ms, 50 + ms / 50, 5260 - ms / 40, 100) for ms in range(0, 3001, 250))), {"G2": VIOLATED, "G3": VIOLATED},
             0, {1: U, 2: U}),
    "traffic appears too near: no way out":
        Kind(flight(lambda _: False, *(truth(9, ms, ms / 50 + 60, 5e3) for ms in (2000, 2250, 2500))),
             {"G2": EXCUSED}, 2000, {1: U}),
    "well clear lost in altitude alone, to traffic that appears":
        Kind(flight(lambda _: False, truth(9, 2000, 40, 5e3, 140), truth(9, 2250, 45, 5e3, 125)), {"G2": EXCUSED}, 2000, {1: U}),
    "two commanders: a stale command is flown":
        Kind(flight(lambda _: False, command(700, U, 0)), {"G4": VIOLATED}, 1800, {1: I}),
    "a command with authority is dropped":
        Kind(flight(lambda _: False, command(300, U, 0), dropped(300, 0)), {"G4": VIOLATED}, 300, {1: U}),
    "forged epoch that is flown":
        Kind(flight(lambda _: False, command(700, U, 10**14)), {"G4": VIOLATED}, 1800, {1: I}),
    "command of ICAROUS after it has handed back":
        Kind(flight(lambda _: False, command(2000, I, 1), command(2100, U, 2)), {"G4": VIOLATED}, 2100, {1: U}),
    "takeover without a new epoch": Kind(without("GateState", gate(600, I, 0), Time=600), {"G4": VIOLATED}, 600, {1: I}),
    "epoch goes back": Kind(without("GateState", gate(1900, U, 1), Time=1900), {"G4": VIOLATED}, 1900, {1: U}),
    "epoch skipped": Kind(without("GateState", gate(1800, I, 3, True), Time=1800), {"G4": VIOLATED}, 1800, {1: I}),
    "handed back without an offer": Kind(without("GateState", Offered=True), {"G4": VIOLATED}, 1900, {1: U}),
    "handback accepted, the gate does not change":
        Kind(without("GateState", Time=1900), {"G4": VIOLATED}, 3000, {1: I}),
    "takeover never handed back": Kind(flight(lambda b: any(b is m[1] for m in BACK)), {"G4": VIOLATED}, 3000, {1: I}),
    "takeover open at a link that is declared down":
        Kind(flight(lambda b: any(b is m[1] for m in BACK), link(900)), {"G4": UNKNOWN, "G5": VIOLATED}, 600, {1: I}),
    "no command at all": Kind(without("GatedCommand", VehicleID=2), {"G4": UNKNOWN}, None, {2: U}),
    "heartbeats to ICAROUS stop":
        Kind(flight(between("Heartbeat", 800, 2300, Direction="Down", VehicleID=1)), {"G5": VIOLATED}, 2500, {1: U}),
    "heartbeats of ICAROUS stop":
        Kind(flight(between("Heartbeat", 800, 2300, Direction="Up", VehicleID=2)), {"G5": VIOLATED}, 2500, {2: U}),
    "heartbeats never came": Kind(without("Heartbeat", Direction="Up", VehicleID=1), {"G5": VIOLATED}, 0, {1: U}),
    "stale heartbeats in place of new ones":
        Kind(flight(between("Heartbeat", 800, 2300), *((ms, lmcp.new("Heartbeat", VehicleID=v, Time=ms, Direction=way, Sequence=1))
             for ms in (1000, 1500, 2000) for v in (1, 2) for way in ("Down", "Up"))), {"G5": VIOLATED}, 2500, {1: U}),
    "messages stop before the end":
        Kind(without("MissionEnd"), dict.fromkeys(("G1", "G2", "G3", "G4", "G5"), UNKNOWN), None, {1: U}),
    "a vehicle is not seen for a while":
        Kind(flight(between("TruthState", 1000, 1500, VehicleID=2)), {"G1": UNKNOWN, "G2": UNKNOWN}, None, {2: U}),
    "a vehicle is never seen":
        Kind(without("TruthState", VehicleID=2), dict.fromkeys(("G1", "G2", "G3"), UNKNOWN), None, {2: U}),
    "a sample is missing":
        Kind(flight(between("TruthState", 1250, 1250)), {"G1": UNKNOWN, "G2": UNKNOWN}, None, {1: U}),
    "a vehicle of the mission of which nothing comes":
        Kind(flight(), dict.fromkeys(("G1", "G2", "G4", "G5"), UNKNOWN), None, {3: U},
             other(vehicles=(*CLEAN.vehicles, vehicle(3)))),
}  # fmt: skip


def judged(kind: Kind) -> Monitor:
    monitor = Monitor(kind.of, PLAN)
    for ms, body in kind.messages:
        monitor.tap(Envelope(lmcp.full_names(body)[0], ms, body))
    return monitor


def summary(monitor: Monitor) -> dict[str, str]:
    return {v.requirement: str(v.outcome) for v in monitor.verdicts() if not v.item}


def first(monitor: Monitor, wanted: Iterable[str]) -> dict[str, Any]:
    """The first row of blame on what must not hold; violated before unknown."""
    rows = constraint_rows(monitor.verdicts(), "flight")
    found = blame_rows(rows, monitor.commands(), monitor.assumptions(), monitor.end_ms)
    mine = [one for one in found if one["requirement"] == min(wanted)]
    return min(mine, key=lambda one: one["verdict"] != VIOLATED)


def test_the_clean_flight_holds() -> None:
    assert summary(judged(Kind(flight(), {}, None, {}))) == dict.fromkeys(
        ("G1", "G2", "G3", "G4", "G5"), "holds"
    )
    assert len(TABLE) >= 40


@pytest.mark.parametrize("name", TABLE)
def test_a_broken_flight_is_found_with_requirement_instant_and_command(name: str) -> None:
    kind = TABLE[name]
    monitor = judged(kind)
    bad = {k: v for k, v in summary(monitor).items() if v != "holds"}
    blamed = first(monitor, kind.wanted)
    who = {one["vehicle"]: one["side"] for one in blamed["command"]}
    assert (bad, blamed["time_ms"], who) == (kind.wanted, kind.at_ms, kind.who), blamed
