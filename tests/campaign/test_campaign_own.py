"""Campaigns that ask for requirements of the user's own."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from campaign_child import written

from cratous.services.campaign.definition import load_campaign
from cratous.services.campaign.outcomes import outcome_of, row_of
from cratous.services.campaign.runs import Run, runs_of
from cratous.services.campaign.summary import build
from cratous.services.campaign.tables import csv_text
from cratous.services.certify.report_input import FORMAT
from cratous.services.cli import main
from cratous.services.cli.campaign import _is_kept
from cratous.services.cli.campaign_flight import fly_run
from cratous.services.requirements.requirement_files import own_file
from cratous.spec.errors import BadInput

TEXT = """trace every 500 ms gap 600 ms
signal z: m from AirVehicleState[ID=1].Location.Altitude hold 1 s
requirement FLOOR: z >= 90 m
requirement CEILING: z <= %d m
"""


def own(folder: Path, ceiling_m: int, name: str = "own.req") -> Path:
    file = folder / name
    file.write_text(TEXT % ceiling_m)
    return file


def of(folder: Path, rest: str) -> tuple[tuple[str, ...], Run]:
    campaign = load_campaign(written(folder, {"plain": ""}, rest), None, ())
    (run,) = runs_of(campaign, "v", True)
    return campaign.requirements, run


def test_a_run_is_held_against_the_files_that_the_campaign_names(tmp_path: Path) -> None:
    own(tmp_path, 250)
    campaign = load_campaign(
        written(tmp_path, {"plain": ""}, "requirements: [own.req, G3]\n"), None, ()
    )
    (run,) = runs_of(campaign, "v", True)
    assert campaign.requirements == ("G3", "FLOOR", "CEILING")
    result = fly_run(run.decides)
    assert outcome_of(result, campaign.requirements) == "violated"
    assert outcome_of(result, ("G3", "FLOOR")) == "holds", "the judge is not asked for FLOOR"
    row = row_of(run, result, campaign.requirements)
    assert row.why.startswith("CEILING violated: CEILING: ")
    assert result["requirements"]["CEILING"]["margin"] == pytest.approx(-50)
    found = build(campaign, [row], "v")
    (group,) = found["groups"]
    assert group["requirements"]["CEILING"]["violated"]["count"] == 1
    assert group["requirements"]["FLOOR"]["not_holding"]["count"] == 0
    assert [one["file"] for one in found["own"]] == ["own.req"]
    assert any("monitor alone" in line for line in found["limits"])
    assert "CEILING margin" in csv_text(found)


def test_the_text_of_a_file_names_the_run_and_its_name_is_in_the_command(tmp_path: Path) -> None:
    rest = "requirements: [G1, own.req]\n"
    own(tmp_path, 250)
    _, one = of(tmp_path, rest)
    _, plain = of(tmp_path, "requirements: [G1]\n")
    own(tmp_path, 260)
    _, two = of(tmp_path, rest)
    assert len({one.id, two.id, plain.id}) == 3
    assert [file["text"] for file in two.decides["own"]] == [TEXT % 260]


def test_a_report_by_another_text_of_a_file_is_not_taken_for_that_of_the_run(
    tmp_path: Path,
) -> None:
    """The flight, so its log, is the same; what it is held against is not."""
    data = own_file(own(tmp_path, 250), "own.req").data()
    report = {
        "format": FORMAT,
        "log": {"digest": "d"},
        "own": {"files": [data], "requirements": []},
    }
    (tmp_path / "report.json").write_text(json.dumps(report))
    changed = own_file(own(tmp_path, 260), "own.req").data()
    kept = [_is_kept(tmp_path, "d", files) for files in ([data], [changed], [])]
    assert kept == [True, False, False]
    (tmp_path / "report.json").write_text(json.dumps({"format": FORMAT, "log": {"digest": "d"}}))
    assert _is_kept(tmp_path, "d", [])


@pytest.mark.parametrize(
    "log", ["[]", '"d"', "null", "{}", '{"digest": "d"}, "own": []', "[" * 9_000]
)
def test_a_report_that_is_none_is_flown_again(tmp_path: Path, log: str) -> None:
    (tmp_path / "report.json").write_text(f'{{"format": "{FORMAT}", "log": {log}}}')
    assert not _is_kept(tmp_path, "d", [])


def test_files_at_the_command_line_are_asked_for_besides(tmp_path: Path) -> None:
    more = own_file(own(tmp_path, 250), "more.req")
    file = written(tmp_path, {"plain": ""}, "requirements: [G2]\n")
    assert load_campaign(file, None, (), (more,)).requirements == ("G2", "FLOOR", "CEILING")


@pytest.mark.parametrize(
    ("rest", "named"),
    [
        ("requirements: [nowhere.req]\n", "nowhere.req"),
        ("requirements: [own.req, again.req]\n", "FLOOR"),
        ("kind: encounters\nrequirements: [G1, own.req]\n", "FLOOR"),
        ("requirements: [own.txt]\n", "own.txt"),
    ],
)
def test_what_no_run_can_be_held_against_is_refused(tmp_path: Path, rest: str, named: str) -> None:
    own(tmp_path, 250)
    own(tmp_path, 250, "again.req")
    with pytest.raises(BadInput, match=named):
        of(tmp_path, rest)


def test_a_search_for_what_nobody_asks_for_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    own(tmp_path, 250)
    file = written(tmp_path, {"plain": ""}, "requirements: [own.req]\n")
    assert main(["campaign", str(file), "--find", "ROOF", "-o", str(tmp_path / "out")]) == 2
    said = capsys.readouterr().err
    assert "CEILING" in said
    assert "ROOF" in said
