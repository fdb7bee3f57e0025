"""Blame of requirements of users over a log: what of the formula, who was in command, what had broken by then.

The instants are those of the sample that is violated and of the one at which that became known. Who commanded and what
broke first by then, the kernels of `core.authority.blame` decide; both are in the log of a mission alone.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from cratous.services.certify.blame import Commands, told_of
from cratous.services.certify.own_blame import blame_rows_of
from cratous.services.certify.rejudge import watch
from cratous.services.logs.log import read_meta
from cratous.services.requirements.outcome import Outcome
from cratous.services.requirements.specification import Specification
from cratous.services.requirements.traces import doubts
from cratous.services.results.names import LOG_NAME
from cratous.spec.errors import BadInput

Data = dict[str, Any]


def own_blame(outcomes: Iterable[Outcome], spec: Specification, trace: Path | None) -> list[Data]:
    """One row for each requirement that is violated, as plain data. trace: None for a running system.

    why_unknown: where the trace is no whole log of a mission, why nobody's command and no assumption is told.
    """
    bad = [one for one in outcomes if one.violated]
    if not bad:
        return []
    return own_rows(bad, spec, *_told(trace))


def _told(trace: Path | None) -> tuple[Commands, list[Data], str]:
    """Who commanded and which assumptions broke, by all messages of a mission; else nothing of both, and why."""
    if trace is None:
        return {}, [], "a running system is watched"
    log = trace / LOG_NAME if trace.is_dir() else trace
    try:
        meta = read_meta(log)
    except BadInput:  # of another format
        meta = {}
    if not {"mission", "plan"} <= set(meta):
        return {}, [], "the trace is no log of a mission"
    # of who is in command the messages that are missing may have told
    if "selected" in meta or "lost" in doubts(log):
        return {}, [], "the log does not have all messages of the mission"
    try:
        seen = watch(log)
    except BadInput as error:
        return {}, [], f"the mission of the log is not read: {error}"
    return seen.commands, seen.assumptions, ""


def own_rows(
    violated: Iterable[Outcome],
    spec: Specification,
    commands: Commands,
    assumptions: list[Data],
    why: str = "",
) -> list[Data]:
    """The rows; commands, assumptions: of `Monitor`, none where `why` says that they are not told."""
    return blame_rows_of(violated, spec, told_of(commands, assumptions, why))
