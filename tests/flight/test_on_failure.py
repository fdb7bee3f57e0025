"""After a declared failure a vehicle flies what the mission says, by permitted ways, and everybody who watches knows."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import yaml
from ground_tools import Flown, flown_of, refusal

from cratous.bridge import lmcp
from cratous.core.authority.failure import Asked, Failure, Seen, failure_step
from cratous.judge.mission_file import read
from cratous.services.flight.encounter import ways_of
from cratous.services.flight.landing_reach import require_reachable
from cratous.services.icarous import failing
from cratous.services.loading import load
from cratous.services.logs.records import from_data, to_data
from cratous.services.mission.landing import on_failure_of
from cratous.services.monitor import failure as monitor_failure
from cratous.services.processes.coverage import told_of
from cratous.services.system_model.replay import replay
from cratous.spec.authority import failure as spec
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission
from cratous.spec.mission.guarantees import Outcome
from cratous.spec.mission.on_failure import Failed

ROW, AUTHORITY = "what vehicle 1 does after a failure", "authority over vehicle 1"
HOVERS = {"id": 90, "position": {"north_m": 1850, "east_m": 0, "alt_m": 300}, "velocity": {"north_m_s": 0, "east_m_s": 0}}  # fmt: skip
BESIDE = {"id": 90, "position": {"north_m": 540, "east_m": 0, "alt_m": 300}, "velocity": {"north_m_s": 22, "east_m_s": 1}, "appears_s": 30, "vanishes_s": 90}  # fmt: skip
TOWARDS = {"id": 90, "position": {"north_m": 2500, "east_m": 0, "alt_m": 300}, "velocity": {"north_m_s": -22, "east_m_s": 0}}  # fmt: skip
FAR = [{"id": 1, "kind": "must_fly", "points": [{"north_m": 3000, "east_m": 0, "alt_m": 300}]}]
OVER_IT = [{"at_s": 10, "zone": {"id": 9, "kind": "keep_out", "vertices": [[-300, -500], [900, -500], [900, 500], [-300, 500]]}}]  # fmt: skip
AROUND = [{"id": 8, "kind": "keep_out", "vertices": [[200, 1300], [400, 1300], [400, 1450], [200, 1450]]}]  # fmt: skip
SENSORS = {"sensors": [{"kind": "gps", "horizontal_m": 3, "vertical_m": 2, "velocity_m_s": 0.3}, {"kind": "adsb", "horizontal_m": 8, "vertical_m": 6, "velocity_m_s": 0.8, "latency_s": 0.4, "drop_out": 0.1}]}  # fmt: skip
LARGE = [{"name": "field", "position": {"north_m": 300, "east_m": 1500}, "radius_m": 150}]


def mission_file(root: Path, folder: Path, **sections: Any) -> Path:
    data = yaml.safe_load((root / "tests/missions/on_failure.yaml").read_text())
    found = {k: v for k, v in {**data, **sections}.items() if v is not None}
    path = folder / "mission.yaml"
    path.write_text(yaml.safe_dump(found))
    return path


def modes(flight: Flown) -> list[str]:
    return [body.Mode.name for body in flight.told("LinkLossState")]


def failures(flight: Flown) -> list[tuple[str, int]]:
    return [(body.Failure.name, body.IntruderID) for body in flight.told("FailureState")]


def assert_known(flight: Flown, folder: Path) -> None:
    """Monitor, judge and the model of authority have no doubt of what was done; what was asked was not served."""
    verdicts, judged = flight.verdicts(), flight.judged(folder)
    for item in (ROW, AUTHORITY, "failures of vehicle 1 are declared when due"):
        assert verdicts[item].outcome is Outcome.HOLDS, verdicts[item]
        assert judged[item] == "holds"
    assert verdicts["G3"].outcome is Outcome.VIOLATED
    assert judged["task 1 served"] == judged["end of mission"] == "violated"
    assert replay(flight.mission, True, flight.log).finding is None
    # ICAROUS has the vehicle from the declaration on
    (declared,) = flight.told("FailureState")
    gates = [body for body in flight.told("GateState") if body.Time >= declared.Time]
    assert all(body.Owner.name == "ICAROUS" for body in gates)


@pytest.fixture(scope="module")
def ended(root: Path) -> Flown:
    return flown_of(load(root / "tests/missions/on_failure.yaml"))


def test_a_mission_that_cannot_be_completed_ends_on_the_ground(
    ended: Flown, tmp_path: Path
) -> None:
    assert failures(ended) == [("Ended", 0)]
    assert modes(ended) == ["Land", "Final", "Landed"]
    assert ended.result.outcome == "failed"
    last = ended.told("TruthState")[-1]
    assert math.hypot(last.North - 300, last.East - 1500) < 60
    assert (last.Altitude, last.VelocityNorth, last.VelocityEast) == (0, 0, 0)
    assert_known(ended, tmp_path)
    assert ended.verdicts()["G1"].outcome is Outcome.HOLDS
    assert "no line of UxAS" not in str(ended.verdicts())


@pytest.mark.parametrize(
    ("after", "flies"),
    [
        ({"choice": "hold"}, ["Loiter"]),
        ({"choice": "return"}, ["Return", "Over"]),
        ({"choice": "return", "to": {"name": "base", "position": {"north_m": 0, "east_m": -600, "alt_m": 280}}}, ["Return", "Over"]),
        ({"choice": "ditch"}, ["Land", "Final", "Landed"]),
    ],
)  # fmt: skip
def test_each_choice_is_flown(
    root: Path, tmp_path: Path, after: dict[str, Any], flies: list[str]
) -> None:
    sites = None if after["choice"] in ("hold", "return") else {}
    more = {"landing_sites": None} if sites is None else {}
    flight = flown_of(load(mission_file(root, tmp_path, on_failure=after, **more)))
    assert failures(flight) == [("Ended", 0)]
    assert modes(flight) == flies
    assert flight.result.outcome == "failed"
    last = flight.told("TruthState")[-1]
    if after["choice"] == "ditch":
        assert math.hypot(last.North - 1500, last.East + 900) < 60
    if "to" in after:
        assert math.hypot(last.North, last.East + 600) < 400
        assert last.Altitude == pytest.approx(280, abs=2)
    assert_known(flight, tmp_path)


def test_a_vehicle_that_cannot_be_told_is_not_waited_for_to_the_limit(
    root: Path, tmp_path: Path
) -> None:
    """Its link is cut while UxAS has it: it never hears that its mission is stopped."""
    simulation = {"limit_s": 1000, "bridge_faults": {"seed": 1, "cut_s": 5}}
    flight = flown_of(load(mission_file(root, tmp_path, simulation=simulation)))
    assert failures(flight) == []
    assert flight.result.outcome == "failed"
    assert flight.result.end_ms < 200_000
    assert flight.verdicts()["G3"].outcome is Outcome.VIOLATED


def test_a_vehicle_that_is_blocked_lands(root: Path, tmp_path: Path) -> None:
    """Somebody hovers behind the goal: the task is given up, the vehicle lands, and no other task is begun."""
    flight = flown_of(load(mission_file(root, tmp_path, traffic=[HOVERS], changes=None)))
    assert failures(flight) == [("Blocked", 90)]
    assert modes(flight) == ["Land", "Final", "Landed"]
    assert flight.result.failed[1].startswith("blocked: ")
    assert_known(flight, tmp_path)


@pytest.mark.parametrize(
    ("sections", "said"),
    [
        ({"traffic": [BESIDE], "changes": None}, ("Surprised", 90)),
        ({"traffic": [TOWARDS], "changes": OVER_IT}, ("Expiring", 0)),
    ],
)
def test_without_a_certificate_for_four_heartbeats_it_lands(
    root: Path, tmp_path: Path, sections: dict[str, Any], said: tuple[str, int]
) -> None:
    """Somebody appears beside it, or a zone over it while ICAROUS has it: it circles until a way is permitted."""
    flight = flown_of(load(mission_file(root, tmp_path, tasks=FAR, **sections)))
    assert failures(flight) == [said]
    assert modes(flight) == ["Loiter", "Land", "Final", "Landed"]
    first = flight.told("LinkLossState")[0]
    assert first.Time == flight.told("FailureState")[0].Time
    assert "a circle is flown until it is" in first.Reason
    left = flight.result.failed[1]
    assert "it has declared a failure" in left
    assert_known(flight, tmp_path)


def test_where_no_way_is_permitted_it_holds_and_says_so(root: Path, tmp_path: Path) -> None:
    """Somebody hovers low over the only site: it circles for five look-aheads, and the flight ends."""
    site = [{"name": "field", "position": {"north_m": 300, "east_m": 1500}, "radius_m": 60}]
    low = {**HOVERS, "position": {"north_m": 300, "east_m": 1500, "alt_m": 20}}
    path = mission_file(root, tmp_path, traffic=[low], landing_sites=site, daa={"lookahead_s": 20})
    flight = flown_of(load(path))
    assert failures(flight) == [("Ended", 0)]
    assert modes(flight) == ["Loiter"]
    (said,) = flight.told("LinkLossState")
    assert "field: it is not permitted against 90; a circle is flown until it is" in said.Reason
    assert 100_000 < flight.result.end_ms - said.Time < 101_000
    assert_known(flight, tmp_path)


def test_what_it_is_not_asked_about_changes_nothing(root: Path, tmp_path: Path) -> None:
    after = {"choice": "hold", "of": ["blocked", "expiring", "surprised"]}
    path = mission_file(root, tmp_path, on_failure=after, landing_sites=None)
    flight = flown_of(load(path))
    assert (flight.result.outcome, failures(flight), modes(flight)) == ("failed", [], [])
    plain = mission_file(root, tmp_path, on_failure=None, landing_sites=None)
    assert flight.result == flown_of(load(plain)).result
    assert flight.verdicts()[ROW].note == "it declared no failure"
    assert flight.judged(tmp_path)[ROW] == "holds"


@pytest.mark.parametrize("seed", [1, 2])
def test_it_lands_by_what_its_sensors_say(root: Path, tmp_path: Path, seed: int) -> None:
    """Its altitude is wrong by metres: it sinks until it feels the ground, on the disc, which has room for that."""
    sections = {"sensing": {"seed": seed, **SENSORS}, "landing_sites": LARGE}
    flight = flown_of(load(mission_file(root, tmp_path, **sections)))
    assert failures(flight) == [("Ended", 0)]
    assert modes(flight) == ["Land", "Final", "Landed"]
    last = flight.told("TruthState")[-1]
    assert math.hypot(last.North - 300, last.East - 1500) < 150
    assert (last.Altitude, last.VelocityNorth, last.VelocityEast) == (0, 0, 0)
    assert_known(flight, tmp_path)
    seen = [one for one in flight.told("SensedState") if one.TrackID == 1]
    truth = {one.Time: one for one in flight.told("TruthState") if one.VehicleID == 1}
    assert max(abs(one.Altitude - truth[one.Time].Altitude) for one in seen) > 0.5


def test_it_lands_clear_of_a_sensed_aircraft(root: Path, tmp_path: Path) -> None:
    """It is surprised by one that flies beside it, and sees it only by ADS-B, with errors and drop-outs."""
    sections = {"traffic": [BESIDE], "changes": None, "tasks": FAR, "landing_sites": LARGE}
    path = mission_file(root, tmp_path, sensing={"seed": 1, **SENSORS}, **sections)
    flight = flown_of(load(path))
    assert failures(flight) == [("Surprised", 90)]
    assert modes(flight) == ["Loiter", "Land", "Final", "Landed"]
    assert_known(flight, tmp_path)


def test_who_stands_on_the_ground_is_seen_by_no_sensor(root: Path, tmp_path: Path) -> None:
    """Both land, one after the other: once the first is down the second has no track of it."""
    data = yaml.safe_load((root / "tests/missions/on_failure.yaml").read_text())
    other = {**data["vehicles"][0], "id": 2, "position": {"north_m": -900, "east_m": 900, "alt_m": 360}}  # fmt: skip
    sites = [
        *LARGE,
        {"name": "far", "position": {"north_m": -1500, "east_m": 900}, "radius_m": 150},
    ]
    sections = {"vehicles": [data["vehicles"][0], other], "landing_sites": sites}
    after = {"choice": "land"}
    path = mission_file(root, tmp_path, on_failure=after, sensing=SENSORS, **sections)
    flight = flown_of(load(path))
    landed = {b.VehicleID: b.Time for b in flight.told("LinkLossState") if b.Mode.name == "Landed"}
    assert sorted(landed) == [1, 2]
    first, second = sorted(landed, key=lambda number: landed[number])
    coast_ms = 6000
    assert landed[second] > landed[first] + coast_ms
    tracks = [one for one in flight.told("SensedState") if one.ObserverID == second]
    assert any(one.VehicleID == first for one in tracks)
    late = [one.Time for one in tracks if one.VehicleID == first]
    assert max(late) < landed[first] + coast_ms
    verdicts, judged = flight.verdicts(), flight.judged(tmp_path)
    for vehicle in (1, 2):
        row = f"what vehicle {vehicle} does after a failure"
        assert verdicts[row].outcome is Outcome.HOLDS
        assert judged[row] == "holds"


def test_another_vehicle_takes_over_its_tasks(root: Path, tmp_path: Path) -> None:
    data = yaml.safe_load((root / "tests/missions/on_failure.yaml").read_text())
    other = {
        **data["vehicles"][0],
        "id": 2,
        "position": {"north_m": -800, "east_m": 900, "alt_m": 300},
    }
    vehicles, after = [data["vehicles"][0], other], {"choice": "hold", "of": ["surprised"]}
    sections = {"vehicles": vehicles, "tasks": FAR, "traffic": [BESIDE], "changes": None}
    path = mission_file(root, tmp_path, on_failure=after, landing_sites=None, **sections)
    flight = flown_of(load(path))
    assert failures(flight) == [("Surprised", 90)]
    assert flight.result.outcome == "complete"
    done = [b.VehicleID for b in flight.told("TaskProgress") if b.Phase.name == "Complete"]
    assert done == [2]
    assert flight.verdicts()["G3"].outcome is Outcome.HOLDS
    judged = flight.judged(tmp_path)
    assert judged["task 1 served"] == judged[ROW] == judged[AUTHORITY] == "holds"


def test_monitor_and_judge_see_what_does_not_follow(ended: Flown, tmp_path: Path) -> None:
    (declared,) = ended.told("FailureState")

    def changed(topic: str, edit: Any) -> tuple[str, str]:
        log = list[Any]()
        for one in ended.log:
            body = one.body
            if one.topic.endswith(topic):
                after = edit(json.loads(lmcp.to_json(body)))
                if after is None:
                    continue
                body = lmcp.from_json(json.dumps(after))
            log.append(replace(one, body=body))
        return ended.verdicts(log)[ROW].outcome.value, ended.judged(tmp_path, log)[ROW]

    bad, good = ("violated", "violated"), ("holds", "holds")
    assert changed("FailureState", lambda d: d) == good
    for other in ("Blocked", "Expiring", "Surprised"):
        assert changed("FailureState", lambda d, name=other: {**d, "Failure": name}) == bad
    assert changed("FailureState", lambda d: None) == bad
    early = {"Time": declared.Time - 1000}
    assert changed("FailureState", lambda d: {**d, **early}) == bad
    assert changed("LinkLossState", lambda d: {**d, "Chosen": "Return"}) == bad
    assert changed("LinkLossState", lambda d: None if d["Mode"] == "Final" else d) == bad
    assert changed("LinkLossState", lambda d: None) == bad
    assert changed("TruthState", lambda d: {**d, "North": d["North"] + 200}) == bad
    assert changed("GateState", lambda d: {**d, "Owner": "UxAS"}) == bad


def test_a_mission_is_read_back_as_it_was_logged(root: Path, tmp_path: Path) -> None:
    path = root / "tests/missions/on_failure.yaml"
    mission = load(path)
    assert from_data(Mission, to_data(mission)) == mission
    after, judged = on_failure_of(mission), read(path).after_failure
    assert after is not None
    assert judged is not None
    assert after.of == tuple(Failed)
    assert (judged.choice, judged.of) == ("Land", {one.value.capitalize() for one in Failed})
    (note,) = (note for note in mission.notes if "declared failure" in note)
    assert note.endswith("each vehicle with ICAROUS acts by itself: land at field")


LAND = {"choice": "land"}


@pytest.mark.parametrize(
    ("sections", "said"),
    [
        ({"sensing": SENSORS}, "landing_sites[0].radius_m: vehicle 1 does not come to a stand on field; expected at least 95.62 m"),
        ({"bridge": {"instances": 0}}, "on_failure: nobody would act by it"),
        ({"landing_sites": None}, "on_failure.site: there is no such landing site; expected one of landing_sites: none"),
        ({"on_failure": {"choice": "ditch", "site": "field"}}, "on_failure.site: there is no such landing site to ditch at; expected one of landing_sites: meadow; got field"),
        ({"on_failure": {"choice": "hold"}}, "landing_sites: no vehicle lands at these sites"),
        ({"on_failure": {"choice": "return", "site": "field"}, "landing_sites": None}, "on_failure.site: no vehicle lands at this site"),
        ({"on_failure": {**LAND, "to": {"name": "a", "position": {"north_m": 0, "east_m": 0, "alt_m": 300}}}}, "on_failure.to: nothing returns there"),
        ({"on_failure": {"choice": "return", "to": {"name": "a", "position": {"north_m": 0, "east_m": 0, "alt_m": 30}}}, "landing_sites": None}, "on_failure.to.position: no manoeuvre goes so low"),
        ({"on_failure": {**LAND, "of": ["lost"]}}, "on_failure.of[0]"),
        ({"zones": AROUND}, "landing_sites[0].position: nobody may land at field"),
    ],
)  # fmt: skip
def test_what_makes_no_sense_is_refused(
    root: Path, tmp_path: Path, sections: dict[str, Any], said: str
) -> None:
    assert said in refusal(mission_file(root, tmp_path, **sections), require_reachable)


def test_it_is_not_flown_by_programs_or_encounters(root: Path) -> None:
    mission = load(root / "tests/missions/on_failure.yaml")
    with pytest.raises(BadInput, match="flown after a failure"):
        told_of(replace(mission, changes=()))
    with pytest.raises(BadInput, match="changes"):
        ways_of(mission)
    with pytest.raises(BadInput, match="on_failure"):
        ways_of(replace(mission, changes=()))


ALL, NOTHING = Asked(True, True, True, True), Seen(False, True, False, 0, False, 0)


@pytest.mark.parametrize(
    ("seen", "kind"),
    [
        (NOTHING, spec.NONE),
        (NOTHING._replace(stopped=True), spec.BLOCKED),
        (NOTHING._replace(stopped=True, flies=False), spec.ENDED),
        (NOTHING._replace(without=True, since_ms=8000), spec.EXPIRING),
        (NOTHING._replace(without=True, since_ms=8001), spec.NONE),
        (NOTHING._replace(without=True, since_ms=8000, expiry_ms=11_999), spec.EXPIRING),
        (NOTHING._replace(without=True, since_ms=8000, expiry_ms=12_000), spec.NONE),
        (NOTHING._replace(without=True, since_ms=8000, expiry_ms=12_000, surprised=True), spec.SURPRISED),
        (NOTHING._replace(without=True, flies=False, since_ms=0), spec.NONE),
    ],
)  # fmt: skip
def test_which_failure_is_declared(seen: Seen, kind: int) -> None:
    none = Failure(spec.NONE, 0)
    found = failure_step(none, ALL, seen, 0, 10_000, 2000)
    assert found.kind == kind
    assert failure_step(none, Asked(False, False, False, False), seen, 0, 10_000, 2000) == none
    for committed in (6, 7):
        assert failure_step(none, ALL, seen, committed, 10_000, 2000) == none
    assert failure_step(found, ALL, NOTHING._replace(stopped=True), 2, 11_000, 2000).kind == (
        kind or spec.BLOCKED
    )


def test_all_have_the_same_reserve() -> None:
    assert failing.RESERVE_BEATS == monitor_failure.RESERVE_BEATS
