"""The report with all its sections, and as PDF: nothing left out, the same bytes, no text that breaks it."""

from __future__ import annotations

import copy
import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from certify_tools import Run, edited, read

from cratous.services.attestation.findings import Subject
from cratous.services.certify.html import render
from cratous.services.full_report import assurance_sections
from cratous.services.full_report.document import Beside, Head, Picture, Table, Words
from cratous.services.full_report.page import html
from cratous.services.full_report.sections import document
from cratous.services.full_report.shapes import Label, Line

BAD_TEXT = "<b>&\"'\x1b[2J\x00\ud800\u202e中→" + "x" * 9000
NAMES = [
    "verdict", "flight", "subject", "requirements", "constraints", "assignment", "trajectory", "runtime",
    "proofs", "assumptions", "coverage", "discrepancies", "tools", "argument", "reproduction",
]  # fmt: skip


class Balanced(HTMLParser):
    """Whether every element that is opened is closed in its turn."""

    VOID = ("meta", "br", "col", "line", "circle", "path", "polyline", "polygon", "rect")

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []

    def handle_starttag(self, tag: str, attrs: Any) -> None:
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        if tag not in self.VOID:
            assert self.open.pop() == tag


def texts(parts: Any) -> str:
    found = []
    for part in parts:
        if isinstance(part, (Words, Head)):
            found.append(part.text)
        elif isinstance(part, Table):
            found += [cell for row in part.rows for cell in row] or [part.empty]
    return "\n".join(found)


def sections(report: dict[str, Any], *unchecked: str) -> dict[str, str]:
    whole = document(Subject(report, unchecked), full=True)
    return {section.name: texts(section.parts) for section in whole.sections}


def pages_of(data: bytes) -> int:
    return len(re.findall(rb"/Type /Page\b", data))


def test_every_section_is_there_and_says_what_there_is_nothing_on(flown: Path) -> None:
    report = read(flown)
    found = sections(report)
    assert list(found) == NAMES
    assert all(found.values())
    assert "evidence, not certification credit" in found["verdict"]
    assert "Trusted: z3" in found["verdict"]
    assert "Lint: not asked for" in found["requirements"]
    assert report["plan"]["certificate"] in found["assignment"]
    told = report["flight"]["alerts"][0]
    row = (
        "1",
        "2",
        f"{told['from_ms'] / 1000:.1f} s",
        f"{told['to_ms'] / 1000:.1f} s",
        "corrective",
    )
    assert "\n".join(row) in found["trajectory"]
    assert f"First alert: {row[2]}" in found["trajectory"]
    page = re.sub("<[^>]+>", " ", (flown / "report.html").read_text())
    assert " ".join(row) in " ".join(page.split())
    assert "well_clear_violation_within_misses_no_instant" in found["trajectory"]
    for row in report["constraints"]:
        assert row["item"] in found["constraints"]
        assert row["item"] in found["coverage"]
    for one in report["proofs"]["kernels"].values():
        assert one["source"] in found["proofs"]
    for one in report["assumptions"]:
        assert one["text"] in found["assumptions"]
    for digest in (report["log"]["digest"], report["mission_hash"], report["plan"]["hash"]):
        assert digest in found["reproduction"]
    assert "plan: all order and timing rows at once" in found["coverage"].split("Nothing tested")[1]
    assert "G-run" in found["argument"]


def test_what_a_report_lacks_is_said_not_left_out(flown: Path) -> None:
    report = copy.deepcopy(read(flown))
    report["constraints"], report["assumptions"] = [], []
    report["plan"].update(items=[], certificate="", bound=None)
    report["proofs"].update(calls="not recorded", kernels={}, theorems={}, definitions={})
    report["flight"].update(tracks={}, takeovers=[], authority=[], events=[], bars=[], served=[])
    for one in report["requirements"]:
        one.update(constraints=0, verdict="unknown")
    report.update(verdict="unknown", not_covered=[2])
    found = sections(report, "environment.code: other code")
    assert list(found) == NAMES
    assert "UNKNOWN" in found["verdict"]
    assert "vehicles 2" in found["verdict"]
    assert "none was written" in found["assignment"]
    assert "not recorded" in found["proofs"]
    assert found["coverage"].count("no row") >= 5
    assert "not checked: other code" in found["discrepancies"]
    assert "not observed" in found["trajectory"]


def test_rows_that_do_not_hold_and_broken_assumptions_are_told(flown: Path) -> None:
    report = copy.deepcopy(read(flown))
    report["constraints"][0].update(verdict="violated", note="at the fence")
    report["assumptions"][0].update(
        state="broken", since_ms=1500, lost="one commander", stands="all else"
    )
    report["avoidance"] = False
    report["proofs"]["problems"] = [{"kernel": "a.b", "what": "its source is another"}]
    found = sections(report)
    assert "at the fence" in found["discrepancies"]
    assert "without ground since: one commander" in found["assumptions"]
    for said in ("--no-daa", "Assumption broken since 1.5 s", "does not vouch for 1 kernels (a.b)"):
        assert said in found["verdict"]
    assert "its source is another" in found["proofs"]


def test_zones_that_appear_in_flight_are_listed(flown: Path) -> None:
    report = copy.deepcopy(read(flown))
    late = {"id": 77, "kind": "keep_out", "vertices": [[0, 0], [9, 0], [9, 9]], "label": ""}
    report["mission"].update(
        zones=[], traffic=[], changes=[{"at_ms": 90_000, "kind": "zone", "zone": late}]
    )
    found = sections(report)["subject"]
    assert "77\nkeep-out\n3 corners, from 90.0 s on" in found
    assert "Neither zones nor traffic" not in found


def test_a_flight_in_real_time_is_not_said_to_be_made_again(flown: Path) -> None:
    report = copy.deepcopy(read(flown))
    before = sections(report)
    assert "byte for byte" in before["tools"]
    report["command"] += " --processes"
    found = sections(report)
    assert "gives another log" in found["tools"]
    assert not [text for text in found.values() if "byte for byte" in text or "Made again" in text]
    assert "virtual, in steps of" in before["subject"]
    assert "virtual" not in found["subject"]
    assert "and gives another log" in render(report)
    assert "gives the message log with the digest" in render(read(flown))


def test_later_plans_are_told_beside_the_one_that_is_certified(flown: Path) -> None:
    report = copy.deepcopy(read(flown))
    assert report["log"]["by_topic"]["cratous.PlanAccepted"] == 1
    assert "took the place" not in "".join(sections(report).values())
    report["log"]["by_topic"]["cratous.PlanAccepted"] = 4
    found = sections(report)
    for name in ("flight", "assignment"):
        assert "In flight 3 more plans took the place of this one" in found[name]


def many(flown: Path, count: int) -> Subject:
    """The report of a flight of so many vehicles, each of which flew as the first."""
    report = copy.deepcopy(read(flown))
    first, bar = report["mission"]["vehicles"][0], report["flight"]["bars"][0]
    numbers = range(1, count + 1)
    report["mission"]["vehicles"] = [{**first, "id": k, "label": f"UAV-{k:03}"} for k in numbers]
    report["flight"]["bars"] = [{**bar, "vehicle": k} for k in numbers]
    report["flight"]["tracks"] = {str(k): report["flight"]["tracks"]["1"][:3] for k in numbers}
    return Subject(report, ())


def test_many_vehicles_are_all_in_the_time_lines(flown: Path) -> None:
    verdict, flight = document(many(flown, 45), full=False).sections
    lines = [part for part in flight.parts if isinstance(part, Picture)]
    assert [one.title for one in lines] == [
        "Time line, vehicles 1 to 20 of 45", "Time line, vehicles 21 to 40 of 45",
        "Time line, vehicles 41 to 45 of 45",
    ]  # fmt: skip
    for k, one in enumerate(lines):
        labels = [s.text for s in one.shapes if isinstance(s, Label) and s.text.startswith("UAV")]
        assert labels == [f"UAV-{n:03}" for n in range(20 * k + 1, min(20 * k + 20, 45) + 1)]
        bars = [s for s in one.shapes if isinstance(s, Line) and s.style.startswith("bar")]
        assert len(bars) == len(labels)
        assert all(0 < y < one.height for bar in bars for _, y in bar.places)
    (beside,) = (part for part in verdict.parts if isinstance(part, Beside))
    assert "(the first 6 of 45 vehicles are named)" in beside.right[0].title


def test_an_argument_that_cannot_be_made_is_said(
    flown: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from cratous.spec.errors import Refused

    def refuse() -> None:
        raise Refused("the ledger is damaged")

    monkeypatch.setattr(assurance_sections.ledger, "read", refuse)
    assert "Not made: the ledger is damaged" in sections(read(flown))["argument"]


def hostile(flown: Path) -> Subject:
    report = copy.deepcopy(read(flown))
    report["mission"].update(name=BAD_TEXT, notes=[BAD_TEXT], relations=BAD_TEXT)
    report["command"] = report["flight"]["outcome"] = BAD_TEXT
    for one in (*report["constraints"], *report["requirements"]):
        one.update(note=BAD_TEXT, item=BAD_TEXT)
    for vehicle in report["mission"]["vehicles"]:
        vehicle["label"] = BAD_TEXT
    return Subject(report, (BAD_TEXT,))


def test_texts_from_anywhere_in_the_page(flown: Path) -> None:
    text = html(document(hostile(flown), full=True))
    text.encode("utf-8")
    assert "<b>&" not in text
    assert not {"\x1b", "\x00", "\u202e"} & set(text)
    page = Balanced()
    page.feed(text)
    assert page.open == []
    assert "http" not in text.replace("http-equiv", "")


def test_pdf_is_the_same_bytes_and_two_pages(flown: Path) -> None:
    pytest.importorskip("reportlab", reason="the extra `pdf` is not installed")
    from cratous.services.full_report.pdf import pdf

    subject = Subject(read(flown), ())
    short = pdf(document(subject, full=False))
    assert short.startswith(b"%PDF-")
    assert pages_of(short) == 2
    assert short == pdf(document(subject, full=False))
    assert b"evidence, not certification credit" in short
    # vectors: no picture of points
    assert b"/Subtype /Image" not in short
    full = pdf(document(subject, full=True))
    assert pages_of(full) > 10
    assert full == pdf(document(subject, full=True))
    # a row goes whole to the next page, so the head of a table stands once on each
    heads = [one.count(b"(Obligations)") for one in full.split(b"endstream")]
    assert max(heads) == 1
    assert sum(heads) > 2
    assert b"/CreationDate (D:20000101" in full


def test_texts_from_anywhere_in_the_pdf(flown: Path) -> None:
    pytest.importorskip("reportlab", reason="the extra `pdf` is not installed")
    from cratous.services.full_report.pdf import pdf, shown

    assert shown("a中b→c\x00\ud800é–") == "a\\u4e2db->c\\x00\\ud800é–"
    assert pages_of(pdf(document(hostile(flown), full=False))) > 2
    # many vehicles: no picture is higher than a page
    assert pages_of(pdf(document(many(flown, 45), full=False))) > 2


def test_the_command_writes_and_refuses(
    run: Run, flown: Path, judged: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = edited(flown, tmp_path)
    code = read(folder)["exit_code"]
    assert run("certify", folder, "-o", tmp_path / "one", "--full")[0] == code
    assert [entry.name for entry in (tmp_path / "one").iterdir()] == ["full.html"]
    monkeypatch.setitem(sys.modules, "reportlab", None)
    monkeypatch.delitem(sys.modules, "reportlab.platypus", raising=False)
    code, out, err = run("certify", folder, "-o", tmp_path / "two", "--pdf")
    assert (code, out, (tmp_path / "two").exists()) == (2, "", False)
    assert "reportlab is not installed" in err
    assert "pip install 'cratous[pdf]'" in err


def test_a_signed_pdf_is_refused_when_a_byte_is_another(
    run: Run, signed_run: Path, judged: None, tmp_path: Path
) -> None:
    pytest.importorskip("reportlab", reason="the extra `pdf` is not installed")
    signing = pytest.importorskip("signing", reason="the extra `sign` is not installed")
    home, views = signed_run, tmp_path / "views"
    words = ("--sign", "--key", home / "own.pem", "--pdf", "--full")
    code = read(home / "run")["exit_code"]
    assert run("certify", home / "run", "-o", views, *words)[0] == code
    check = ("certify", "--verify", home / "run", "-o", views, "--public-key", home / "own.pub")
    done, out, _ = run(*check)
    assert done in (0, 3)
    assert "full." not in out, "made again, and the same"
    for name in ("full.pdf", "full.html"):
        before = (views / name).read_bytes()
        signing.flip(views / name)
        done, _, err = run(*check)
        assert done == 1
        assert f"refused: views/{name}: SHA-256 signed" in err
        (views / name).write_bytes(before)
    (views / "report.pdf").write_bytes(b"another")
    assert "refused: views/report.pdf: the statement does not cover it" in run(*check)[2]
