"""A vehicle that starts on the ground leaves it under ICAROUS, by permitted ways, and everybody who watches knows."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
import yaml
from ground_tools import Flown, assert_in_the_guide, flown_of, refusal

from cratous.bridge import lmcp
from cratous.services.flight.encounter import ways_of
from cratous.services.flight.take_off import require_take_offs
from cratous.services.loading import load
from cratous.services.logs.records import from_data, to_data
from cratous.services.mission.leg_bounds import LONGEST_LOOKAHEADS
from cratous.services.parameters.listing import parameters_of
from cratous.services.processes.coverage import told_of
from cratous.services.system_model.replay import replay
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission
from cratous.spec.mission.guarantees import Outcome

ROW = "take-off of vehicle 1"
WITHOUT_LINK = "what vehicle 1 flies without the link"
HOVERS = {"id": 9, "position": {"north_m": 600, "east_m": 0, "alt_m": 90}, "velocity": {"north_m_s": 0, "east_m_s": 0}}  # fmt: skip
FIELD = {"name": "field", "position": {"north_m": 0, "east_m": -500}, "radius_m": 60}


class TakeOff(Flown):
    """A flight, of which is asked what one vehicle did."""

    def of(self, topic: str, vehicle: int = 1) -> list[Any]:
        return [body for body in self.told(topic) if body.VehicleID == vehicle]

    def modes(self, vehicle: int = 1) -> list[tuple[str, str]]:
        return [(b.Mode.name, b.Reason) for b in self.of("TakeOffState", vehicle)]


def mission_file(root: Path, folder: Path, **sections: Any) -> Path:
    """The mission of the example with its first vehicle alone, and nobody else in the air."""
    data = yaml.safe_load((root / "examples/takeoff/mission.yaml").read_text())
    one = {"vehicles": data["vehicles"][:1], "tasks": data["tasks"][:1], "traffic": None}
    del data["expect"]
    path = folder / "mission.yaml"
    found = {k: v for k, v in {**data, **one, **sections}.items() if v is not None}
    path.write_text(yaml.safe_dump(found))
    return path


def flown(path: Path) -> TakeOff:
    mission = load(path)
    require_take_offs(mission)
    return TakeOff(*flown_of(mission))


@pytest.fixture(scope="module")
def both(root: Path) -> TakeOff:
    return flown(root / "examples/takeoff/mission.yaml")


def test_each_stands_rolls_and_climbs_and_flies_its_plan(both: TakeOff, tmp_path: Path) -> None:
    assert both.result.outcome == "complete"
    rolls, climbs, up = both.of("TakeOffState")
    assert [b.Mode.name for b in (rolls, climbs, up)] == ["Rolling", "Climbing", "Up"]
    truth = both.of("TruthState")
    ground = [b for b in truth if b.Altitude == 0]
    assert {(b.East, b.Heading) for b in ground} == {(0.0, 0.0)}
    assert all(a.VelocityNorth <= b.VelocityNorth for a, b in pairwise(ground))
    assert ground[-1].VelocityNorth == 15
    assert 110 <= ground[-1].North <= 125
    assert all(b.Altitude > 0 for b in truth if b.Time > ground[-1].Time)
    assert max(-b.VelocityDown for b in truth) <= 5
    there = next(b for b in truth if b.Time == up.Time)
    assert abs(there.Altitude - 150) < 5
    verdicts, judged = both.verdicts(), both.judged(tmp_path)
    for name in ("G1", "G2", "G3", "G4", "G5"):
        assert verdicts[name].outcome is Outcome.HOLDS, verdicts[name]
    assert set(judged.values()) == {"holds"}
    assert "off the ground at 14.75 s" in verdicts[ROW].note
    assert replay(both.mission, True, both.log).finding is None


def test_it_stands_while_no_way_up_is_permitted_and_says_why(both: TakeOff) -> None:
    said = both.modes(2)
    assert ("Standing", "it stands: vehicle 1 rolls") in said
    assert ("Standing", "it stands: it is not permitted against 9") in said
    rolls_ms = next(b.Time for b in both.of("TakeOffState", 2) if b.Mode.name == "Rolling")
    stood = [b for b in both.of("TruthState", 2) if b.Time < rolls_ms]
    assert rolls_ms > 15_000
    assert {(b.North, b.East, b.Altitude, b.VelocityNorth) for b in stood} == {(0, 1500, 0, 0)}


def test_a_mission_with_a_take_off_is_written_and_read(both: TakeOff) -> None:
    assert from_data(Mission, json.loads(json.dumps(to_data(both.mission)))) == both.mission


def test_monitor_and_judge_see_a_take_off_that_is_none(both: TakeOff, tmp_path: Path) -> None:
    rolls, climbs, up = both.of("TakeOffState")

    def changed(topic: str, edit: Callable[[dict[str, Any]], Any]) -> str:
        log = list[Any]()
        for one in both.log:
            if one.time_ms > up.Time + 5000 and not one.topic.endswith("MissionEnd"):
                continue
            body = one.body
            if one.topic.endswith(topic) and getattr(body, "VehicleID", 0) == 1:
                after = edit(json.loads(lmcp.to_json(body)))
                if after is None:
                    continue
                body = lmcp.from_json(json.dumps(after))
            log.append(replace(one, body=body))
        found = both.verdicts(log)[ROW].outcome.value
        assert both.judged(tmp_path, log)[ROW] == found
        return found

    assert changed("TakeOffState", lambda d: d) == "unknown"  # the log was cut behind it
    assert changed("TakeOffState", lambda d: d if d["Mode"] != "Rolling" else None) == "violated"
    assert changed("TakeOffState", lambda d: d if d["Mode"] != "Climbing" else None) == "violated"
    late = {"Time": climbs.Time + 3000}
    assert changed("TakeOffState", lambda d: {**d, **late} if d["Mode"] == "Climbing" else d) == "violated"  # fmt: skip
    silent = {"Heard": rolls.Time - 2001}
    assert changed("TakeOffState", lambda d: {**d, **silent} if d["Mode"] == "Rolling" else d) == "violated"  # fmt: skip
    assert changed("GateState", lambda d: {**d, "Owner": "UxAS"}) == "violated"
    stays = {"Altitude": 0.0, "VelocityDown": 0.0}
    assert changed("TruthState", lambda d: {**d, **stays}) == "violated"
    again = climbs.Time + 4000
    assert changed("TruthState", lambda d: {**d, **stays} if d["Time"] == again else d) == "violated"  # fmt: skip


@pytest.mark.parametrize(
    "unseen",
    [
        range(3000, 5000),
        range(250, 5000),  # all but the first step of the roll's begin
        range(14_000, 18_000),  # as it leaves the ground
        range(20_000),  # until it is in the air
        range(5000, 1_000_000),  # from the roll on
        range(1_000_000),
    ],
)
def test_of_a_take_off_that_was_not_seen_nothing_is_said(
    both: TakeOff, tmp_path: Path, unseen: range
) -> None:
    log = [o for o in both.log if not o.topic.endswith("TruthState") or o.time_ms not in unseen]
    found = both.verdicts(log)[ROW]
    assert found.outcome is Outcome.UNKNOWN, found.note
    assert both.judged(tmp_path, log)[ROW] == "unknown"


def test_a_roll_that_is_permitted_no_more_is_broken_off(root: Path, tmp_path: Path) -> None:
    comes = {**HOVERS, "appears_s": 8, "vanishes_s": 40}
    found = flown(mission_file(root, tmp_path, traffic=[comes]))
    said = [mode for mode, _ in found.modes()]
    assert said == ["Rolling", "Standing", "Rolling", "Climbing", "Up"]
    assert found.modes()[1][1] == "the roll is broken off: it is not permitted against 9"
    broken_ms = found.of("TakeOffState")[1].Time
    brakes = [b for b in found.of("TruthState") if broken_ms <= b.Time < 40_000]
    assert all(a.VelocityNorth - b.VelocityNorth <= 0.5 for a, b in pairwise(brakes))
    assert brakes[-1].VelocityNorth == 0
    assert found.result.outcome == "complete"
    row = found.verdicts()[ROW]
    assert (row.outcome.value, found.judged(tmp_path)[ROW]) == ("holds", "holds"), row


def test_a_climb_that_is_permitted_no_more_is_left_to_avoidance(root: Path, tmp_path: Path) -> None:
    comes = {**HOVERS, "appears_s": 20, "position": {"north_m": 600, "east_m": 0, "alt_m": 130}}
    found = flown(mission_file(root, tmp_path, traffic=[comes]))
    assert found.modes()[-1] == ("Up", "the climb is left: it is not permitted against 9")
    verdicts, judged = found.verdicts(), found.judged(tmp_path)
    for name in (ROW, "well clear of 1 and 9", "task 1 served"):
        assert verdicts[name].outcome is Outcome.HOLDS, verdicts[name]
        assert judged[name] == "holds"


def test_what_is_flown_without_the_link_begins_in_the_climb(root: Path, tmp_path: Path) -> None:
    """It takes off, the link breaks for good, and it lands beside where it started."""
    loss = {"choice": "land", "after_s": 3}
    cut = {"limit_s": 400, "bridge_faults": {"cut_s": 20}}
    path = mission_file(root, tmp_path, link_loss=loss, landing_sites=[FIELD], simulation=cut)
    found = flown(path)
    assert found.modes()[-1] == ("Up", "the climb is left: UxAS is not heard")
    lost = [b.Mode.name for b in found.of("LinkLossState")]
    assert lost[-1] == "Landed"
    verdicts, judged = found.verdicts(), found.judged(tmp_path)
    for name in (ROW, WITHOUT_LINK, "authority over vehicle 1"):
        assert verdicts[name].outcome is Outcome.HOLDS, verdicts[name]
        assert judged[name] == "holds", name
    assert replay(found.mission, True, found.log).finding is None


def test_without_the_link_nobody_leaves_the_ground(root: Path, tmp_path: Path) -> None:
    loss, cut = {"choice": "loiter", "after_s": 3}, {"limit_s": 60, "bridge_faults": {"cut_s": 10}}
    comes = {**HOVERS, "vanishes_s": 20}
    found = flown(mission_file(root, tmp_path, link_loss=loss, simulation=cut, traffic=[comes]))
    assert [mode for mode, _ in found.modes()] == ["Standing", "Standing"]
    assert found.modes()[-1][1] == "it stands: UxAS is not heard"
    assert {(b.North, b.Altitude) for b in found.of("TruthState")} == {(0.0, 0.0)}
    verdicts, judged = found.verdicts(), found.judged(tmp_path)
    assert verdicts[ROW].outcome.value == judged[ROW] == "holds"
    assert verdicts["well clear of 1 and 9"].outcome.value == "unknown"
    assert judged["well clear of 1 and 9"] == "unknown"
    (lost,) = found.of("LinkLossState")
    assert lost.Reason.endswith("it does not leave the ground")
    assert verdicts[WITHOUT_LINK].outcome.value == judged[WITHOUT_LINK] == "holds"


def test_who_never_may_is_given_up_by_name_where_it_stands(root: Path, tmp_path: Path) -> None:
    daa = {"lookahead_s": 20}
    found = flown(mission_file(root, tmp_path, traffic=[HOVERS], daa=daa))
    assert (found.result.outcome, found.result.end_ms < 200_000) == ("failed", True)
    assert found.result.failed[1].startswith("blocked: ICAROUS took vehicle 1 over once")
    verdicts, judged = found.verdicts(), found.judged(tmp_path)
    for name in ("authority over vehicle 1", ROW):
        assert (verdicts[name].outcome.value, judged[name]) == ("holds", "holds"), verdicts[name]
    assert "where it started" in verdicts["authority over vehicle 1"].note
    assert verdicts["task 1 served"].outcome.value == judged["task 1 served"] == "violated"
    moved = [
        replace(o, body=lmcp.from_json(lmcp.to_json(o.body).replace('"North":0', '"North":1')))
        if o.topic.endswith("TruthState") and o.time_ms == found.log[-1].time_ms
        else o
        for o in found.log
    ]
    assert found.verdicts(moved)["authority over vehicle 1"].outcome is Outcome.VIOLATED


@pytest.mark.parametrize("lost", [False, True])
def test_what_uxas_has_for_it_meanwhile_begins_up_there(
    root: Path, tmp_path: Path, lost: bool
) -> None:
    """Nothing is left for it while it stands, or climbs: it circles where its plan began, not down there."""
    data = yaml.safe_load((root / "examples/takeoff/mission.yaml").read_text())
    ground, air = data["vehicles"]
    del air["start"]
    far = {**data["tasks"][1], "points": [{"north_m": 5200, "east_m": 1500, "alt_m": 250}]}
    changes: list[dict[str, Any]] = [{"at_s": 0, "vehicle_holds": {"vehicle": 1}}]
    if lost:
        changes.append({"at_s": 5, "vehicle_lost": 1})
    path = mission_file(
        root, tmp_path, vehicles=[ground, air], tasks=[*data["tasks"][:lost], far],
        traffic=[{**HOVERS, "vanishes_s": 100}], daa={"lookahead_s": 20}, changes=changes,
    )  # fmt: skip
    found = flown(path)
    said = [o.body.Consequence for o in found.log if o.topic.endswith("MissionChange")]
    assert said[0] == "refused: it has not taken off"
    back = [b.Time for b in found.told("AuthorityChange") if b.Owner.name == "UxAS"]
    assert back[0] < found.result.end_ms - 60_000
    low = min(b.Altitude for b in found.of("TruthState") if b.Time >= back[0])
    assert low > 149


def test_a_take_off_is_none_of_the_time_that_avoidance_may_take(root: Path, tmp_path: Path) -> None:
    """It takes longer than ICAROUS may fly on a leg; its task is not given up for that, neither then nor later."""
    data = yaml.safe_load((root / "examples/takeoff/mission.yaml").read_text())
    slow = {**data["vehicles"][0], "max_climb_m_s": 1}
    far = {**data["tasks"][0], "points": [{"north_m": 8000, "east_m": 0, "alt_m": 150}]}
    sections = {"daa": {"lookahead_s": 20}, "simulation": {"limit_s": 900}}
    path = mission_file(root, tmp_path, vehicles=[slow], tasks=[far], **sections)
    found = flown(path)
    back = next(b.Time for b in found.told("AuthorityChange") if b.Owner.name == "UxAS")
    assert back > 1000 * LONGEST_LOOKAHEADS * 20
    assert found.result.outcome == "complete"
    assert dict(found.result.ends)[1] > back


def test_a_way_up_for_another_wind_is_not_flown(root: Path, tmp_path: Path) -> None:
    """Wind makes it faster over the ground: what was permitted for the roll and the climb is left."""
    wind = {"at_s": 4, "wind": {"north_m_s": -6, "east_m_s": 5}}
    again = {"at_s": 30, "wind": {**wind["wind"]}}  # type: ignore[dict-item]
    lulls = {"at_s": 6, "wind": {"north_m_s": 0, "east_m_s": 0}}
    found = flown(mission_file(root, tmp_path, changes=[wind, lulls, again]))
    why = "in the wind of now it flies at another speed"
    broken, left = f"the roll is broken off: {why}", f"the climb is left: {why}"
    said = found.modes()
    assert [text for _, text in said if why in text] == [broken, broken, left]
    assert [mode for mode, _ in said][-2:] == ["Climbing", "Up"]
    row = found.verdicts()[ROW]
    assert (row.outcome.value, found.judged(tmp_path)[ROW]) == ("holds", "holds"), row


def test_it_rolls_in_any_direction(root: Path, tmp_path: Path) -> None:
    """The velocity that is commanded is a hair below the least speed in some."""
    (kestrel,) = yaml.safe_load(mission_file(root, tmp_path).read_text())["vehicles"]
    turned = {**kestrel, "heading_deg": 42.33281461791092}
    short = {"limit_s": 20}
    found = flown(mission_file(root, tmp_path, vehicles=[turned], simulation=short))
    assert [mode for mode, _ in found.modes()] == ["Rolling", "Climbing"]
    assert found.of("TruthState")[-1].Altitude > 5


START = {"id": 1, "start": "ground", "position": {"north_m": 0, "east_m": 0, "alt_m": 150}, "heading_deg": 0, "speed_m_s": 22, "min_speed_m_s": 15}  # fmt: skip
AHEAD = [{"id": 7, "kind": "keep_out", "vertices": [[165, -50], [200, -50], [200, 50], [165, 50]], "ceiling_m": 5}]  # fmt: skip
WALL = [{"id": 7, "kind": "keep_out", "vertices": [[300, -50], [320, -50], [320, 50], [300, 50]]}]
GPS = {"kind": "gps", "horizontal_m": 3, "vertical_m": 5, "velocity_m_s": 0.3, "period_s": 1}
MESA = {"name": "mesa", "position": {"north_m": 200, "east_m": 0, "alt_m": 40}, "radius_m": 80}


@pytest.mark.parametrize(
    ("sections", "said"),
    [
        ({"vehicles": [START], "bridge": {"instances": 0}}, "vehicles[0].start: vehicle 1 starts on the ground: nobody takes it off; expected a vehicle with an ICAROUS instance"),
        ({"vehicles": [{**START, "position": {"north_m": 0, "east_m": 0, "alt_m": 0}}]}, "it would not leave the ground; expected a position above the ground of 0 m MSL; got 0 m MSL"),
        ({"vehicles": [{**START, "max_climb_m_s": 0.05}]}, "it climbs for too long; expected a take-off of at most 1800 s"),
        ({"landing_sites": [MESA], "link_loss": {"choice": "land"}}, "its roll may cross the rim of mesa, which is not as high; expected level ground for 168.8 m"),
        ({"sensing": {"sensors": [GPS, {**GPS, "kind": "adsb"}]}}, "a way up is not permitted against sensed tracks"),
        ({"zones": AHEAD, "vehicles": [{**START, "position": {"north_m": 0, "east_m": 0, "alt_m": 12}}]}, "vehicles[0].start: vehicle 1 cannot take off; expected a way up from where it stands, in the direction of heading_deg, clear of the zones; got a zone is where the roll would end"),
        ({"zones": WALL}, "vehicles[0].start: vehicle 1 cannot take off; expected a way up from where it stands, in the direction of heading_deg, clear of the zones; got zone 7 is in the way"),
        ({"vehicles": [{**START, "start": "hangar"}]}, "vehicles[0].start"),
    ],
)  # fmt: skip
def test_what_cannot_take_off_is_refused(
    root: Path, tmp_path: Path, sections: dict[str, Any], said: str
) -> None:
    assert said in refusal(mission_file(root, tmp_path, **sections), require_take_offs)


def test_a_start_on_a_site_is_as_high_as_the_site(root: Path, tmp_path: Path) -> None:
    wide = {**MESA, "position": {"north_m": 0, "east_m": 0, "alt_m": 40}, "radius_m": 400}
    loss = {"choice": "land"}
    mission = load(mission_file(root, tmp_path, landing_sites=[wide], link_loss=loss))
    (vehicle,) = mission.vehicles
    assert vehicle.stands_at.alt_m == 40  # type: ignore[attr-defined]
    require_take_offs(mission)


def test_it_is_not_flown_in_processes_nor_as_an_encounter(both: TakeOff) -> None:
    mission = replace(both.mission, relations="", frame=replace(both.mission.frame, terrain_m=0.0))
    for flies in (told_of, ways_of):
        with pytest.raises(BadInput) as caught:
            flies(mission)
        assert "vehicles.start" in str(caught.value)


def test_what_follows_from_a_take_off_is_a_parameter(both: TakeOff, root: Path) -> None:
    rows = parameters_of(both.mission, root / "examples/takeoff/mission.yaml")
    found = {row.name: row.value for row in rows if row.vehicle == 1}
    assert (found["take-off roll"], found["room to stop"], found["take-off"]) == (
        112.5,
        56.25,
        54.5,
    )


def test_the_diagram_in_the_guide_is_the_kernel_s(root: Path) -> None:
    assert_in_the_guide(root, "take_off_machine.py")
