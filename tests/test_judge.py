"""The judge on logs made by hand, with known answers."""

from __future__ import annotations

import json
import sqlite3
from pathlib import Path

import judge_tools as tools
import pytest
from hypothesis import given
from hypothesis import strategies as st
from judge_tools import Scene, mission, task, vehicle, verdicts, zone

from cratous.judge import judge
from cratous.judge.algebra import parse
from cratous.judge.relations import Deed, best_way
from cratous.services.cli import main
from cratous.spec.errors import BadInput

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
    """Against `spec.algebra_meaning.satisfied`, which was written without this code."""
    from cratous.spec import algebra
    from cratous.spec.algebra_meaning import branches, satisfied, tasks

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


# ---- G3 -----------------------------------------------------------------------------------------


def served(
    folder: Path, asked: dict, start: int = 2000, end: int | None = 8000, looks=(), **more
) -> str:
    scene = Scene(tasks=[asked], **more).straight(1, (0, 0, 300), NORTH).does(1, 1, start, end)
    for time_ms, corners in looks:
        see(scene, time_ms, corners)
    return one(folder, scene, "task 1 served")


def see(scene: Scene, time_ms: int, corners: list[tuple[float, float]], payload: int = 1) -> None:
    """A footprint (metres), said by vehicle 1 from where it is."""
    import pyproj

    frame = scene.mission["frame"]
    projection = pyproj.Proj(
        proj="aeqd", ellps="WGS84", lat_0=frame["latitude_deg"], lon_0=frame["longitude_deg"]
    )

    def place(north: float, east: float, alt: float = 0.0) -> dict[str, float]:
        lon, lat = projection(east, north, inverse=True)
        return {"Latitude": lat, "Longitude": lon, "Altitude": alt}

    camera = {
        "PayloadID": payload, "HorizontalFieldOfView": 45.0, "Centerpoint": place(*corners[0]),
        "Footprint": [place(*corner) for corner in corners],
    }  # fmt: skip
    scene.say(
        time_ms, "AirVehicleState", ID=1, Time=time_ms, Location=place(20.0 * time_ms / 1000, 0.0, 300.0),
        PayloadStateList=[camera],
    )  # fmt: skip


def box(n0: float, n1: float, e0: float = -50, e1: float = 50) -> list[tuple[float, float]]:
    return [(n0, e0), (n0, e1), (n1, e1), (n1, e0)]


def test_a_point_is_flown_through(tmp_path: Path) -> None:
    assert served(tmp_path, task(1, "must_fly", (100, 49.9))) == "holds"
    assert served(tmp_path, task(1, "must_fly", (100, 50.1))) == "violated"
    assert served(tmp_path, task(1, "must_fly", (100, 0)), 6500) == "holds"
    assert served(tmp_path, task(1, "must_fly", (100, 0)), 7600) == "violated"  # 52 m beyond it
    assert served(tmp_path, task(1, "must_fly", (100, 0)), end=None) == "violated"


def test_a_loiter_lasts(tmp_path: Path) -> None:
    asked = task(1, "loiter", (100, 0), radius_m=50.0, duration_ms=6000)
    assert served(tmp_path, asked) == "holds"
    assert served(tmp_path, asked | {"duration_ms": 6500}) == "unknown"  # less than a step lacks
    assert served(tmp_path, asked | {"duration_ms": 7100}) == "violated"
    assert served(tmp_path, task(1, "loiter", (100, 400), radius_m=50.0)) == "violated"
    shape = {"centre": {"north_m": 100.0, "east_m": 240.0}, "radius_m": 50.0, "length_m": 300.0}
    race = asked | {"loiter": shape | {"shape": "racetrack"}, "duration_ms": 1000}
    assert served(tmp_path, race) == "holds"
    assert served(tmp_path, race | {"loiter": shape | {"shape": "circular"}}) == "violated"


def test_lines_are_seen(tmp_path: Path) -> None:
    asked = task(1, "line_search", (0, 0), (1000, 0))
    first, last = (3000, box(-1, 500)), (5000, box(499, 1001))
    assert served(tmp_path, asked, looks=[first, last]) == "holds"
    assert served(tmp_path, asked, looks=[first]) == "violated"
    assert served(tmp_path, asked, looks=[first, (8500, last[1])]) == "violated"  # too late
    assert served(tmp_path, asked, looks=[first, (5000, box(502, 1001))]) == "holds"  # 2 m lack
    assert served(tmp_path, asked, looks=[first, (5000, box(510, 1001))]) == "unknown"  # 1 %
    assert served(tmp_path, asked, looks=[first, (5000, box(516, 1001))]) == "violated"
    assert served(tmp_path, asked | {"wavelength": "LWIR"}, looks=[first, last]) == "holds"
    blind = vehicle(1, cameras=[{"payload_id": 1, "wavelength": "EO", "pixels": 100}])
    infrared = asked | {"wavelength": "LWIR"}
    assert served(tmp_path, infrared, looks=[first, last], vehicles=[blind]) == "violated"
    coarse = asked | {"gsd_m": 0.5, "wavelength": "EO"}
    assert served(tmp_path, coarse, looks=[first, last], vehicles=[blind]) == "violated"
    assert (
        served(tmp_path, coarse | {"gsd_m": 9.0}, looks=[first, last], vehicles=[blind]) == "holds"
    )
    assert served(tmp_path, asked | {"gsd_m": 0.5}, looks=[first, last]) == "unknown"


def test_areas_are_seen(tmp_path: Path) -> None:
    asked = task(1, "area_search", (0, 0), (0, 200), (200, 200), (200, 0))
    halves = [(3000, box(-1, 100, -1, 201)), (5000, box(99, 201, -1, 201))]
    assert served(tmp_path, asked, looks=halves) == "holds"
    assert served(tmp_path, asked, looks=halves[:1]) == "violated"
    disc = task(1, "pattern_search", (100, 100), pattern="spiral", extent_m=99.0)
    assert served(tmp_path, disc, looks=halves) == "holds"
    assert served(tmp_path, disc | {"extent_m": 130.0}, looks=halves) == "violated"
    assert (
        served(tmp_path, disc | {"pattern": "square", "extent_m": 100.0}, looks=halves) == "holds"
    )
    missing = [(3000, box(-1, 100, -1, 201)), (5000, box(103, 201, -1, 201))]
    assert served(tmp_path, asked, looks=missing) == "violated"


def test_points_are_seen_for_as_long_as_asked(tmp_path: Path) -> None:
    asked = task(1, "point_search", (100, 30))
    looks = [(ms, box(0, 200)) for ms in range(3000, 6500, 500)]
    assert served(tmp_path, asked, looks=looks[:1]) == "holds"
    assert served(tmp_path, asked, looks=[]) == "violated"
    assert served(tmp_path, asked, looks=[(3000, box(0, 200, 31, 50))]) == "violated"
    assert served(tmp_path, asked, looks=[(3000, box(0, 200, 30, 50))]) == "unknown"  # on its edge
    assert served(tmp_path, asked | {"duration_ms": 4000}, looks=looks) == "holds"
    assert served(tmp_path, asked | {"duration_ms": 4500}, looks=looks) == "violated"
    assert served(tmp_path, asked | {"duration_ms": 4000}, looks=looks[::2]) == "violated"
    assert served(tmp_path, asked | {"standoff_m": 29.0}, looks=looks) == "holds"
    assert served(tmp_path, asked | {"standoff_m": 31.0}, looks=looks) == "violated"


def test_who_says_to_be_elsewhere_is_not_believed(tmp_path: Path) -> None:
    scene = Scene(tasks=[task(1, "point_search", (100, 30))])
    scene.straight(1, (0, 5, 300), NORTH).does(1, 1, 2000, 8000)
    see(scene, 3000, box(0, 200))
    assert one(tmp_path, scene, "task 1 served") == "unknown"


def changed(at_ms: int, kind: str, task_id: int) -> dict:
    return {"at_ms": at_ms, "kind": kind, "vehicle": 0, "task": task_id, "zone": None}


def test_what_is_asked_for_and_not_done_is_a_row(tmp_path: Path) -> None:
    asked = [task(1, "must_fly", (100, 0)), task(2, "must_fly", (120, 0))]

    def rows(**more) -> dict[str, str]:
        scene = Scene(tasks=asked, **more).straight(1, (0, 0, 300), NORTH).does(1, 1, 4000, 6000)
        return {k: v for k, v in verdicts(scene.judged(tmp_path)).items() if "served" in k}

    undone = {"task 1 served": "holds", "task 2 served": "violated"}
    assert rows() == undone
    assert rows(relations="+(p1 p2)") == {"task 1 served": "holds"}
    assert rows(changes=[changed(500, "task_added", 2)]) == undone
    assert rows(changes=[changed(99_000, "task_added", 2)]) == undone
    assert rows(changes=[changed(500, "task_removed", 2)]) == {"task 1 served": "holds"}
    # done before it was removed: it stays; a removal after that changes nothing
    assert rows(changes=[changed(7000, "task_removed", 1)]) == undone
    assert rows(changes=[changed(5000, "task_removed", 1)]) == {"task 2 served": "violated"}


# ---- G4 -----------------------------------------------------------------------------------------

TAKEN = [
    (0, "command", "UxAS", 0), (2000, "state", "ICAROUS", 1), (2000, "change", "ICAROUS", 1),
    (2000, "command", "ICAROUS", 1), (3000, "command", "UxAS", 0), (3000, "drop", "UxAS", 0),
    (5000, "state", "ICAROUS", 2, True), (5000, "command", "ICAROUS", 2),
    (5500, "command", "UxAS", 2), (5500, "state", "UxAS", 2), (5500, "change", "UxAS", 2),
    (6000, "command", "UxAS", 2),
]  # fmt: skip


def authority(folder: Path, rows: list, **more) -> str:
    scene = Scene(**more).straight(1, (0, 0, 300), NORTH).commands(1, *rows)
    return one(folder, scene, "authority over vehicle 1")


def test_a_takeover_that_is_handed_back(tmp_path: Path) -> None:
    assert authority(tmp_path, TAKEN) == "holds"
    assert authority(tmp_path, TAKEN[:1]) == "holds"
    assert authority(tmp_path, []) == "unknown"
    withdrawn = [*TAKEN[:7], (5200, "state", "ICAROUS", 3)]
    back = [(6000, "state", "ICAROUS", 4, True), (6100, "command", "UxAS", 4),
            (6100, "state", "UxAS", 4), (6100, "change", "UxAS", 4)]  # fmt: skip
    assert authority(tmp_path, withdrawn + back) == "holds"


@pytest.mark.parametrize("left_out", [1, 2, 3, 5, 6, 8, 9, 10])
def test_a_story_with_a_hole(tmp_path: Path, left_out: int) -> None:
    rows = [row for k, row in enumerate(TAKEN) if k != left_out]
    # that ICAROUS steered is not needed for the story
    assert authority(tmp_path, rows) == ("holds" if left_out == 3 else "violated")


@pytest.mark.parametrize(
    "rows",
    [
        [*TAKEN[:7]],  # never handed back
        [TAKEN[0], (1000, "command", "ICAROUS", 0)],  # steers without a takeover
        [TAKEN[0], (1000, "command", "UxAS", 1)],  # of an epoch that is not yet
        [TAKEN[0], (1000, "drop", "UxAS", 0)],
        [TAKEN[0], (1000, "state", "UxAS", 1)],
        [TAKEN[0], (1000, "state", "ICAROUS", 2), (1000, "change", "ICAROUS", 2)],
        [TAKEN[0], (1000, "change", "ICAROUS", 1)],
        [*TAKEN[:5], (5000, "state", "UxAS", 2), (5000, "change", "UxAS", 2)],
        # UxAS takes what was not offered
        [
            *TAKEN[:4],
            (5000, "command", "UxAS", 1),
            (5000, "state", "UxAS", 1),
            (5000, "change", "UxAS", 1),
        ],
    ],
)
def test_stories_that_do_not_fit(tmp_path: Path, rows) -> None:
    assert authority(tmp_path, rows) == "violated"


def test_a_takeover_may_end_in_a_declared_failure(tmp_path: Path) -> None:
    scene = Scene(tasks=[task(1, "must_fly", (100, 0))]).straight(1, (0, 0, 300), NORTH)
    scene.commands(1, *TAKEN[:4])
    scene.say(7000, "TaskProgress", TaskID=1, VehicleID=1, Time=7000, Phase="Failed")
    assert one(tmp_path, scene, "authority over vehicle 1") == "holds"


# ---- G5 -----------------------------------------------------------------------------------------


def beats(folder: Path, skip=(), status=(), zones=(), instances=(1,)) -> str:
    scene = Scene(instances=list(instances), zones=list(zones))
    scene.straight(1, (0, 0, 300), NORTH)
    scene.beats(1, skip)
    for at, alive in status:
        scene.say(at, "BridgeStatus", VehicleID=1, Time=at, Alive=alive)
    found = verdicts(scene.judged(folder))
    both = {v for k, v in found.items() if k.startswith("heartbeat")}
    assert len(both) == 1
    return both.pop()


def test_heartbeats(tmp_path: Path) -> None:
    assert beats(tmp_path) == "holds"
    assert beats(tmp_path, skip=[5]) == "holds"  # two periods, not more
    assert beats(tmp_path, skip=[5, 6]) == "violated"
    assert beats(tmp_path, skip=range(30)) == "violated"
    assert beats(tmp_path, skip=[0, 1, 2]) == "violated"
    assert beats(tmp_path, skip=[18, 19, 20]) == "violated"
    assert beats(tmp_path, instances=[]) == "unknown"


def test_a_declared_silence_is_safe_or_not(tmp_path: Path) -> None:
    quiet = range(4, 12)
    assert beats(tmp_path, quiet, [(2500, False), (6000, True)]) == "unknown"
    assert beats(tmp_path, quiet, [(9000, False)]) == "violated"  # not about this silence
    there = zone(7, "keep_out", (60, -5), (60, 5), (70, 5), (70, -5))
    assert beats(tmp_path, quiet, [(2500, False)], [there]) == "violated"


# ---- the report beside it -------------------------------------------------------------------------


def row(requirement: str, item: str, verdict: str) -> dict[str, str]:
    return {"requirement": requirement, "item": item, "verdict": verdict, "source": "flight"}


def full(folder: Path, *, lost: bool = False) -> tuple[Path, list[dict[str, str]]]:
    """A log, and a monitor's rows that say what the judge says."""
    scene = Scene(vehicles=[vehicle(1), vehicle(2)], tasks=[task(1, "must_fly", (100, 0))])
    scene.straight(1, (0, 0, 300), NORTH).straight(2, (0, 100.0 if lost else 900.0, 300), NORTH)
    scene.does(1, 1, 4000, 6000).commands(1, TAKEN[0]).commands(2, TAKEN[0])
    log = scene.write(folder / "log.sqlite")
    return log, [
        row(r.guarantee, r.item, r.verdict) for r in judge(log).rows if r.subject[0] != "relations"
    ]


def test_agreement_is_said_and_rows_of_the_plan_are_left_aside(tmp_path: Path) -> None:
    log, rows = full(tmp_path)
    rows.append(row("G1", "plan: something", "violated") | {"source": "plan"})
    found = judge(tools.with_report(log, rows))
    assert found.report
    assert not found.differences


def test_disagreement_is_the_first_line(tmp_path: Path, capsys) -> None:
    log, rows = full(tmp_path, lost=True)
    for there in rows:
        if there["requirement"] == "G2":
            there["verdict"] = "holds"
    folder = tools.with_report(log, rows)
    assert main(["judge", str(folder)]) == 1
    out = capsys.readouterr().out
    assert out.startswith("DISAGREEMENT of judge and monitor in 1 rows\n")
    assert "G2 well clear of 1 and 2: judge violated, monitor holds" in out.splitlines()[1]
    assert main(["judge", str(folder / "log.sqlite"), "--json"]) == 1
    data = json.loads(capsys.readouterr().out)
    assert data["disagreements"] == 1
    assert data["differences"][0]["kind"] == "disagree"


def test_a_violation_where_the_monitor_holds_back_only_disagreement_counts(tmp_path: Path) -> None:
    log, rows = full(tmp_path)
    for there in rows:
        if there["requirement"] == "G2":
            there["verdict"] = "violated"
    found = judge(tools.with_report(log, rows))
    assert found.of("G2") == "holds"
    assert found.exit_code == 1


def test_excuses_are_listed_and_are_no_disagreement(tmp_path: Path) -> None:
    log, rows = full(tmp_path, lost=True)
    for there in rows:
        if there["requirement"] == "G2":
            there["verdict"] = "excused"
    found = judge(tools.with_report(log, rows))
    assert [d.kind for d in found.differences] == ["claimed excused"]
    assert found.exit_code == 1
    assert not found.disagreements


@pytest.mark.parametrize("gone", ["task 1 served", "end of mission", "authority over vehicle 2"])
def test_a_row_that_the_monitor_leaves_out(tmp_path: Path, gone: str) -> None:
    log, rows = full(tmp_path)
    found = judge(tools.with_report(log, [r for r in rows if r["item"] != gone]))
    assert not found.disagreements  # it holds, so that nothing is hidden
    scene = Scene(tasks=[task(1, "must_fly", (100, 0))]).straight(1, (0, 0, 300), NORTH)
    log = scene.write(tmp_path / "other" / "log.sqlite", end="failed")
    (different,) = [
        d for d in judge(tools.with_report(log, [])).disagreements if d.item == "task 1 served"
    ]
    assert (different.judge, different.monitor) == ("violated", "no row")


def test_a_report_of_another_log(tmp_path: Path) -> None:
    log, rows = full(tmp_path)
    folder = tools.with_report(log, rows)
    full(tmp_path, lost=True)
    found = judge(folder)
    assert found.disagreements
    assert found.disagreements[0].note == "the report is about another log"


# ---- bad input ------------------------------------------------------------------------------------


def refused(capsys, *arguments: str) -> dict[str, str]:
    """The typed error of the command line; never a traceback."""
    assert main(["judge", *arguments, "--json"]) == 2
    data = json.loads(capsys.readouterr().out)
    assert data["exit_code"] == 2
    assert data["error"]
    return data


def whole(folder: Path, **more) -> Path:
    return Scene(**more).straight(1, (0, 0, 300), NORTH).write(folder / "log.sqlite")


def test_files_that_are_no_logs(tmp_path: Path, capsys) -> None:
    assert "no such file" in refused(capsys, str(tmp_path / "none"))["error"]
    assert "no such file" in refused(capsys, str(tmp_path))["error"]
    text = tmp_path / "log.sqlite"
    text.write_text("not a database, but long enough to have a header " * 9)
    assert "not a message log" in refused(capsys, str(text))["error"]
    text.write_bytes(b"")
    assert "not a message log" in refused(capsys, str(text))["error"]
    other = tmp_path / "other.sqlite"
    with sqlite3.connect(other) as database:
        database.execute("CREATE TABLE msg(id INTEGER)")
    assert "tables messages and meta" in refused(capsys, str(other))["expected"]
    with sqlite3.connect(other) as database:
        database.execute("CREATE TABLE messages(a)")
        database.execute("CREATE TABLE meta(key, value)")
    assert refused(capsys, str(other))["error"] == "not a message log"


def test_every_truncation_is_refused(tmp_path: Path, capsys) -> None:
    log = whole(tmp_path)
    data = log.read_bytes()
    for size in range(0, len(data), 777):
        log.write_bytes(data[:size])
        refused(capsys, str(log))


def test_damage_anywhere_is_refused_or_changes_nothing(tmp_path: Path) -> None:
    log = whole(tmp_path)
    data = log.read_bytes()
    for place in range(0, len(data), 97):
        log.write_bytes(data[:place] + bytes([data[place] ^ 0x5A]) + data[place + 1 :])
        try:
            judge(log)
        except BadInput:
            continue


@pytest.mark.parametrize(
    "sql",
    [
        "DELETE FROM messages WHERE seq > 5",
        "DELETE FROM messages WHERE seq = 5",
        "UPDATE messages SET time_ms = 'soon' WHERE seq = 5",
        "UPDATE messages SET body = 7 WHERE seq = 5",
        "UPDATE messages SET body = x'4c4d4350' WHERE seq = 5",
        "UPDATE messages SET body = '{\"$type\"' WHERE seq = 5",
        "UPDATE messages SET body = replace(body, '300', '301') WHERE seq = 5",
        "UPDATE messages SET body = '[]' WHERE seq = 5",
        "UPDATE closing SET messages = 'many'",
        "UPDATE closing SET digest = x'00'",
        "UPDATE meta SET value = 'null'",
        "UPDATE meta SET value = x'00'",
        "UPDATE meta SET key = 'nothing'",
    ],
)
def test_a_log_that_was_meddled_with(tmp_path: Path, capsys, sql: str) -> None:
    log = whole(tmp_path)
    with sqlite3.connect(log) as database:
        database.execute(sql)
    refused(capsys, str(log))


HUGE = 10**400


@pytest.mark.parametrize(
    "edit",
    [
        lambda m: m.update(zones=None),
        lambda m: m.update(vehicles={}),
        lambda m: m.update(vehicles=[vehicle(1), vehicle(1)]),
        lambda m: m.update(zones=[zone(1, "keep_off", (0, 0), (0, 1), (1, 0))]),
        lambda m: m.update(zones=[zone(1, "keep_in", (0, 0), (0, 1))]),
        lambda m: m.update(zones=[zone(1, "keep_in", (0, 0), (5, 5), (5, 0), (0, 5))]),
        lambda m: m.update(zones=[zone(1, "keep_in", (0, 0), (0, HUGE), (5, 0))]),
        lambda m: m.update(zones=[zone(1, "keep_in", (0, 0), (0, 1e300), (5, 0))]),
        lambda m: m.update(zones=[zone(1, "keep_in", (0, 0), (0, True), (5, 0))]),
        lambda m: m.update(tasks=[task(1, "tea", (0, 0))]),
        lambda m: m.update(tasks=[task(1, "must_fly")]),
        lambda m: m.update(tasks=[task(HUGE, "must_fly", (0, 0))]),
        lambda m: m.update(tasks=[task(1, "loiter", (0, 0), duration_ms=-1)]),
        lambda m: m.update(tasks=[task(1, "must_fly", (0, 0))], relations="p1 p1"),
        lambda m: m.update(tasks=[task(1, "must_fly", (0, 0))], relations=".(p1 p2)"),
        lambda m: m.update(tasks=[task(1, "must_fly", (0, 0))], relations=".(p1"),
        lambda m: m.update(tasks=[task(1, "must_fly", (0, 0))], relations=".(" * 999 + "p1" + ")" * 999),
        lambda m: m.update(tasks=[task(1, "must_fly", (0, 0))], relations="p1_[9-1]"),
        lambda m: m.update(tasks=[task(1, "must_fly", (0, 0))], relations="p1_[0-" + "9" * 5000 + "]"),
        lambda m: m.update(changes=[changed(0, "task_added", 9)]),
        lambda m: m.update(changes=[changed(0, "earthquake", 9)]),
        lambda m: m["simulation"].update(step_ms=0),
        lambda m: m["frame"].update(latitude_deg=91.0),
        lambda m: m["daa"]["well_clear"].update(dthr_m=-1.0),
        lambda m: m.update(relations=5),
    ],
)  # fmt: skip
def test_a_mission_that_does_not_fit(tmp_path: Path, capsys, edit) -> None:
    scene = Scene().straight(1, (0, 0, 300), NORTH)
    edit(scene.mission)
    data = refused(capsys, str(scene.write(tmp_path / "log.sqlite")))
    assert data["item"] or data["where"]


@pytest.mark.parametrize(
    ("kind", "field", "value"),
    [
        ("TruthState", "North", "far"), ("TruthState", "North", HUGE), ("TruthState", "North", 1e300),
        ("TruthState", "North", None), ("TruthState", "Time", 1.5), ("TruthState", "Time", 2**70),
        ("TruthState", "VehicleID", True), ("TaskProgress", "Phase", "Dancing"),
        ("GateState", "Owner", "Nobody"), ("GateState", "Offered", 1), ("Heartbeat", "Direction", 0),
        ("GatedCommand", "Epoch", "1"),
    ],
)  # fmt: skip
def test_a_message_that_does_not_fit(tmp_path: Path, capsys, kind, field, value) -> None:
    scene = Scene(tasks=[task(1, "must_fly", (100, 0))]).straight(1, (0, 0, 300), NORTH).beats(1)
    scene.does(1, 1, 0, 500).commands(1, *TAKEN)
    next(m for m in scene.messages if m.kind == kind).body[field] = value
    data = refused(capsys, str(scene.write(tmp_path / "log.sqlite")))
    assert kind in data["item"]
    assert field in data["item"]


@pytest.mark.parametrize(
    "report", ["", "[]", "{}", '{"format": "cratous-report/1"}', "[" * 100_000]
)
def test_a_report_that_does_not_fit(tmp_path: Path, capsys, report: str) -> None:
    whole(tmp_path)
    (tmp_path / "report.json").write_text(report)
    refused(capsys, str(tmp_path))


@pytest.mark.parametrize(
    "text", ["", "a: [", "[]", "{name: x}", "&a [*a]", "name: !!python/object:os.system x"]
)
def test_a_mission_file_that_does_not_fit(tmp_path: Path, capsys, text: str) -> None:
    file = tmp_path / "mission.yaml"
    file.write_text(text)
    assert refused(capsys, str(whole(tmp_path)), "--mission", str(file))["where"] == str(file)
    refused(capsys, str(whole(tmp_path)), "--mission", str(tmp_path))


def test_the_mission_of_a_file(tmp_path: Path) -> None:
    """Paddings as distances, seconds as milliseconds, places in degrees."""
    file = tmp_path / "mission.yaml"
    file.write_text("""
name: file
frame: {latitude_deg: 45, longitude_deg: 7}
vehicles: [{id: 1, speed_m_s: 20, heading_deg: 0, position: {north_m: 0, east_m: 0, alt_m: 300}}]
tasks: [{id: 1, kind: must_fly, points: [{latitude_deg: 45.0009, longitude_deg: 7}]}]
zones: [{id: 7, kind: keep_out, padding_m: 10, vertices: [[90, 9], [90, 50], [110, 50], [110, 9]]}]
simulation: {step_ms: 1000}
changes: [{at_s: 7, zone: {id: 8, kind: keep_out, vertices: [[90, -5], [90, 5], [110, 5]]}}]
""")
    scene = Scene().straight(1, (0, 0, 300), NORTH).does(1, 1, 4000, 6000)
    found = verdicts(judge(scene.write(tmp_path / "log.sqlite"), file))
    assert found["zone: keep_out 7, flight of vehicle 1"] == "violated"
    assert found["zone: keep_out 8, flight of vehicle 1"] == "holds"
    assert found["task 1 served"] == "holds"


def test_a_mission_that_asks_for_nothing_is_unknown(tmp_path: Path) -> None:
    found = Scene(vehicles=[vehicle(1, protected=False)]).judged(tmp_path)
    assert [found.of(g) for g in ("G1", "G2", "G4", "G5")] == ["unknown"] * 4
    assert found.exit_code == 3
    assert mission()["tasks"] == []
