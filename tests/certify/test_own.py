"""Requirements of the user's own in the report: judged, confirmed, shown in every view, and verified from the log."""

from __future__ import annotations

import copy
import csv
import hashlib
import json
from pathlib import Path
from typing import Any

import pytest
import yaml
from certify_tools import Run, edited, meta, proved, read
from own_tools import TEXT, changed, rows

from cratous.core import ledger
from cratous.services.argument.build import argument
from cratous.services.argument.elements import Element, State
from cratous.services.argument.form import document, faults
from cratous.services.certify import rejudge
from cratous.services.certify.report import Flown
from cratous.services.cli import job
from cratous.services.cli import run as command
from cratous.services.requirements.requirement_files import files_of, own_file
from cratous.services.results.ownership import manifest_text
from cratous.spec.errors import BadInput

# ---- what stands in the report -----------------------------------------------------------------


def test_verdicts_margins_blame_and_texts_stand_there(with_own: Path, flown: Path) -> None:
    report = read(with_own)
    found = rows(report)
    assert {name: row["verdict"] for name, row in found.items()} == {
        "FLOOR": "holds", "BANK": "violated", "IDLE": "holds", "GONE": "unknown", "RISE": "holds",
    }  # fmt: skip
    assert (report["verdict"], report["exit_code"]) == ("violated", 1)
    floor, bank = found["FLOOR"], found["BANK"]
    assert (floor["severity"], floor["source"], floor["line"]) == ("hazardous", "manual 2.1", 6)
    track = [row[3] for row in read(flown)["flight"]["tracks"]["1"]]
    assert floor["margin"] == pytest.approx(min(track) - 90, abs=0.01)
    assert (floor["unit"], bank["unit"]) == ("m", "deg")
    assert bank["margin"] < 0
    blame = bank["blame"]
    assert blame["facts"] == ["roll_1 > 20 deg"]
    assert blame["at_s"] == bank["time_ms"] / 1000
    assert blame["command"] == [{"vehicle": 1, "side": "UxAS", "since_ms": 0}]
    assert (found["IDLE"]["asked"], found["IDLE"]["checks"]) == (0, 0)
    assert found["RISE"]["line"] is None
    (kept,) = report["own"]["files"]
    assert (kept["file"], kept["text"]) == ("own.req", TEXT)
    assert kept["sha256"] == hashlib.sha256(TEXT.encode()).hexdigest()
    assert [one["file"] for one in kept["imports"]] == ["export.json"]
    assert [one["kind"] for one in report["own"]["findings"]] == ["never"]
    # nothing else is another report than without them
    more = ("own", "verdict", "exit_code")
    assert {k: v for k, v in report.items() if k not in more} == {
        k: v for k, v in read(flown).items() if k not in more
    }


def test_it_is_judged_again_from_the_folder_alone(
    run: Run, with_own: Path, flown: Path, tmp_path: Path
) -> None:
    folder = edited(with_own, tmp_path)
    code, out, _ = run("certify", folder, "--json")
    data = json.loads(out)
    assert (code, data["confirmed"], data["rewritten"]) == (1, True, [])
    assert [one["requirement"] for one in data["own"]] == list(rows(read(folder)))
    other = tmp_path / "other.req"
    other.write_text(TEXT.partition("requirement")[0] + "requirement LOW: z_1 <= 1 km\n")
    code, out, err = run("certify", folder, "--requirements", other)
    assert "LOW: holds; 442 samples hold" in out, err
    assert list(rows(read(folder))) == ["LOW"], "files of an earlier command are replaced"
    alone = read(flown)
    assert (code, read(folder)["verdict"]) == (alone["exit_code"], alone["verdict"])


def named(folder: Path, own: Path) -> None:
    """As if the flight had been flown with the file."""
    meta(folder, "own", [own_file(own, own.name).named])
    there = sorted(entry.name for entry in folder.iterdir() if entry.name != "manifest.json")
    (folder / "manifest.json").write_text(manifest_text(folder, there))


def test_what_the_flight_was_flown_with_stays(
    run: Run, with_own: Path, own: Path, tmp_path: Path
) -> None:
    folder = edited(with_own, tmp_path)
    named(folder, own)
    other = tmp_path / "other.req"
    other.write_text(TEXT.partition("requirement")[0] + "requirement LOW: z_1 <= 1 km\n")
    run("certify", folder, "--requirements", other)
    assert list(rows(read(folder)))[-1] == "LOW"
    assert len(rows(read(folder))) == 6
    changed = tmp_path / "own.req"
    changed.write_text(other.read_text())
    code, _, err = run("certify", folder, "--requirements", changed)
    assert (code, "own.req: these files cannot be judged together" in err) == (2, True), err


def test_certify_finds_what_was_edited(run: Run, with_own: Path, tmp_path: Path) -> None:
    for edit, said in (
        (changed("verdict", "holds"), "own.requirements[1].verdict: written \"holds\""),
        (lambda r: r["own"]["files"][0].update(text=TEXT + "#"), "own.req: its text has another digest"),
        (lambda r: r.pop("own"), "verdict: written"),
        (lambda r: r.update(own=[]), "these are no files of requirements"),
        (lambda r: r["own"]["requirements"][0].update(lint=[{"kind": "valid", "text": "x"}]), "lint"),
    ):  # fmt: skip
        folder = edited(with_own, tmp_path)
        report = read(folder)
        edit(report)
        (folder / "report.json").write_text(json.dumps(report))
        code, _, err = run("certify", folder)
        assert (code, said in err) == (1, True), err


def test_a_log_that_names_files_misses_them(
    run: Run, flown: Path, judged: None, own: Path, tmp_path: Path
) -> None:
    folder = edited(flown, tmp_path)
    named(folder, own)
    code, _, err = run("certify", folder)
    assert (code, "own: the flight was flown with own.req (SHA-256 " in err) == (1, True)


# ---- what is refused before anything is judged ---------------------------------------------------


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("requirement G2: z_1 >= 1 m", "the id is taken"),
        ("requirement A: z_1 >= 1 kn", "units that do not fit"),
        ("signal q: m from AirVehicleState[ID=1].Location.Height\nrequirement A: q >= 1 m",
         "no such field"),
        ('fret "none.json"', "there is no such file"),
    ],
)  # fmt: skip
def test_a_file_that_cannot_be_judged_is_refused(
    run: Run, flown: Path, tmp_path: Path, text: str, said: str
) -> None:
    file = tmp_path / "a.req"
    file.write_text(TEXT.partition("requirement")[0] + text + "\n")
    code, _, err = run("certify", flown, "--requirements", file)
    assert (code, said in err) == (2, True), err


def test_files_that_clash_are_refused(run: Run, flown: Path, own: Path, tmp_path: Path) -> None:
    same = tmp_path / "same.req"
    same.write_text(TEXT.partition("requirement")[0] + "requirement BANK: z_1 >= 1 m\n")
    for second, said in (
        (same, "two requirements have one id"),
        (own, "cannot be judged together"),
    ):
        code, _, err = run("certify", flown, "--requirements", own, "--requirements", second)
        assert (code, said in err) == (2, True), err
    with pytest.raises(BadInput, match="this name cannot be kept"):
        own_file(own, "a\udcff.req")
    with pytest.raises(BadInput, match="these are no files"):
        files_of([{"file": "a"}])


# ---- the run -------------------------------------------------------------------------------------


def test_a_run_hands_them_on_and_its_log_names_them(
    run: Run, flown: Path, own: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen: list[Any] = []
    report = read(flown)

    def run_one(*words: Any) -> tuple[dict[str, Any], Path]:
        seen.append(words[3])
        return report, flown

    monkeypatch.setattr(command, "run_one", run_one)
    run("run", "m.yaml", "--requirements", own, "--quiet")
    (settings,) = seen
    assert settings.command == "cratous run m.yaml --requirements own.req"
    mission, _ = rejudge.subject(flown / "log.sqlite")
    how = Flown(settings.command, True, report["proofs"], report["environment"], settings.own)
    assert job.log_meta(mission, how)["own"] == [own_file(own, "own.req").named]
    assert "own" not in job.log_meta(mission, Flown("", True, report["proofs"], {}))


# ---- the views -----------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def views(with_own: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    from cratous.services.cli import main

    out = tmp_path_factory.mktemp("views") / "v"
    names = ("--junit", "--sarif", "--csv", "--full")
    assert main(["certify", str(with_own), "-o", str(out), *names]) == 1
    return out


def test_page_one_has_a_row_for_each(with_own: Path, flown: Path) -> None:
    page = (with_own / "report.html").read_text()
    answer = page[page.index('id="answer"') : page.index('id="flight"')]
    for name in ("FLOOR never below 90 m", "BANK", "IDLE", "GONE", "RISE"):
        assert f"<tr><td><b>{name}</b>" in answer
    assert "Requirements of one's own: 3 hold, 1 violated, 1 unknown." in page
    assert "UxAS had vehicle 1, since 0.00 s" in page
    assert "own" not in read(flown)
    assert "one's own" not in (flown / "report.html").read_text()


def test_junit_sarif_and_csv_have_them(views: Path) -> None:
    junit = (views / "junit.xml").read_text()
    assert '<testsuite name="BANK" tests="1" failures="1"' in junit
    assert (
        '<testsuite name="FLOOR never below 90 m" tests="1" failures="0" errors="0" skipped="0">'
        in junit
    )
    assert '<testsuite name="IDLE" tests="1" failures="0" errors="0" skipped="1">' in junit
    (sarif,) = json.loads((views / "report.sarif").read_text())["runs"]
    rule = next(r for r in sarif["tool"]["driver"]["rules"] if r["id"] == "FLOOR")
    assert rule["properties"]["severity"] == "hazardous"
    levels = {
        one["ruleId"]: one["level"] for one in sarif["results"] if one["ruleId"] not in "G1G3"
    }
    assert levels == {"BANK": "error", "IDLE": "note", "GONE": "warning"}
    place = next(r for r in sarif["results"] if r["ruleId"] == "BANK")["locations"][0]
    assert place["physicalLocation"]["artifactLocation"] == {"uri": "own.req"}
    assert place["physicalLocation"]["region"] == {"startLine": 7}
    table = list(csv.DictReader((views / "constraints.csv").open()))
    (bank,) = (row for row in table if row["requirement"] == "BANK")
    assert (bank["source"], bank["verdict"], bank["unit"]) == ("own", "violated", "deg")
    assert float(bank["margin"]) < 0


def test_the_full_report_has_source_lint_margins_and_what_nothing_tested(views: Path) -> None:
    page = (views / "full.html").read_text()
    untested = page[page.index("Nothing tested these") : page.index("from each to its theorems")]
    assert "IDLE" in untested
    assert "GONE" in untested
    assert "FLOOR" not in untested
    assert "manual 2.1" in page
    assert "1 violated, 1 unknown" in page[page.index("Requirements of one") :][:80]
    assert "z_1 - 90 m: least" in page
    assert "until_decided -&gt; requirements_until_of_any_sample_is_its_definition" in page


# ---- in the assurance argument ------------------------------------------------------------------

GOALS = {"FLOOR": 1, "BANK": 2, "IDLE": 3, "GONE": 4, "RISE": 5}


@pytest.fixture
def report(with_own: Path) -> dict[str, Any]:
    return proved(with_own)


def goal(elements: dict[str, Element], name: str) -> Element:
    return elements[f"G-own-{GOALS[name]}"]


def test_each_is_a_goal_with_its_text_verdict_and_file(report: dict[str, Any]) -> None:
    elements = argument(report, ())
    assert faults(document(elements.values())) == []
    assert elements["G-run"].supported_by == ("S-guarantees", "S-own")
    assert elements["S-own"].supported_by == tuple(f"G-own-{n}" for n in GOALS.values())
    assert {name: goal(elements, name).state for name in GOALS} == {
        "FLOOR": State.SUPPORTED, "BANK": State.VIOLATED, "IDLE": State.NOTHING, "GONE": State.UNKNOWN,
        "RISE": State.SUPPORTED,
    }  # fmt: skip
    for row in report["own"]["requirements"]:
        one = goal(elements, row["requirement"])
        assert one.text.startswith(row["text"])
        assert f"In this run: {row['verdict']}, {row['note']}" in one.text
        assert one.in_context_of[0] == "C-own-file-1"
        # what is not supported has nothing that seems to support it
        assert bool(one.supported_by) == (one.state is State.SUPPORTED)
    (file,) = report["own"]["files"]
    context = elements["C-own-file-1"].text
    assert all(
        said in context
        for said in (file["sha256"], file["imports"][0]["sha256"], "no value ever came")
    )
    floor = goal(elements, "FLOOR").supported_by
    assert {*floor} == {
        "G-own-kernel-reaches",
        "G-own-kernel-negated",
        "G-own-kernel-both",
        "Sn-own-1",
    }
    assert elements["G-own-kernel-both"].supported_by == (
        "G-theorem-requirements_verdicts_join_as_their_definitions",
    )
    assert (
        "of its 3 kernels judged a requirement"
        in elements["Sn-requirements_verdicts_join_as_their_definitions"].text
    )
    assert "Blame: " in goal(elements, "BANK").text


def test_the_top_says_which_of_them_hold(report: dict[str, Any]) -> None:
    top = argument(report, ())["G-run"]
    assert top.state is State.VIOLATED
    assert "FLOOR, BANK, IDLE, GONE, RISE of one's own, of which nothing tested IDLE" in top.text
    assert "Supported here: G1, G2, G3, G4, G5, FLOOR, RISE" in top.text
    good = copy.deepcopy(report)
    mine = good["own"]["requirements"]
    good["own"]["requirements"] = [row for row in mine if row["requirement"] in ("FLOOR", "IDLE")]
    good["verdict"] = "holds"
    elements = argument(good, ())
    assert elements["G-run"].state is elements["S-own"].state is State.SUPPORTED
    assert "supported here" not in elements["G-run"].text.lower()
    good["own"]["requirements"][0]["kernels"] = []
    assert goal(argument(good, ()), "FLOOR").state is State.NOTHING
    del good["own"]
    assert elements["G-run"].text != argument(good, ())["G-run"].text
    assert "S-own" not in argument(good, ())


@pytest.mark.parametrize("lost", ["kernels", "theorems"])
def test_what_the_ledger_does_not_have_proves_nothing(report: dict[str, Any], lost: str) -> None:
    kept = copy.deepcopy(ledger.read())
    name = {
        "kernels": "cratous.core.requirements.verdict.both",
        "theorems": "requirements_verdicts_join_as_their_definitions",
    }[lost]
    del kept[lost][name]
    elements = argument(report, (), kept)
    floor = goal(elements, "FLOOR")
    assert floor.state is State.NOT_PROVED
    assert elements["G-own-kernel-both"].state is State.NOT_PROVED
    assert not any(one.startswith("Sn-") for one in floor.supported_by)
    assert goal(elements, "RISE").state is State.SUPPORTED


def test_yaml_and_picture_have_them(run: Run, with_own: Path, judged: None, tmp_path: Path) -> None:
    code, _, err = run("certify", with_own, "--argument", "-o", tmp_path / "views")
    assert code == 1, err
    data = yaml.safe_load((tmp_path / "views" / "argument.yaml").read_text())
    assert data["G-own-2"]["classes"] == ["violated"]
    picture = (tmp_path / "views" / "argument.svg").read_text()
    assert "Drawing G-own-2: violated" in picture
    assert "Drawing G-own-5: supported" in picture
