"""From a row of a report to the kernels that decided it, their theorems and definitions."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import pytest
from certify_tools import Run

from cratous.services.certify import trace
from cratous.services.certify.trace import lines, traced

ROWS = "cratous.core.schedule.rows."
LEG = "cratous.core.geofence.mission_legs.leg_ok"


def kernel(**edits: Any) -> dict[str, Any]:
    return {
        "kind": "kernel", "count": 3, "how": {"CPython": 3}, "within": [], "status": "s",
        "theorems": ["t"], "against": ["t"], "definition": "schedule.row_holds", "step_of": "",
        "restates": "", "checked_by": [], "rechecked_by": [], **edits,
    }  # fmt: skip


def report(kernels: dict[str, Any], *named: str, verdict: str = "holds", **proofs: Any) -> Any:
    row = {"requirement": "G1", "source": "plan", "item": "i", "verdict": verdict, "kernels": named}
    theorems = {"t": {"status": "proved"}, "u": {"status": "not proved"}}
    found = {
        "calls": "recorded",
        "problems": [],
        "kernels": kernels,
        "theorems": theorems,
        **proofs,
    }
    return {"constraints": [row], "proofs": found}


def test_a_whole_chain() -> None:
    found = traced(report({ROWS + "row_holds": kernel()}, ROWS + "row_holds"))
    (row,) = found["rows"]
    (chain,) = row["chains"]
    assert (chain["calls"], chain["theorems"]) == (3, ["t"])
    assert chain["file"] == "spec/schedule.py"
    assert (row["missing"], found["missing"], found["undecided"]) == ([], 0, 0)
    assert "1 of 1 rows trace to a definition" in list(lines(found))[-1]


def test_a_driver_is_followed_to_the_kernels_that_decide_in_it_and_were_called() -> None:
    driver = kernel(kind="driver", against=[], definition="", checked_by=["k.a", "k.b"])
    kernels = {LEG: driver, "k.a": kernel(definition="")}
    (row,) = traced(report(kernels, LEG))["rows"]
    assert [(c["kernel"], c["by"]) for c in row["chains"]] == [("k.a", LEG)]
    (row,) = traced(report({LEG: driver}, LEG))["rows"]
    assert "no kernel that decides in it was called" in row["missing"][0]


@pytest.mark.parametrize(
    ("one", "missing"),
    [
        (kernel(against=[]), "no theorem holds it against a definition"),
        (kernel(against=["t", "u"]), "u is not among the proved theorems"),
        (kernel(definition="schedule.nothing"), "schedule.nothing does not exist"),
        (kernel(definition="nowhere.row_holds"), "nowhere.row_holds does not exist"),
        (kernel(definition=""), "it names no definition"),
        (None, "it was not called in this run"),
    ],
)
def test_what_is_missing_is_said(one: Any, missing: str) -> None:
    name = ROWS + "row_holds"
    found = traced(report({} if one is None else {name: one}, name))
    assert found["missing"] == 1
    assert missing in found["rows"][0]["missing"][0]
    assert any(line.startswith("  MISSING") for line in lines(found))


def test_a_kernel_that_the_ledger_did_not_vouch_for_proves_nothing() -> None:
    problems = [{"kernel": "row_holds", "what": "changed"}]
    name = ROWS + "row_holds"
    found = traced(report({name: kernel()}, name, problems=problems))
    assert "did not vouch" in found["rows"][0]["missing"][0]


def test_a_row_without_a_kernel_is_missing_unless_it_decides_nothing() -> None:
    assert traced(report({}))["rows"][0]["missing"] == ["no kernel decided it: the messages say it"]
    found = traced(report({}, verdict="unknown"))
    assert (found["missing"], found["undecided"]) == (0, 1)


def test_a_definition_of_another_package_is_found_without_importing_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    top = tmp_path / "own_kernels_of_a_report"
    (top / "spec" / "deep").mkdir(parents=True)
    for file in (top / "__init__.py", top / "spec" / "__init__.py"):
        file.write_text("raise RuntimeError('imported')\n")
    (top / "spec" / "deep" / "__init__.py").write_text(
        "from cratous.spec.schedule import row_holds\n"
    )
    (top / "spec" / "plain.py").write_text(
        "def here(x: float) -> bool:\n    return x > 0\nunbound\nvalue = 3\n"
    )
    (top / "spec" / "broken.py").write_text("def here(:\n")
    monkeypatch.syspath_prepend(tmp_path)
    assert trace.definition_of(top.name, "plain.here") == ("spec/plain.py", "")
    assert trace.definition_of(top.name, "deep.row_holds") == ("spec/deep/__init__.py", "")
    for name in (
        "plain.unbound",
        "plain.value",
        "deep.nothing",
        "broken.here",
        "here",
        "..here",
        "../x.here",
        ".",
    ):
        assert trace.definition_of(top.name, name) == ("", f"its definition {name} does not exist")
    assert top.name not in sys.modules


@pytest.mark.parametrize("package", ["", "..", "json", "sys", "no_such_package", "a/b", "__main__"])
def test_a_package_that_has_no_definitions(package: str) -> None:
    assert trace.definition_of(package, "tool.main") == (
        "",
        "its definition tool.main does not exist",
    )


@pytest.mark.usefixtures("judged")
def test_every_row_of_the_crossing_traces_to_a_definition(flown: Path, run: Run) -> None:
    code, out, err = run("certify", flown, "--trace")
    assert code == 0, err
    assert "MISSING" not in out
    assert "0 undecided, 0 with something missing" in out
    code, out, _ = run("certify", flown, "--trace", "--json")
    data = json.loads(out)["trace"]
    assert (code, data["missing"]) == (0, 0)
    ends = {c["definition"] for row in data["rows"] for c in row["chains"]}
    assert {"schedule.flown_as_asked", "executive.completes_at", "geofence.part_seen"} <= ends


@pytest.mark.usefixtures("judged")
def test_a_trace_with_something_missing_exits_1(
    flown: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = trace._file
    gone = "executive.completes_at"
    monkeypatch.setattr(trace, "_file", lambda top, name: "" if name == gone else real(top, name))
    code, out, _ = run("certify", flown, "--trace")
    assert code == 1
    assert "MISSING completes: its definition executive.completes_at does not exist" in out
    code, out, _ = run("certify", flown)
    assert code == 0, "without --trace the flight's own"
