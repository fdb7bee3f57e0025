"""The assurance argument of a run: what is not shown is never shown as supported, and it is well formed."""

from __future__ import annotations

import copy
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml
from certify_tools import proved
from lxml import etree

from cratous.core import ledger
from cratous.services.argument.assumptions import BEARS_ON, PLACED, UP_TO
from cratous.services.argument.build import argument
from cratous.services.argument.elements import Argument, Element, Kind, State
from cratous.services.argument.form import document, faults, yaml_text
from cratous.services.argument.proved import Proofs
from cratous.services.argument.trust import TRUSTED
from cratous.services.argument.views import views
from cratous.spec.errors import BadInput

GUARANTEES = ("G1", "G2", "G3", "G4", "G5")
BAD_TEXT = "=1+1\x1b[2J\x00\ufffe\ud800<&\"'\n\u202e"


def below(elements: dict[str, Element], start: str) -> Iterator[Element]:
    """All that an element leads to by support."""
    todo, seen = [start], set()
    while todo:
        name = todo.pop()
        if name not in seen:
            seen.add(name)
            yield elements[name]
            todo += elements[name].supported_by


def solutions(elements: dict[str, Element], start: str) -> list[str]:
    return [one.id for one in below(elements, start) if one.kind is Kind.SOLUTION]


def goal_of(elements: dict[str, Element], item: str) -> Element:
    """The one goal that names a row."""
    (found,) = [one for one in elements.values() if "-row-" in one.id and item in one.text]
    return found


def well_formed(elements: dict[str, Element]) -> None:
    data = document(elements.values())
    assert faults(data) == []
    assert yaml.safe_load(yaml_text(data, ["head"])) == data
    for one in elements.values():
        marked = [one.state.replace(" ", "-")] if one.state is not State.SUPPORTED else None
        assert data[one.id].get("classes") == marked
        assert data[one.id]["text"].startswith(f"{one.state.upper()}: ") == bool(marked)
        if one.kind in (Kind.GOAL, Kind.STRATEGY):
            assert one.undeveloped == (not one.supported_by)
            assert one.undeveloped == data[one.id].get("undeveloped", False)


def test_a_state_that_is_not_said_is_noticed(
    report: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The check of this module is one: it fails where texts do not begin with their state."""
    elements = argument(report, ())
    well_formed(elements)
    monkeypatch.setattr(Element, "shown", property(lambda one: one.text))
    with pytest.raises(AssertionError):
        well_formed(elements)


@pytest.fixture
def report(flown: Path) -> dict[str, Any]:
    return proved(flown)


def test_each_guarantee_of_the_crossing_reaches_solutions(report: dict[str, Any]) -> None:
    elements = argument(report, ())
    well_formed(elements)
    for goal in GUARANTEES:
        assert elements[goal].state is State.SUPPORTED
        reached = solutions(elements, f"S-{goal}-run")
        assert any(name.startswith(f"Sn-{goal}-row-") for name in reached)
        assert any(name[3:] in report["proofs"]["theorems"] for name in reached)
        for one in below(elements, f"S-{goal}-run"):
            neutral = one.state is State.NOTHING
            assert one.kind is Kind.SOLUTION or one.supported_by or neutral, one.id
    assert elements["G-run"].state is State.SUPPORTED
    # each row stands in one goal, and each kernel that decided it below that
    for row in report["constraints"]:
        goal = goal_of(elements, f"{row['item']} ({row['note']})" if row["note"] else row["item"])
        if row["checks"]:
            assert goal.id.startswith(f"G-{row['requirement']}-row-")
            kernels = [n for n in goal.supported_by if n.startswith("G-kernel-")]
            assert kernels
            assert goal.supported_by[-1].startswith("Sn-")


def test_no_text_says_more_than_the_theorem(report: dict[str, Any]) -> None:
    elements = argument(report, ())
    theorems = [one for one in elements.values() if one.id.startswith("G-theorem-")]
    assert len(theorems) > 30
    for one in theorems:
        assert (
            one.text == report["proofs"]["theorems"][one.id.removeprefix("G-theorem-")]["sentence"]
        )
        assert f"Sn-{one.id.removeprefix('G-theorem-')}" in one.supported_by
    for of, names in BEARS_ON.items():
        found = elements[f"G-{of}-system"]
        assert found.supported_by == tuple(f"G-theorem-{n}" for n in names)
        assert found.text.endswith(UP_TO.get(of, "under its assumptions"))


@pytest.mark.parametrize("verdict", ["violated", "unknown", "excused"])
@pytest.mark.parametrize("requirement", GUARANTEES)
def test_a_row_that_does_not_hold_is_not_supported(
    report: dict[str, Any], requirement: str, verdict: str
) -> None:
    row = next(r for r in report["constraints"] if r["requirement"] == requirement)
    row.update(verdict=verdict, note="why it is so", time_ms=1500)
    elements = argument(report, ())
    well_formed(elements)
    goal = goal_of(elements, f"{row['item']} (why it is so)")
    assert goal.state == verdict
    assert goal.shown.startswith(f"{verdict.upper()}: ")
    assert goal.text.endswith("At 1.50 s")
    assert goal.undeveloped
    assert solutions(elements, goal.id) == []
    for name in (requirement, f"S-{requirement}-run", "S-guarantees", "G-run"):
        assert elements[name].state == verdict
        assert elements[name].shown.startswith(f"{verdict.upper()}: ")
    data = document(elements.values())
    assert data[goal.id]["classes"] == [verdict]
    others = [one for one in GUARANTEES if one != requirement]
    assert all(elements[one].state is State.SUPPORTED for one in others)
    assert f"Supported here: {', '.join(others)}" in elements["G-run"].text


@pytest.mark.parametrize("requirement", GUARANTEES)
def test_a_guarantee_without_rows_is_unknown(report: dict[str, Any], requirement: str) -> None:
    report["constraints"] = [r for r in report["constraints"] if r["requirement"] != requirement]
    elements = argument(report, ())
    well_formed(elements)
    assert elements[requirement].state is State.UNKNOWN
    assert "nothing was observed" in elements[requirement].text
    assert f"S-{requirement}-run" not in elements
    assert elements["G-run"].state is State.UNKNOWN


def test_what_had_nothing_to_check_supports_nothing(report: dict[str, Any]) -> None:
    for row in report["constraints"]:
        if row["requirement"] == "G2":
            row["checks"] = 0
    elements = argument(report, ())
    goals = elements["S-G2-run"].supported_by
    assert {elements[name].state for name in goals} == {State.NOTHING}
    assert all(elements[name].undeveloped for name in goals)
    assert elements["G2"].state is State.UNKNOWN


def test_the_verdict_of_the_report_counts_too(report: dict[str, Any]) -> None:
    report["verdict"] = "unknown"
    assert argument(report, ())["G-run"].state is State.UNKNOWN


AGAINST, LEMMA = "schedule_eligible_is_its_definition", "well_clear_vertical_window_is_exact"
SYSTEM = "system_silence_is_noticed_within_one_heartbeat"


@pytest.mark.parametrize("how", ["removed", "another statement", "not proved"])
@pytest.mark.parametrize(("theorem", "of"), [(AGAINST, "G1"), (LEMMA, "G2"), (SYSTEM, "G5")])
def test_a_theorem_that_is_no_longer_on_record_supports_nothing(
    report: dict[str, Any], monkeypatch: pytest.MonkeyPatch, theorem: str, of: str, how: str
) -> None:
    assert argument(report, ())[of].state is State.SUPPORTED
    records = copy.deepcopy(ledger.read())
    if how == "removed":
        del records["theorems"][theorem]
    elif how == "not proved":
        records["theorems"][theorem]["status"] = how
        report["proofs"]["theorems"][theorem]["status"] = how
    else:
        records["theorems"][theorem]["statement"] += " and more"
    monkeypatch.setattr(ledger, "read", lambda: records)
    elements = argument(report, ())
    well_formed(elements)
    assert f"Sn-{theorem}" not in elements
    assert elements[of].state is State.NOT_PROVED
    assert elements["G-run"].state is State.NOT_PROVED
    assert any(
        theorem in one.shown or theorem in one.id for one in elements.values() if one.undeveloped
    )
    for one in elements.values():
        if one.kind is Kind.GOAL and "Missing" in one.text:
            assert one.state is State.NOT_PROVED, one.id
            if "-row-" not in one.id:
                assert one.undeveloped, one.id


@pytest.mark.parametrize("last", ["proved", "not proved", "in a circle"])
def test_lemmas_that_many_rest_on_are_looked_at_once(report: dict[str, Any], last: str) -> None:
    """A ladder of two theorems a step, each resting on both below: there are 2 ** 200 ways down."""
    one = report["proofs"]["theorems"][LEMMA]
    names = [[f"a{step}", f"b{step}"] for step in range(200)]
    theorems = {
        name: {**one, "lemmas": below}
        for here, below in zip(names, [*names[1:], []], strict=True)
        for name in here
    }
    records = copy.deepcopy(theorems)
    if last == "in a circle":
        theorems["b199"]["lemmas"] = ["a0"]
    elif last == "not proved":
        theorems["b199"]["status"] = last
    proofs = Proofs(Argument(), {**report["proofs"], "theorems": theorems}, records)
    assert (proofs._lacks("a0") == "") == (last == "proved")
    assert (proofs._lacks("b0") == "") == (last == "proved")
    assert proofs._lacks("a199") == ""


@pytest.mark.parametrize("edit", ["gone", "not proved"])
def test_a_theorem_that_the_run_does_not_have_supports_nothing(
    report: dict[str, Any], edit: str
) -> None:
    if edit == "gone":
        del report["proofs"]["theorems"][AGAINST]
    else:
        report["proofs"]["theorems"][AGAINST]["status"] = edit
    elements = argument(report, ())
    well_formed(elements)
    kernel = elements["G-kernel-eligible"]
    assert (kernel.state, kernel.undeveloped) == (State.NOT_PROVED, True)
    assert AGAINST in kernel.text
    assert elements["G1"].state is State.NOT_PROVED


def test_a_kernel_that_the_ledger_did_not_vouch_for_supports_nothing(
    report: dict[str, Any],
) -> None:
    report["proofs"]["problems"] = [{"kernel": "gate_accepts", "what": "its source is another"}]
    elements = argument(report, [("proof of gate_accepts", "not proved: its source is another")])
    assert elements["G-kernel-gate_accepts"].state is State.NOT_PROVED
    assert elements["G4"].state is State.NOT_PROVED
    assert "proof of gate_accepts: not proved" in elements["C-not-shown"].text


def test_a_row_that_no_kernel_decided_is_not_proved(report: dict[str, Any]) -> None:
    row = next(r for r in report["constraints"] if r["item"] == "end of mission")
    row["kernels"] = []
    elements = argument(report, ())
    goal = goal_of(elements, "end of mission")
    assert (goal.state, goal.undeveloped) == (State.NOT_PROVED, True)
    assert elements["G3"].state is State.NOT_PROVED


def assumption(state: str, theorem: str, *of: str, note: str = "as seen") -> dict[str, Any]:
    return {
        "name": "n", "text": f"assumed, and {state}", "theorems": [theorem], "guarantees": list(of),
        "state": state, "since_ms": 12_340 if state == "broken" else None, "note": note,
        "observed": None, "bound": 1.0, "unit": "s",
    }  # fmt: skip


def test_assumptions_stand_with_what_was_seen_of_them(report: dict[str, Any]) -> None:
    silence = SYSTEM.removeprefix("system_")
    report["assumptions"] = [
        assumption("held", silence, "G5"),
        assumption("not observed", silence, "G5"),
        assumption("held", "permitted_has_no_hit", "G2"),
    ]
    report["assumptions"][0]["observed"] = 0.5
    elements = argument(report, ())
    well_formed(elements)
    theorem = elements[f"G-theorem-{SYSTEM}"]
    texts = [elements[name].text for name in theorem.in_context_of]
    assert texts == [
        "assumed, and held. Watched in this run: held: as seen (worst 0.5, bound 1 s)",
        "assumed, and not observed. Not watched in this run: not observed: as seen",
    ]
    assert (theorem.state, elements["G5"].state) == (State.SUPPORTED, State.SUPPORTED)
    assert len(elements["G-G2-system"].in_context_of) == 1, "one that no theorem here names"


def test_a_broken_assumption_takes_the_ground_away(report: dict[str, Any]) -> None:
    report["assumptions"] = [
        assumption("broken", SYSTEM.removeprefix("system_"), "G5"),
        assumption("broken", "permitted_has_no_hit", "G2"),
    ]
    elements = argument(report, ())
    well_formed(elements)
    theorem = elements[f"G-theorem-{SYSTEM}"]
    assert (theorem.state, theorem.undeveloped) == (State.NO_GROUND, True)
    assert "broken at 12.34 s: as seen" in theorem.text
    for of in ("G2", "G5"):
        assert elements[of].state is State.NO_GROUND
        system = elements[f"G-{of}-system"]
        assert "broke in this run: assumed, and broken" in system.text
        (name,) = system.in_context_of
        assert "Watched in this run: broken at 12.34 s: as seen" in elements[name].text
    assert elements["G3"].state is State.SUPPORTED
    assert elements["G-run"].state is State.NO_GROUND


def test_a_report_without_assumptions_is_refused(report: dict[str, Any]) -> None:
    report.pop("assumptions", None)
    with pytest.raises(BadInput, match="says nothing of assumptions"):
        argument(report, ())


def test_every_theorem_on_the_system_is_placed(root: Path) -> None:
    records = {name for name in ledger.read()["theorems"] if name.startswith("system_")}
    assert records == {name for names in BEARS_ON.values() for name in names} == PLACED


def test_the_trusted_base_is_that_of_its_page(root: Path) -> None:
    page = (root / "docs" / "proofs" / "trusted-base.md").read_text(encoding="utf-8")
    rows = [line.split("|")[1].strip() for line in page.splitlines() if line.startswith("| ")]
    assert [row.partition(" (")[0] for row in rows if row != "part"] == list(TRUSTED)


def test_many_rows_are_all_named(report: dict[str, Any]) -> None:
    row = next(r for r in report["constraints"] if r["requirement"] == "G2")
    others = [r for r in report["constraints"] if r["requirement"] != "G2"]
    many = [{**row, "item": f"well clear of 1 and <{number}>"} for number in range(57)]
    many[30] = {**many[30], "verdict": "unknown"}
    report["constraints"] = [*others, *many]
    elements = argument(report, ())
    well_formed(elements)
    for number in range(57):
        goal = goal_of(elements, f"<{number}>")
        assert (goal.state is State.UNKNOWN) == (number == 30)
    assert "constraints 57, of these 56 hold, 1 unknown" in elements["G2"].text


def test_texts_from_anywhere(report: dict[str, Any]) -> None:
    report["mission"]["name"] = report["command"] = BAD_TEXT
    for row in report["constraints"]:
        row.update(item=BAD_TEXT, note=BAD_TEXT)
    report["limits"] = [BAD_TEXT]
    text, drawn = views(report, [(BAD_TEXT, BAD_TEXT)])
    for one in (text, drawn):
        one.encode("utf-8")
        assert "\x1b" not in one
        assert "\x00" not in one
    assert faults(yaml.safe_load(text)) == []
    assert etree.fromstring(drawn.encode()).tag == "{http://www.w3.org/2000/svg}svg"
