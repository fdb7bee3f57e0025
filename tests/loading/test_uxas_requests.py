"""Every automation request of a UxAS configuration is a mission of its own, in the order of sending."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cratous.bridge import lmcp
from cratous.services.cli import main
from cratous.services.loading import count_requests, load
from cratous.services.loading.uxas_cfg import Configuration, Sent
from cratous.services.loading.uxas_requests import requests_of
from cratous.spec.errors import BadInput

SHIPPED = Path(__file__).resolve().parents[3] / "shared" / "examples" / "openuxas-shipped"
TEMPLATE = SHIPPED / "00_Template"
shipped = pytest.mark.skipif(not TEMPLATE.is_dir(), reason="no ../shared/examples")


def state(number: int, value: int) -> object:
    return lmcp.new("AirVehicleState", ID=number, Time=value)


@given(st.lists(st.one_of(st.none(), st.integers(1, 3)), max_size=12))
def test_a_request_means_what_was_told_last_before_it_else_first_after(
    kinds: list[int | None],
) -> None:
    bodies = [
        lmcp.new("AutomationRequest", OperatingRegion=k) if number is None else state(number, k)
        for k, number in enumerate(kinds)
    ]
    messages = tuple(Sent(body, f"file {k}", k) for k, body in enumerate(bodies))
    places = [k for k, number in enumerate(kinds) if number is None]
    found = requests_of(Configuration(Path("cfg.xml"), {}, (), messages, ()))
    if not places:
        assert [one.messages for one in found] == [messages]
        return
    assert [one.messages[-1].body.OperatingRegion for one in found] == places
    for place, one in zip(places, found, strict=True):
        known = {sent.body.ID: sent.body.Time for sent in one.messages[:-1]}
        for number in {n for n in kinds if n is not None}:
            told = [k for k, n in enumerate(kinds) if n == number]
            before = [k for k in told if k < place]
            assert known[number] == (before[-1] if before else told[0])


@shipped
def test_plan_plans_each_request_of_a_folder(capsys: pytest.CaptureFixture[str]) -> None:
    assert count_requests(TEMPLATE) == 2
    assert main(["plan", str(TEMPLATE), "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    done = [sorted(i["task_id"] for i in one["plan"]["items"]) for one in data["requests"]]
    assert done == [[21, 22, 27, 31], [23, 28, 32]]
    assert [one["notes"][0][:22] for one in data["requests"]] == [
        "this is request 1 of 2",
        "this is request 2 of 2",
    ]
    assert main(["plan", str(TEMPLATE), "--json", "--request", "2"]) == 0
    alone = json.loads(capsys.readouterr().out)
    assert alone["plan"] == data["requests"][1]["plan"]


@shipped
def test_a_bad_request_does_not_hide_the_others(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "folder"
    shutil.copytree(TEMPLATE, folder, copy_function=shutil.copyfile)
    for path in [folder, *folder.rglob("*")]:
        path.chmod(0o755)
    bad = folder / "MessagesToSend" / "AutomationRequest_a.xml"
    text = bad.read_text(encoding="utf-8")
    bad.write_text(text.replace("<int64>21</int64>", "<int64>99</int64>"), encoding="utf-8")
    assert main(["plan", str(folder)]) == 2
    said = capsys.readouterr()
    assert "task 99 does not exist" in said.err
    assert "request 2 of 2" in said.out
    assert "vehicle 6: p23" in said.out
    assert main(["plan", str(folder), "--request", "1"]) == 2


@shipped
def test_what_needs_one_request_says_so(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plan", str(TEMPLATE), "--why", "23"]) == 2
    assert "several requests; expected --request 1 to 2" in capsys.readouterr().err
    with pytest.raises(BadInput, match="there is no such request"):
        load(TEMPLATE, request=3)
    assert load(TEMPLATE, request=2).tasks[0].id in (23, 28, 32)


def test_a_mission_file_is_one_request(tmp_path: Path) -> None:
    path = tmp_path / "m.yaml"
    path.write_text("name: m\n")
    assert count_requests(path) == 1
    with pytest.raises(BadInput, match="a mission file is one request"):
        load(path, request=2)


@shipped
def test_a_request_in_a_file_is_planned_at_its_own_speed_and_altitude(tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    shutil.copytree(TEMPLATE, folder, copy_function=shutil.copyfile)
    for path in [folder, *folder.rglob("*")]:
        path.chmod(0o755)
    file = folder / "MessagesToSend" / "AutomationRequest_a.xml"
    text = re.sub(
        r"<OperatingRegion>\s*</", "<OperatingRegion>0</", file.read_text(encoding="utf-8")
    )
    (sent,) = lmcp.xml.loads(text.replace("<OperatingRegion/>", ""))
    plain = load(TEMPLATE).vehicles[0]
    pair = lmcp.new(
        "SpeedAltPair",
        VehicleID=plain.id,
        Speed=plain.speed_m_s + 1,
        Altitude=777.0,
        AltitudeType="MSL",
    )
    asked = lmcp.new(
        "ImpactAutomationRequest", TrialRequest=sent, OverridePlanningConditions=[pair]
    )
    file.write_text(lmcp.xml.dumps(asked), encoding="utf-8")
    mission = load(folder)
    first = mission.vehicle(plain.id)
    assert (first.speed_m_s, first.cruise_alt_m) == (plain.speed_m_s + 1, 777.0)
    assert any("OverridePlanningConditions" in note for note in mission.notes)
    pair.TaskID = sent.TaskList[0]
    file.write_text(lmcp.xml.dumps(asked), encoding="utf-8")
    with pytest.raises(BadInput, match="some tasks at another speed"):
        load(folder)
