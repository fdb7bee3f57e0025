"""Conformance: published vectors against the kernels that decide.

A suite reads the cases of a file (JSON lines, also gzipped), runs the exact reading of kernels on
each and compares. A case passes, fails, or is of a kind that the suite does not cover; the last is
said and counted apart, never as passed. Suites are imported when they are asked for.
"""

from __future__ import annotations

import gzip
import importlib
import json
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from cratous.spec.errors import BadInput

SUITES = {
    "well-clear": "Horizontal and vertical well-clear violation with modified tau, now.",
    "polygon": "Location of a point in a polygon: inside, outside or on the boundary.",
    "assignment": "Optimal assignments: recorded optima, and best costs of OpenUxAS.",
}


@dataclass(frozen=True)
class Result:
    """What came of one case: `passed`, `failed` or `not covered`.

    label: kind of difference, or of what is not covered; text: expected and got, for people.
    checks: how many single verdicts of kernels were compared.
    """

    case: str
    status: str
    label: str = ""
    text: str = ""
    checks: int = 0


def passed(case: str, checks: int = 1) -> Result:
    """The kernels say what the vector says."""
    return Result(case, "passed", checks=checks)


def failed(case: str, label: str, text: str, checks: int = 1) -> Result:
    """They do not."""
    return Result(case, "failed", label, text, checks)


def not_covered(case: str, label: str) -> Result:
    """The suite cannot judge a case of this kind."""
    return Result(case, "not covered", label)


Suite = Callable[[dict[str, Any]], Result]


@dataclass(frozen=True)
class Beside:
    """A suite that also reads files which lie beside that of its cases."""

    judge: Callable[[dict[str, Any], Path], Result]


def suite(name: str) -> Suite | Beside:
    """The function that judges one case; raises BadInput for a name that is none."""
    if name not in SUITES:
        raise BadInput(
            "there is no such suite", item="SUITE", expected=" or ".join(SUITES), got=name
        )
    module = importlib.import_module(f"cratous.services.conform.{name.replace('-', '_')}")
    judge: Suite | Beside = module.judge
    return judge


@dataclass
class FileReport:
    """The results of one file: counts, classified differences, and the first few of them."""

    file: str
    passed: int = 0
    failed: int = 0
    checks: int = 0
    skipped: Counter[str] = field(default_factory=Counter)
    differences: Counter[str] = field(default_factory=Counter)
    shown: list[Result] = field(default_factory=list)

    @property
    def line(self) -> str:
        """One line for the terminal."""
        text = f"{self.file}: {self.passed} passed, {self.failed} failed"
        if self.skipped:
            kinds = ", ".join(f"{count} {kind}" for kind, count in sorted(self.skipped.items()))
            text += f", not covered: {kinds}"
        return text


def cases(file: Path) -> Iterator[tuple[int, dict[str, Any]]]:
    """(line number, case) of a JSON-lines file, also gzipped; raises BadInput with the line."""
    opener = gzip.open if file.suffix == ".gz" else open
    number = 0
    try:
        with opener(file, "rt", encoding="utf-8") as lines:
            for number, line in enumerate(lines, 1):
                if not line.strip():
                    continue
                case = json.loads(line)
                if not isinstance(case, dict):
                    raise BadInput(
                        "a case is a JSON object",
                        where=f"{file}:{number}",
                        got=type(case).__name__,
                    )
                yield number, case
    except FileNotFoundError as error:
        raise BadInput("there is no such file", where=str(file)) from error
    except (OSError, EOFError, UnicodeDecodeError) as error:
        raise BadInput(f"the file cannot be read: {error}", where=str(file)) from error
    except json.JSONDecodeError as error:
        raise BadInput(f"this is no JSON: {error.msg}", where=f"{file}:{number}") from error


def run(judge: Suite | Beside, file: Path, show: int) -> FileReport:
    """Judge every case of a file; at most `show` differences are kept in full.

    Raises BadInput for a case that cannot be read: it is neither passed nor failed.
    """
    report = FileReport(str(file))
    for number, case in cases(file):
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
        else:
            report.failed += 1
            report.differences[result.label] += 1
            if len(report.shown) < show:
                report.shown.append(result)
    if not report.passed + report.failed + report.skipped.total():
        raise BadInput("the file has no cases", where=str(file), expected="JSON lines")
    return report
