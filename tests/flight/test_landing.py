"""A vehicle whose link breaks lands where the mission says, by permitted ways, and everybody who watches knows."""

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
from cratous.judge import judge
from cratous.services.flight.dynamics import AirState, touching_down, traffic_state
from cratous.services.flight.landing_reach import require_reachable
from cratous.services.flight.notices import truth
from cratous.services.loading import load
from cratous.services.parameters.listing import parameters_of
from cratous.services.system_model.replay import replay
from cratous.spec.mission import LandingLoss, LinkLossDaa, Position
from cratous.spec.mission.guarantees import Outcome

ROW = "what vehicle 1 flies without the link"
FIELD = {"name": "field", "position": {"north_m": 300, "east_m": 1500}, "radius_m": 60}
MEADOW = {"name": "meadow", "position": {"north_m": 1500, "east_m": -600}, "radius_m": 60, "ditch": True}  # fmt: skip


def modes(flight: Flown, vehicle: int = 1) -> list[str]:
    return [b.Mode.name for b in flight.told("LinkLossState") if b.VehicleID == vehicle]


def mission_file(root: Path, folder: Path, **sections: Any) -> Path:
    data = yaml.safe_load((root / "examples/landing/mission.yaml").read_text())
    del data["expect"]
    path = folder / "mission.yaml"
    found = {k: v for k, v in {**data, **sections}.items() if v is not None}
    path.write_text(yaml.safe_dump(found))
    return path


def flown(path: Path) -> Flown:
    return flown_of(load(path))


@pytest.fixture(scope="module")
def landed(root: Path) -> Flown:
    return flown(root / "examples/landing/mission.yaml")


def test_it_comes_down_on_the_site_and_stands_there(landed: Flown) -> None:
    assert modes(landed) == ["Land", "Final", "Landed"]
    down_ms = landed.told("LinkLossState")[-1].Time
    ground = [b for b in landed.told("TruthState") if b.Time >= down_ms]
    assert all(math.hypot(b.North - 300, b.East - 1500) < 60 for b in ground)
    assert {b.Altitude for b in ground} == {0.0}
    assert ground[-1].VelocityNorth == ground[-1].VelocityEast == 0
    before = [b for b in landed.told("TruthState") if b.Time < down_ms]
    assert all(b.Altitude > 0 for b in before)
    assert max(b.VelocityDown for b in before) <= 5


def test_what_it_leaves_is_served_by_nobody_and_said_so(landed: Flown) -> None:
    result, verdicts = landed.result, landed.verdicts()
    assert result.outcome == "failed"
    assert "it has landed at field" in result.failed[2]
    assert verdicts["task 1 served"].outcome is Outcome.HOLDS
    left = verdicts["task 2 served"]
    assert left.outcome is Outcome.VIOLATED
    assert "no vehicle could do it from" in left.note
    for name in ("G2", "G4", ROW):
        assert verdicts[name].outcome is Outcome.HOLDS, verdicts[name]
    assert "landed at field" in verdicts[ROW].note
    assert "landed at field" in verdicts["authority over vehicle 1"].note
    assert replay(landed.mission, True, landed.log).finding is None


def test_monitor_and_judge_see_a_landing_that_is_none(landed: Flown, tmp_path: Path) -> None:
    down_ms = landed.told("LinkLossState")[-1].Time

    def changed(topic: str, edit: Any, since_ms: int = down_ms - 2000) -> tuple[Outcome, str]:
        log = list[Any]()
        for one in landed.log:
            body = one.body
            if one.topic.endswith("TruthState") and one.time_ms < since_ms:
                continue  # what is asked here is where it came down
            if one.topic.endswith(topic):
                data = json.loads(lmcp.to_json(body))
                after = edit(data)
                if after is None:
                    continue
                body = lmcp.from_json(json.dumps(after))
            log.append(replace(one, body=body))
        found = landed.verdicts(log)[ROW].outcome
        return found, landed.judged(tmp_path, log)[ROW]

    good = Outcome.HOLDS, "holds"
    bad, unseen = (Outcome.VIOLATED, "violated"), (Outcome.UNKNOWN, "unknown")
    assert changed("LinkLossState", lambda d: d, 0) == good
    assert changed("LinkLossState", lambda d: d) == unseen
    assert changed("TruthState", lambda d: {**d, "Altitude": d["Altitude"] + 5}) == bad
    assert changed("TruthState", lambda d: {**d, "North": d["North"] + 200}) == bad
    assert changed("LinkLossState", lambda d: d if d["Mode"] != "Landed" else None) == bad
    assert changed("LinkLossState", lambda d: d if d["Mode"] != "Final" else None) == bad
    assert changed("LinkLossState", lambda d: {**d, "Chosen": "Return"}) == bad
    assert changed("LinkLossState", lambda d: {**d, "Heard": d["Heard"] - 1000}) == bad
    assert changed("LinkLossState", lambda d: None) == bad
    early = {"Time": down_ms - 1000}
    assert changed("LinkLossState", lambda d: {**d, **early} if d["Mode"] == "Landed" else d) == bad
    heard = {"Heard": landed.told("LinkLossState")[1].Time}
    assert changed("LinkLossState", lambda d: {**d, **heard} if d["Mode"] == "Final" else d) == bad
    rolls = down_ms + 500
    assert changed("TruthState", lambda d: d if d["Time"] < rolls else None) == unseen
    assert changed("TruthState", lambda d: d if d["Time"] < down_ms - 1000 else None, 0) == unseen
    late = range(down_ms - 1000, down_ms + 1000)
    assert changed("TruthState", lambda d: None if d["Time"] in late else d, 0) == unseen
    gap = range(down_ms - 5000, down_ms - 4000)
    assert changed("TruthState", lambda d: None if d["Time"] in gap else d, 0) == unseen
    end = landed.told("TruthState")[-1]
    moves = {"North": end.North + 0.0005, "VelocityNorth": 1.0}
    assert changed("TruthState", lambda d: {**d, **moves} if d["Time"] == end.Time else d, 0) == bad


def test_a_takeover_does_not_end_in_the_roll(landed: Flown, tmp_path: Path) -> None:
    rolls = landed.told("LinkLossState")[-1].Time + 500
    log = [o for o in landed.log if not o.topic.endswith("TruthState") or o.time_ms < rolls]
    name = "authority over vehicle 1"
    assert landed.verdicts(log)[name].outcome is Outcome.UNKNOWN
    assert landed.judged(tmp_path, log)[name] == "unknown"


def test_the_judge_knows_that_it_landed(landed: Flown, tmp_path: Path) -> None:
    found = landed.judged(tmp_path)
    assert found[ROW] == found["authority over vehicle 1"] == found["well clear of 1"] == "holds"
    assert found["task 2 served"] == "violated"


def test_who_is_on_the_ground_is_in_nobodys_way(root: Path, tmp_path: Path) -> None:
    """Somebody hovers over the field: it ditches; that one flies low over the meadow once it stands there."""
    hovers = {"id": 9, "position": {"north_m": 300, "east_m": 1500, "alt_m": 20}, "velocity": {"north_m_s": 0, "east_m_s": 0}}  # fmt: skip
    passes = {"id": 10, "position": {"north_m": 1500, "east_m": -600, "alt_m": 25}, "velocity": {"north_m_s": 30, "east_m_s": 0}, "appears_s": 150}  # fmt: skip
    found = flown(mission_file(root, tmp_path, traffic=[hovers, passes]))
    assert modes(found)[-1] == "Landed"
    reasons = [body.Reason for body in found.told("LinkLossState")]
    assert "here at meadow (field: it is not permitted against 9)" in reasons[0]
    assert reasons[-1] == "landed at meadow"
    verdicts, judged = found.verdicts(), found.judged(tmp_path)
    for other in (9, 10):
        assert verdicts[f"well clear of 1 and {other}"].outcome is Outcome.HOLDS
        assert judged[f"well clear of 1 and {other}"] == "holds"


def test_heard_in_the_last_descent_it_lands_all_the_same(root: Path, tmp_path: Path) -> None:
    faults = {"cut_s": 40, "reconnect_s": 135}
    found = flown(
        mission_file(root, tmp_path, simulation={"limit_s": 400, "bridge_faults": faults})
    )
    assert modes(found) == ["Land", "Final", "Landed"]
    assert found.result.outcome == "failed"
    assert found.verdicts()["G4"].outcome is Outcome.HOLDS


def test_of_who_comes_when_it_stands_nothing_is_said_to_be_seen(
    landed: Flown, root: Path, tmp_path: Path
) -> None:
    """Somebody drives by where it stands: both say that they do not know, of the pair and of no other row."""
    drives = {"id": 9, "position": {"north_m": 300, "east_m": 1530, "alt_m": 1}, "velocity": {"north_m_s": 3, "east_m_s": 0}, "appears_s": 158}  # fmt: skip
    mission, log = load(mission_file(root, tmp_path, traffic=[drives])), list[Any]()
    (traffic,) = mission.traffic
    for one in landed.log:
        log.append(one)
        if one.topic.endswith("TruthState") and (air := traffic_state(traffic, one.time_ms)):
            log.append(replace(one, body=truth(9, air, one.time_ms, False)))
    found, name = Flown(mission, log, landed.result), "well clear of 1 and 9"
    assert found.verdicts()[name].outcome is Outcome.UNKNOWN
    assert found.verdicts()[ROW].outcome is Outcome.HOLDS
    assert found.judged(tmp_path)[ROW] == "holds"
    (row,) = [row for row in judge(tmp_path / "log.sqlite").rows if row.item == name]
    assert (row.verdict, row.checks) == ("unknown", 0)
    assert "on the ground" in row.note


def test_a_site_takes_one_vehicle(root: Path, tmp_path: Path) -> None:
    """The second lands elsewhere, since one stands at the first site; where it did not, monitor and judge would know."""
    kestrel = yaml.safe_load((root / "examples/landing/mission.yaml").read_text())["vehicles"][0]
    near = [
        {**kestrel, "id": k, "position": {"north_m": 300, "east_m": east_m, "alt_m": 90}}
        for k, east_m in ((1, 600), (2, 1100))
    ]
    cut = {"limit_s": 400, "bridge_faults": {"cut_s": 1}}
    found = flown(mission_file(root, tmp_path, vehicles=near, simulation=cut, zones=None))
    reasons = [(body.VehicleID, body.Reason) for body in found.told("LinkLossState")]
    assert reasons[-2:] == [(1, "the last descent to meadow"), (1, "landed at meadow")]
    assert (2, "landed at field") in reasons
    places = {b.VehicleID: b for b in found.told("TruthState")}
    stands = {"North": places[2].North, "East": places[2].East}

    def beside_it(one: Any) -> Any:
        data = json.loads(lmcp.to_json(one.body))
        ours = one.topic.endswith("TruthState") and data["VehicleID"] == 1
        if not ours or data["Altitude"] > 0:
            return one
        return replace(one, body=lmcp.from_json(json.dumps({**data, **stands})))

    there = [beside_it(one) for one in found.log]
    row = found.verdicts(there)[ROW]
    assert row.outcome.value == found.judged(tmp_path, there)[ROW] == "violated"
    assert "vehicle 2 was there before it" in row.note


def test_who_is_flown_into_the_ground_ends_there(root: Path, tmp_path: Path) -> None:
    """UxAS flies it into a hill beside its site, which no file may have: monitor and judge say so."""
    hill = {"name": "hill", "position": {"north_m": 200, "east_m": 0, "alt_m": 50}, "radius_m": 60}
    mission = load(mission_file(root, tmp_path, landing_sites=[FIELD, hill], zones=None))
    loss = mission.link_loss
    assert isinstance(loss, LandingLoss)
    higher = replace(loss, sites=(loss.sites[0], replace(loss.sites[1], ground_m=350.0)))
    assert isinstance(mission.daa, LinkLossDaa)
    found = flown_of(replace(mission, daa=replace(mission.daa, link_loss=higher)))
    assert found.result.outcome == "failed"
    row = found.verdicts()[ROW]
    assert "landed at hill" in row.note
    assert row.outcome.value == found.judged(tmp_path)[ROW] == "violated"


RING = [
    [[200, 1300], [400, 1300], [400, 1400], [200, 1400]],
    [[200, 1600], [400, 1600], [400, 1700], [200, 1700]],
    [[380, 1400], [400, 1400], [400, 1600], [380, 1600]],
    [[200, 1400], [220, 1400], [220, 1600], [200, 1600]],
]
AROUND = [{"id": k, "kind": "keep_out", "vertices": ring} for k, ring in enumerate(RING, 21)]
NEAR = [{"id": 8, "kind": "keep_out", "vertices": [[200, 1300], [400, 1300], [400, 1450], [200, 1450]]}]  # fmt: skip
LAND = {"choice": "land", "after_s": 3}
SINKS = {"id": 1, "position": {"north_m": 0, "east_m": 0, "alt_m": 300}, "heading_deg": 0, "speed_m_s": 15, "max_climb_m_s": 0.001}  # fmt: skip


@pytest.mark.parametrize(
    ("sections", "said"),
    [
        ({"landing_sites": None, "link_loss": LAND}, "link_loss.choice: there is no landing site"),
        ({"link_loss": {**LAND, "site": "fild"}}, "link_loss.site: there is no such landing site; expected one of landing_sites: field, meadow; got fild"),
        ({"link_loss": {"choice": "return"}}, "landing_sites: no vehicle lands at these sites"),
        ({"landing_sites": None, "link_loss": {"choice": "return", "site": "field"}}, "link_loss.site: no vehicle lands at this site"),
        ({"link_loss": {**LAND, "to": {"name": "a", "position": {"north_m": 0, "east_m": 0, "alt_m": 300}}}}, "link_loss.to: nothing returns there"),
        ({"landing_sites": [FIELD, {**MEADOW, "name": "field"}]}, "landing_sites[1].name: two landing sites have the same name"),
        ({"zones": NEAR}, "landing_sites[0].position: nobody may land at field; expected a disc on the ground that keeps zone 8"),
        ({"landing_sites": [{**FIELD, "radius_m": 35}]}, "landing_sites[0].radius_m: vehicle 1 does not come to a stand on field; expected at least 35.62 m"),
        ({"landing_sites": [FIELD, {**MEADOW, "position": {"north_m": 300, "east_m": 1380}}]}, "landing_sites[1].position: landing sites field and meadow overlap; expected middles more than 120 m apart; got 120 m"),
        ({"landing_sites": [{**FIELD, "position": {"north_m": 300, "east_m": 1500, "alt_m": 300}}]}, "landing_sites[0].position: the ground of field is as high as vehicle 1 flies; expected below 300 m MSL, at which it starts or flies its tasks; got 300 m MSL"),
        ({"frame": {"latitude_deg": 37.1, "longitude_deg": -76.4, "terrain_m": 320}, "landing_sites": [{**FIELD, "position": {"north_m": 300, "east_m": 1500, "alt_m": 10}}]}, "frame.terrain_m: the terrain is as high as vehicle 1 flies"),
        ({"zones": AROUND, "landing_sites": [FIELD]}, "landing_sites: vehicle 1 can land nowhere"),
        ({"vehicles": [SINKS]}, "field: its last descent takes longer than 1800 s"),
        ({"link_loss": LAND, "bridge": {"instances": 0}}, "nobody would act by it"),
    ],
)  # fmt: skip
def test_what_makes_no_sense_is_refused(
    root: Path, tmp_path: Path, sections: dict[str, Any], said: str
) -> None:
    assert said in refusal(mission_file(root, tmp_path, **sections), require_reachable)


def test_what_follows_from_a_landing_is_a_parameter(landed: Flown, root: Path) -> None:
    rows = parameters_of(landed.mission, root / "examples/landing/mission.yaml")
    found = {row.name: row.value for row in rows}
    assert (found["landing roll"], found["least site"], found["landing gate"]) == (
        56.25,
        35.625,
        60,
    )


def test_a_site_that_no_way_reaches_leaves_another(root: Path, tmp_path: Path) -> None:
    require_reachable(load(mission_file(root, tmp_path, zones=AROUND)))
    require_reachable(load(mission_file(root, tmp_path, zones=AROUND, link_loss=LAND)))


@pytest.mark.parametrize(
    ("height_m", "climbs_m_s"),
    [(1.0, -4.0), (0.5, -2.0), (0.629, -2.516), (0.6349, -2.5396), (0.636, -2.5), (2.0, -2.5)],
)
def test_who_comes_to_the_ground_comes_down_to_it(height_m: float, climbs_m_s: float) -> None:
    """A step that would end millimetres above the ground, where it counts as on it, ends on it: nothing jumps there."""
    wanted_m_s = -5.0 if height_m == 1.0 else -2.5
    air = AirState(Position(0.0, 0.0, 100.0 + height_m), 0.0, 15.0, wanted_m_s)
    assert touching_down(air, 100.0, 0.25).climb_m_s == pytest.approx(climbs_m_s)
