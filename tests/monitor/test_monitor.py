"""The monitor: each guarantee's violation is seen, named, timed and measured; unknown stays so."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import pytest

from cratous.bridge import lmcp
from cratous.services.monitor import Monitor
from cratous.spec.mission import (
    Daa,
    FaultySimulation,
    Frame,
    Mission,
    Position,
    Task,
    TaskKind,
    Vehicle,
    WellClear,
    Zone,
    ZoneKind,
)
from cratous.spec.mission.bridge_faults import BridgeFaults
from cratous.spec.mission.guarantees import Outcome
from cratous.spec.mission.plan import Plan, PlanItem


@dataclass
class Envelope:
    topic: str
    time_ms: int
    body: Any


def vehicle(number: int, protected: bool = True) -> Vehicle:
    at = Position(0.0, 0.0, 100.0)
    return Vehicle(number, "", at, 0.0, 20.0, 15.0, 30.0, 0.5, 5.0, protected)


def item(task: int, number: int, start: int, end: int) -> PlanItem:
    here = (Position(0.0, 0.0, 100.0),)
    return PlanItem(task, 1, number, here, here, None, 20.0, 0, start, 0, start, end, 0.0)


def mission(**more: Any) -> Mission:
    basis: dict[str, Any] = {
        "name": "test",
        "source": "",
        "frame": Frame(45.0, -121.0),
        "vehicles": (vehicle(1), vehicle(2)),
        "tasks": (
            Task(1, TaskKind.MUST_FLY, "", (Position(10.0, 5000.0, 100.0),)),
            Task(2, TaskKind.MUST_FLY, "", (Position(50.0, 10000.0, 100.0),)),
        ),
        "daa": Daa(WellClear(100.0, 30.0, 10.0, 0.0)),
        "relations": ".(p1 p2)",
        "instances": (1, 2),
    }
    return Mission(**{**basis, **more})


PLAN = Plan(
    "test", (item(1, 1, 0, 1000), item(2, 2, 2000, 3000)), (), (1, 2), 3000, "MINMAX", 1, True
)


def watch(m: Mission, messages: list[tuple[int, Any]]) -> dict[str, Any]:
    monitor = Monitor(m, PLAN)
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


def test_a_good_flight_holds_in_everything():
    seen = watch(mission(), [*apart(), *beats(3000), *done()])
    assert {k: v.outcome for k, v in seen.items() if v.outcome is not Outcome.HOLDS} == {}
    assert seen["G2"].checks == 12


def test_loss_of_well_clear_between_two_samples_is_seen():
    # 600 m apart at both samples, through each other in between
    fast = [
        truth(1, 0, -300, 0),
        truth(2, 0, 300, 0),
        truth(1, 250, 300, 0),
        truth(2, 250, -300, 0),
    ]
    verdict = watch(mission(), [*fast, *beats(3000), *done()])["G2"]
    assert verdict.outcome is Outcome.VIOLATED
    assert verdict.vehicles == (1, 2)
    assert verdict.time_ms == 0
    assert "no evidence that no way out existed" in verdict.note
    assert verdict.margin == -100, "headed for each other: a miss by 0 m, DTHR is 100 m"


def test_a_loss_by_modified_tau_has_no_positive_margin():
    # 250 m apart, closing at 40 m/s, headed for a miss by 60 m: lost by time, never near
    on_the_way = [
        at
        for ms, gap in ((0, 250.0), (250, 240.0))
        for at in (truth(1, ms, 0, 0), truth(2, ms, gap, 60))
    ]
    verdict = watch(mission(), [*on_the_way, *beats(3000), *done()])["G2"]
    assert verdict.outcome is Outcome.VIOLATED
    assert verdict.margin == pytest.approx(-40)
    assert "headed for a miss by 60.0 m; nearest 247.4 m" in verdict.note


def test_traffic_counts_and_an_unprotected_vehicle_is_not_covered():
    m = mission(vehicles=(vehicle(1), vehicle(2, protected=False)))
    near = [truth(2, ms, 0, 0) for ms in (0, 250)] + [truth(9, ms, 10, 0) for ms in (0, 250)]
    assert watch(m, [*near, *apart(), *done()])["G2"].outcome is Outcome.HOLDS
    near = [truth(1, ms, 0, 0) for ms in (0, 250)] + [truth(9, ms, 10, 0) for ms in (0, 250)]
    assert watch(m, sorted([*near, *done()], key=lambda x: x[0]))["G2"].vehicles == (1, 9)
    assert Monitor(m, PLAN).not_covered == (2,)


def test_entering_a_keep_out_between_samples_is_seen():
    zone = Zone(
        7, ZoneKind.KEEP_OUT, ((10.0, -5.0), (12.0, -5.0), (12.0, 5.0), (10.0, 5.0)), 0.0, 500.0
    )
    flight = [truth(1, 0, 0, 0), truth(1, 250, 20, 0), truth(1, 500, 40, 0)]
    seen = watch(mission(zones=(zone,)), [*flight, *done()])
    verdict = seen["G1:zone: keep_out 7, flight of vehicle 1"]
    assert verdict.outcome is Outcome.VIOLATED
    assert verdict.time_ms == 0
    over = [truth(1, 0, 0, 0, 600), truth(1, 250, 20, 0, 600)]
    seen = watch(mission(zones=(zone,)), [*over, *done(250)])
    assert seen["G1:zone: keep_out 7, flight of vehicle 1"].outcome is Outcome.HOLDS


def test_order_is_judged_by_real_times():
    early = [progress(2, 2, 900, "Active") if m[0] == 2000 else m for m in done()]
    verdict = watch(mission(), [*apart(), *beats(3000), *early])["G1"]
    assert verdict.outcome is Outcome.VIOLATED
    assert verdict.margin == pytest.approx(-0.1)
    assert "p2" in verdict.note


@pytest.mark.parametrize("relations", ["+(.(p1 p2) .(p2 p1))", "+(.(p2 p1) .(p1 p2))"])
def test_of_branches_with_the_same_tasks_the_one_that_was_flown_is_judged(relations: str):
    seen = watch(mission(relations=relations), [*apart(), *beats(3000), *done()])
    assert seen["G1"].outcome is Outcome.HOLDS
    assert seen["G1:flight: `.(p1 p2)`: p2 starts no earlier than p1 ends"].outcome is Outcome.HOLDS
    early = [progress(2, 2, 900, "Active") if m[0] == 2000 else m for m in done()]
    seen = watch(mission(relations=relations), [*apart(), *beats(3000), *early])
    assert seen["G1"].outcome is Outcome.VIOLATED


def test_a_task_that_was_not_flown_is_not_complete_and_its_order_is_unknown():
    short = [m for m in done() if m[0] != 3000] + [done()[-1]]
    seen = watch(mission(), [*apart(), *beats(3000), *short])
    assert seen["G3"].outcome is Outcome.VIOLATED
    assert seen["G1"].outcome is Outcome.UNKNOWN


@pytest.mark.parametrize(("relations", "phase"), [("~(p1 p2)", ""), (".(p1 p2)", "Active")])
def test_a_task_that_did_not_wait_for_one_that_never_came_breaks_the_order(relations, phase):
    """What it waits for was never begun (`~`), or never ended (`.`): that is no matter of its times."""
    short = [m for m in done() if getattr(m[1], "TaskID", 0) != 1]
    if phase:
        short.append(progress(1, 1, 0, phase))
    seen = watch(mission(relations=relations), [*apart(), *beats(3000), *short])
    (row,) = [v for k, v in seen.items() if k.startswith(f"G1:flight: `{relations}`: p2 starts")]
    assert (row.outcome, row.method, row.time_ms) == (Outcome.VIOLATED, "in_order", 2000)
    assert "had not" in row.note
    # while the mission goes on it may still come
    on = [m for m in short if type(m[1]).__name__ != "MissionEnd"]
    seen = watch(mission(relations=relations), [*apart(), *beats(3000), *on])
    (row,) = [v for k, v in seen.items() if k.startswith(f"G1:flight: `{relations}`: p2 starts")]
    assert row.outcome is Outcome.UNKNOWN


def test_a_task_that_began_before_one_that_it_waits_for_is_told_as_it_was():
    short = [m for m in done() if getattr(m[1], "TaskID", 0) != 1]
    seen = watch(
        mission(relations="~(p1 p2)"),
        [*apart(), *beats(3000), *short, progress(1, 1, 2500, "Active")],
    )
    (row,) = [v for k, v in seen.items() if k.startswith("G1:flight: `~(p1 p2)`: p2 starts")]
    assert row.outcome is Outcome.VIOLATED
    assert row.note == "task 2 began, though task 1 had not begun by then"


def test_the_tasks_of_a_later_plan_count():
    m = mission(relations="+(p1 p2)")
    later = (500, lmcp.new("PlanAccepted", Time=500, Tasks=[2]))
    only_two = [x for x in done() if getattr(x[1], "TaskID", 2) == 2]
    seen = watch(m, [*apart(), *beats(3000), later, *only_two])
    assert seen["G3"].outcome is Outcome.HOLDS
    assert seen["G1"].outcome is Outcome.HOLDS
    both = (500, lmcp.new("PlanAccepted", Time=500, Tasks=[1, 2]))
    assert watch(m, [*apart(), *beats(3000), both, *done()])["G1"].outcome is Outcome.VIOLATED


def test_a_search_must_be_covered_by_footprints():
    line = (Position(0.0, 0.0, 0.0), Position(100.0, 0.0, 0.0))
    m = mission(tasks=(Task(1, TaskKind.LINE_SEARCH, "", line), mission().tasks[1]))
    seen = watch(m, [*apart(), *beats(3000), *done()])
    assert seen["G3:task 1 served"].outcome is Outcome.VIOLATED
    assert "0.00 %" in seen["G3:task 1 served"].note


def test_a_point_must_really_be_flown_through():
    tasks = (Task(1, TaskKind.MUST_FLY, "", (Position(10.0, 5060.0, 100.0),)), mission().tasks[1])
    seen = watch(mission(tasks=tasks), [*apart(), *beats(3000), *done()])
    assert seen["G3:task 1 served"].outcome is Outcome.VIOLATED
    assert seen["G3:task 2 served"].outcome is Outcome.HOLDS


def test_a_loiter_must_last():
    def loiter(ms: int) -> Mission:
        centre = (Position(0.0, 5000.0, 100.0),)
        task = Task(1, TaskKind.LOITER, "", centre, duration_ms=ms, radius_m=100.0)
        return mission(tasks=(task, mission().tasks[1]))

    flight = sorted([*apart(), *beats(3000), *done()], key=lambda m: m[0])
    assert watch(loiter(1000), flight)["G3:task 1 served"].outcome is Outcome.HOLDS
    short = watch(loiter(2000), flight)["G3:task 1 served"]
    assert short.outcome is Outcome.VIOLATED
    assert "of 2.00 s" in short.note


def gate(ms: int, owner: str, epoch: int, offered: bool = False) -> tuple[int, Any]:
    return ms, lmcp.new(
        "GateState", VehicleID=1, Time=ms, Owner=owner, Epoch=epoch, Offered=offered
    )


def command(ms: int, sender: str, epoch: int, vehicle: int = 1) -> tuple[int, Any]:
    return ms, lmcp.new("GatedCommand", VehicleID=vehicle, Sender=sender, Epoch=epoch)


def dropped(ms: int, epoch: int) -> tuple[int, Any]:
    return ms, lmcp.new("CommandDropped", VehicleID=1, Time=ms, Epoch=epoch)


TAKEN = [gate(600, "ICAROUS", 1), command(600, "ICAROUS", 1)]
BACK = [gate(800, "ICAROUS", 2, True), command(900, "UxAS", 2), gate(900, "UxAS", 2)]


def authority(*messages: tuple[int, Any]) -> Any:
    basis = [*apart(), *beats(3000), *done()]
    return watch(mission(), sorted([*messages, *basis], key=lambda m: m[0]))["G4"]


def test_a_takeover_that_is_handed_back_holds():
    assert authority(command(0, "UxAS", 0), *TAKEN, *BACK).outcome is Outcome.HOLDS
    stale = [command(700, "UxAS", 0), dropped(700, 0)]
    assert authority(*TAKEN, *stale, *BACK).outcome is Outcome.HOLDS


def link(ms: int, alive: bool, vehicle: int = 1) -> tuple[int, Any]:
    note = "heard again" if alive else "link lost: eof"
    return ms, lmcp.new("BridgeStatus", VehicleID=vehicle, Time=ms, Alive=alive, Note=note)


@pytest.mark.parametrize(
    ("statuses", "expected"),
    [
        ([], "violated"),
        ([link(100, False)], "unknown"),  # before the takeover
        ([link(900, False)], "unknown"),
        ([link(900, True)], "violated"),
        (
            [link(900, False), link(1000, True)],
            "violated",
        ),  # alive again, and still not handed back
        ([link(900, False), link(1000, True), link(1100, False)], "unknown"),
        ([link(900, False, 90)], "violated"),  # another vehicle's
    ],
)
def test_a_takeover_that_is_open_at_the_end_is_unknown_only_where_the_link_is_declared_down(
    statuses, expected
):
    verdict = authority(command(0, "UxAS", 0), *TAKEN, *statuses)
    assert verdict.outcome.value == expected
    assert "the takeover of 0.60 s was never handed back" in verdict.note
    assert ("the link was declared down since" in verdict.note) == (expected == "unknown")
    assert authority(command(0, "UxAS", 0), *TAKEN, *BACK, *statuses).outcome is Outcome.HOLDS
    # what else is wrong stays so
    assert authority(*TAKEN, command(700, "UxAS", 0), *statuses).outcome is Outcome.VIOLATED


@pytest.mark.parametrize(
    ("messages", "wanted"),
    [
        (TAKEN, "never handed back"),
        ([*TAKEN, gate(900, "UxAS", 2)], "went from ICAROUS in epoch 1 to UxAS in epoch 2"),
        ([gate(600, "ICAROUS", 0)], "went from UxAS in epoch 0 to ICAROUS in epoch 0"),
        ([*TAKEN, command(700, "UxAS", 0), *BACK], "was not dropped"),
        ([command(100, "UxAS", 0), dropped(100, 0)], "dropped that had authority"),
        ([*TAKEN, *BACK[:2]], "the gate did not change"),
    ],
)
def test_two_commanders_or_none_are_seen(messages, wanted):
    verdict = authority(*messages)
    assert verdict.outcome is Outcome.VIOLATED
    assert wanted in verdict.note


def test_what_was_forged_is_refused_counted_and_told():
    forged = [command(700, "UxAS", 10**14), dropped(700, 10**14)]
    mode = lmcp.new("ModeRefused", VehicleID=1, Time=750, Owner="ICAROUS", Epoch=10**14)
    verdict = authority(command(0, "UxAS", 0), *TAKEN, *forged, (750, mode), *BACK)
    assert verdict.outcome is Outcome.HOLDS
    assert (
        "1 of them stale and dropped, 1 of these of an epoch that was never given" in verdict.note
    )
    assert verdict.note.endswith("1 modes refused that could not be true")


def test_a_silent_bridge_is_seen_and_a_missing_one_is_unknown():
    gap = [m for m in beats(3000) if not 700 < m[0] < 2300]
    verdict = watch(mission(), [*apart(), *gap, *done()])["G5"]
    assert verdict.outcome is Outcome.VIOLATED
    assert verdict.margin == pytest.approx(-1.0)
    none = watch(mission(instances=()), [*apart(), *done()])["G5"]
    assert none.outcome is Outcome.UNKNOWN


def again(number: int, *times: int) -> list[tuple[int, Any]]:
    """A heartbeat that comes again at these times, both ways of both vehicles."""
    return [
        (ms, lmcp.new("Heartbeat", VehicleID=v, Time=ms, Direction=way, Sequence=number))
        for ms in times
        for v in (1, 2)
        for way in ("Down", "Up")
    ]


def in_order(messages: list[tuple[int, Any]]) -> list[tuple[int, Any]]:
    return sorted(messages, key=lambda one: one[0])


def test_a_heartbeat_that_comes_again_or_too_late_is_no_sign_of_life():
    whole = in_order([*beats(3000), *again(1, 1200, 2700), *again(3, 2600)])
    assert watch(mission(), [*apart(), *whole, *done()])["G5"].outcome is Outcome.HOLDS
    gap = in_order([m for m in beats(3000) if not 700 < m[0] < 2300] + again(1, 1000, 1500, 2000))
    verdict = watch(mission(), [*apart(), *gap, *done()])["G5"]
    assert verdict.outcome is Outcome.VIOLATED
    assert verdict.margin == pytest.approx(-1.0)


def test_of_a_bridge_that_was_made_to_fail_nobody_knows_what_came_down():
    faulty = mission(simulation=FaultySimulation(bridge_faults=BridgeFaults(loss=0.5)))
    seen = watch(faulty, [*apart(), *beats(3000), *done()])
    ways = {way: seen[f"G5:heartbeat {way} the ICAROUS instance of 1"] for way in ("to", "from")}
    assert {way: v.outcome for way, v in ways.items()} == {
        "to": Outcome.UNKNOWN,
        "from": Outcome.HOLDS,
    }
    assert "whether they came is not logged" in ways["to"].note
    assert ways["to"].kernels == ()


def test_messages_that_stop_leave_it_unknown():
    seen = watch(mission(), [*apart(), *beats(3000), *done()[:-1]])
    assert seen["G4"].outcome is Outcome.UNKNOWN
    assert seen["G3"].outcome is Outcome.UNKNOWN


def test_a_violation_is_told_when_it_happens():
    told: list[Any] = []
    monitor = Monitor(mission(), PLAN, told.append)
    for ms, body in [
        truth(1, 0, 0, 0),
        truth(2, 0, 10, 0),
        truth(1, 250, 0, 0),
        truth(2, 250, 10, 0),
    ]:
        monitor.tap(Envelope(lmcp.full_names(body)[0], ms, body))
    assert told == []
    ms, body = truth(1, 500, 0, 0)
    monitor.tap(Envelope(lmcp.full_names(body)[0], ms, body))
    assert [v.requirement for v in told] == ["G2"]
