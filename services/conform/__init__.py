"""Conformance: published vectors for the deciding kernels, and for the wire formats.

A suite reads the cases of a file (JSON lines or a list, also gzipped; or through its own function
`cases`) and judges each: by the exact reading of kernels, or by what the codecs make of the bytes.
A case passes, fails, is a knife edge (the tolerance of the other system explains the difference),
or is of a kind that the suite does not cover; the last two are reported and counted separately,
never as passed. Suites are imported when needed.
"""

from __future__ import annotations

import importlib
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from cratous.spec.errors import BadInput
from cratous.spec.files.limits import DOCUMENT_BYTES, at_most, json_of
from cratous.spec.files.text_file import lines_of

SUITES = {
    "well-clear": "Well-clear violation now and over a span: tau_mod, tcpa, tep, cylinder.",
    "polygon": "Places of points in polygons and layers, nearness with a buffer, exact distances.",
    "lmcp": "LMCP messages in binary and XML, both ways, and malformed ones.",
    "frames": "Captured sentinel frames and envelopes, and what breaks a TCP bridge.",
    "detect-and-avoid": "Alerts, bands, recovery, last times and resolutions of DAIDALUS.",
    "bridge": "Lines and recorded sessions of the CRATOUS text protocol, whole and cut at every place.",
    "monitor": "Requirements over time: verdicts of R2U2 on its traces and suites.",
    "trajectory": "Flights of AMASE against the simulator in compatibility mode.",
    "assignment": "Optimal assignments: recorded optima, and best costs of OpenUxAS.",
}


@dataclass(frozen=True)
class Result:
    """Result of one case: `passed`, `failed`, `knife edge` or `not covered`.

    label: kind of difference, or of what is not covered; text: expected and got, for people.
    checks: number of kernel verdicts compared.
    """

    case: str
    status: str
    label: str = ""
    text: str = ""
    checks: int = 0


def passed(case: str, checks: int = 1) -> Result:
    """Result: the product agrees with the vector."""
    return Result(case, "passed", checks=checks)


def failed(case: str, label: str, text: str, checks: int = 1) -> Result:
    """Result: the product disagrees with the vector."""
    return Result(case, "failed", label, text, checks)


def edge(case: str, label: str, text: str, checks: int = 1) -> Result:
    """Result: the product disagrees with the vector, within the numerical tolerance of the vector's own system."""
    return Result(case, "knife edge", label, text, checks)


def not_covered(case: str, label: str) -> Result:
    """Result: the suite cannot judge a case of this kind."""
    return Result(case, "not covered", label)


Suite = Callable[[dict[str, Any]], Result]


@dataclass(frozen=True)
class Beside:
    """A suite that also reads files beside the file of its cases."""

    judge: Callable[[dict[str, Any], Path], Result]


def suite(name: str) -> Suite | Beside:
    """The function that judges one case; raises BadInput for an unknown name.

    A suite whose cases depend on each other has state: call this again for each file.
    """
    if name not in SUITES:
        raise BadInput(
            "there is no such suite", item="SUITE", expected=" or ".join(SUITES), got=name
        )
    module = importlib.import_module(f"cratous.services.conform.{name.replace('-', '_')}")
    judge: Suite | Beside = module.suite() if hasattr(module, "suite") else module.judge
    return judge


def summary_of(judge: Suite | Beside) -> list[str]:
    """Summary lines of a suite that keeps statistics."""
    lines: list[str] = getattr(getattr(judge, "__self__", None), "summary", list)()
    return lines


@dataclass
class FileReport:
    """The results of one file: counts, classified differences, and the first few of them."""

    file: str
    passed: int = 0
    failed: int = 0
    checks: int = 0
    skipped: Counter[str] = field(default_factory=Counter)
    edges: Counter[str] = field(default_factory=Counter)
    differences: Counter[str] = field(default_factory=Counter)
    shown: list[Result] = field(default_factory=list)
    summary: list[str] = field(default_factory=list)
    edge_cases: list[Result] = field(default_factory=list)

    @property
    def line(self) -> str:
        """One line for the terminal."""
        text = f"{self.file}: {self.passed} passed, {self.failed} failed"
        if self.edges:
            text += f", {self.edges.total()} on a knife edge"
        if self.skipped:
            kinds = ", ".join(f"{count} {kind}" for kind, count in sorted(self.skipped.items()))
            text += f", not covered: {kinds}"
        return text


def cases(file: Path) -> Iterator[tuple[int, dict[str, Any]]]:
    """(number, case) of a file of JSON lines, or one JSON list; also gzipped.

    Raises BadInput with the line.
    """
    lines = lines_of(file)
    for number, line in lines:
        if number == 1 and line.lstrip().startswith("["):
            yield from _listed(file, line, lines)
            return
        if line.strip():
            yield number, _case(json_of(line, f"{file}:{number}"), f"{file}:{number}")


def _case(value: Any, where: str) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise BadInput("a case is a JSON object", where=where, got=type(value).__name__)
    return value


def _listed(
    file: Path, first: str, rest: Iterator[tuple[int, str]]
) -> Iterator[tuple[int, dict[str, Any]]]:
    """The cases of a file that is one JSON list, numbered from 1."""
    parts, size = [first], len(first)
    for _, line in rest:
        parts.append(line)
        size += len(line)
        at_most(size, DOCUMENT_BYTES, "the JSON is too long", str(file))
    for number, value in enumerate(json_of("".join(parts), str(file)), 1):
        yield number, _case(value, f"{file}, case {number}")


def run(judge: Suite | Beside, file: Path, show: int) -> FileReport:
    """Judge every case of a file; at most `show` differences are kept in full.

    Raises BadInput for a case that cannot be read: it neither passes nor fails.
    """
    report = FileReport(str(file))
    of = judge.judge if isinstance(judge, Beside) else judge
    module = importlib.import_module(of.__module__)
    for number, case in getattr(module, "cases", cases)(file):
        try:
            result = judge.judge(case, file) if isinstance(judge, Beside) else judge(case)
        except BadInput as error:
            error.where = error.where or f"{file}:{number}"
            raise BadInput(
                error.what,
                where=error.where,
                item=error.item,
                expected=error.expected,
                got=error.got,
            ) from error
        report.checks += result.checks
        if result.status == "passed":
            report.passed += 1
        elif result.status == "not covered":
            report.skipped[result.label] += 1
        elif result.status == "knife edge":
            report.edges[result.label] += 1
            report.edge_cases.append(result)
        else:
            report.failed += 1
            report.differences[result.label] += 1
            if len(report.shown) < show:
                report.shown.append(result)
    counted = report.passed + report.failed + report.skipped.total() + report.edges.total()
    if not counted:
        raise BadInput("the file has no cases", where=str(file), expected="JSON lines")
    return report
