"""Blame of requirements of users over a log: what of the formula, who was in command, what had broken by then.

The instants are those of the sample that is violated and of the one at which that became known. Who commanded and what
broke first by then, the kernels of `core.authority.blame` decide; both are in the log of a mission alone.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from cratous.services.assumptions.listing import State
from cratous.services.certify.blame import Commands, command_at, first_broken
from cratous.services.certify.rejudge import watch
from cratous.services.logs.log import read_meta
from cratous.services.requirements.formula import signals
from cratous.services.requirements.said import facts
from cratous.services.requirements.specification import NotRead, Requirement, Specification
from cratous.services.requirements.traces import doubts
from cratous.services.requirements.watch import Outcome
from cratous.services.results.names import LOG_NAME
from cratous.spec.errors import BadInput

Data = dict[str, Any]
MS = 10**6


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
    return [_row(one, spec, commands, assumptions, why) for one in violated]


def _row(
    one: Outcome, spec: Specification, commands: Commands, assumptions: list[Data], why: str
) -> Data:
    at_ms, known_ms = one.first_violated // MS, one.decided_at // MS
    instants: Data = {"at": one.first_violated, "known_at": one.decided_at}
    if spec.timed:
        instants = {"at_s": one.first_violated / 1e9, "known_s": one.decided_at / 1e9}
    named = _vehicles(one.requirement, spec)
    asked = [n for n in named or sorted(commands) if n in commands]
    there = [command_at(number, commands, at_ms) for number in asked]
    later = [command_at(number, commands, known_ms) for number in asked]
    return {
        "requirement": one.name,
        "facts": facts(one.blamed, spec),
        **instants,
        "command": there,
        "command_known": [now for now, before in zip(later, there, strict=True) if now != before],
        "no_gate": [] if why else [n for n in named if n not in commands],
        "broken_first": None if why else first_broken(assumptions, known_ms),
        "not_observed": [a["name"] for a in assumptions if a["state"] == State.NOT_OBSERVED],
        "why_unknown": why,
    }


def _vehicles(one: Requirement, spec: Specification) -> list[int]:
    """The vehicles that the messages of its signals are chosen by; none where no signal names one."""
    if isinstance(one.formula, NotRead):
        return []
    chosen = [pair for name in signals(one.formula) for pair in spec.signals[name].chosen]
    found = {value for field, value in chosen if field in ("ID", "VehicleID")}
    return sorted(int(value) for value in found if re.fullmatch("[0-9]{1,9}", value))


def lines(rows: Iterable[Data]) -> Iterator[str]:
    """The rows for people, one line each."""
    for one in rows:
        at = f"{one['at_s']:g} s" if "at_s" in one else f"sample {one['at']}"
        said = [" and ".join(one["facts"])]
        said += [_had(c, "") for c in one["command"]]
        said += [_had(c, " when it was known") for c in one["command_known"]]
        said += [f"vehicle {n} has no gate, which would tell who had it" for n in one["no_gate"]]
        if one["why_unknown"]:
            said.append(f"who was in command is not told: {one['why_unknown']}")
        elif (first := one["broken_first"]) is not None:
            said.append(f"first broken assumption: {first['name']} at {_s(first['since_ms'])}")
        else:
            said.append("no watched assumption had broken by then")
        if one["not_observed"]:
            said.append(f"not observed: {', '.join(one['not_observed'])}")
        yield f"blame, {one['requirement']} at {at}: {'; '.join(said)}"


def _had(command: Data, when: str) -> str:
    side, vehicle = command["side"], command["vehicle"]
    return f"{side} had vehicle {vehicle}{when}, since {_s(command['since_ms'])}"


def _s(time_ms: int) -> str:
    return f"{time_ms / 1000:.2f} s"
