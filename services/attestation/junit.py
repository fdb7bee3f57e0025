"""JUnit XML of a report: one suite per requirement, one test case per constraint or user
requirement.

A case passes only if its constraint was checked and holds. A violation is a failure; unknown,
excused and unchecked cases are skipped, with the reason. Each suite has the digest of the message
log as a property. There is no time stamp: the same subject gives the same bytes.
"""

from __future__ import annotations

import re
from typing import Any
from xml.sax.saxutils import quoteattr

from cratous.services.attestation.findings import Data, Subject, doubt, unshown
from cratous.services.certify.requirement_views import own_constraints
from cratous.spec.files.printable import printable
from cratous.spec.mission.guarantees import Outcome

NOT_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
PROPERTIES = ("margin", "unit", "time_ms", "kind", "method", "checks")
OF_OWN = ("severity", "source", "text")
Case = tuple[str, list[str]]
"""Result element of a case, and its lines."""


def junit(subject: Subject) -> str:
    """The text of the file."""
    report = subject.report
    suites = []
    for wanted in report["requirements"]:
        rows = [r for r in report["constraints"] if r["requirement"] == wanted["requirement"]]
        name = f"{wanted['requirement']} {wanted['title']}"
        suites.append((name, [_case(report, row) for row in rows]))
    for row in own_constraints(report):
        suites.append((f"{row['requirement']} {row['own']['title']}".strip(), [_case(report, row)]))
    suites.append(("not shown", [_skipped("cratous.report", *one) for one in unshown(subject)]))
    every = [case for _, cases in suites for case in cases]
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f"<testsuites name={_quoted('CRATOUS ' + report['mission']['name'])} {_counts(every)}>",
    ]
    for name, cases in suites:
        lines.append(f"  <testsuite name={_quoted(name)} {_counts(cases)}>")
        lines += _block("    ", {"log_digest": report["log"]["digest"]})
        lines += [line for _, case in cases for line in case]
        lines.append("  </testsuite>")
    return "\n".join([*lines, "</testsuites>", ""])


def _case(report: Data, row: Data) -> Case:
    of = f"cratous.{report['mission']['name']}.{row['requirement']}.{row['source']}"
    reason = doubt(row)
    if reason:
        return _skipped(of, row["item"], reason, row)
    lines = [*_opened(of, row["item"]), *_properties(row)]
    if row["verdict"] == Outcome.HOLDS:
        return "passed", [*lines, "    </testcase>"]
    lines.append(f"      <failure type={_quoted(row['verdict'])} message={_quoted(row['note'])}/>")
    return "failed", [*lines, "    </testcase>"]


def _skipped(of: str, name: str, reason: str, row: Data | None = None) -> Case:
    lines = [*_opened(of, name), *(_properties(row) if row else [])]
    return "skipped", [*lines, f"      <skipped message={_quoted(reason)}/>", "    </testcase>"]


def _opened(of: str, name: str) -> list[str]:
    return [f"    <testcase classname={_quoted(of)} name={_quoted(name)}>"]


def _properties(row: Data) -> list[str]:
    said = {name: row[name] for name in PROPERTIES}
    said |= {name: row["own"][name] for name in OF_OWN if "own" in row}
    return _block("      ", {k: v for k, v in said.items() if v not in (None, "")})


def _block(indent: str, named: dict[str, Any]) -> list[str]:
    found = [
        f"{indent}  <property name={_quoted(name)} value={_quoted(str(value))}/>"
        for name, value in named.items()
    ]
    return [f"{indent}<properties>", *found, f"{indent}</properties>"]


def _counts(cases: list[Case]) -> str:
    ended = [how for how, _ in cases]
    return (
        f'tests="{len(ended)}" failures="{ended.count("failed")}" errors="0" '
        f'skipped="{ended.count("skipped")}"'
    )


def _quoted(text: str) -> str:
    """An attribute value; characters that XML cannot contain are escaped."""
    shown = NOT_XML.sub(lambda found: found[0].encode("unicode_escape").decode(), printable(text))
    return quoteattr(shown)
