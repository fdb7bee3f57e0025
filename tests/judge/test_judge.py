"""The judge on logs made by hand, with known answers."""

from __future__ import annotations

import sqlite3
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from judge_tools import TAKEN, Scene, task, vehicle, verdicts, zone

from cratous.judge import judge
from cratous.judge.algebra import parse
from cratous.judge.relations import Deed, best_way

NORTH = (20.0, 0.0, 0.0)


def one(folder: Path, scene: Scene, item: str) -> str:
    """The verdict on one item."""
    return verdicts(scene.judged(folder))[item]


# ---- G1 zones -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("kind", "corners", "expected"),
    [
        ("keep_out", [(90, -5), (90, 5), (110, 5), (110, -5)], "violated"),
        ("keep_out", [(90, 0), (90, 5), (110, 5), (110, 0)], "violated"),  # along its edge
        ("keep_out", [(90, 0.001), (90, 5), (110, 5), (110, 0.001)], "holds"),
        ("keep_out", [(102, -1), (102, 1), (104, 0)], "violated"),  # between two samples
        ("keep_in", [(-10, -10), (-10, 10), (300, 10), (300, -10)], "holds"),
        ("keep_in", [(-10, -10), (-10, 10), (200, 10), (200, -10)], "violated"),  # ends on the edge
        ("keep_in", [(0, -10), (0, 10), (300, 10), (300, -10)], "violated"),  # starts on the edge
    ],
)
def test_zones(tmp_path: Path, kind, corners, expected) -> None:
    scene = Scene(zones=[zone(7, kind, *corners)]).straight(1, (0, 0, 300), NORTH)
    assert one(tmp_path, scene, f"zone: {kind} 7, flight of vehicle 1") == expected


def test_a_zone_counts_from_when_it_is_known(tmp_path: Path) -> None:
    for at_ms, expected in ((3000, "violated"), (7000, "holds"), (99_000, "holds")):
        there = zone(7, "keep_out", (90, -5), (90, 5), (110, 5), (110, -5))
        changes = [{"at_ms": at_ms, "kind": "zone", "vehicle": 0, "task": 0, "zone": there}]
        scene = Scene(changes=changes).straight(1, (0, 0, 300), NORTH)
        assert one(tmp_path, scene, "zone: keep_out 7, flight of vehicle 1") == expected


@pytest.mark.parametrize(
    ("from_ms", "until_ms", "expected"),
    [
        (0, 1, ("holds", 1)),  # the first leg
        (2000, 2001, ("holds", 1)),
        (2001, 2500, ("unknown", 0)),  # there and gone between two states
        (2000, None, ("violated", 3)),
        (99_000, None, ("holds", 1)),  # that the flight was over before
    ],
)
def test_a_zone_that_nothing_was_held_against_is_unknown(
    tmp_path: Path, from_ms: int, until_ms: int | None, expected: tuple[str, int]
) -> None:
    there = zone(7, "keep_out", (90, -5), (90, 5), (110, 5), (110, -5))
    none: dict[str, Any] = {"vehicle": 0, "task": 0, "zone": None}
    changes = [{**none, "at_ms": from_ms, "kind": "zone", "zone": there}] if from_ms else []
    if until_ms is not None:
        changes.append({**none, "at_ms": until_ms, "kind": "zone_ends", "zone_id": 7})
    scene = Scene(zones=[] if from_ms else [there], changes=changes)
    rows = scene.straight(1, (0, 0, 300), NORTH).judged(tmp_path).rows
    (row,) = [row for row in rows if row.item == "zone: keep_out 7, flight of vehicle 1"]
    assert (row.verdict, row.checks) == expected


def test_padding_is_a_distance(tmp_path: Path) -> None:
    for east, expected in ((9.999, "violated"), (10.0, "violated"), (10.001, "holds")):
        there = zone(7, "keep_out", (90, east), (90, 50), (110, 50), (110, east), padding_m=10.0)
        scene = Scene(zones=[there]).straight(1, (0, 0, 300), NORTH)
        assert one(tmp_path, scene, "zone: keep_out 7, flight of vehicle 1") == expected


def test_what_is_not_known_of_a_flight_does_not_hold(tmp_path: Path) -> None:
    far = zone(7, "keep_out", (900, 0), (900, 5), (910, 5))
    item = "zone: keep_out 7, flight of vehicle 1"

    def scene() -> Scene:
        return Scene(zones=[far]).straight(1, (0, 0, 300), NORTH)

    assert one(tmp_path, scene(), item) == "holds"
    gap = scene()
    del gap.messages[4]
    jump = scene()
    jump.messages[4].body["East"] = 3.0
    late, early = scene(), scene()
    del late.messages[0]
    del early.messages[-1]
    swapped = scene()
    swapped.messages[4].body["Time"] = 3000
    silent = Scene(zones=[far])
    for spoilt in (gap, jump, late, early, swapped, silent):
        assert one(tmp_path, spoilt, item) == "unknown"
    assert verdicts(scene().judged(tmp_path, end=""))[item] == "unknown"
    assert verdicts(scene().judged(tmp_path, seal=False))[item] == "unknown"


def test_a_gap_is_no_violation_either(tmp_path: Path) -> None:
    """What lies between two positions that a gap parts is not known; the positions are."""

    def found(vehicles: int, **more) -> dict[str, str]:
        scene = Scene(vehicles=[vehicle(k + 1) for k in range(vehicles)], **more)
        scene.straight(1, (0, 0, 300), NORTH).does(1, 1, 4000, 6000)
        scene.straight(2, (100, -500, 300), (0.0, 100.0, 0.0))
        gone = range(3000, 8000, 1000)
        scene.messages = [
            m for m in scene.messages if m.kind != "TruthState" or m.body["Time"] not in gone
        ]
        return verdicts(scene.judged(tmp_path))

    asked = [task(1, "must_fly", (100, 60))]
    inside = zone(7, "keep_out", (90, -5), (90, 5), (110, 5), (110, -5))
    at_sample = zone(8, "keep_out", (30, -5), (30, 5), (41, 5), (41, -5))
    now = {"dthr_m": 150.0, "zthr_m": 30.0, "tthr_s": 0.0, "tcoa_s": 0.0}
    rows = found(2, tasks=asked, zones=[inside, at_sample], daa={"well_clear": now})
    assert rows["zone: keep_out 7, flight of vehicle 1"] == "unknown"
    assert rows["zone: keep_out 8, flight of vehicle 1"] == "violated"
    assert rows["well clear of 1 and 2"] == "unknown"
    assert rows["task 1 served"] == "unknown"


def test_a_zone_that_is_known_with_the_last_state_binds_no_way(tmp_path: Path) -> None:
    def found(at_ms: int) -> str:
        late = zone(7, "keep_out", (-900, -900), (-900, 900), (900, 900), (900, -900))
        change = {"at_ms": at_ms, "vehicle": 0, "task": 0, "zone": late, "kind": "zone"}
        scene = Scene(tasks=[], changes=[change]).straight(1, (0, 0, 300), NORTH)
        last = max(m.body["Time"] for m in scene.messages if m.kind == "TruthState")
        change["at_ms"] += last
        return one(tmp_path, scene, "zone: keep_out 7, flight of vehicle 1")

    assert (found(0), found(-3000)) == ("holds", "violated")


def test_what_is_missing_may_be_among_what_was_lost(tmp_path: Path) -> None:
    there = zone(7, "keep_out", (90, -5), (90, 5), (110, 5), (110, -5))
    scene = Scene(zones=[there], tasks=[task(1, "must_fly", (100, 0))], instances=[1])
    scene.straight(1, (0, 0, 300), NORTH).commands(1, *TAKEN[:7]).beats(1, range(5, 9))
    log = scene.write(tmp_path / "log.sqlite")
    before = verdicts(judge(log))
    with sqlite3.connect(log) as database:
        database.execute("INSERT INTO gaps VALUES(5, 3, 2000, 3000, 'disk full')")
    after = verdicts(judge(log))
    lost = {"task 1 served", "authority over vehicle 1", *(k for k in before if "heartbeat" in k)}
    assert {before[k] for k in lost} == {"violated"}
    assert {after[k] for k in lost} == {"unknown"}
    assert after["zone: keep_out 7, flight of vehicle 1"] == "violated"


def test_unprotected_vehicles_are_not_covered(tmp_path: Path) -> None:
    there = zone(7, "keep_out", (90, -5), (90, 5), (110, 5), (110, -5))
    scene = Scene(zones=[there], vehicles=[vehicle(1), vehicle(2, protected=False)])
    found = scene.straight(1, (0, 900, 300), NORTH).straight(2, (0, 0, 900), NORTH).judged(tmp_path)
    assert found.not_covered == (2,)
    assert not any("vehicle 2" in row.item for row in found.rows)
    assert verdicts(found)["well clear of 1 and 2"] == "holds"


# ---- G2 -----------------------------------------------------------------------------------------

PAIR = "well clear of 1 and 2"


@pytest.mark.parametrize(
    ("start", "v", "expected"),
    [
        ((0.0, 150.0, 300.0), NORTH, "violated"),  # DTHR belongs to it
        ((0.0, 150.1, 300.0), NORTH, "holds"),
        ((0.0, 100.0, 330.0), NORTH, "violated"),  # ZTHR belongs to it
        ((0.0, 100.0, 330.1), NORTH, "holds"),
        ((760.0, 0.0, 300.0), (-20.0, 0.0, 0.0), "violated"),  # tau_mod comes below TTHR
        ((1500.0, 0.0, 300.0), (-20.0, 0.0, 0.0), "holds"),
        # passes in the middle of a step, at 30 m of altitude just then
        ((210.0, 2000.0, 345.0), (0.0, -400.0, -3.0), "violated"),
        ((210.0, 2000.0, 345.1), (0.0, -400.0, 0.0), "holds"),
    ],
)
def test_well_clear(tmp_path: Path, start, v, expected) -> None:
    scene = Scene(vehicles=[vehicle(1), vehicle(2)])
    scene.straight(1, (0, 0, 300), NORTH).straight(2, start, v)
    assert one(tmp_path, scene, PAIR) == expected


def test_every_aircraft_counts_and_what_is_not_seen_is_unknown(tmp_path: Path) -> None:
    there = {"id": 90, "appears_ms": 0, "vanishes_ms": 4000}
    scene = Scene(traffic=[there]).straight(1, (0, 0, 300), NORTH)
    assert one(tmp_path, scene, "well clear of 1 and 90") == "unknown"
    way = [(5000.0, 0.0, 300.0)] * 5
    scene.flies(90, way)
    assert one(tmp_path, scene, "well clear of 1 and 90") == "holds"
    scene.straight(55, (0, 50, 300), NORTH)  # an aircraft that the mission does not know
    assert one(tmp_path, scene, "well clear of 1 and 55") == "violated"
    # one that is logged in between was there, but was held against nobody
    between = Scene().straight(1, (0, 0, 300), NORTH).straight(55, (0, 9000, 300), NORTH)
    for message in between.messages:
        if message.body["VehicleID"] == 55:
            message.body["Time"] += 500
    assert one(tmp_path, between, "well clear of 1 and 55") == "unknown"
    for k, expected in ((9, "holds"), (10, "unknown")):
        short = Scene().straight(1, (0, 0, 300), NORTH).straight(55, (0, 9000, 300), NORTH)
        short.messages = [
            m for m in short.messages if m.body["VehicleID"] == 1 or m.body["Time"] >= 1000 * k
        ]
        assert one(tmp_path, short, "well clear of 1 and 55") == expected
    alone = Scene().straight(1, (0, 0, 300), NORTH)
    assert one(tmp_path, alone, "well clear of 1") == "holds"


# ---- G1 order and timing --------------------------------------------------------------------------


def relations(folder: Path, text: str, *done: tuple[int, int, int | None], **more) -> str:
    ids = sorted(set(parse(text).tasks()))
    scene = Scene(relations=text, tasks=[task(i, "must_fly", (100, 0)) for i in ids], **more)
    scene.straight(1, (0, 0, 300), NORTH)
    for number, start, end in done:
        scene.does(number, 1, start, end)
    rows = [r for r in scene.judged(folder).rows if r.subject[0] == "relations"]
    return next((v for v in ("violated", "unknown") if v in [r.verdict for r in rows]), "holds")


@pytest.mark.parametrize(
    ("text", "done", "expected"),
    [
        (".(p1 p2)", [(1, 0, 5000), (2, 5000, 6000)], "holds"),
        (".(p1 p2)", [(1, 0, 5000), (2, 4999, 6000)], "violated"),
        (".(p1 p2)", [(2, 5000, 6000)], "violated"),
        (".(p1 p2)", [(1, 0, None), (2, 5000, 6000)], "violated"),  # undone satisfies nothing
        (".(p1 p2)", [(1, 0, 5000)], "unknown"),
        ("~(p1 p2)", [(1, 1000, 5000), (2, 1000, 2000)], "holds"),
        ("~(p1 p2)", [(1, 1000, 5000), (2, 999, 2000)], "violated"),
        ("~(|(p1 p3) p2)", [(1, 3000, 5000), (3, 1000, 9000), (2, 1000, 2000)], "holds"),
        (".(|(p1 p3) p2)", [(1, 0, 5000), (3, 0, 9000), (2, 6000, 9500)], "violated"),
        ("+(p1 p2)", [(1, 0, 5000)], "holds"),
        ("+(p1 p2)", [(1, 0, 5000), (2, 6000, None)], "violated"),
        ("+(p1 p2)", [], "unknown"),
        ("+(.(p1 p2) .(p2 p1))", [(1, 0, 5000), (2, 6000, 7000)], "holds"),
        ("+(.(p1 p2) .(p2 p1))", [(2, 0, 5000), (1, 6000, 7000)], "holds"),
        ("+(.(p1 p2) .(p2 p1))", [(2, 0, 5000), (1, 4000, 7000)], "violated"),
        ("p1_[1000-5000]", [(1, 1000, 5000)], "holds"),
        ("p1_[1001-5000]", [(1, 1000, 5000)], "violated"),
        ("p1_[1000-4999]", [(1, 1000, 5000)], "violated"),
        ("|(p1 p2)-[1000-5000]", [(1, 1000, 5000), (2, 1000, 5001)], "violated"),  # as absolute
        # relative: counted from the end of the one before; the first operand is free
        (".(p1 p2)-[1000-3000]", [(1, 0, 4000), (2, 5000, 7000)], "holds"),
        (".(p1 p2)-[1001-3000]", [(1, 0, 4000), (2, 5000, 7000)], "violated"),
        (".(p1 p2)-[1000-2999]", [(1, 0, 4000), (2, 5000, 7000)], "violated"),
        ("~(p1 p2)-[1000-3000]", [(1, 4000, 9000), (2, 5000, 7000)], "holds"),
        ("~(p1 p2)-[1000-2999]", [(1, 4000, 9000), (2, 5000, 7000)], "violated"),
        # the innermost wins, also where it is wider
        ("|(p1 p2_[0-9000])_[0-3000]", [(1, 0, 3000), (2, 4000, 9000)], "holds"),
        ("|(p1 p2_[0-9000])_[0-3000]", [(1, 0, 3001), (2, 4000, 9000)], "violated"),
        ("|(.(p1 p2)-[0-9000])_[0-3000]", [(1, 0, 3000), (2, 4000, 9000)], "holds"),
        ("|(.(p1 p2)-[0-9000])_[0-3000]", [(1, 0, 3001), (2, 4000, 9000)], "violated"),
        # order is never overridden
        (".(p1 p2_[0-9000])", [(1, 0, 5000), (2, 4000, 6000)], "violated"),
        ("+(p1 p2)_[0-3000]", [(1, 0, 3001)], "violated"),
        ("+(p1_[0-9000] p2)_[0-3000]", [(1, 0, 3001)], "holds"),
        ("|(p1 p2)", [(1, 0, 5000), (2, 0, 5000)], "holds"),
    ],
)
def test_order_and_timing(tmp_path: Path, text, done, expected) -> None:
    assert relations(tmp_path, text, *done) == expected


def terms(ids: list[int]) -> st.SearchStrategy[str]:
    """Terms over just these tasks."""
    window = st.sampled_from(["", "", "", "_[0-9]", "_[3-12]", "-[0-5]", "-[1-9]"])
    if len(ids) == 1:
        return st.builds(lambda w: f"p{ids[0]}{w}", window)
    return st.integers(1, len(ids) - 1).flatmap(
        lambda k: st.builds(
            lambda o, a, b, w: f"{o}({a} {b}){w}",
            st.sampled_from(".~|+"),
            terms(ids[:k]),
            terms(ids[k:]),
            window,
        )
    )


@given(terms([1, 2, 3, 4]), st.data())
def test_the_reading_of_the_algebra_is_that_of_the_specification(text, data) -> None:
    """Against `spec.algebra.meaning.satisfied`, which was written without this code."""
    from cratous.spec import algebra
    from cratous.spec.algebra.meaning import branches, satisfied, tasks

    ways = list(branches(algebra.parse(text)))
    ran = tasks(data.draw(st.sampled_from(ways)))
    times = {}
    for number in ran:
        start = data.draw(st.integers(0, 9))
        times[number] = (start, start + data.draw(st.integers(0, 4)))
    done = {n: Deed([(1, a, b)], b) for n, (a, b) in times.items()}
    _, found, whole = best_way(parse(text), done, set(done))
    assert whole
    assert all(f.verdict == "holds" for f in found) == satisfied(algebra.parse(text), times)


def test_eligibility(tmp_path: Path) -> None:
    def verdict(by: int, at: int, eligible: list[int], **change: int) -> str:
        changes = [{"at_ms": 4000, "vehicle": 0, "task": 0, "zone": None, "kind": k} | {
            "vehicle" if k.startswith("vehicle") else "task": v} for k, v in change.items()]  # fmt: skip
        scene = Scene(
            tasks=[task(1, "must_fly", (100, 0), eligible=eligible)], changes=changes,
            vehicles=[vehicle(1), vehicle(2)],
        )  # fmt: skip
        scene.straight(1, (0, 0, 300), NORTH).straight(2, (0, 900, 300), NORTH)
        return one(tmp_path, scene.does(1, by, at, 9000), "eligibility: task 1 in flight")

    assert verdict(1, 0, []) == verdict(2, 0, [2]) == "holds"
    assert verdict(1, 0, [2]) == "violated"
    assert verdict(3, 0, []) == "violated"
    assert verdict(1, 3000, [], vehicle_lost=1) == "holds"
    assert verdict(1, 5000, [], vehicle_lost=1) == "violated"
    assert verdict(1, 3000, [], vehicle_joins=1) == "violated"
    assert verdict(1, 3000, [], task_added=1) == "violated"
    assert verdict(1, 5000, [], task_added=1, vehicle_joins=1) == "holds"
    # who was lost may join again: what was said last counts
    assert verdict(1, 5000, [], vehicle_lost=1, vehicle_joins=1) == "holds"
    assert verdict(1, 5000, [], vehicle_joins=1, vehicle_lost=1) == "violated"
    # one that is commanded to hold takes part all the same
    assert verdict(1, 5000, [], vehicle_holds=1, vehicle_resumes=1) == "holds"
