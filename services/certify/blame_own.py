"""Blame for violated user requirements over a log: part of the formula, commander, and broken
assumption.

The instants are those of the violated sample and of the sample at which the violation became known.
The kernels of `core.authority.blame` decide who commanded and what broke first by then; both are
known only from the log of a mission.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from cratous.services.certify.blame import Commands, told_of
from cratous.services.certify.rejudge import watch
from cratous.services.certify.requirement_blame import blame_rows_of
from cratous.services.logs.log import read_meta
from cratous.services.requirements.outcome import Outcome
from cratous.services.requirements.specification import Specification
from cratous.services.requirements.traces import doubts
from cratous.services.results.names import LOG_NAME
from cratous.spec.errors import BadInput

Data = dict[str, Any]


def own_blame(outcomes: Iterable[Outcome], spec: Specification, trace: Path | None) -> list[Data]:
    """One row for each violated requirement, as plain data. trace: None for a running system.

    why_unknown: why commander and assumptions are unknown if the trace is no complete mission log.
    """
    bad = [one for one in outcomes if one.violated]
    if not bad:
        return []
    return own_rows(bad, spec, *_told(trace))


def _told(trace: Path | None) -> tuple[Commands, list[Data], str]:
    """Commanders and assumptions from all messages of a mission; otherwise both empty, with the reason."""
    if trace is None:
        return {}, [], "a running system is watched"
    log = trace / LOG_NAME if trace.is_dir() else trace
    try:
        meta = read_meta(log)
    except BadInput:  # a file of another format
        meta = {}
    if not {"mission", "plan"} <= set(meta):
        return {}, [], "the trace is no log of a mission"
    # the missing messages might have changed who is in command
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
    """The rows; commands, assumptions: of `Monitor`, empty where `why` states why they are unknown."""
    return blame_rows_of(violated, spec, told_of(commands, assumptions, why))
