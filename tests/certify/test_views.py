"""Views of a confirmed report for other tools: the same bytes each time, and nothing passes unchecked."""

from __future__ import annotations

import copy
import csv
import io
import json
from pathlib import Path
from typing import Any

import pytest
from certify_tools import ROOT, Run, edited, read, unconfirmed
from lxml import etree

from cratous.services.attestation.findings import Subject, doubt, unshown
from cratous.services.attestation.junit import junit
from cratous.services.attestation.mission_lines import line, lines_of
from cratous.services.attestation.names import VIEWS
from cratous.services.attestation.sarif import sarif
from cratous.services.attestation.table import COLUMNS, table
from cratous.services.loading.document import read_document
from cratous.spec.errors import BadInput

BAD_TEXT = "=1+1\x1b[2J\x00\ufffe\ud800<&\"'\n\u202e"


def cases(text: str) -> list[Any]:
    return list(etree.fromstring(text.encode("utf-8", "surrogatepass")).iter("testcase"))


def with_verdicts(report: dict[str, Any]) -> dict[str, Any]:
    """The report with a row of each verdict, and one that holds because there was nothing to check."""
    found = copy.deepcopy(report)
    rows = [copy.deepcopy(found["constraints"][0]) for _ in range(5)]
    for row, verdict in zip(
        rows, ("holds", "violated", "unknown", "excused", "holds"), strict=True
    ):
        row.update(
            verdict=verdict, item=f"task 1 served {verdict}", note=f"note {verdict}", checks=1
        )
    rows[4].update(checks=0, item="nothing to check")
    found["constraints"] = rows
    return found


def test_junit_passes_only_what_was_checked_and_holds(flown: Path) -> None:
    report = with_verdicts(read(flown))
    report["not_covered"] = [7]
    report["proofs"]["problems"] = [{"kernel": "a.b", "what": "its source is another"}]
    subject = Subject(report, ("environment.code: other code",))
    found = cases(junit(subject))
    ended = {
        case.get("name"): [part.tag for part in case if part.tag != "properties"] for case in found
    }
    assert ended["task 1 served holds"] == []
    assert ended["task 1 served violated"] == ["failure"]
    passed = [name for name, tags in ended.items() if not tags]
    assert passed == ["task 1 served holds"]
    reasons = {c.get("name"): c.find("skipped").get("message") for c in found if c.find("skipped") is not None}  # fmt: skip
    assert reasons["task 1 served unknown"] == "unknown: note unknown"
    assert reasons["task 1 served excused"] == "excused: note excused"
    assert reasons["nothing to check"] == "nothing was checked: note holds"
    assert reasons["vehicle 7"] == "not covered: the vehicle is not protected"
    assert reasons["proof of a.b"] == "not proved: its source is another"
    assert reasons["environment.code"] == "not checked: other code"
    whole = etree.fromstring(junit(subject).encode())
    digests = [suite.findall("properties/property[@name='log_digest']") for suite in whole]
    assert [[one.get("value") for one in found] for found in digests] == [
        [report["log"]["digest"]]
    ] * len(whole)
    count = [int(whole.get(key)) for key in ("tests", "failures", "errors", "skipped")]
    assert count == [len(found), 1, 0, len(found) - 2]
    assert count[0] == sum(int(suite.get("tests")) for suite in whole)


def test_a_case_and_a_line_for_each_constraint_of_a_flight(flown: Path) -> None:
    report = read(flown)
    subject = Subject(report, ())
    names = [row["item"] for row in report["constraints"]]
    assert sorted(case.get("name") for case in cases(junit(subject))) == sorted(names)
    rows = list(csv.DictReader(io.StringIO(table(subject))))
    assert [row["item"] for row in rows] == names
    assert tuple(rows[0]) == COLUMNS
    # the margins are the numbers of the report, negative ones too
    for row, full in zip(rows, report["constraints"], strict=True):
        assert (float(row["margin"]) if row["margin"] else None) == full["margin"]
    empty = copy.deepcopy(report)
    empty["constraints"] = []
    for row in empty["requirements"]:
        row["constraints"] = 0
    assert len(cases(junit(Subject(empty, ())))) == 5, "what nothing was observed of is said"
    assert unshown(Subject(empty, ()))[0] == ("G1: Constraints", "unknown: nothing was observed")


@pytest.mark.parametrize("start", ["=", "+", "-", "@", "\t", "\r"])
def test_no_cell_is_a_formula(flown: Path, start: str) -> None:
    report = read(flown)
    row = report["constraints"][0]
    row.update(item=f"{start}cmd|' /C calc'!A0", note=f"{start}1+1", margin=-2.5)
    first = next(csv.DictReader(io.StringIO(table(Subject(report, (f"{start}x: y",))))))
    assert first["item"].startswith("'")
    assert first["note"].startswith("'")
    assert first["margin"] == "-2.5"
    assert list(csv.DictReader(io.StringIO(table(Subject(report, (f"{start}x: y",))))))[-1][
        "item"
    ].startswith("'")


def test_sarif_tells_what_is_not_shown_and_where(flown: Path) -> None:
    report = with_verdicts(read(flown))
    data = json.loads(sarif(Subject(report, ("a: b",)), {"task 1 served violated": 36}.get))
    (run,) = data["runs"]
    assert data["version"] == "2.1.0"
    found = {one["message"]["text"].partition(":")[0]: one for one in run["results"]}
    assert {name: one["level"] for name, one in found.items()} == {
        "task 1 served violated": "error",
        "task 1 served unknown": "warning",
        "task 1 served excused": "note",
        "nothing to check": "note",
    }
    places = {n: one["locations"][0]["physicalLocation"] for n, one in found.items()}
    source = {"uri": report["mission"]["source"]}
    assert places["task 1 served violated"] == {
        "artifactLocation": source,
        "region": {"startLine": 36},
    }
    assert places["task 1 served unknown"] == {"artifactLocation": source}
    for one in run["results"]:
        assert run["tool"]["driver"]["rules"][one["ruleIndex"]]["id"] == one["ruleId"]
    notes = run["invocations"][0]["toolExecutionNotifications"]
    assert [one["message"]["text"] for one in notes] == ["a: not checked: b"]


def test_lines_of_a_mission_file() -> None:
    file = ROOT / "examples" / "partial" / "mission.yaml"
    document = read_document(file)
    text = file.read_text().splitlines()
    for item, start in (
        ("task 3 served", "  - id: 3"),
        ("eligibility: task 6 in flight", "  - id: 6"),
        ("zone: keep_out 9, flight of vehicle 1", "      id: 9"),
        ("authority over vehicle 2", "  - id: 2"),
        ("heartbeat to the ICAROUS instance of 1", "  - id: 1"),
        ("well clear of 2 and 90", "  - id: 2"),
        ("flight: `.(p3 p4)`: p4 starts no earlier than p3 ends", "relations:"),
        ("end of mission", "#"),
        ("task 99 served", "#"),
    ):
        assert text[line(document, item) - 1].startswith(start), item
    vehicle = next(k for k, row in enumerate(text, 1) if row == "  - id: 2")
    assert line(document, "authority over vehicle 2") == vehicle


def test_no_line_of_another_file(flown: Path, tmp_path: Path) -> None:
    report = read(flown)
    own = ROOT / "examples" / "crossing" / "mission.yaml"
    line_of, said = lines_of(report, own)
    assert (said, line_of("task 1 served") is not None) == ("", True)
    other = ROOT / "examples" / "partial" / "mission.yaml"
    with pytest.raises(BadInput, match="not the mission that was flown"):
        lines_of(report, other)
    report["mission"]["source"] = str(other)
    line_of, said = lines_of(report, None)
    assert (line_of("task 1 served"), "not the mission" in said) == (None, True)
    report["mission"]["source"] = "nowhere.yaml"
    line_of, said = lines_of(report, None)
    assert (line_of("task 1 served"), "not here" in said) == (None, True)


def test_texts_from_anywhere(flown: Path) -> None:
    report = with_verdicts(read(flown))
    for row in report["constraints"]:
        row.update(item=BAD_TEXT, note=BAD_TEXT)
    report["mission"]["name"] = BAD_TEXT
    subject = Subject(report, (BAD_TEXT,))
    texts = [junit(subject), sarif(subject, lambda _item: None), table(subject)]
    for text in texts:
        assert "\x1b" not in text
        assert "\x00" not in text
        text.encode("utf-8")
    assert len(cases(texts[0])) == 6
    assert json.loads(texts[1])["runs"][0]["results"]


def test_the_command_writes_the_same_bytes_again(
    run: Run, flown: Path, judged: None, tmp_path: Path
) -> None:
    target = tmp_path / "views"
    code, _, err = run("certify", flown, "-o", target)
    assert (code, err) == (read(flown)["exit_code"], "")
    assert sorted(entry.name for entry in target.iterdir()) == sorted(VIEWS)
    before = {entry.name: entry.read_bytes() for entry in target.iterdir()}
    assert json.loads(run("certify", flown, "-o", target, "--json")[1])["written"]
    assert {entry.name: entry.read_bytes() for entry in target.iterdir()} == before
    one = tmp_path / "one"
    assert run("certify", flown, "-o", one, "--junit")[0] == code
    assert [entry.name for entry in one.iterdir()] == ["junit.xml"]
    # inside the results: they are no part of what they are about
    folder = edited(flown, tmp_path)
    for _ in range(2):
        assert run("certify", folder, "--csv")[0] == code
        assert (folder / "attestation" / "constraints.csv").read_bytes() == before[
            "constraints.csv"
        ]


def test_nothing_is_written_of_what_is_not_confirmed(
    run: Run, flown: Path, judged: None, tmp_path: Path
) -> None:
    folder = unconfirmed(flown, tmp_path)
    code, out, err = run("certify", folder, "-o", tmp_path / "views")
    assert (code, out, (tmp_path / "views").exists()) == (1, "", False)
    assert "not written: junit.xml: the report is not confirmed" in err
    assert "written: " not in err.replace("not written: ", "")
    assert "of an earlier run" not in err


def test_views_of_an_earlier_run_are_named_beside_a_report_that_is_not_confirmed(
    run: Run, flown: Path, judged: None, tmp_path: Path
) -> None:
    folder = edited(flown, tmp_path)
    _, out, err = run("certify", folder, "--junit", "--csv")
    stale = [folder / "attestation" / name for name in ("junit.xml", "constraints.csv")]
    assert [line for line in out.splitlines() if line.startswith("written: ")] == [
        f"written: {file}" for file in stale
    ]
    assert "of an earlier run" not in out + err
    whole = read(folder)
    whole["constraints"][0]["verdict"] = "violated"
    (folder / "report.json").write_text(json.dumps(whole), encoding="utf-8")
    code, _, err = run(
        "certify", folder
    )  # no views asked for: those that are there pass all the same
    lines = err.splitlines()
    assert code == 1
    assert all(f"of an earlier run, not confirmed now: {file}" in lines for file in stale)
    assert "not written" not in err
    data = json.loads(run("certify", folder, "--json", "--sarif")[1])
    assert data["of_an_earlier_run"] == [str(file) for file in stale]
    assert (data["written"], data["not_written"]) == (
        [],
        ["report.sarif: the report is not confirmed"],
    )


def test_what_is_written_and_what_is_not(
    run: Run, flown: Path, judged: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)  # no mission file is here
    _, out, _ = run("certify", flown, "-o", "views", "--sarif")
    said = [line for line in out.splitlines() if "written: " in line]
    assert said[0] == "written: views/report.sarif"
    assert said[1].startswith("not written: lines of ")
    assert len(said) == 2
    for words in (("--csv",), ("--junit", "--csv")):
        code, _, err = run("certify", flown, "-o", "v", *words, "--mission", "x.yaml")
        assert (code, "--mission finds lines for report.sarif, which is not asked for" in err) == (
            2,
            True,
        )
    assert not (tmp_path / "v").exists()


def test_only_the_folder_of_the_views_itself_is_left_out_of_what_was_not_checked(
    run: Run, flown: Path, judged: None, tmp_path: Path
) -> None:
    folder = edited(flown, tmp_path)
    (folder / "attestation: x").write_text("")
    for _ in range(2):
        assert run("certify", folder, "--csv")[0] == read(folder)["exit_code"]
    text = (folder / "attestation" / "constraints.csv").read_text()
    rows = [row["item"] for row in csv.DictReader(io.StringIO(text)) if row["source"] == "report"]
    assert rows == ["attestation"]  # the other one, with what follows its colon as the reason
    assert "x: no file of the results" in text


def test_folders_that_are_refused(run: Run, flown: Path, judged: None, tmp_path: Path) -> None:
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "mine").write_text("x")
    (tmp_path / "file").write_text("x")
    for target, said in (
        (flown, "cannot stand among the results"),
        (tmp_path / "full", "holds files that would not be replaced"),
        (tmp_path / "file", "cannot be made"),
    ):
        code, _, err = run("certify", flown, "-o", target)
        assert (code, said in err) == (2, True), err
    assert (tmp_path / "full" / "mine").read_text() == "x"


def test_doubts_are_of_what_is_not_shown() -> None:
    row = {"verdict": "holds", "checks": 1, "note": ""}
    assert doubt(row) == ""
    assert doubt({**row, "checks": 0}) == "nothing was checked: no reason is given"
    assert doubt({**row, "verdict": "unknown"}) == "unknown: no reason is given"
    assert doubt({**row, "verdict": "violated", "checks": 0}) == ""
