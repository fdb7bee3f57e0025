"""Blame: for each constraint not shown to hold, who was in command, and which monitored assumption
broke first.

The kernels of `core.authority.blame` decide which change of command and which broken assumption
apply at an instant.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from cratous.core.authority.blame import broke_first, stood_at
from cratous.services.assumptions.listing import State
from cratous.services.certify.requirement_blame import Told
from cratous.services.certify.verdicts import broken_of
from cratous.spec.mission.guarantees import Outcome

Commands = Mapping[int, Sequence[tuple[int, str]]]
"""For each vehicle with a gate: (time [ms], commander) from time 0 on (`Monitor.commands`)."""
Data = dict[str, Any]


def blame_rows(
    rows: Iterable[Data], commands: Commands, assumptions: list[Data], end_ms: int
) -> list[Data]:
    """One row for each constraint on the flight that is not shown to hold, as plain data.

    rows: of `verdicts.constraint_rows`; assumptions: of `Monitor.assumptions`; end_ms: end of the
    messages [ms], used as the instant where a constraint names none.
    """
    bad = [r for r in rows if r["source"] == "flight" and r["verdict"] != Outcome.HOLDS]
    return [_row(one, commands, assumptions, end_ms) for one in bad]


def _row(row: Data, commands: Commands, assumptions: list[Data], end_ms: int) -> Data:
    at_ms = end_ms if row["time_ms"] is None else row["time_ms"]
    asked = [n for n in sorted(row["vehicles"] or commands) if n in commands]
    unseen = [
        one["name"]
        for one in assumptions
        if one["state"] == State.NOT_OBSERVED and row["requirement"] in one["guarantees"]
    ]
    return {
        "requirement": row["requirement"],
        "item": row["item"],
        "verdict": row["verdict"],
        "time_ms": row["time_ms"],
        "why": row["note"],
        "command": [command_at(number, commands, at_ms) for number in asked],
        "ways_out": list(_ways_out(row, commands)),
        "broken_first": _bearing(row["requirement"], first_broken(assumptions, at_ms)),
        "not_observed": unseen,
    }


def command_at(number: int, commands: Commands, at_ms: int) -> Data:
    """The commander of a vehicle at an instant [ms]; the first commander is taken to command from the start."""
    changes = commands[number]
    place = stood_at(((ms, k) for k, (ms, _) in enumerate(changes)), at_ms).place
    since_ms, side = changes[max(place, 0)]
    return {"vehicle": number, "side": side, "since_ms": since_ms}


def _ways_out(row: Data, commands: Commands) -> Iterator[Data]:
    """For avoidable losses: the instant and manoeuvre of a way out, and who was in command then."""
    for loss in (row.get("evidence") or {}).get("losses", ()):
        if (way := loss.get("way_out")) and loss["own"] in commands:
            there = command_at(loss["own"], commands, way["time_ms"])
            yield {**there, "at_ms": way["time_ms"], "manoeuvre": way["manoeuvre"]}


def first_broken(assumptions: list[Data], at_ms: int) -> Data | None:
    """The assumption that broke first up to at_ms, with the requirements whose theorems rest on it;
    None if none did.
    """
    broken = broken_of(assumptions)
    place = broke_first(((one["since_ms"], k) for k, one in enumerate(broken)), at_ms).place
    if place < 0:
        return None
    return {key: broken[place][key] for key in ("name", "since_ms", "vehicle", "guarantees")}


def told_of(commands: Commands, assumptions: list[Data], why: str = "") -> Told:
    """Command and assumption look-ups of a flight, decided by kernels, for user requirements; why:
    reason if nothing is known.
    """
    unseen = tuple(one["name"] for one in assumptions if one["state"] == State.NOT_OBSERVED)
    return Told(
        tuple(commands),
        lambda number, at_ms: command_at(number, commands, at_ms),
        lambda at_ms: first_broken(assumptions, at_ms),
        unseen,
        why,
    )


def _bearing(requirement: str, first: Data | None) -> Data | None:
    """The assumption's row, and whether a theorem on the requirement rests on it."""
    if first is None:
        return None
    told = {key: value for key, value in first.items() if key != "guarantees"}
    return {**told, "bears": requirement in first["guarantees"]}
