"""`cratous certify` of a log that says less than this version's, or something else than the report."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from certify_tools import Run, edited, meta, read

from cratous.services.certify import report
from cratous.services.logs.sqlite_log import SqliteLog
from cratous.services.results.ownership import manifest_text


def test_a_log_that_says_less(run: Run, flown: Path, judged: None, tmp_path: Path) -> None:
    """Results of the version before: confirmed, and what nothing vouches for is listed."""
    folder = edited(flown, tmp_path)
    kept = json.loads(
        json.dumps(report.Flown("", True, read(folder)["proofs"], {}).meta()["proofs"])
    )
    for key in ("environment", "command", "avoidance"):
        meta(folder, key, None)
    meta(folder, "proofs", {key: kept[key] for key in ("seal", "problems")})
    (folder / "manifest.json").unlink()
    code, out, err = run("certify", folder)
    assert (code, err) == (read(flown)["exit_code"], "")
    for name in ("environment", "command", "avoidance", "proofs.line", "proofs.solver", "manifest"):
        assert f"not checked: {name}" in out
    whole = read(folder)
    whole["command"] = 7
    (folder / "report.json").write_text(json.dumps(whole), encoding="utf-8")
    code, _, err = run("certify", folder)
    assert (code, "command: written 7" in err) == (1, True)


def test_the_report_lists_what_the_log_recorded(flown: Path) -> None:
    whole, calls = read(flown), SqliteLog(flown / "log.sqlite").meta()["calls"]
    kernels = whole["proofs"]["kernels"]
    assert set(kernels) == {*calls["called"], *calls["within"]}
    assert {name: one["how"] for name, one in kernels.items() if one["how"]} == calls["called"]
    named = {name for row in whole["constraints"] for name in row["kernels"]}
    assert named <= set(calls["called"])
    gate = "cratous.core.authority.gate.gate_accepts"
    assert gate in named
    for kernel in kernels.values():
        assert kernel["kind"] == "driver" or (kernel["theorems"] and kernel["definition"])
        assert set(kernel["theorems"]) <= set(whole["proofs"]["theorems"])
    page = (flown / "report.html").read_text(encoding="utf-8")
    links = set(re.findall(r'href="#([^"]*)"', page))
    assert links <= set(re.findall(r'id="([^"]*)"', page))
    assert f"kernel-{gate}" in links


def test_counts_that_are_not_those_of_the_flight(
    run: Run, flown: Path, judged: None, tmp_path: Path
) -> None:
    folder = edited(flown, tmp_path)
    calls = SqliteLog(folder / "log.sqlite").meta()["calls"]
    calls["called"]["cratous.core.authority.gate.gate_accepts"]["CPython"] += 1
    meta(folder, "calls", calls)
    code, _, err = run("certify", folder)
    assert (code, "proofs: not those of the flight" in err) == (1, True)


def test_a_log_from_before_calls_were_counted(
    run: Run, flown: Path, judged: None, tmp_path: Path
) -> None:
    """Such a log vouches for no call; the report of then is held against all else and made anew."""
    folder = edited(flown, tmp_path)
    meta(folder, "calls", None)
    code, _, err = run("certify", folder)
    assert (code, "proofs.calls: written" in err) == (1, True)  # calls that nothing recorded
    (folder / "manifest.json").unlink()
    whole = read(folder)
    whole["format"] = "cratous-report/1"
    whole["proofs"] = {"kernels": [], "theorems": []}
    for row in whole["constraints"]:
        del row["kernels"]
    text = json.dumps(whole, indent=1, sort_keys=True)
    (folder / "report.json").write_text(text, encoding="utf-8")
    code, _, err = run("certify", folder)
    assert code == 1
    assert "not checked: format" in err
    assert "constraints" not in err.replace("report.json, line", "")
    code, out, err = run("certify", folder, "--rewrite")
    assert (code, err) == (read(flown)["exit_code"], "")
    assert "rewritten: report.json" in out
    anew = read(folder)
    assert anew["format"] == "cratous-report/2"
    assert (anew["proofs"]["calls"], anew["proofs"]["kernels"]) == ("not recorded", {})
    assert "was not recorded" in (folder / "report.html").read_text(encoding="utf-8")
    code, out, _ = run("certify", folder)
    assert code == read(flown)["exit_code"]
    assert "not checked: proofs.calls" in out
    damaged = read(folder)
    damaged["constraints"][0]["verdict"] = "violated"
    (folder / "report.json").write_text(json.dumps(damaged), encoding="utf-8")
    assert run("certify", folder)[0] == 1


def test_another_ledger_than_at_the_flight(
    run: Run, flown: Path, judged: None, tmp_path: Path
) -> None:
    """The inventory is then held against the digest in the log."""
    folder = edited(flown, tmp_path)
    whole = read(folder)
    whole["proofs"]["seal"] = "0" * 64
    kept = report.Flown("", True, whole["proofs"], {}).meta()["proofs"]
    meta(folder, "proofs", kept)
    files = {**whole}
    (folder / "report.json").write_text(report.report_text(files), encoding="utf-8")
    for name, text in report.pages(files).items():
        (folder / name).write_text(text, encoding="utf-8")
    names = ("certificate.json", "log.sqlite", "map.svg", "report.html", "report.json")
    (folder / "manifest.json").write_text(manifest_text(folder, names))
    assert run("certify", folder)[0] == whole["exit_code"]
    next(iter(whole["proofs"]["theorems"].values()))["status"] = "refuted"
    (folder / "report.json").write_text(json.dumps(whole), encoding="utf-8")
    code, _, err = run("certify", folder)
    assert (code, "proofs: not the inventory of the flight" in err) == (1, True)
    meta(folder, "proofs", {"seal": "1" * 64, "problems": []})  # of the version before
    code, _, err = run("certify", folder)
    assert (code, "not checked: proofs: the ledger is another" in err) == (1, True)


@pytest.mark.parametrize(
    "key", ["environment", "command", "avoidance", "proofs", "calls", "mission", "plan"]
)
def test_what_a_log_cannot_say(
    run: Run, flown: Path, judged: None, tmp_path: Path, key: str
) -> None:
    for value in (7, [], "text", {"a": 1}, {"problems": [3]}):
        folder = edited(flown, tmp_path)
        meta(folder, key, value)
        code, out, err = run("certify", folder)
        assert code in (1, 2), (value, out, err)
        assert "internal error" not in err
