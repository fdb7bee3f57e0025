"""Vehicles that merge pass the fix one after the other, at slots granted by a majority, as monitor and judge confirm."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import combinations, pairwise
from pathlib import Path
from typing import Any

import pytest
import yaml
from ground_tools import Flown, flown_of

from cratous.bridge import lmcp
from cratous.judge.mission_file import read
from cratous.services.bus import Bus
from cratous.services.flight.encounter import ways_of
from cratous.services.flight.loop import fly
from cratous.services.loading import load
from cratous.services.logs.records import from_data, to_data
from cratous.services.mission.merging import TOLERANCE_MS, merging_of
from cratous.services.monitor.required_rows import merge_item
from cratous.services.parameters.listing import parameters_of
from cratous.services.pipeline.plan import make_plan
from cratous.services.processes.coverage import told_of
from cratous.spec.errors import BadInput
from cratous.spec.mission import MergingDaa, Mission
from cratous.spec.mission.guarantees import Outcome

EXAMPLE = "examples/merging/mission.yaml"
FAR_M, BEYOND_M = 4000.0, 3000.0


class Merged(Flown):
    """A flight with merging."""

    def stages(self, vehicle: int) -> list[str]:
        """The successive stages of a vehicle."""
        said = [b.Stage.name for b in self.told("MergeState") if b.VehicleID == vehicle]
        return [s for k, s in enumerate(said) if not k or said[k - 1] != s]

    def passed(self, vehicle: int) -> int:
        """Time of the logged state nearest to the fix, which is the origin [ms]."""
        states = [b for b in self.told("TruthState") if b.VehicleID == vehicle]
        return min((math.hypot(b.North, b.East), b.Time) for b in states)[1]

    def slot(self, vehicle: int) -> int:
        """The last slot of a vehicle [ms]."""
        return [b.Slot for b in self.told("MergeState") if b.VehicleID == vehicle and b.Slot >= 0][
            -1
        ]

    def rows(self, log: list[Any] | None = None) -> dict[str, Outcome]:
        """The monitor's outcomes for all pairs."""
        return {
            item: v.outcome for item, v in self.verdicts(log).items() if "separation at" in item
        }


def mission_file(root: Path, folder: Path, count: int = 3, **merging: Any) -> Path:
    """A mission of `count` vehicles that arrive at the fix at one time, from within a half circle."""
    data = yaml.safe_load((root / EXAMPLE).read_text())
    del data["expect"]
    vehicles, tasks = [], []
    for k in range(count):
        course = math.radians(180 / count * k)
        north, east = math.cos(course), math.sin(course)
        place = {"north_m": -FAR_M * north, "east_m": -FAR_M * east, "alt_m": 300}
        goal = {"north_m": BEYOND_M * north, "east_m": BEYOND_M * east, "alt_m": 300}
        one = {"id": k + 1, "position": place, "heading_deg": math.degrees(course)}
        vehicles.append({**data["vehicles"][0], **one, "label": f"vehicle {k + 1}"})
        tasks.append({"id": k + 1, "kind": "must_fly", "eligible": [k + 1], "points": [goal]})
    data |= {"vehicles": vehicles, "tasks": tasks}
    data["relations"] = f"|({' '.join(f'p{k + 1}' for k in range(count))})"
    data["merging"] |= {"vehicles": [k + 1 for k in range(count)], "faults": {}} | merging
    path = folder / "mission.yaml"
    path.write_text(yaml.safe_dump(data))
    return path


def flown(path: Path) -> Merged:
    return Merged(*flown_of(load(path)))


def assert_merged(flight: Merged, folder: Path) -> None:
    """All pass at their slots, far enough apart for monitor and judge, and the mission is complete."""
    merging = merging_of(flight.mission)
    assert merging is not None
    assert flight.result.outcome == "complete"
    for one in merging.vehicles:
        near_ms = TOLERANCE_MS + flight.mission.simulation.step_ms
        assert abs(flight.passed(one) - flight.slot(one)) <= near_ms
        assert flight.stages(one)[-1] == "Away"
    rows, verdicts = flight.rows(), flight.verdicts()
    assert len(rows) == len(list(combinations(merging.vehicles, 2)))
    assert set(rows.values()) == {Outcome.HOLDS}
    assert [verdicts[g].outcome for g in ("G1", "G2", "G3")] == [Outcome.HOLDS] * 3
    judged = flight.judged(folder)
    assert {item: judged[item] for item in rows} == dict.fromkeys(rows, "holds")
    assert set(judged.values()) == {"holds"}


@pytest.fixture(scope="module")
def example(root: Path) -> Merged:
    return flown(root / EXAMPLE)


def test_the_leader_is_lost_and_all_pass_one_after_the_other(
    example: Merged, tmp_path: Path
) -> None:
    assert_merged(example, tmp_path)
    led = [(b.Time, b.Leader) for b in example.told("MergeState") if b.VehicleID == 3]
    leaders = [leader for _, leader in led if leader]
    assert list(dict.fromkeys(leaders)) == [1, 2]
    # what it learns from a message is recorded at its next heartbeat, before vehicle 1 falls silent
    assert led[1] == (4000, 1)
    assert {b.Leader for b in example.told("MergeState") if b.VehicleID == 1} >= {1, 2}
    # one takeover each, with the reason, and a handback beyond the fix
    for one in (1, 2, 3):
        taken, back = (b for b in example.told("AuthorityChange") if b.VehicleID == one)
        assert taken.Owner.name == "ICAROUS"
        assert taken.Reason.startswith("merging: it is flown to be at the fix at")
        assert back.Time >= example.passed(one)
    assert example.stages(1) == ["Away", "Asking", "InSlot", "Away"]


@pytest.mark.parametrize("count", [4, pytest.param(6, marks=pytest.mark.long)])
def test_many_pass_though_the_leader_is_lost_for_good(
    root: Path, tmp_path: Path, count: int
) -> None:
    """Vehicle 1 leads until all that request a slot have one, and is then never heard again."""
    silent = [{"vehicle": 1, "from_s": 40}]
    flight = flown(mission_file(root, tmp_path, count, faults={"silent": silent}))
    assert_merged(flight, tmp_path)
    passed = sorted(flight.passed(k + 1) for k in range(count))
    assert {after - before for before, after in pairwise(passed)} == {22_000}
    for one in range(2, count + 1):
        led = [b.Leader for b in flight.told("MergeState") if b.VehicleID == one and b.Leader]
        assert list(dict.fromkeys(led)) == [1, 2]


def test_a_leader_that_is_lost_before_it_has_a_slot_holds_outside(
    root: Path, tmp_path: Path
) -> None:
    """It is never heard again: the others pass, it circles until its task is given up, and is in nobody's way."""
    silent = [{"vehicle": 1, "from_s": 20}]
    flight = flown(mission_file(root, tmp_path, 3, faults={"silent": silent}))
    assert list(flight.result.failed) == [1]
    assert flight.result.failed[1].startswith("blocked: ")
    assert flight.stages(1) == ["Away", "Asking", "Holding", "Away"]
    pairs = [("unknown", (1, 2)), ("unknown", (1, 3)), ("holds", (2, 3))]
    expected = {merge_item("gate", *pair): verdict for verdict, pair in pairs}
    assert {item: row.value for item, row in flight.rows().items()} == expected
    judged = flight.judged(tmp_path)
    assert {item: judged[item] for item in expected} == expected
    assert flight.verdicts()["G2"].outcome is Outcome.HOLDS
    assert abs(flight.passed(3) - flight.passed(2)) == 22_000


def test_too_near_in_time_is_seen_by_both(example: Merged, tmp_path: Path) -> None:
    daa = example.mission.daa
    assert isinstance(daa, MergingDaa)
    stricter = replace(daa, merging=replace(daa.merging, separation_ms=30_000))
    mission = replace(example.mission, daa=stricter)
    strict = Merged(mission, example.log, example.result)
    near, far = merge_item("gate", 2, 3), merge_item("gate", 1, 2)
    assert strict.rows()[near] is Outcome.VIOLATED
    assert strict.rows()[far] is Outcome.HOLDS
    judged = strict.judged(tmp_path)
    assert (judged[near], judged[far]) == ("violated", "holds")


def test_what_was_not_seen_is_unknown_to_both(example: Merged, tmp_path: Path) -> None:
    def seen(one: Any) -> bool:
        hidden = one.topic.endswith("TruthState") and one.body.VehicleID == 2
        return not (hidden and 150_000 <= one.time_ms <= 200_000)

    log = [one for one in example.log if seen(one)]
    with_2, without = merge_item("gate", 1, 2), merge_item("gate", 1, 3)
    assert example.rows(log)[with_2] is Outcome.UNKNOWN
    assert example.rows(log)[without] is Outcome.HOLDS
    judged = example.judged(tmp_path, log)
    assert (judged[with_2], judged[without]) == ("unknown", "holds")


def test_without_icarous_they_are_there_at_once(root: Path, tmp_path: Path) -> None:
    mission = load(mission_file(root, tmp_path, 2))
    bus, log = Bus(lmcp.full_names), list[Any]()
    bus.tap(log.append)
    flight = Merged(mission, log, fly(mission, make_plan(mission), bus, daa=False))
    assert set(flight.rows().values()) == {Outcome.VIOLATED}
    assert flight.judged(tmp_path)[merge_item("gate", 1, 2)] == "violated"


def test_who_comes_too_early_at_any_speed_holds_outside(root: Path, tmp_path: Path) -> None:
    flight = flown(mission_file(root, tmp_path, 2, separation_s=110))
    assert_merged(flight, tmp_path)
    held = [one for one in (1, 2) if "Holding" in flight.stages(one)]
    assert len(held) == 1
    merging = merging_of(flight.mission)
    assert merging is not None
    holds = [b.Time for b in flight.told("MergeState") if b.Stage.name == "Holding"]
    goes = [
        b.Time for b in flight.told("MergeState") if b.Stage.name == "InSlot" and b.Time > holds[0]
    ]
    there = [b for b in flight.told("TruthState") if b.VehicleID == held[0]]
    while_held = [math.hypot(b.North, b.East) for b in there if holds[0] <= b.Time < goes[0]]
    assert min(while_held) > merging.entry_m


def test_messages_that_are_lost_cost_time_alone(root: Path, tmp_path: Path) -> None:
    flight = flown(mission_file(root, tmp_path, 2, faults={"loss": 0.5, "seed": 3}))
    assert_merged(flight, tmp_path)


def test_the_same_twice(root: Path, tmp_path: Path) -> None:
    mission = load(mission_file(root, tmp_path, 2, faults={"loss": 0.3}))
    mission = replace(mission, simulation=replace(mission.simulation, limit_ms=40_000))
    logs = [[lmcp.to_json(one.body) for one in flown_of(mission).log] for _ in range(2)]
    assert logs[0] == logs[1]
    assert any("MergeState" in one for one in logs[0])


def test_a_mission_is_read_back_as_it_was_logged(root: Path) -> None:
    mission = load(root / EXAMPLE)
    assert from_data(Mission, to_data(mission)) == mission
    fix, merging = read(root / EXAMPLE).fix, merging_of(mission)
    assert fix is not None
    assert merging is not None
    assert (fix.name, fix.vehicles) == (merging.name, frozenset(merging.vehicles))
    assert (fix.separation_ms, fix.entry_m) == (merging.separation_ms, merging.entry_m)
    assert "vehicles 1, 2, 3 pass gate at least 20 s apart" in mission.notes[0]


@pytest.mark.parametrize(
    ("merging", "item", "what"),
    [
        ({"vehicles": [1, 9]}, "merging.vehicles[1]", "no such vehicle"),
        ({"schedule_m": 4000}, "merging", "zones that do not lie in each other"),
        ({"schedule_m": 350}, "merging.schedule_m", "nobody can hold before the entry zone"),
        ({"separation_s": 2}, "merging.separation_s", "slots are nearer than well clear"),
        ({"faults": {"silent": [{"vehicle": 3, "from_s": 1}]}}, "merging.faults.silent[0].vehicle", "it does not merge"),
        ({"vehicles": [1]}, "merging.vehicles", ""),
        ({"entry_m": 0}, "merging.entry_m", ""),
    ],
)  # fmt: skip
def test_what_does_not_make_sense_is_refused(
    root: Path, tmp_path: Path, merging: dict[str, Any], item: str, what: str
) -> None:
    with pytest.raises(BadInput) as caught:
        load(mission_file(root, tmp_path, 2, **merging))
    assert item in str(caught.value)
    assert what in str(caught.value)


def with_first_task(path: Path, north_m: float, **fields: Any) -> Path:
    """The mission, in which vehicle 1 first has a task at a place on its way along the north axis."""
    data = yaml.safe_load(path.read_text())
    place = {"north_m": north_m, "east_m": 0, "alt_m": 300}
    first = {"id": 9, "kind": "must_fly", "eligible": [1], "points": [place]}
    data["tasks"].append({**first, **fields})
    data["relations"] = "|(.(p9 p1) p2)"
    path.write_text(yaml.safe_dump(data))
    return path


@pytest.mark.parametrize(
    ("north_m", "fields", "got"),
    [
        (0, {}, "0 m before it"),
        (-200, {}, "200 m before it"),
        (-450, {}, "450 m before it"),
        (-450, {"eligible": [1, 2]}, "450 m before it"),
        (-700, {}, ""),
        (200, {}, ""),
    ],
)
def test_a_task_at_the_fix_or_too_near_before_it_is_refused(
    root: Path, tmp_path: Path, north_m: float, fields: dict[str, Any], got: str
) -> None:
    path = with_first_task(mission_file(root, tmp_path, 2), north_m, **fields)
    if not got:
        load(path)
        return
    with pytest.raises(BadInput) as caught:
        load(path)
    said = str(caught.value)
    assert "tasks[2].points: it begins at the fix gate, or too near before it" in said
    assert got in said
    assert "or beyond it" in said


@pytest.mark.long
def test_a_task_before_the_fix_is_flown_before_a_slot_is_taken(root: Path, tmp_path: Path) -> None:
    path = with_first_task(mission_file(root, tmp_path, 2), -1500)
    flight = flown(path)
    assert_merged(flight, tmp_path)
    assert "InSlot" in flight.stages(1)


def test_vehicles_that_cannot_wait_or_that_nobody_flies_are_refused(
    root: Path, tmp_path: Path
) -> None:
    path = mission_file(root, tmp_path, 2)
    data = yaml.safe_load(path.read_text())
    steady = {"min_speed_m_s": 22, "max_speed_m_s": 22}
    for change, what in (
        ({"vehicles": [{**data["vehicles"][0], **steady}, data["vehicles"][1]]}, "it cannot be there at any time"),
        ({"bridge": {"instances": 1}}, "nobody merges it"),
        ({"vehicles": [{**data["vehicles"][0], "start": "ground"}, data["vehicles"][1]]}, "it starts on the ground"),
        ({"link_loss": {"choice": "loiter"}}, "keeps no slot"),
        ({"sensing": {"sensors": [{"kind": "adsb", "horizontal_m": 5, "vertical_m": 5, "velocity_m_s": 1}]}}, "miss their slots"),
    ):  # fmt: skip
        path.write_text(yaml.safe_dump({**data, **change}))
        with pytest.raises(BadInput, match=what):
            load(path)


def test_it_is_not_flown_where_nobody_talks(root: Path) -> None:
    mission = load(root / EXAMPLE)
    with pytest.raises(BadInput, match="vehicles merge at a fix"):
        told_of(mission)
    with pytest.raises(BadInput, match="merging"):
        ways_of(mission)


def test_its_parameters_are_listed(root: Path) -> None:
    path = root / EXAMPLE
    found = {(one.name, one.vehicle): one for one in parameters_of(load(path), path)}
    assert found["merging.separation_s", 0].value == 20
    assert found["merging.coordination_m", 0].origin == "given"
    assert found["slots apart", 0].value == 22
    assert found["merging", 2].value == pytest.approx(3500 / 15 + 66, abs=0.01)


def test_one_that_avoids_traffic_on_the_way_to_its_slot_is_in_time(
    root: Path, tmp_path: Path
) -> None:
    path = mission_file(root, tmp_path, 2)
    data = yaml.safe_load(path.read_text())
    place = {"north_m": -1800, "east_m": 2000, "alt_m": 300}
    data["traffic"] = [{"id": 9, "position": place, "velocity": {"north_m_s": 0, "east_m_s": -20}}]
    path.write_text(yaml.safe_dump(data))
    flight = flown(path)
    assert_merged(flight, tmp_path)
    # its route is straight along the north axis
    aside = [abs(b.East) for b in flight.told("TruthState") if b.VehicleID == 1]
    assert max(aside) > 100


def test_one_that_has_declared_a_failure_keeps_no_slot(root: Path, tmp_path: Path) -> None:
    """Somebody appears beside vehicle 1 on the way to its slot: it acts by itself, and the other passes at its own."""
    path = mission_file(root, tmp_path, 2)
    data = yaml.safe_load(path.read_text())
    beside = {"id": 90, "position": {"north_m": -3030, "east_m": 30, "alt_m": 300}, "velocity": {"north_m_s": 22, "east_m_s": 1}, "appears_s": 40, "vanishes_s": 110}  # fmt: skip
    after = {"choice": "hold", "of": ["surprised"]}
    path.write_text(yaml.safe_dump({**data, "traffic": [beside], "on_failure": after}))
    flight = flown(path)
    (failed,) = flight.told("FailureState")
    assert (failed.Failure.name, failed.VehicleID) == ("Surprised", 1)
    assert failed.Time > next(b.Time for b in flight.told("MergeState") if b.Slot >= 0)
    assert flight.stages(1) == ["Away", "Asking", "InSlot", "Away"]
    told = [b for b in flight.told("MergeState") if b.VehicleID == 1][-1]
    assert (told.Time, told.Request, told.Slot) == (failed.Time, 0, -1)
    assert abs(flight.passed(2) - flight.slot(2)) <= TOLERANCE_MS
    verdicts, judged = flight.verdicts(), flight.judged(tmp_path)
    rows = [f"what vehicle {k} does after a failure" for k in (1, 2)]
    for row in (*rows, "authority over vehicle 1"):
        assert verdicts[row].outcome is Outcome.HOLDS, verdicts[row]
        assert judged[row] == "holds"
    (separation,) = flight.rows()  # only one of the two passed
    assert (verdicts[separation].outcome, judged[separation]) == (Outcome.UNKNOWN, "unknown")
    assert from_data(Mission, to_data(flight.mission)) == flight.mission
