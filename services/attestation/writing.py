"""Writes the views of a confirmed report, and the signed statement on them and the evidence."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

from cratous.core.files.whole_file import write_atomically
from cratous.services.argument.views import views
from cratous.services.attestation.findings import Subject, unshown
from cratous.services.attestation.junit import junit
from cratous.services.attestation.mission_lines import lines_of
from cratous.services.attestation.names import (
    ALL_VIEWS,
    ARGUMENT_NAME,
    CSV_NAME,
    DRAWING_NAME,
    JUNIT_NAME,
    SARIF_NAME,
    STATEMENT_NAME,
)
from cratous.services.attestation.sarif import sarif
from cratous.services.attestation.table import table
from cratous.services.results.names import NAMES
from cratous.spec.errors import BadInput


class Wanted(NamedTuple):
    """What to write. names: of the views; mission: the mission file; key: for signing, None:
    unsigned; more: makes a view not implemented here (`full_report.views`), by name.
    """

    names: tuple[str, ...]
    mission: Path | None = None
    key: Any = None
    more: Callable[[Subject, str], bytes] | None = None


class Written(NamedTuple):
    """The paths written, and what was left out, in words."""

    files: list[str]
    left_out: list[str]


def write_views(subject: Subject, results: Path, target: Path, wanted: Wanted) -> Written:
    """Write the wanted views into a new folder.

    results: the folder of the run, whose files a statement covers. BadInput if the target is the
    results folder itself, or contains anything that is not overwritten: a statement would not cover
    it.
    """
    _refuse_others(results, target, wanted)
    texts: dict[str, str | bytes] = {}
    said = ""
    for name in wanted.names:
        if name == JUNIT_NAME:
            texts[name] = junit(subject)
        elif name == CSV_NAME:
            texts[name] = table(subject)
        elif name == SARIF_NAME:
            line_of, said = lines_of(subject.report, wanted.mission)
            texts[name] = sarif(subject, line_of)
        elif name == ARGUMENT_NAME:
            drawn = views(subject.report, unshown(subject))
            texts |= zip((ARGUMENT_NAME, DRAWING_NAME), drawn, strict=True)
        elif wanted.more is not None and name not in texts:
            texts[name] = wanted.more(subject, name)
    try:
        target.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise BadInput(
            "the folder cannot be made", where=str(target), got=error.strerror or ""
        ) from None
    for name, text in texts.items():
        write_atomically(target / name, text, "the view")
    if wanted.key is not None:
        _sign(subject, results, target, [target / name for name in texts], wanted.key)
    names = [*texts, *([STATEMENT_NAME] if wanted.key is not None else [])]
    return Written([str(target / name) for name in names], [said] if said else [])


def earlier(target: Path) -> list[str]:
    """Paths of existing views and statement in a folder."""
    return [str(target / name) for name in (*ALL_VIEWS, STATEMENT_NAME) if (target / name).exists()]


def _sign(subject: Subject, results: Path, target: Path, views: list[Path], key: Any) -> None:
    from cratous.services.attestation.dsse import signed
    from cratous.services.attestation.statement import statement

    there = [results / name for name in NAMES if (results / name).is_file()]
    text = signed(statement(subject, there, views), key)
    write_atomically(target / STATEMENT_NAME, text, "the statement")


def _refuse_others(results: Path, target: Path, wanted: Wanted) -> None:
    if target.resolve() == results.resolve():
        raise BadInput(
            "the views cannot stand among the results", where=str(target),
            expected="a folder of their own (-o)",
        )  # fmt: skip
    if not target.is_dir():
        return
    written = {*wanted.names, STATEMENT_NAME}
    strange = sorted(entry.name for entry in target.iterdir() if entry.name not in written)
    # without a new statement an existing one would cover other bytes
    if wanted.key is None and (target / STATEMENT_NAME).exists():
        strange.append(STATEMENT_NAME)
    if strange:
        raise BadInput(
            "the folder holds files that would not be replaced", where=str(target),
            expected="an empty folder, or one with former views of the same kinds",
            got=", ".join(strange[:5]),
        )  # fmt: skip
