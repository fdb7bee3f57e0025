"""Campaigns whose logs are held against the proved steps of authority."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from campaign_child import written
from tampering import other

from cratous.services.campaign.definition import Campaign, load_campaign
from cratous.services.campaign.outcomes import Row, row_of
from cratous.services.campaign.pages import model_line, page
from cratous.services.campaign.runs import runs_of
from cratous.services.campaign.summary import build
from cratous.services.cli import campaign_flight
from cratous.services.cli.campaign_flight import fly_run
from cratous.services.system_model import replay
from cratous.spec.errors import BadInput

BOTH = "options:\n- {name: with}\n- {name: without, daa: false}\nmodel: true\n"


def rows_of(campaign: Campaign) -> list[Row]:
    return [
        row_of(run, fly_run(run.decides), campaign.requirements)
        for run in runs_of(campaign, "v", True)
    ]


@pytest.fixture(scope="module")
def campaign(tmp_path_factory: pytest.TempPathFactory) -> Campaign:
    return load_campaign(written(tmp_path_factory.mktemp("model"), {"plain": ""}, BOTH), None, ())


def test_each_log_is_counted_by_whether_it_fits(campaign: Campaign) -> None:
    rows = rows_of(campaign)
    model = build(campaign, rows, "v")["model"]
    assert [(r.result or {})["model"]["fits"] for r in rows] == [True, None]
    assert (model["fits"], model["does_not_fit"], model["not_asked"]) == (1, 0, 1)
    assert model["events"] > 100
    said = f"1 of 1, {model['events']} events in these; 1 without ICAROUS"
    assert model_line(model).endswith(said)


def test_where_no_flight_has_icarous_nothing_is_said_to_fit(campaign: Campaign) -> None:
    """All requirements of the flight hold, but what `model: true` asks for was not looked at."""
    rows = [row for row in rows_of(campaign) if row.run.option == "without"]
    held = [replace(row, outcome="holds") for row in rows]
    found = build(campaign, held, "v")
    assert (found["model"]["not_asked"], found["exit_code"]) == (1, 3)
    said = "No log was held against the proved steps of authority: 1 without ICAROUS"
    assert model_line(found["model"]) == said
    assert said in page(found, {})
    assert build(replace(campaign, model=False), held, "v")["exit_code"] == 0


def test_a_log_with_an_event_that_is_no_step_is_a_misfit_and_says_which(
    campaign: Campaign, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A command that nobody had authority for, among those of the flight."""

    def forged(mission: Any, avoidance: bool, envelopes: Any) -> Any:
        log = list(envelopes)
        at = next(k for k, one in enumerate(log) if one.topic.endswith("GatedCommand"))
        log[at] = other(log[at], Epoch=log[at].body.Epoch + 7)
        return replay.replay(mission, avoidance, log)

    monkeypatch.setattr(campaign_flight, "replayed", forged)
    rows = rows_of(campaign)
    row = rows[0]
    assert row.outcome == "misfit"
    assert row.why.startswith("its log does not fit the model: ")
    found = build(campaign, rows, "v")
    assert (found["model"]["does_not_fit"], found["exit_code"]) == (1, 1)
    assert "0 of 1" in page(found, {})


def test_it_names_the_run_and_encounters_have_none(tmp_path: Path) -> None:
    with_it, without = (
        next(iter(runs_of(load_campaign(written(tmp_path, {"plain": ""}, rest), None, ()), "v", True)))
        for rest in ("model: true\n", "")
    )  # fmt: skip
    assert with_it.id != without.id
    assert (
        build(load_campaign(written(tmp_path, {"plain": ""}, ""), None, ()), [], "v")["model"]
        is None
    )
    rest = "kind: encounters\nmodel: true\n"
    with pytest.raises(BadInput, match="an encounter has no log"):
        load_campaign(written(tmp_path, {"plain": ""}, rest), None, ())
