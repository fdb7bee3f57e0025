"""A vehicle whose link breaks does what the mission chose, by permitted ways, and goes on once it is heard again."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import yaml
from ground_tools import Flown, assert_in_the_guide, flown_of
from loading_tools import small

from cratous.bridge import lmcp
from cratous.services.flight.encounter import ways_of
from cratous.services.loading import load
from cratous.services.parameters.listing import parameters_of
from cratous.services.processes.coverage import told_of
from cratous.services.system_model.replay import replay
from cratous.spec.errors import BadInput
from cratous.spec.mission import FaultySimulation, Simulation
from cratous.spec.mission.bridge_faults import BridgeFaults
from cratous.spec.mission.guarantees import Outcome, Verdict

ROW = "what vehicle 1 flies without the link"
MEADOW = (300.0, 900.0)
SENSING = {"seed": 3, "sensors": [{"kind": "gps", "horizontal_m": 3, "vertical_m": 3, "velocity_m_s": 0.3}, {"kind": "adsb", "horizontal_m": 8, "vertical_m": 6, "velocity_m_s": 0.8}]}  # fmt: skip
LAP_RADIUS_M = 1.1 * 22**2 / (9.80665 * math.tan(math.radians(30)))
"""Of a circle at the vehicle's speed [m]."""
AHEAD = {"id": 9, "position": {"north_m": 400, "east_m": 3200, "alt_m": 265}, "velocity": {"north_m_s": 0, "east_m_s": -30}}  # fmt: skip


class WithoutLink(Flown):
    """A flight, of which is asked what is flown without the link."""

    def modes(self) -> list[tuple[int, str]]:
        return [(body.Time, body.Mode.name) for body in self.told("LinkLossState")]


def mission_file(root: Path, tmp_path: Path, **sections: Any) -> Path:
    data = yaml.safe_load((root / "tests/missions/link_loss.yaml").read_text())
    path = tmp_path / "mission.yaml"
    path.write_text(yaml.safe_dump({**data, **sections}))
    return path


def flown(path: Path) -> WithoutLink:
    return WithoutLink(*flown_of(load(path)))


@pytest.fixture(scope="module")
def returned(root: Path) -> WithoutLink:
    return flown(root / "tests/missions/link_loss.yaml")


def test_it_returns_by_a_permitted_way_and_the_mission_goes_on(returned: WithoutLink) -> None:
    begin, over, again = returned.modes()
    assert [name for _, name in (begin, over, again)] == ["Return", "Over", "Linked"]
    heard = returned.told("LinkLossState")[0].Heard
    assert heard + 3000 < begin[0] <= heard + 3000 + 500
    assert again[0] == 110_000
    near = [
        math.hypot(b.North - MEADOW[0], b.East - MEADOW[1])
        for b in returned.told("TruthState")
        if over[0] <= b.Time <= again[0]
    ]
    assert max(near) < 300
    assert returned.result.outcome == "complete"
    verdicts = returned.verdicts()
    for name in ("G1", "G2", "G3", "G4", ROW):
        assert verdicts[name].outcome is Outcome.HOLDS, verdicts[name]
    assert verdicts["G5"].outcome is Outcome.VIOLATED  # heartbeats did not come
    assert replay(returned.mission, True, returned.log).finding is None


def test_uxas_commands_nothing_meanwhile_and_counts_no_leg(returned: WithoutLink) -> None:
    commands = [
        one.time_ms for one in returned.log
        if one.topic.endswith("GatedCommand") and one.body.Sender.name == "UxAS"
    ]  # fmt: skip
    assert [t for t in commands if 30_000 <= t < 111_000] == []
    assert any(t >= 111_000 for t in commands)
    assert returned.told("CommandDropped") == []
    reasons = [body.Reason for body in returned.told("AuthorityChange")]
    assert reasons == ["link: UxAS is not heard", "the way back is free: handed back"]


def test_it_finishes_the_known_way(root: Path, tmp_path: Path) -> None:
    found = flown(mission_file(
        root, tmp_path, link_loss={"choice": "finish", "after_s": 3},
        simulation={"limit_s": 400, "bridge_faults": {"cut_s": 30, "reconnect_s": 150}},
    ))  # fmt: skip
    assert [name for _, name in found.modes()] == ["Finish", "Over", "Linked"]
    end = found.modes()[1][0]
    place = next(b for b in found.told("TruthState") if b.Time == end)
    assert math.hypot(place.North - 3000, place.East) < 40
    assert found.result.outcome == "complete"


@pytest.mark.parametrize(
    ("traffic", "flies"),
    [([], ["Return", "Over", "Linked"]), ([AHEAD], ["Loiter", "Return", "Linked"])],
)
def test_it_returns_by_what_its_sensors_say(
    root: Path, tmp_path: Path, traffic: list[Any], flies: list[str]
) -> None:
    """With somebody ahead it circles longer than with the true states: all places are kept where that one may be."""
    found = flown(mission_file(root, tmp_path, traffic=traffic, sensing=SENSING))
    assert [name for _, name in found.modes()] == flies
    verdicts, judged = found.verdicts(), found.judged(tmp_path)
    for name in ("G1", "G2", "G3", "G4", ROW):
        assert verdicts[name].outcome is Outcome.HOLDS, verdicts[name]
    assert judged[ROW] == "holds"
    assert all(judged["well clear of 1 and 9"] == "holds" for _ in traffic)


def test_what_is_not_permitted_waits_in_a_circle(root: Path, tmp_path: Path) -> None:
    faults = {"cut_s": 30, "reconnect_s": 80}
    shorter = {"limit_s": 82, "bridge_faults": faults}
    found = flown(mission_file(root, tmp_path, traffic=[AHEAD], simulation=shorter))
    assert [name for _, name in found.modes()] == ["Loiter", "Return", "Linked"]
    first = found.told("LinkLossState")[0]
    assert "not permitted against 9; a circle is flown until it is" in first.Reason
    verdicts = found.verdicts()
    for name in ("G1", "G2", "G4", ROW):
        assert verdicts[name].outcome is Outcome.HOLDS, verdicts[name]


def test_a_circle_keeps_the_thresholds_of_time(root: Path, tmp_path: Path) -> None:
    """The disc of the circle is clear of who passes; a lap of it would still head for them, so it flies aside first."""
    passing = {"id": 10, "position": {"north_m": 2715.8, "east_m": 1439.4, "alt_m": 290.7}, "velocity": {"north_m_s": -15.41, "east_m_s": -12.34}}  # fmt: skip
    shorter = {"limit_s": 125, "bridge_faults": {"cut_s": 45}}
    found = flown(mission_file(
        root, tmp_path, link_loss={"choice": "loiter", "after_s": 6}, traffic=[passing], simulation=shorter,
    ))  # fmt: skip
    assert [name for _, name in found.modes()] == ["Loiter"]
    assert found.verdicts()["G2"].outcome is Outcome.HOLDS
    begin = found.modes()[0][0]
    places = [
        (b.North, b.East) for b in found.told("TruthState") if b.VehicleID == 1 and b.Time >= begin
    ]
    lap_ms = 2 * math.pi * LAP_RADIUS_M / 22 * 1000
    assert lap_ms < 30_000
    first = places[: 30_000 // 100]
    assert max(math.dist(places[0], place) for place in first) > 3 * LAP_RADIUS_M


def test_a_short_break_is_no_loss(root: Path, tmp_path: Path) -> None:
    faults = {"cut_s": 30, "reconnect_s": 32}
    shorter = {"limit_s": 60, "bridge_faults": faults}
    found = flown(mission_file(root, tmp_path, simulation=shorter))
    assert found.modes() == []
    assert found.told("AuthorityChange") == []
    assert found.told("TruthState")[-1].North > 1300
    assert found.verdicts()[ROW].outcome is Outcome.HOLDS


def test_g5_sees_what_was_not_flown(returned: WithoutLink) -> None:
    def changed(**fields: Any) -> Verdict:
        log = list(returned.log)
        for k, one in enumerate(log):
            if one.topic.endswith("LinkLossState"):
                body = json.dumps({**json.loads(lmcp.to_json(one.body)), **fields})
                log[k] = replace(one, body=lmcp.from_json(body))
                break
        return returned.verdicts(log)[ROW]

    assert changed(Mode="Finish").outcome is Outcome.VIOLATED
    assert changed(Chosen="Loiter").outcome is Outcome.VIOLATED
    late = changed(Heard=29_000)
    assert late.outcome is Outcome.VIOLATED
    assert late.margin == -0.5
    silent = [one for one in returned.log if not one.topic.endswith("LinkLossState")]
    nothing = returned.verdicts(silent)[ROW]
    assert nothing.outcome is Outcome.VIOLATED
    assert "did nothing" in nothing.note
    assert returned.verdicts(returned.log[:-5])[ROW].outcome is Outcome.UNKNOWN


def test_where_lines_are_lost_nobody_knows_whether_uxas_was_heard(returned: WithoutLink) -> None:
    """Its connection stands, so that nothing was said is no proof that there was nothing to say."""
    quiet = [
        one for one in returned.log if not one.topic.endswith(("LinkLossState", "BridgeStatus"))
    ]
    for faults, outcome in (
        (BridgeFaults(repeat=0.1, cut_ms=30_000), Outcome.HOLDS),
        (BridgeFaults(loss=0.9), Outcome.UNKNOWN),
        (BridgeFaults(delay_ms=5000), Outcome.UNKNOWN),
        (BridgeFaults(stops_reading_ms=30_000), Outcome.UNKNOWN),
    ):
        mission = replace(returned.mission, simulation=FaultySimulation(bridge_faults=faults))
        row = returned._replace(mission=mission).verdicts(quiet)[ROW]
        assert row.outcome is outcome, faults
        assert ("not logged" in row.note) == (outcome is Outcome.UNKNOWN)


TO = {"name": "meadow", "position": {"north_m": 0, "east_m": 0, "alt_m": 300}}
LOW = {"name": "mine", "position": {"north_m": 900, "east_m": 900, "alt_m": -50}}
AWAY = {"name": "meadow", "position": {"north_m": 900, "east_m": 900, "alt_m": 300}}
AROUND = {"id": 7, "kind": "keep_out", "vertices": [[800, 800], [1e3, 800], [1e3, 1e3], [800, 1e3]]}


@pytest.mark.parametrize(
    ("sections", "item"),
    [
        ({"link_loss": {"choice": "land"}}, "link_loss.choice"),
        ({"link_loss": {"choice": "loiter", "to": TO}}, "link_loss.to"),
        ({"link_loss": {"choice": "return", "after_s": 0.5}}, "link_loss.after_s"),
        ({"link_loss": {"choice": "finish", "after_s": 1}, "simulation": {"heartbeat_ms": 1000}}, "link_loss.after_s"),
        ({"link_loss": {"choice": "return", "to": LOW}}, "above"),
        ({"link_loss": {"choice": "return", "to": AWAY}, "zones": [AROUND]}, "keeps zone 7"),
        ({"link_loss": {"choice": "finish"}, "bridge": {"instances": 0}}, "link_loss"),
    ],
)  # fmt: skip
def test_what_makes_no_sense_is_refused(
    tmp_path: Path, sections: dict[str, Any], item: str
) -> None:
    path = tmp_path / "mission.yaml"
    path.write_text(yaml.safe_dump({**small(), **sections}))
    with pytest.raises(BadInput) as caught:
        load(path)
    assert item in str(caught.value)


def test_how_long_uxas_may_be_silent_is_a_parameter(returned: WithoutLink, root: Path) -> None:
    path = root / "tests/missions/link_loss.yaml"
    found = {row.name: row for row in parameters_of(returned.mission, path)}
    row = found["link_loss.after_s"]
    assert (row.value, row.default, row.low, row.high) == (3, 5, 1, 3600)


def test_it_is_not_flown_in_processes_nor_as_an_encounter(returned: WithoutLink) -> None:
    mission = replace(returned.mission, simulation=Simulation(), relations="")
    for flies in (told_of, ways_of):
        with pytest.raises(BadInput) as caught:
            flies(mission)
        assert "link_loss" in str(caught.value)


def test_the_diagram_in_the_guide_is_the_kernel_s(root: Path) -> None:
    assert_in_the_guide(root, "link_loss_machine.py")
