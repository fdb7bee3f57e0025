"""`certify --verify` makes pages, map, SARIF, full report and PDF again: what a signer has changed is refused."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from certify_tools import ROOT, Run, read

pytest.importorskip("cryptography", reason="the extra `sign` is not installed")
pytest.importorskip("reportlab", reason="the extra `pdf` is not installed")

from signing import edit_report, sign_again, verify

from cratous.services.attestation import rebuilt_pages as module
from cratous.services.attestation.findings import Subject
from cratous.services.attestation.names import FULL_NAME, FULL_PDF_NAME, PDF_NAME, SARIF_NAME
from cratous.services.attestation.rebuilt_pages import pages_again, sarif_faults
from cratous.services.attestation.signed_files import Place
from cratous.services.attestation.writing import Wanted, write_views
from cratous.services.full_report.views import view
from cratous.services.results.names import HTML_NAME, MAP_NAME
from cratous.services.results.ownership import digest_of

MADE = (FULL_NAME, PDF_NAME, FULL_PDF_NAME)
MISSION = ROOT / "examples" / "crossing" / "mission.yaml"


@pytest.fixture(scope="module")
def subject(flown: Path) -> Subject:
    return Subject(read(flown), ("a file: nobody vouches for it",))


@pytest.fixture(scope="module")
def made(subject: Subject) -> Callable[[Subject, str], bytes]:
    """Makes each view once."""
    kept = cache(lambda name: view(subject, name))
    return lambda _subject, name: kept(name)


@pytest.fixture
def place(flown: Path, subject: Subject, made: Any, tmp_path: Path) -> Place:
    """Files as they are signed, SARIF with lines of the mission file."""
    results, views = tmp_path / "run", tmp_path / "views"
    results.mkdir()
    for name in (HTML_NAME, MAP_NAME):
        (results / name).write_bytes((flown / name).read_bytes())
    write_views(subject, results, views, Wanted((*MADE, SARIF_NAME), MISSION, None, made))
    return Place(results, views)


def named(place: Place) -> dict[str, str]:
    found = [f"results/{name}" for name in (HTML_NAME, MAP_NAME)]
    return dict.fromkeys([*found, *(f"views/{name}" for name in (*MADE, SARIF_NAME))], "")


def tamper(place: Place) -> None:
    """One character more in each file."""
    for name in named(place):
        file = place.of(*name.split("/", 1))
        file.write_bytes(file.read_bytes() + b" ")


def test_what_the_report_gives_is_confirmed_byte_for_byte(
    place: Place, subject: Subject, made: Any
) -> None:
    found = pages_again(place, named(place), subject, made)
    assert found.refused == []
    lines = "views/report.sarif: whether its lines of the mission file are right"
    assert found.not_judged == [lines]
    assert b"startLine" in (place.views / SARIF_NAME).read_bytes()
    assert sarif_faults(place, named(place), subject) == []


def test_what_was_changed_is_refused_by_name(
    place: Place, subject: Subject, made: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    tamper(place)
    files = [name for name in named(place) if not name.endswith("sarif")]
    found = pages_again(place, named(place), subject, made)
    assert found.refused == [f"{name}: it is not what report.json gives" for name in files]
    assert len(sarif_faults(place, named(place), subject)) == 1
    # another ledger gives another argument, and nothing else
    monkeypatch.setattr(module, "_seal", lambda: "0" * 64)
    found = pages_again(place, named(place), subject, made)
    assert [line.split(":")[0] for line in found.not_judged[:2]] == [
        f"views/{FULL_NAME}", f"views/{FULL_PDF_NAME}",
    ]  # fmt: skip
    assert len(found.refused) == len(files) - 2
    # other code may make other pages
    monkeypatch.setattr(module, "code_digest", lambda: "0" * 64)
    found = pages_again(place, named(place), subject, made)
    assert found.refused == []
    assert [line.split(":")[0] for line in found.not_judged[:-1]] == files


def test_sarif_that_says_less_is_refused_whatever_its_lines(place: Place, subject: Subject) -> None:
    file = place.views / SARIF_NAME
    text = file.read_text()
    for old, new in (('"level": "note"', '"level": "none"'), ('"startLine": ', '"startLine": -'),
                     ('"results"', '"result"'), (text, "[]"), (text, "{"), (text, "\x00")):  # fmt: skip
        assert old in text
        file.write_text(text.replace(old, new))
        assert sarif_faults(place, named(place), subject), (old[:20], new)
    file.write_text(re.sub(r'"startLine": \d+', '"startLine": true', text))
    assert sarif_faults(place, named(place), subject), "true is no line"


def test_without_reportlab_a_pdf_is_not_judged(place: Place, subject: Subject, made: Any) -> None:
    def missing(one: Subject, name: str) -> bytes:
        if name.endswith("pdf"):
            raise ModuleNotFoundError("no reportlab", name="reportlab")
        return bytes(made(one, name))

    found = pages_again(place, named(place), subject, missing)
    assert found.refused == []
    text = "what stands in it, as reportlab is not installed"
    assert found.not_judged[:2] == [f"views/{name}: {text}" for name in MADE[1:]]


def test_a_page_that_its_signer_has_changed_is_refused_by_the_command(run: Run, home: Path) -> None:
    page = home / "run" / HTML_NAME
    page.write_text(page.read_text().replace("a", "e", 1))
    sign_again(home, lambda _statement: None)
    code, _, err = verify(run, home)
    assert (code, err) == (1, f"refused: results/{HTML_NAME}: it is not what report.json gives\n")


def test_of_a_plan_that_was_not_flown_no_page_is_made(run: Run, home: Path) -> None:
    page = home / "views" / FULL_NAME
    page.write_text("as it was")
    edit_report(home, plan={**read(home / "run")["plan"], "cost": "of no kind"})
    one = {"name": f"views/{FULL_NAME}", "digest": {"sha256": digest_of(page)}}
    sign_again(home, lambda statement: statement["subject"].append(one))
    code, _, err = verify(run, home)
    assert code == 1
    assert "refused: report.json: plan is not what the log recorded" in err
