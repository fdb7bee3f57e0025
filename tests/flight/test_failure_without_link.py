"""A mission that says what is flown without the link and after a failure: the first until the second is declared."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import yaml
from ground_tools import Flown, flown_of, refusal

from cratous.bridge import lmcp
from cratous.core.authority.failure import Failure, procedure
from cratous.judge.mission_file import read
from cratous.services.flight.landing_reach import require_reachable
from cratous.services.loading import load
from cratous.services.logs.records import from_data, to_data
from cratous.services.mission.landing import on_failure_of
from cratous.services.system_model.replay import replay
from cratous.spec.mission import Mission
from cratous.spec.mission.guarantees import Outcome

FAILS, ALONE, AUTHORITY = (
    "what vehicle 1 does after a failure",
    "what vehicle 1 flies without the link",
    "authority over vehicle 1",
)
ROWS = (FAILS, ALONE, AUTHORITY, "failures of vehicle 1 are declared when due")
BESIDE = {"id": 90, "position": {"north_m": 480, "east_m": 20, "alt_m": 300}, "velocity": {"north_m_s": 20, "east_m_s": 1}, "appears_s": 25, "vanishes_s": 85}  # fmt: skip
FAR = [{"id": 1, "kind": "must_fly", "points": [{"north_m": 3000, "east_m": 0, "alt_m": 300}]}]
FINISH = {"choice": "finish", "after_s": 3}


def mission_file(root: Path, folder: Path, **sections: Any) -> Path:
    data = yaml.safe_load((root / "tests/missions/on_failure.yaml").read_text())
    found = {k: v for k, v in {**data, "link_loss": FINISH, **sections}.items() if v is not None}
    path = folder / "mission.yaml"
    path.write_text(yaml.safe_dump(found))
    return path


def cut(at_s: int, again_s: int | None = None) -> dict[str, Any]:
    faults = {"cut_s": at_s} if again_s is None else {"cut_s": at_s, "reconnect_s": again_s}
    return {"limit_s": 1000, "bridge_faults": faults}


def modes(flight: Flown) -> list[tuple[str, str]]:
    return [(body.Mode.name, body.Chosen.name) for body in flight.told("LinkLossState")]


def assert_known(flight: Flown, folder: Path) -> None:
    verdicts, judged = flight.verdicts(), flight.judged(folder)
    for item in ROWS:
        assert verdicts[item].outcome is Outcome.HOLDS, verdicts[item]
        assert judged[item] == "holds"
    assert replay(flight.mission, True, flight.log).finding is None


@pytest.fixture(scope="module")
def surprised(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Flown:
    """The link is cut at 15 s, and somebody appears beside it ten seconds later."""
    sections = {"tasks": FAR, "changes": None, "traffic": [BESIDE], "simulation": cut(15)}
    return flown_of(load(mission_file(root, tmp_path_factory.mktemp("m"), **sections)))


def test_the_way_is_finished_without_the_link_until_a_failure_is_declared(
    surprised: Flown, tmp_path: Path
) -> None:
    (failed,) = surprised.told("FailureState")
    assert (failed.Failure.name, failed.IntruderID) == ("Surprised", 90)
    flown = modes(surprised)
    assert flown[0] == ("Finish", "Finish")
    assert flown[-3:] == [("Land", "Land"), ("Final", "Land"), ("Landed", "Land")]
    states = surprised.told("LinkLossState")
    assert all((one.Chosen.name == "Land") == (one.Time >= failed.Time) for one in states)
    assert_known(surprised, tmp_path)
    # that UxAS was not heard is told by itself, as what is flown no longer says it
    assert [bool(one.Heard) for one in surprised.told("UxasHeard")] == [False]


@pytest.mark.parametrize(
    ("simulation", "flies"),
    [
        (cut(35, 70), ["Land", "Final", "Landed"]),  # after the failure
        (cut(10, 25), ["Finish", "Linked", "Land", "Final", "Landed"]),  # and before
    ],
)
def test_after_a_failure_the_link_changes_nothing(
    root: Path, tmp_path: Path, simulation: dict[str, Any], flies: list[str]
) -> None:
    flight = flown_of(load(mission_file(root, tmp_path, simulation=simulation)))
    assert [body.Failure.name for body in flight.told("FailureState")] == ["Ended"]
    names = [name for name, _ in modes(flight)]
    assert [n for n in names if n != "Over"] == flies
    assert_known(flight, tmp_path)


def test_the_loss_of_the_link_alone_is_no_failure(root: Path, tmp_path: Path) -> None:
    """It returns and circles there, and the flight ends in the safe state."""
    sections = {"link_loss": {"choice": "return"}, "tasks": FAR, "changes": None}
    flight = flown_of(load(mission_file(root, tmp_path, simulation=cut(20), **sections)))
    assert flight.told("FailureState") == []
    assert [name for name, _ in modes(flight)] == ["Return", "Over"]
    assert flight.result.outcome == "safe state"
    verdicts, judged = flight.verdicts(), flight.judged(tmp_path)
    for item in (FAILS, ALONE):
        assert verdicts[item].outcome is Outcome.HOLDS, verdicts[item]
        assert judged[item] == "holds"


Edit = Callable[[dict[str, Any], int], dict[str, Any] | None]


def late(body: dict[str, Any], failed_ms: int) -> bool:
    return body["Time"] >= failed_ms


CHANGES: list[tuple[str, Edit, str]] = [
    ("LinkLossState", lambda b, at: {**b, "Chosen": "Finish"} if late(b, at) else b, FAILS),
    ("LinkLossState", lambda b, at: None if late(b, at) else b, FAILS),
    ("LinkLossState", lambda b, at: b if late(b, at) else {**b, "Chosen": "Return"}, ALONE),
    ("LinkLossState", lambda b, at: b if late(b, at) else None, ALONE),
    ("FailureState", lambda b, at: None, ALONE),
]


@pytest.mark.parametrize(("topic", "edit", "item"), CHANGES)
def test_each_of_the_rows_sees_what_does_not_follow(
    surprised: Flown, tmp_path: Path, topic: str, edit: Edit, item: str
) -> None:
    (failed,) = surprised.told("FailureState")
    log = list[Any]()
    for one in surprised.log:
        body: Any = one.body
        if one.topic.endswith(topic):
            after = edit(json.loads(lmcp.to_json(body)), failed.Time)
            if after is None:
                continue
            body = lmcp.from_json(json.dumps(after))
        log.append(SimpleNamespace(topic=one.topic, time_ms=one.time_ms, body=body))
    assert surprised.verdicts(log)[item].outcome is Outcome.VIOLATED
    assert surprised.judged(tmp_path, log)[item] == "violated"


def test_a_mission_with_both_is_read_back_as_it_was_logged(root: Path, tmp_path: Path) -> None:
    path = mission_file(root, tmp_path)
    mission = load(path)
    assert from_data(Mission, to_data(mission)) == mission
    assert mission.link_loss is not None
    assert on_failure_of(mission) is not None
    judged = read(path)
    assert judged.without_link is not None
    assert (judged.without_link.choice, judged.without_link.after_ms) == ("Finish", 3000)
    assert judged.after_failure is not None
    assert judged.after_failure.choice == "Land"
    said = [note for note in mission.notes if "acts by itself" in note]
    assert len(said) == 2


LOW = {"name": "low", "position": {"north_m": 0, "east_m": 0, "alt_m": 30}}


@pytest.mark.parametrize(
    ("sections", "said"),
    [
        ({"link_loss": {"choice": "land", "site": "nowhere"}}, "link_loss.site: there is no such landing site"),
        ({"link_loss": {"choice": "finish", "site": "field"}}, "link_loss.site: no vehicle lands at this site"),
        ({"on_failure": {"choice": "ditch", "site": "field"}, "link_loss": {"choice": "land"}}, "on_failure.site: there is no such landing site to ditch at"),
        ({"on_failure": {"choice": "hold"}}, "landing_sites: no vehicle lands at these sites"),
        ({"link_loss": {"choice": "return", "to": LOW}}, "link_loss.to.position: no manoeuvre goes so low"),
        ({"link_loss": {"choice": "return", "to": {**LOW, "position": {"north_m": 0, "east_m": 0, "alt_m": 300}}}, "on_failure": {"choice": "return", "to": LOW}, "landing_sites": None}, "on_failure.to.position: no manoeuvre goes so low"),
    ],
)  # fmt: skip
def test_what_makes_no_sense_is_refused(
    root: Path, tmp_path: Path, sections: dict[str, Any], said: str
) -> None:
    assert said in refusal(mission_file(root, tmp_path, **sections), require_reachable)


def test_each_landing_is_checked_for_reach(root: Path, tmp_path: Path) -> None:
    """The site of the failure can be reached; those that are left for the lost link cannot be, for their zone."""
    around = [[1100, -1300], [1900, -1300], [1900, -500], [1100, -500]]
    ring = [{"id": 8, "kind": "keep_out", "vertices": around, "floor_m": 20, "ceiling_m": 900}]
    only = {"choice": "land", "site": "meadow"}
    sites = [{"name": "field", "position": {"north_m": 300, "east_m": 1500}, "radius_m": 60}, {"name": "meadow", "position": {"north_m": 1500, "east_m": -900}, "radius_m": 60}]  # fmt: skip
    sections = {"zones": ring, "landing_sites": sites, "changes": None}
    assert "can land nowhere" in refusal(
        mission_file(root, tmp_path, link_loss=only, **sections), require_reachable
    )
    require_reachable(load(mission_file(root, tmp_path, **sections)))


def test_which_procedure_is_flown() -> None:
    assert procedure(Failure(0, 0), 1, 5) == 1
    assert all(procedure(Failure(kind, 10), 1, 5) == 5 for kind in (1, 2, 3, 4))


def test_a_mission_file_without_one_of_them_keeps_its_record(root: Path, tmp_path: Path) -> None:
    with_both = load(mission_file(root, tmp_path))
    alone = load(mission_file(root, tmp_path, link_loss=None))
    assert type(with_both.daa).__name__ == "CombinedDaa"
    assert type(alone.daa).__name__ == "FailureDaa"
    assert replace(alone, daa=with_both.daa, notes=()) == replace(with_both, notes=())
