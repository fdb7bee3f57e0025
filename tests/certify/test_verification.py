"""`certify --verify` against signers who tell less, more, or something else than the log shows."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from certify_tools import Run, meta, read

pytest.importorskip("cryptography", reason="the extra `sign` is not installed")

from signing import KEY as SIGNER
from signing import (
    STATEMENT,
    edit_report,
    retell,
    sign_again,
    sign_whole,
    statement_of,
    verify,
    verify_edited,
)

from cratous.services.attestation import log_check, planned
from cratous.services.monitor import plan_check, required_rows
from cratous.spec.mission.guarantees import REQUIREMENTS

Report = dict[str, Any]
Edit = Callable[[Report], None]

LEFT_OUT = {
    "G1": "eligibility: task 1 in flight",
    "G2": "well clear of 1 and 2",
    "G3": "task 2 served",
    "G4": "authority over vehicle 2",
    "G5": "heartbeat to the ICAROUS instance of 1",
}
GRAMMATICAL = "flight: `.(p1 p2)`: p2 starts no earlier than p1 ends"


def without(item: str) -> Edit:
    def edit(report: Report) -> None:
        rows = report["constraints"]
        report["constraints"] = [row for row in rows if row["item"] != item]
        assert len(report["constraints"]) == len(rows) - 1

    return edit


def with_row(name: str, item: str, verdict: str = "holds", source: str = "flight") -> Edit:
    def edit(report: Report) -> None:
        row = next(row for row in report["constraints"] if row["requirement"] == "G4")
        new = {**row, "requirement": name, "item": item, "verdict": verdict, "source": source}
        report["constraints"].append(new)

    return edit


def twice(report: Report) -> None:
    report["constraints"].append(dict(report["constraints"][-1]))


def said_again(report: Report) -> None:
    """The same pair in other words."""
    row = next(row for row in report["constraints"] if row["requirement"] == "G2")
    report["constraints"].append({**row, "item": "well clear of 2 and 1"})


def turned(item: str, verdict: str) -> Edit:
    def edit(report: Report) -> None:
        next(row for row in report["constraints"] if row["item"] == item)["verdict"] = verdict

    return edit


def uncovered(report: Report) -> None:
    report["not_covered"] = [2]


# ---- rows that are left out --------------------------------------------------------------------


@pytest.mark.parametrize("name", LEFT_OUT)
def test_a_row_that_is_left_out_is_missed(run: Run, home: Path, name: str) -> None:
    """All that follows from the rest is signed: nothing but the judge knows of the row."""
    retell(home, without(LEFT_OUT[name]))
    code, out, err = verify(run, home)
    assert (code, err) == (3, "")
    line = f"not decided: {name} {LEFT_OUT[name]}: no row in the report, the judge says holds"
    assert line in out.splitlines()
    said = read(home / "run")["verdict"].upper()  # G2 has one row alone, and is unknown without
    assert said == ("UNKNOWN" if name == "G2" else "HOLDS")
    assert f"the report says {said}; verified: UNKNOWN; exit code 3" in out
    assert "12 of 13 verdicts on the flight" in out
    data = json.loads(verify(run, home, "--json")[1])
    assert (data["verified"], data["verified_verdict"], data["exit_code"]) == (True, "unknown", 3)
    assert (data["expected"], data["recomputed"]) == (13, 12)


@pytest.mark.parametrize("name", LEFT_OUT)
def test_a_requirement_that_is_left_out_is_refused(run: Run, home: Path, name: str) -> None:
    report = read(home / "run")
    for key in ("requirements", "constraints"):
        report[key] = [row for row in report[key] if row["requirement"] != name]
    report["counts"]["holds"] = len(report["constraints"])
    sign_whole(home, report)
    code, out, err = verify(run, home)
    assert (code, "verified" in out) == (1, False)
    rest = ", ".join(one.id for one in REQUIREMENTS if one.id != name)
    assert f"refused: report.json: its requirements are {rest}, expected G1, G2" in err


# ---- rows that are strange ---------------------------------------------------------------------

STRANGE: dict[str, tuple[Edit, str]] = {
    "a requirement of its own": (
        with_row("G6", "beauty"), "report.json: a row of G6, which is no requirement: beauty",
    ),
    "G3 on the plan": (
        with_row("G3", "task 1 served in the plan", source="plan"),
        "a row of G3 on the plan, of which only G1 speaks",
    ),
    "words that no monitor writes": (
        with_row("G2", "well clear of all birds"), "G2 well clear of all birds: holds, a row that",
    ),
    "words that no monitor writes, unknown": (
        with_row("G2", "well clear of all birds", "unknown"),
        "G2 well clear of all birds: unknown, a row that",
    ),
    "a relation that is none": (
        with_row("G1", "flight: nobody was disturbed"), "G1 flight: nobody was disturbed: holds",
    ),
    "a relation that the mission does not state": (
        with_row("G1", GRAMMATICAL), f"G1 {GRAMMATICAL}: holds, a row that",
    ),
    "a vehicle that the mission does not have": (
        with_row("G2", "well clear of 99"), "G2 well clear of 99: judge no row, monitor holds",
    ),
    "two equal rows": (twice, "report.json: 2 rows of G5 on the same: heartbeat to"),
    "the same in other words": (said_again, "G2 well clear of 2 and 1: holds, a row that"),
    "no row on the plan": (
        without(plan_check.WHOLE), f"one row on the plan of these: {plan_check.WHOLE}",
    ),
    "no row on the order of the plan": (
        without(required_rows.PLAN_ROWS[1].item), "G1 lacks the row on the plan: plan: all order",
    ),
    "an excuse of what holds": (
        turned("well clear of 1 and 2", "excused"), "judge holds, monitor excused",
    ),
    "a vehicle that is not covered": (uncovered, "report.json: not covered are [2], by the log []"),
}  # fmt: skip


@pytest.mark.parametrize("case", STRANGE)
def test_rows_that_are_strange_are_refused(run: Run, home: Path, case: str) -> None:
    edit, said = STRANGE[case]
    if case == "a requirement of its own":  # `retell` would make a sixth requirement
        report = read(home / "run")
        edit(report)
        report["counts"]["holds"] += 1
        sign_whole(home, report)
    else:
        retell(home, edit)
    code, out, err = verify(run, home)
    assert (code, "verified" in out) == (1, False)
    assert any(line.startswith("refused: ") and said in line for line in err.splitlines()), err


def test_the_rows_on_a_plan_are_those_of_its_check() -> None:
    assert (planned.WHOLE, planned.PART) == (plan_check.WHOLE, plan_check.PART)
    assert [row.item for row in required_rows.PLAN_ROWS] == [planned.WHOLE, planned.AT_ONCE]


# ---- a summary that its rows do not give --------------------------------------------------------


def problems(report: Report) -> None:
    report["proofs"]["problems"] = [{"kernel": "a.b", "what": "its source is another"}]


def other_sum(name: str, key: str, value: Any) -> Edit:
    def edit(report: Report) -> None:
        row = next(row for row in report["requirements"] if row["requirement"] == name)
        row[key] = value

    return edit


SUMS: dict[str, tuple[Edit, str]] = {
    "verdict": (lambda r: r.update(verdict="excused"), "verdict is excused, by its rows holds"),
    "exit code": (lambda r: r.update(exit_code=3), "exit_code is 3, by its rows 0"),
    "counts": (lambda r: r["counts"].update(excused=1), "counts is {"),
    "verdict of one": (other_sum("G4", "verdict", "unknown"), "G4 is unknown, its rows holds"),
    "rows of one": (other_sum("G4", "constraints", 9), "G4 has 9 constraints, its rows are 2"),
    "title of one": (other_sum("G4", "title", "Safety"), "its requirements are G1, G2"),
    "the former format": (
        lambda r: r.update(format="cratous-report/1"),
        "a report of cratous-report/1 has no schema",
    ),
    "problems of proofs": (problems, "verdict is holds, by its rows unknown"),
}


@pytest.mark.parametrize("case", SUMS)
def test_a_summary_that_its_rows_do_not_give_is_refused(run: Run, home: Path, case: str) -> None:
    edit, said = SUMS[case]
    code, _, err = verify_edited(run, home, edit)
    assert code == 1
    assert f"refused: report.json: {said}" in err


# ---- what the log recorded -----------------------------------------------------------------------


def mission_of_another(report: Report) -> None:
    report["mission"]["vehicles"][0]["speed_m_s"] += 1


def plan_of_another(report: Report) -> None:
    report["plan"]["bound"] += 1


RECORDED: dict[str, Edit] = {
    "mission": mission_of_another,
    "plan": plan_of_another,
    "command": lambda r: r.update(command="cratous run other.yaml"),
    "avoidance": lambda r: r.update(avoidance=False),
    "environment": lambda r: r["environment"].update(python="2.7"),
    "mission_hash": lambda r: r.update(mission_hash="0" * 64),
    "proofs.seal": lambda r: r["proofs"].update(seal="0" * 64),
    "proofs.line": lambda r: r["proofs"].update(line="all is proved"),
    "proofs.solver": lambda r: r["proofs"].update(solver="none"),
}


@pytest.mark.parametrize("name", RECORDED)
def test_what_the_log_recorded_is_what_the_report_says(run: Run, home: Path, name: str) -> None:
    code, _, err = verify_edited(run, home, RECORDED[name])
    assert (code, f"refused: report.json: {name} is not what the log recorded" in err) == (1, True)


def test_problems_of_proofs_that_are_hidden_are_known_to_the_log(run: Run, home: Path) -> None:
    proofs = read(home / "run")["proofs"]
    hidden = {**proofs, "problems": [{"kernel": "a.b", "what": "its source is another"}]}
    meta(home / "run", "proofs", {key: hidden[key] for key in log_check.PROOFS})
    sign_again(home, lambda data: None)
    code, _, err = verify(run, home)
    assert (code, "proofs.problems is not what the log recorded" in err) == (1, True), err


def test_what_the_log_does_not_say_is_named(run: Run, home: Path) -> None:
    meta(home / "run", "proofs", None)
    sign_again(home, lambda data: None)
    code, out, err = verify(run, home)
    assert (code, err) == (0, "")
    assert "not judged: proofs.problems: the log says nothing of it" in out


# ---- files and statement ------------------------------------------------------------------------


def gone(home: Path, name: str) -> None:
    """File and subject, and the file's line in the manifest."""
    where, file = name.split("/")
    (home / {"results": "run", "views": "views"}[where] / file).unlink()

    def edit(data: dict[str, Any]) -> None:
        data["subject"] = [one for one in data["subject"] if one["name"] != name]

    data = statement_of(home)
    edit(data)
    if file != "manifest.json":
        edit_report(home)
    _resign(home, data)


def _resign(home: Path, data: dict[str, Any]) -> None:
    from cratous.services.attestation.dsse import signed

    (home / "views" / STATEMENT).write_text(signed(json.dumps(data).encode(), SIGNER))
    sign_again(home, lambda _data: None)


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("results/map.svg", "the statement does not cover it"),
        ("results/manifest.json", "the statement does not cover it"),
        ("results/certificate.json", "the plan names it, and it is not there"),
    ],
)
def test_a_file_that_is_gone_with_its_subject(run: Run, home: Path, name: str, said: str) -> None:
    if name == "results/map.svg":
        (home / "run" / "map.svg").unlink()
        data = statement_of(home)
        data["subject"] = [one for one in data["subject"] if one["name"] != name]
        _resign(home, data)
    else:
        gone(home, name)
    code, _, err = verify(run, home)
    assert (code, f"refused: {name}: {said}" in err) == (1, True), err


def test_a_view_that_is_gone_with_its_subject_was_never_made(run: Run, home: Path) -> None:
    gone(home, "views/constraints.csv")
    assert verify(run, home)[0] == 0


@pytest.mark.parametrize("stated", ["", "no such file", "it cannot be read"])
def test_no_digest_is_that_of_no_file(run: Run, home: Path, stated: str) -> None:
    def edit(data: dict[str, Any]) -> None:
        named = {one["name"]: one["digest"] for one in data["subject"]}
        named["views/report.sarif"]["sha256"] = stated

    sign_again(home, edit)
    (home / "views" / "report.sarif").unlink()
    code, _, err = verify(run, home)
    assert (code, "views/report.sarif: SHA-256 signed" in err) == (1, True), err


STATEMENTS: dict[str, tuple[Callable[[dict[str, Any]], object], str]] = {
    "another predicate": (lambda d: d.update(predicateType="urn:other:1"), "not a statement on"),
    "another statement": (lambda d: d.update(_type="urn:other:1"), "not a statement on"),
    "no list of what was not checked": (
        lambda d: d["predicate"].update(not_checked="nothing"), "not a statement on",
    ),
    "a list of something else": (
        lambda d: d["predicate"].update(not_checked=[1]), "not a statement on",
    ),
    "no predicate": (lambda d: d.pop("predicate"), "not an in-toto statement"),
    "a subject twice": (lambda d: d["subject"].append(d["subject"][0]), "named twice"),
    "far too many subjects": (
        lambda d: d["subject"].extend(
            {"name": f"views/{n}", "digest": {"sha256": ""}} for n in range(200)
        ),
        "far too many",
    ),
    "a digest that is no text": (
        lambda d: d["subject"][0].update(digest={"sha256": 1}), "no file of results or views",
    ),
    "another verdict": (lambda d: d["predicate"].update(verdict="violated"), "verdict is not that"),
    "other limits": (lambda d: d["predicate"].update(limits=[]), "limits is not that"),
    "another log": (lambda d: d["predicate"].update(log_digest="0" * 64), "log_digest is not that"),
    "another product": (lambda d: d["predicate"].update(product={}), "product is not that"),
}  # fmt: skip


@pytest.mark.parametrize("case", STATEMENTS)
def test_a_statement_that_says_something_else(run: Run, home: Path, case: str) -> None:
    edit, said = STATEMENTS[case]
    sign_again(home, lambda data: (edit(data), None)[1])
    code, _, err = verify(run, home)
    assert (code, f"refused: {STATEMENT}: " in err, said in err) == (1, True, True), err


@pytest.mark.parametrize(
    ("name", "old"), [("junit.xml", "heartbeat"), ("constraints.csv", "holds")]
)
def test_a_view_that_the_report_does_not_give(run: Run, home: Path, name: str, old: str) -> None:
    file = home / "views" / name
    for text in (file.read_text().replace(old, "other", 1), file.read_text() + "\n"):
        file.write_text(text)
        sign_again(home, lambda data: None)
        code, out, err = verify(run, home)
        assert (code, "verified" in out) == (1, False)
        assert f"refused: views/{name}: it is not what report.json gives" in err
