"""Blame rows of user requirements: part of the formula, commander, and the assumption broken by
then.

`Told` answers who commanded and what broke first: by proved kernels where a flight is judged
(`blame.told_of`), in plain Python where a report is verified, in a process without the flight's
kernels.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

from cratous.services.requirements.arithmetic import sources
from cratous.services.requirements.formula import signals
from cratous.services.requirements.formula_text import facts
from cratous.services.requirements.outcome import Outcome
from cratous.services.requirements.specification import NotRead, Requirement, Specification

Data = dict[str, Any]
MS = 10**6


class Told(NamedTuple):
    """gates: vehicles with a gate; command: the commander of a vehicle at an instant [ms]; first:
    the assumption that broke first up to an instant [ms]; unseen: assumptions that were not
    observed; why: reason if none of this is known.
    """

    gates: tuple[int, ...]
    command: Callable[[int, int], Data]
    first: Callable[[int], Data | None]
    unseen: tuple[str, ...]
    why: str = ""


def blame_rows_of(violated: Iterable[Outcome], spec: Specification, told: Told) -> list[Data]:
    """One row for each of these requirements, as plain data."""
    return [_row(one, spec, told) for one in violated]


def _row(one: Outcome, spec: Specification, told: Told) -> Data:
    at_ms, known_ms = one.first_violated // MS, one.decided_at // MS
    instants: Data = {"at": one.first_violated, "known_at": one.decided_at}
    if spec.timed:
        instants = {"at_s": one.first_violated / 1e9, "known_s": one.decided_at / 1e9}
    named = _vehicles(one.requirement, spec)
    asked = [n for n in named or sorted(told.gates) if n in told.gates]
    there = [told.command(number, at_ms) for number in asked]
    later = [told.command(number, known_ms) for number in asked]
    return {
        "requirement": one.name,
        "facts": facts(one.blamed, spec),
        **instants,
        "command": there,
        "command_known": [now for now, before in zip(later, there, strict=True) if now != before],
        "no_gate": [] if told.why else [n for n in named if n not in told.gates],
        "broken_first": None if told.why else told.first(known_ms),
        "not_observed": list(told.unseen),
        "why_unknown": told.why,
    }


def _vehicles(one: Requirement, spec: Specification) -> list[int]:
    """The vehicles that the requirement's signals select messages by; empty if no signal names one."""
    if isinstance(one.formula, NotRead):
        return []
    read = sources(signals(one.formula), spec.signals)
    chosen = [pair for name in read for pair in spec.signals[name].chosen]
    found = {value for field, value in chosen if field in ("ID", "VehicleID")}
    return sorted(int(value) for value in found if re.fullmatch("[0-9]{1,9}", value))
