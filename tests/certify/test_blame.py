"""Blame: who was in command where something does not hold, and which watched assumption had broken first."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from pathlib import Path
from random import Random
from typing import Any

import pytest
from certify_tools import ROOT, edited, read

from cratous.services.attestation.blame_check import blame_faults, blame_of
from cratous.services.certify.blame import blame_rows
from cratous.services.certify.blame_texts import lines, sentence
from cratous.services.certify.rejudge import certify_again, watch
from cratous.services.certify.report_schema import departures
from cratous.services.cli import main

ON_G2 = ["G2", "G4"]


def row(**more: Any) -> dict[str, Any]:
    basis = {"requirement": "G2", "item": "pair", "source": "flight", "verdict": "violated"}
    return {**basis, "time_ms": 7000, "vehicles": [1, 9], "note": "lost", **more}


def assumption(name: str, since_ms: int | None = None, about: list[str] = ON_G2) -> dict[str, Any]:
    state = "held" if since_ms is None else "broken"
    return {"name": name, "state": state, "since_ms": since_ms, "vehicle": 1, "guarantees": about}


HAD = {1: [(0, "UxAS"), (5000, "ICAROUS"), (9000, "UxAS")], 2: [(0, "UxAS")]}


@pytest.mark.parametrize(
    ("at_ms", "side", "since_ms"),
    [(4999, "UxAS", 0), (5000, "ICAROUS", 5000), (8999, "ICAROUS", 5000), (9000, "UxAS", 9000)],
)
def test_who_was_in_command_changes_with_the_gate(at_ms: int, side: str, since_ms: int) -> None:
    (one,) = blame_rows([row(time_ms=at_ms)], HAD, [], 20_000)
    # 9 is an intruder, which has no gate
    assert one["command"] == [{"vehicle": 1, "side": side, "since_ms": since_ms}]


def test_what_names_no_vehicle_and_no_instant_asks_about_all_at_the_end() -> None:
    (one,) = blame_rows([row(vehicles=[], time_ms=None, verdict="unknown")], HAD, [], 20_000)
    assert [(c["vehicle"], c["side"]) for c in one["command"]] == [(1, "UxAS"), (2, "UxAS")]
    assert one["time_ms"] is None


def test_what_holds_and_what_is_said_of_the_plan_has_no_blame() -> None:
    assert blame_rows([row(verdict="holds"), row(source="plan")], HAD, [], 0) == []


def test_the_first_that_had_broken_is_named_and_none_that_broke_later() -> None:
    late, early = assumption("late", 6000), assumption("early", 3000, ["G4"])
    same, after = assumption("same", 3000), assumption("after", 7001)
    (one,) = blame_rows([row()], HAD, [late, after, early, same, assumption("kept")], 0)
    wanted = {"name": "early", "since_ms": 3000, "vehicle": 1, "bears": False}
    assert one["broken_first"] == wanted
    assert "early at 3.00 s, on which no theorem on G2 rests" in sentence(one)
    (one,) = blame_rows([row(time_ms=2999)], HAD, [late, early], 0)
    assert one["broken_first"] is None
    assert "no watched assumption had broken by then" in sentence(one)


def test_what_was_not_watched_is_named_so_that_nobody_takes_it_for_kept() -> None:
    unseen = {**assumption("unseen"), "state": "not observed"}
    other = {**assumption("other", None, ["G5"]), "state": "not observed"}
    (one,) = blame_rows([row()], HAD, [unseen, other], 0)
    assert one["not_observed"] == ["unseen"]
    assert sentence(one).endswith("not observed: unseen")


def test_of_many_rows_the_violated_come_first_and_the_rest_is_counted() -> None:
    rows = [row(verdict="unknown", item=f"i{k}") for k in range(10)] + [row(item="bad")]
    said = list(lines(blame_rows(rows, HAD, [], 0)))
    assert said[0].startswith(
        "blame, G2 bad, violated at 7.00 s: ICAROUS had vehicle 1 since 5.00 s"
    )
    assert (len(said), said[-1]) == (11, "blame: 1 rows more")


def drawn(random: Random) -> dict[str, Any]:
    """A report with rows, changes of command and assumptions at few instants, so that many coincide."""
    authority = [
        {"vehicle": random.choice((1, 2)), "time_ms": random.randrange(6),
         "owner": random.choice(("UxAS", "ICAROUS"))}
        for _ in range(random.randrange(6))
    ]  # fmt: skip
    way = {"own": 1, "way_out": {"time_ms": random.randrange(6), "manoeuvre": "hdir to 0 deg"}}
    rows = [
        row(
            time_ms=random.choice((None, *range(6))), vehicles=random.choice(([], [1], [2, 9])),
            verdict=random.choice(("violated", "unknown", "excused", "holds")),
            evidence={"losses": [way]},
        )
        for _ in range(4)
    ]  # fmt: skip
    names = [assumption(f"a{k}", random.choice((None, *range(6)))) for k in range(3)]
    return {
        "constraints": rows,
        "assumptions": names,
        "mission": {"vehicles": [{"id": 1, "protected": True}, {"id": 2, "protected": True},
                                 {"id": 3, "protected": False}]},
        "flight": {"end_ms": 5, "authority": sorted(authority, key=lambda one: one["time_ms"])},
    }  # fmt: skip


def test_the_verifier_makes_the_same_blame_without_kernels() -> None:
    random = Random(1)
    for _ in range(300):
        report = drawn(random)
        had: dict[int, list[tuple[int, str]]] = {1: [(0, "UxAS")], 2: [(0, "UxAS")]}
        for one in report["flight"]["authority"]:
            changes = had[one["vehicle"]]
            if changes[-1][1] != one["owner"]:
                changes.append((one["time_ms"], one["owner"]))
        made = blame_rows(report["constraints"], had, report["assumptions"], 5)
        assert blame_of(report) == made


@pytest.fixture(scope="module")
def cut(fly_once: Callable[[Path], Path]) -> Path:
    return fly_once(ROOT / "tests" / "missions" / "bridge_cut.yaml")


def test_a_flight_whose_bridge_was_cut(cut: Path, capsys: pytest.CaptureFixture[str]) -> None:
    report = read(cut)
    assert departures(report) == []
    bad = [one for one in report["blame"] if one["verdict"] == "violated"]
    assert bad
    assert {one["requirement"] for one in bad} == {"G5"}
    assert all(one["command"][0]["side"] in ("UxAS", "ICAROUS") for one in bad)
    assert blame_faults(report) == []
    page = (cut / "report.html").read_text(encoding="utf-8")
    assert sentence(bad[0]) in page
    main(["monitor", str(cut), "--allow-unproved", "--json"])
    assert json.loads(capsys.readouterr().out)["blame"] == watched(cut)
    main(["monitor", str(cut), "--allow-unproved"])
    assert sentence(bad[0]) in capsys.readouterr().out.replace("\n", " ")


def watched(folder: Path) -> list[dict[str, Any]]:
    """The blame of the report, in the order in which the monitor gives its rows."""
    order = [(v.requirement, v.item) for v in watch(folder / "log.sqlite").verdicts]
    return sorted(
        read(folder)["blame"], key=lambda one: order.index((one["requirement"], one["item"]))
    )


def test_another_blame_is_found_by_certify_and_refused_by_verify(cut: Path, tmp_path: Path) -> None:
    folder, report = edited(cut, tmp_path), read(cut)
    for change in (
        lambda one: one["command"][0].update(side="ICAROUS" if one["command"][0]["side"] == "UxAS" else "UxAS"),
        lambda one: one.update(broken_first={"name": "x", "since_ms": 0, "vehicle": 1, "bears": True}),
    ):  # fmt: skip
        told = copy.deepcopy(report)
        change(told["blame"][0])
        assert len(blame_faults(told)) == 1
        assert "the blame for G5" in blame_faults(told)[0]
    (folder / "report.json").write_text(json.dumps(told), encoding="utf-8")
    assert any(line.startswith("blame[0].broken_first") for line in certify_again(folder).found)
    assert "0 rows of blame" in blame_faults({**report, "blame": []})[0]
    del told["blame"]  # as reports were before
    (folder / "report.json").write_text(json.dumps(told), encoding="utf-8")
    done = certify_again(folder)
    assert "blame: the report was made before it was told" in done.unchecked
