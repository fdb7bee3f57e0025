"""A campaign's runs as CSV for spreadsheets, and as JUnit for continuous integration."""

from __future__ import annotations

import csv
import io
from typing import Any
from xml.etree import ElementTree

from cratous.services.campaign.outcomes import FAILED, IMPOSSIBLE, LOST
from cratous.spec.files.printable import cell, printable
from cratous.spec.mission.guarantees import Outcome

HEAD = ("run", "mission", "option", "seed", "outcome", "takeovers", "end_ms", "separation_m", "log")


def csv_text(summary: dict[str, Any]) -> str:
    """A line for each run; a text that a spreadsheet would take for a formula begins with `'`."""
    names = summary["requirements"]
    drawn = sorted({name for run in summary["runs"] for name in run["drawn"]})
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    measures = [f"{name} {what}" for name in names for what in ("verdict", "margin", "unit")]
    writer.writerow([cell(text) for text in (*HEAD, *measures, *drawn, "why")])
    for run in summary["runs"]:
        result = run["result"] or {}
        row = [run["name"], run["mission"], run["option"], run["seed"], run["outcome"]]
        row += [result.get(key) for key in HEAD[5:]]
        for name in names:
            found = result.get("requirements", {}).get(name, {})
            row += [found.get(key) for key in ("verdict", "margin", "unit")]
        row += [run["drawn"].get(name) for name in drawn]
        writer.writerow([cell(value) for value in (*row, run["why"])])
    return out.getvalue()


def junit_text(summary: dict[str, Any]) -> str:
    """A test for each run: what is not shown to hold is a failure, what was not flown an error or skipped."""
    root = ElementTree.Element("testsuites", name=summary["name"])
    suites: dict[tuple[str, str], ElementTree.Element] = {}
    for run in summary["runs"]:
        key = (run["mission"], run["option"])
        if key not in suites:
            suites[key] = ElementTree.SubElement(root, "testsuite", name=".".join(key))
        case = ElementTree.SubElement(
            suites[key], "testcase", name=run["name"], classname=".".join((summary["name"], *key))
        )
        kind = _kind(run["outcome"])
        if kind:
            told = {"type": run["outcome"], "message": printable(run["why"])}
            ElementTree.SubElement(case, kind, told)
    for suite in suites.values():
        suite.set("tests", str(len(suite)))
        for kind, name in (("failure", "failures"), ("error", "errors"), ("skipped", "skipped")):
            suite.set(name, str(len(suite.findall(f"testcase/{kind}"))))
    ElementTree.indent(root, " ")
    text = ElementTree.tostring(root, encoding="unicode")
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{text}\n'


def _kind(outcome: str) -> str:
    """What JUnit calls an outcome; nothing for a run that holds."""
    if outcome == Outcome.HOLDS:
        return ""
    if outcome == IMPOSSIBLE:
        return "skipped"
    return "error" if outcome in (FAILED, LOST) else "failure"
