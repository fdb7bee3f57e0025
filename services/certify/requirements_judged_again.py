"""User requirements when a report is judged again: the files it contains, and a report with other files."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from cratous.services.certify.requirement_blame import Told
from cratous.services.certify.user_requirements import own_section
from cratous.services.requirements.requirement_files import OwnFile, files_of, refuse_clashes
from cratous.services.results.names import OWN
from cratous.spec.errors import BadInput
from cratous.spec.mission.guarantees import Outcome, exit_code, worst

Data = dict[str, Any]


def files_in(written: Data, meta: Data) -> tuple[tuple[OwnFile, ...], list[str]]:
    """The files that a report contains, and faults: files that cannot be read again, and files that
    the log names and the report lacks. meta: of the log.
    """
    wrong: list[str] = []
    files: tuple[OwnFile, ...] = ()
    if OWN in written:
        kept = written[OWN]
        try:
            files = files_of(kept.get("files") if isinstance(kept, dict) else None)
        except BadInput as error:
            wrong.append(f"{OWN}: {error}")
    there = [file.named for file in files]
    wrong += [
        f"{OWN}: the flight was flown with {shown(one)}, which the report lacks"
        for one in named(meta)
        if one not in there
    ]
    return files, wrong


def named(meta: Data) -> list[Any]:
    """The requirement files with which the flight was flown, as named in the log."""
    said = meta.get(OWN, [])
    return said if isinstance(said, list) else [said]


def shown(one: Any) -> str:
    if isinstance(one, dict) and isinstance(one.get("file"), str):
        return f"{one['file']} (SHA-256 {one.get('sha256')})"
    return "files that it does not name rightly"


def together(files: Sequence[OwnFile], meta: Data, given: Iterable[OwnFile]) -> tuple[OwnFile, ...]:
    """The files with which the flight was flown, and the given ones; BadInput where they clash.

    files: of the report, confirmed; those added only by an earlier `cratous certify --requirements`
    are dropped.
    """
    flown = named(meta)
    kept = [file for file in files if file.named in flown]
    added = [file for file in given if file not in kept]
    refuse_clashes([*kept, *added])
    return (*kept, *added)


def with_own(report: Data, files: Sequence[OwnFile], log: Path, told: Told) -> Data:
    """The same report with these requirement files evaluated on its log, and its verdict recomputed."""
    from cratous.services.requirements.lint import lint

    made = {key: value for key, value in report.items() if key != OWN}
    if files:
        made[OWN] = json.loads(json.dumps(own_section(files, log, told, lint)))
    outcomes = outcomes_of(made)
    return {**made, "verdict": str(worst(outcomes)), "exit_code": exit_code(outcomes)}


def outcomes_of(report: Data) -> list[Outcome]:
    """The outcomes that determine a report's verdict: its requirements, user requirements, and
    broken assumptions.
    """
    from cratous.services.certify.verdicts import without_ground

    rows = [*report["requirements"], *report.get(OWN, {}).get("requirements", ())]
    found = [Outcome(row["verdict"]) for row in rows]
    groundless = without_ground(report["command"], report["assumptions"])
    return [*found, *[Outcome.UNKNOWN] * bool(report["proofs"]["problems"] or groundless)]
