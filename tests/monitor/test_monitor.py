"""The monitor: each guarantee's violation is seen, named, timed and measured; unknown stays so."""

from __future__ import annotations

import pytest
from mission_tools import must_fly
from monitor_tools import (
    PLAN,
    Envelope,
    apart,
    beats,
    done,
    mission,
    progress,
    truth,
    vehicle,
    watch,
)

from cratous.bridge import lmcp
from cratous.services.monitor import Monitor
from cratous.spec.mission import (
    Change,
    Mission,
    Position,
    Task,
    TaskKind,
    Zone,
    ZoneKind,
    changes,
)
from cratous.spec.mission.guarantees import Outcome


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


def test_a_zone_that_appears_over_a_vehicle_is_told_as_that_and_when_it_was_left():
    corners = ((10.0, -5.0), (30.0, -5.0), (30.0, 5.0), (10.0, 5.0))
    zone = Zone(7, ZoneKind.KEEP_OUT, corners, 0.0, 500.0)
    of = mission(zones=(), changes=(Change(250, changes.ZONE, zone=zone),))
    item = "G1:zone: keep_out 7, flight of vehicle 1"
    flight = [truth(1, 250 * k, 20 * k, 0) for k in range(4)]
    row = watch(of, [*flight, *done(750)])[item]
    assert (row.outcome, row.time_ms) == (Outcome.VIOLATED, 250)
    said = "it appeared over the vehicle at 0.25 s, which left it by 0.50 s, at most 0.25 s later"
    assert row.note == said
    back = [*flight, truth(1, 1000, 20, 0)]
    assert watch(of, [*back, *done(1000)])[item].note.endswith(", and entered it at 0.75 s")
    assert watch(of, [*flight[:2], truth(1, 500, 25, 0), *done(500)])[item].note.endswith(
        "which did not leave it"
    )
    # ahead of the vehicle it is entered
    ahead = [truth(1, 0, 0, 0), truth(1, 250, 5, 0), truth(1, 500, 20, 0)]
    row = watch(of, [*ahead, *done(500)])[item]
    told = "entered at 0.25 s; when it appeared at 0.25 s it was 5 m away: none of "
    assert row.note.startswith(told)
    assert row.evidence is not None
    assert (row.evidence["away_m"], row.evidence["way_kept"]) == (5.0, None)
    # of a zone that was there from the start nothing is said of when it appeared
    row = watch(mission(zones=(zone,)), [*ahead, *done(500)])[item]
    assert (row.note, row.evidence) == ("entered at 0.25 s", None)


def test_a_zone_that_appears_far_ahead_and_is_entered_could_have_been_kept():
    corners = ((900.0, -500.0), (1900.0, -500.0), (1900.0, 500.0), (900.0, 500.0))
    zone = Zone(7, ZoneKind.KEEP_OUT, corners, 0.0, 500.0)
    of = mission(zones=(), changes=(Change(250, changes.ZONE, zone=zone),))
    flight = [truth(1, 250 * k, 5.0 * k, 0) for k in range(200)]
    row = watch(of, [*flight, *done(199 * 250)])["G1:zone: keep_out 7, flight of vehicle 1"]
    assert row.outcome is Outcome.VIOLATED
    assert row.note.startswith("entered at 44.75 s; when it appeared at 0.25 s it was 895 m away: ")
    assert row.note.endswith("would have kept the zones")
    assert row.evidence is not None
    assert row.evidence["way_kept"] in row.note


WALL = Zone(7, ZoneKind.KEEP_OUT, ((500.0, -500.0), (900.0, -500.0), (900.0, 500.0), (500.0, 500.0)), 0.0, 500.0)  # fmt: skip


@pytest.mark.parametrize(
    ("places", "told"),
    [
        ({0: 0, 250: 5, 500: 10, 750: 505}, "495 m away: straight on"),
        # not seen for 5 s before it appeared: it came there at 20 m/s, not at 400
        ({0: 0, 5000: 100, 5250: 105, 5500: 505}, "400 m away: straight on"),
        # not seen when it appeared: nothing is said of how it flew then
        ({0: 0, 250: 5, 6000: 110, 6250: 505}, None),
        ({0: 0, 5000: 0, 5250: 0, 5500: 505}, "500 m away and did not move: no way was tried"),
        ({4750: -4000, 5000: 0, 5250: 5, 5500: 505}, "flew at 16000 m/s: no way was tried"),
    ],
)
def test_how_a_vehicle_flew_as_a_zone_appeared_is_what_was_seen_of_it(places, told):
    at_ms = 250 if 500 in places else 5000
    of = mission(zones=(), changes=(Change(at_ms, changes.ZONE, zone=WALL),))
    flight = [truth(1, ms, north, 0) for ms, north in places.items()]
    row = watch(of, [*flight, *done(max(places))])["G1:zone: keep_out 7, flight of vehicle 1"]
    assert row.outcome is Outcome.VIOLATED
    if told is None:
        assert (row.note, row.evidence) == ("entered at 6.00 s", None)
        return
    assert row.evidence is not None
    assert f"when it appeared at {at_ms / 1000:.2f} s" in row.note
    assert told in row.note
    assert ("way_kept" in row.evidence) == ("tried" not in told)


def test_a_zone_to_keep_in_is_left_not_entered():
    corners = ((10.0, -5.0), (30.0, -5.0), (30.0, 5.0), (10.0, 5.0))
    zone = Zone(7, ZoneKind.KEEP_IN, corners, 0.0, 500.0)
    item = "G1:zone: keep_in 7, flight of vehicle 1"
    of = mission(zones=(), changes=(Change(0, changes.ZONE, zone=zone),))
    flight = [truth(1, 250 * k, 2 + 10 * k, 0) for k in range(5)]
    assert watch(of, [*flight, *done(1000)])[item].note == (
        "it appeared beside the vehicle at 0.00 s, which entered it by 0.25 s, at most 0.25 s later, and left it at 0.50 s"
    )
    assert watch(of, [*flight[:2], *done(250)])[item].note.endswith("which did not enter it")
    of = mission(zones=(zone,))
    inside = [truth(1, 250 * k, 12 + 10 * k, 0) for k in range(3)]
    assert watch(of, [*inside, *done(500)])[item].note == "left at 0.25 s"


def test_each_violation_is_told_once_as_it_happens_in_whatever_order():
    corners = ((10.0, -5.0), (30.0, -5.0), (30.0, 5.0), (10.0, 5.0))
    zone = Zone(7, ZoneKind.KEEP_OUT, corners, 0.0, 500.0)
    of = mission(zones=(), changes=(Change(0, changes.ZONE, zone=zone),))
    first = [truth(v, ms, 20, 5000.0 * (v - 1)) for ms in (0, 250) for v in (1, 2)]
    then = [truth(v, ms, 20, 0) for ms in (500, 750) for v in (1, 2)]
    told: list[tuple[str, str]] = []
    monitor = Monitor(of, PLAN, lambda verdict: told.append((verdict.item, verdict.note)))
    for time_ms, body in (*first, *then, *done(1000)):
        monitor.tap(Envelope(lmcp.full_names(body)[0], time_ms, body))
    assert [item for item, _ in told].count("zone: keep_out 7, flight of vehicle 1") == 1
    assert len(told) == len(set(told)) == 3
    # what the vehicle does about it is not known yet
    assert told[0][1] == "it appeared over the vehicle at 0.00 s"
    assert any("well clear" in f"{item} {note}" for item, note in told), told


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


@pytest.mark.parametrize("relations", ["~(p1 p2)", ".(p1 p2)"])
def test_an_order_that_was_broken_before_the_other_task_was_asked_for_says_so(relations):
    late = (Change(2500, changes.TASK_ADDED, task=1),)
    begun = [m for m in done() if getattr(m[1], "TaskID", 0) != 1]
    flown = [*apart(), *beats(3000), *begun, progress(1, 1, 2750, "Active")]
    seen = watch(mission(relations=relations, changes=late), flown)
    (row,) = [v for k, v in seen.items() if k.startswith(f"G1:flight: `{relations}`: p2 starts")]
    assert row.outcome is Outcome.VIOLATED
    assert row.note.endswith("; task 1 was asked for only at 2.50 s")


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
    tasks = (must_fly(1, (10.0, 5060.0, 100.0)), mission().tasks[1])
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
