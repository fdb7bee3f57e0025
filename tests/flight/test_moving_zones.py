"""A keep-out that moves: what is refused, the regions that hold it, and flights judged where it is at each instant."""

from __future__ import annotations

import copy
import math
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
import shapely
import yaml
from flight_tools import flown, told_to_icarous
from hypothesis import given, settings
from hypothesis import strategies as st

from cratous.bridge.text_protocol import FenceDone, HardReset
from cratous.judge import judge
from cratous.judge.log import State
from cratous.judge.outlines import Zone as Judged
from cratous.judge.zones import Fence, beside
from cratous.services.certify.verdicts import broken_of
from cratous.services.certify.zone_positions import positions
from cratous.services.cli.job import Settings, new_bus, plan_and_check, run_mission
from cratous.services.exporting.exported import exported
from cratous.services.flight.encounter import ways_of
from cratous.services.loading import load
from cratous.services.mission.moving_zones import Now, exact_moving_leg_ok, moving_zones
from cratous.services.mission.zone_times import judged_zones, zones_of
from cratous.services.monitor.moving_plan import check_in_time
from cratous.services.processes.coverage import told_of
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission, MovingZone, Position, SweptZone
from cratous.spec.mission.changes import known_at

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "examples" / "moving_zone" / "mission.yaml"
FENCE = "zone: keep_out 7, flight of vehicle {}"
Data = dict[str, Any]


def mission_of(folder: Path, change: Callable[[Data], None] = lambda _: None) -> Mission:
    """The example with a change of its data."""
    data = yaml.safe_load(EXAMPLE.read_text(encoding="utf-8"))
    change(data)
    file = folder / "mission.yaml"
    file.write_text(yaml.safe_dump(data), encoding="utf-8")
    return load(file)


def zone(data: Data) -> Data:
    found: Data = data["zones"][1]
    return found


# -- loading ------------------------------------------------------------------------------------
def _link_loss(data: Data) -> None:
    data["link_loss"] = {"choice": "loiter"}


def _in_a_change(data: Data) -> None:
    data["changes"] = [{"at_s": 9, "zone": copy.deepcopy(zone(data)) | {"id": 8}}]


@pytest.mark.parametrize(
    ("change", "text"),
    [
        (lambda d: zone(d).update(kind="keep_in"), "keep-in zone 7 moves"),
        (lambda d: zone(d).update(velocity_m_s=[-25, 0.01]), "moves too fast"),
        (lambda d: zone(d).update(velocity_m_s=[0, 0]), "does not move"),
        (lambda d: zone(d).pop("velocity_m_s"), "does not move"),
        (lambda d: zone(d).update(velocity_m_s=[-250, 0]), "velocity_m_s"),
        (lambda d: zone(d).update(from_s=300), "never in force"),
        # in force only after the simulation's limit
        (
            lambda d: (
                zone(d).update(from_s=5000, until_s=6000),
                d.update(simulation={"limit_s": 3600}),
            ),
            "from_s: zone 7 is never in force",
        ),
        (lambda d: (zone(d).pop("until_s"), zone(d).update(velocity_m_s=[-20, 0])), "leaves the area"),
        (lambda d: d.update(changes=[{"at_s": 9, "zone_ends": 7}]), "its end is told"),
        (_in_a_change, "becomes known in flight"),
        (_link_loss, "without the link"),
        (
            lambda d: d.update(simulation={"bridge_faults": {"seed": 1, "loss": 0.1}}),
            "without the link",
        ),
        # over the vehicle, or over it soon
        (lambda d: zone(d).update(vertices=[[-90, -90], [-90, 90], [90, 0]]), "starts inside"),
        (lambda d: zone(d).update(vertices=[[400, -90], [400, 90], [500, 0]]), "starts inside"),
    ],
)  # fmt: skip
def test_what_cannot_be_flown_is_refused_with_its_place(
    tmp_path: Path, change: Callable[[Data], None], text: str
) -> None:
    with pytest.raises(BadInput) as error:
        mission_of(tmp_path, change)
    assert text in str(error.value)


def test_formats_and_modes_without_moving_zones_refuse_them() -> None:
    mission = load(EXAMPLE)
    for form in ("amase", "uxas", "kml", "geojson", "geofence"):
        with pytest.raises(BadInput, match="zone 7 moves"):
            exported(mission, form)
    with pytest.raises(BadInput, match="a zone moves"):
        told_of(mission)
    with pytest.raises(BadInput, match="velocity_m_s"):
        ways_of(mission)


# -- regions ------------------------------------------------------------------------------------
def _padded(data: Data) -> None:
    zone(data).update(padding_m=40, from_s=70, velocity_m_s=[-9, 5])


@pytest.mark.parametrize("change", [lambda _: None, _padded])
def test_a_region_holds_the_zone_at_every_instant_of_it(
    tmp_path: Path, change: Callable[[Data], None]
) -> None:
    mission = mission_of(tmp_path, change)
    (moving,) = moving_zones(mission)
    regions = [b for b in zones_of(mission, 10**9) if isinstance(b.zone, SweptZone)]
    assert len(regions) > 3
    assert regions[-1].until_ms == 300_000
    seen = 0
    for time_ms in range(0, 300_000, 1250):
        held = [b for b in regions if b.binds(time_ms)]
        known = [z for z in known_at(mission, time_ms).zones if isinstance(z, SweptZone)]
        assert known == [b.zone for b in held]
        if time_ms < moving.from_ms:
            continue
        (region,) = held
        gone_s = (time_ms - moving.from_ms) / 1000
        north, east = (gone_s * v for v in moving.velocity_m_s)
        there = shapely.Polygon([(n + north, e + east) for n, e in moving.vertices])
        assert shapely.Polygon(region.zone.vertices).contains(there.buffer(5.9))
        seen += 1
    assert seen > 150
    # what is judged is the zone itself
    assert [type(b.zone) for b in judged_zones(mission, 10**9)][-1] is MovingZone
    assert not any(isinstance(b.zone, SweptZone) for b in judged_zones(mission, 10**9))


def test_the_map_shows_where_it_is() -> None:
    region = {"id": 7, "moving": {"vertices": [(0, 0)], "velocity_m_s": (2, 0), "from_ms": 10_000,
                                  "until_ms": None}}  # fmt: skip
    found = positions([region, region], 40_000)
    assert [(zone["vertices"][0][0], at_s) for zone, at_s in found] == [
        (0.0, 10.0), (20.0, 20.0), (40.0, 30.0), (60.0, 40.0),
    ]  # fmt: skip
    assert len(positions([region], 10_000)) == 4
    assert positions([region], 9_999) == [], "it moves after the end of the flight"


# -- kernels against the judge's own code ---------------------------------------------------------
COORDINATE = st.integers(-40, 40).map(lambda k: k / 4)
PLACE = st.tuples(COORDINATE, COORDINATE, st.sampled_from([50.0, 100.0, 130.0]))
SHAPE = ((0.0, 0.0), (0.0, 6.0), (5.0, 6.0), (2.0, 3.0), (5.0, 0.0))


@settings(max_examples=300, deadline=None)
@given(PLACE, PLACE, st.tuples(COORDINATE, COORDINATE), st.integers(0, 9))
def test_judge_and_kernels_agree_on_every_leg(p: Any, q: Any, velocity: Any, k: int) -> None:
    begin_ms, end_ms = 250 * k, 250 * k + 1000
    moving = MovingZone(7, SHAPE, 90.0, 120.0, velocity, from_ms=500)
    ours = exact_moving_leg_ok(Position(*p), Position(*q), (begin_ms, end_ms), moving)
    own = Judged(7, False, SHAPE, 90.0, 120.0, 0.0, 500, None, velocity)
    states = [State(at, *x, 0, 0, 0) for at, x in ((begin_ms, p), (end_ms, q))]
    breaks = Fence(own).breaks(*(beside(state, own) for state in states))
    # a climbing leg is refused by the kernels if it is at the zone's altitudes anywhere, and over it anywhere
    assert ours != breaks or (p[2] != q[2] and not ours)
    if not breaks:
        return
    # a polygon that is moved to each of many instants is met, or nearly
    near = math.inf
    for step in range(201):
        share = step / 200
        at_s = Fraction(begin_ms - 500, 1000) + Fraction(share)
        there = shapely.Polygon(
            [(n + at_s * velocity[0], e + at_s * velocity[1]) for n, e in SHAPE]
        )
        here = shapely.Point(*(a + share * (b - a) for a, b in zip(p[:2], q[:2], strict=True)))
        near = min(near, float(there.distance(here)))
    assert near < 0.3


# -- flights --------------------------------------------------------------------------------------
Flown = tuple[Path, Data, dict[str, Data]]


def flight(mission: Mission, folder: Path) -> Flown:
    report = run_mission(mission, folder, Settings(allow_unproved=True))
    return folder, report, {row["item"]: row for row in report["constraints"] if row["source"] == "flight"}  # fmt: skip


@pytest.fixture(scope="module")
def drifted(tmp_path_factory: pytest.TempPathFactory) -> Flown:
    return flight(load(EXAMPLE), tmp_path_factory.mktemp("drifted"))


def test_one_vehicle_goes_around_it_and_the_other_waits(drifted: Flown) -> None:
    folder, report, rows = drifted
    assert report["flight"]["outcome"] == "complete"
    for vehicle in (1, 2):
        row = rows[FENCE.format(vehicle)]
        assert row["verdict"] == "holds"
        assert row["checks"] == 300_000 // 250
        assert row["margin"] > 0
        assert "motion.seen_from" in str(row["kernels"])
    # when it begins, task 2 lies in the zone
    done = {one["task"]: one["time_ms"] for one in report["flight"]["served"]}
    assert [one["task_id"] for one in report["plan"]["left_out"]] == [2]
    assert done[2] > 100_000
    assert not any(row["verdict"] == "violated" for row in rows.values())
    assert broken_of(report["assumptions"]) == []
    found = judge(folder, EXAMPLE)
    assert [one.line() for one in found.disagreements] == []
    assert {row.verdict for row in found.rows} == {"holds"}
    assert [one.line() for one in judge(folder).disagreements] == []
    assert "zone 7 at 100 s" in (folder / "map.svg").read_text(encoding="utf-8")


def test_icarous_gets_a_region_in_place_of_the_last_one(monkeypatch: pytest.MonkeyPatch) -> None:
    heard = told_to_icarous(monkeypatch)
    mission = load(EXAMPLE)
    simulation = type(mission.simulation)(limit_ms=120_000)
    flown(mission.__class__(**{**vars(mission), "simulation": simulation}))
    told = [message for vehicle, message in heard if vehicle == 1]
    assert [m.zone for m in told if isinstance(m, FenceDone)] == [1, 2, 2, 2]
    assert not any(isinstance(m, HardReset) for m in told)


def _trapped(data: Data) -> None:
    """A corridor that the zone sweeps from wall to wall."""
    data["vehicles"], data["tasks"] = data["vehicles"][:1], data["tasks"][:2]
    for task, east_m in zip(data["tasks"], (1500, 5000), strict=True):
        task.update(eligible=[1], points=[{"north_m": 0, "east_m": east_m, "alt_m": 400}])
    data["zones"][0]["vertices"] = [[-300, -500], [300, -500], [300, 6000], [-300, 6000]]
    ring = [[-400, 4000], [400, 4000], [400, 4300], [-400, 4300]]
    zone(data).update(vertices=ring, velocity_m_s=[0, -10], until_s=600)
    data["simulation"] = {"limit_s": 480}


@pytest.mark.long
def test_a_zone_that_cannot_be_avoided_is_violated_by_monitor_and_judge(tmp_path: Path) -> None:
    made = tmp_path / "out"
    made.mkdir()
    folder, report, rows = flight(mission_of(tmp_path, _trapped), made)
    row = rows[FENCE.format(1)]
    assert row["verdict"] == "violated"
    assert report["exit_code"] == 1
    found = judge(folder, tmp_path / "mission.yaml")
    assert [one.line() for one in found.disagreements] == []
    (own,) = [one for one in found.rows if one.item == row["item"]]
    assert (own.verdict, own.at_ms) == ("violated", row["time_ms"])


def _met_late(data: Data) -> None:
    """The zone is in force only from when the vehicle is near it."""
    data["vehicles"], data["tasks"] = data["vehicles"][:1], data["tasks"][:1]
    ring = [[-200, 4000], [200, 4000], [200, 4200], [-200, 4200]]
    zone(data).update(vertices=ring, velocity_m_s=[0, -8], from_s=150, until_s=400)


def test_a_plan_that_meets_it_later_is_not_said_to_hold(tmp_path: Path) -> None:
    mission = mission_of(tmp_path, _met_late)
    plan, checks = plan_and_check(mission, new_bus())
    assert not any("in time" in check.item for check in checks)
    (row,) = check_in_time(mission, plan)
    assert row.outcome == "unknown"
    # at 25 m/s against 8 m/s from 250 m away
    assert row.time_ms is not None
    assert row.time_ms / 1000 == pytest.approx(150 + 250 / 33, abs=2)


def test_a_leg_keeps_clear_of_a_zone_that_comes_for_as_long_as_it_is_flown() -> None:
    ring = ((0.0, -50.0), (100.0, -50.0), (100.0, 50.0), (0.0, 50.0))
    moving = MovingZone(7, ring, 0.0, 200.0, (-20.0, 0.0))
    leg = Position(-200.0, 0.0, 100.0), Position(-3.0, 0.0, 100.0)
    near = Position(-10.0, 0.0, 100.0), Position(-5.0, 0.0, 100.0)
    far = Position(-150.0, 0.0, 100.0), Position(-145.0, 0.0, 100.0)
    assert Now(moving, 0, 0).kept_by(leg, near, 1.0)  # 4 m away
    assert not Now(moving, 0, 250).kept_by(leg, near, 1.0)  # and it comes 5 m nearer
    assert Now(moving, 0, 250).kept_by(leg, far, 1.0)
