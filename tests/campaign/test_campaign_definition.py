"""Campaign files: what is read, what is refused, and what names a run."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from campaign_child import written
from jsonschema import Draft202012Validator

from cratous.services.campaign.definition import Campaign, campaign_schema, load_campaign
from cratous.services.campaign.identity import sources_digest
from cratous.services.campaign.runs import Run, put, runs_of
from cratous.services.loading.document import parse_document
from cratous.spec.errors import BadInput

ROOT = Path(__file__).resolve().parents[2]
CROSSING = ROOT / "examples" / "crossing" / "mission.yaml"


def runs(campaign: Campaign, version: str = "v") -> list[Run]:
    return list(runs_of(campaign, version, False))


def test_the_schema_is_one_and_says_what_everything_is() -> None:
    Draft202012Validator.check_schema(campaign_schema())

    def walk(schema: dict[str, Any], name: str) -> None:
        assert schema.get("description"), name
        for inner, value in schema.get("properties", {}).items():
            walk(value, f"{name}.{inner}")

    walk(campaign_schema(), "campaign")


@pytest.mark.parametrize("file", sorted((ROOT / "examples" / "campaigns").glob("*.yaml")))
def test_examples_are_campaigns(file: Path) -> None:
    campaign = load_campaign(file, range(1, 3), ())
    assert len(runs(campaign)) == 2 * len(campaign.options)


@pytest.mark.parametrize(
    ("rest", "item"),
    [
        ("seeds: [5, 1]\n", "seeds"),
        ("seeds: [1, 5]\n", "variation"),
        ("vary: [{item: daa.buffer, range: [1, 2]}]\n", "seeds"),
        ("seeds: [1, 2]\nvary: [{item: daa.buffer, range: [2, 1]}]\n", "vary[0].range"),
        ("options: [{name: a}, {name: a}]\n", "options"),
        ("generator: {kind: aimed}\n", "generator"),
        ("workers: 5\n", "workers"),
        ("requirements: [G9]\n", "requirements[0]"),
        ("limits: {time_s: 0}\n", "limits.time_s"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named(tmp_path: Path, rest: str, item: str) -> None:
    file = written(tmp_path, {"plain": ""}, rest)
    with pytest.raises(BadInput) as error:
        load_campaign(file, None, ())
    assert error.value.item == item
    assert error.value.where.startswith(str(tmp_path))


def test_a_folder_of_uxas_is_no_campaign(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="UxAS"):
        load_campaign(tmp_path, range(1, 2), ())


def test_a_mission_that_is_bad_as_written_is_bad_input(tmp_path: Path) -> None:
    file = written(tmp_path, {"plain": ""}, "")
    text = (
        (tmp_path / "plain.yaml").read_text().replace("id: 1, kind", "id: 1, eligible: [7], kind")
    )
    (tmp_path / "plain.yaml").write_text(text)
    with pytest.raises(BadInput, match="eligible"):
        load_campaign(file, None, ())


def test_a_run_is_named_by_all_that_decides_it() -> None:
    campaign = load_campaign(CROSSING, range(1, 4), ())
    first = runs(campaign)
    assert len({run.id for run in first}) == 3
    assert [run.id for run in runs(campaign)] == [run.id for run in first]
    assert not {run.id for run in runs(campaign, "w")} & {run.id for run in first}
    assert {run.decides["seed"] for run in first} == {1, 2, 3}


def test_a_changed_option_names_only_its_own_runs_anew(tmp_path: Path) -> None:
    text = "seeds: [1, 3]\nvary: [{item: daa.buffer, range: [1, 2]}]\n"
    options = "options: [{name: a}, {name: b, set: {'vehicles[0].speed_m_s': %d}}]\n"
    one = runs(load_campaign(written(tmp_path, {"plain": ""}, text + options % 21), None, ()))
    two = runs(load_campaign(written(tmp_path, {"plain": ""}, text + options % 22), None, ()))
    same = {run.id for run in one} & {run.id for run in two}
    assert same == {run.id for run in one if run.option == "a"}


def test_each_item_is_drawn_by_itself(tmp_path: Path) -> None:
    text = "seeds: [1, 20]\nvary: [{item: daa.buffer, range: [1, 2]}%s]\n"
    more = ", {item: 'vehicles[0].speed_m_s', values: [19, 23]}"
    one = runs(load_campaign(written(tmp_path, {"plain": ""}, text % ""), None, ()))
    two = runs(load_campaign(written(tmp_path, {"plain": ""}, text % more), None, ()))
    assert [r.drawn["daa.buffer"] for r in one] == [r.drawn["daa.buffer"] for r in two]
    assert {r.drawn["vehicles[0].speed_m_s"] for r in two} == {19, 23}
    for run in two:
        data = parse_document(run.decides["mission"], "mission").data
        assert data["daa"]["buffer"] == run.drawn["daa.buffer"]
        assert data["vehicles"][0]["speed_m_s"] == run.drawn["vehicles[0].speed_m_s"]


def test_a_path_that_leads_nowhere_is_refused() -> None:
    data: dict[str, Any] = {"vehicles": [{"id": 1}]}
    put(data, "daa.well_clear.dthr_m", 200)
    assert data["daa"] == {"well_clear": {"dthr_m": 200}}
    for item in ("vehicles[1].id", "vehicles.id", "vehicles[0].id.x", ""):
        with pytest.raises(BadInput):
            put({"vehicles": [{"id": 1}]}, item, 2) if item else put([], item, 2)


def test_the_version_is_its_sources(tmp_path: Path) -> None:
    (tmp_path / "core").mkdir()
    (tmp_path / "core" / "a.py").write_text("1")
    one = sources_digest(tmp_path)
    (tmp_path / "core" / "a.py").write_text("2")
    two = sources_digest(tmp_path)
    (tmp_path / "core" / "a.pyc").write_text("x")
    assert one != two == sources_digest(tmp_path)
