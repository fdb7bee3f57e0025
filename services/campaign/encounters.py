"""Evaluates a flown encounter: the monitor's verdicts with margins, compared with the judge's.

The monitor's verdicts are those of a whole flight, on zones and well clear; only the judge checks
whether the points of the route were passed.
"""

from __future__ import annotations

import hashlib
import struct
from collections import defaultdict
from collections.abc import Iterable
from itertools import chain, pairwise
from math import inf
from typing import Any, NamedTuple

from cratous.services.flight.encounter import Encounter
from cratous.services.monitor.constraints import ConstraintWatch
from cratous.services.monitor.observation import Ending, Presence
from cratous.services.monitor.required_rows import alone_item, fence_item, watched
from cratous.services.monitor.samples import Sample
from cratous.services.monitor.separation import SeparationWatch
from cratous.spec.mission import Mission
from cratous.spec.mission.guarantees import Outcome, Verdict, worst

REQUIREMENTS = ("G1", "G2", "G3")
"""Requirements that apply to an encounter: zones, well clear, and the points of its route."""
States = dict[int, list[list[float]]]


class Judged(NamedTuple):
    """A row of the judge's result."""

    guarantee: str
    item: str
    verdict: str
    note: str


def states_of(flown: Encounter) -> States:
    """Recorded states by aircraft: time [ms]; north, east, altitude [m]; velocity north, east, up [m/s]."""
    found: States = defaultdict(list)
    for now_ms, aircraft in flown.instants:
        for number, air in aircraft:
            v = air.velocity
            state = [now_ms, *air.position, v.north_m_s, v.east_m_s, -v.down_m_s]
            found[number].append(state)
    return dict(found)


def digest_of(states: States) -> str:
    """SHA-256 of all recorded states, with every double bit-exact."""
    found = hashlib.sha256()
    for number, told in sorted(states.items()):
        flat = tuple(chain.from_iterable(told))
        found.update(struct.pack(f"<2q{len(flat)}d", number, len(flat), *flat))
    return found.hexdigest()


def verdicts_of(mission: Mission, flown: Encounter) -> list[Verdict]:
    """The monitor's verdicts on each zone and each pair."""
    presence = Presence(mission.simulation.step_ms)
    fences, pairs = ConstraintWatch(mission, presence), SeparationWatch(mission, presence)
    ours = {v.id for v in mission.vehicles}
    samples = [
        {
            number: Sample(now_ms, air.position, air.heading_rad, number in ours, k)
            for number, air in aircraft
        }
        for k, (now_ms, aircraft) in enumerate(flown.instants)
    ]
    for before, after in pairwise(samples):
        presence.step(before, after)
        fences.step(before, after)
        pairs.step(before, after)
    end_ms = flown.instants[-1].now_ms
    seen, ending = watched(mission, end_ms, set(), set()), Ending(end_ms, True)
    zoned = {
        fence_item(zone, v.id) for zone in mission.zones for v in mission.vehicles if v.protected
    }
    held = [v for v in fences.verdicts(seen, ending) if v.item in zoned]
    return [*held, *pairs.verdicts(seen, ending)]


def result_of(
    mission: Mission,
    flown: Encounter,
    states: States,
    judged: list[Judged],
    proved: bool,
    name: str,
) -> dict[str, Any]:
    """The result of the run as plain data. states: of `flown`; judged: the judge's rows; proved:
    only proved kernels ran; name: digest of the mission.
    """
    verdicts = verdicts_of(mission, flown)
    rows = [*map(_row, verdicts), *(_Row(*j) for j in judged if j.guarantee == "G3")]
    return {
        "kind": "flown",
        "proved": proved,
        "requirements": {name: _requirement(name, rows) for name in REQUIREMENTS},
        "takeovers": flown.takeovers,
        "outcome": flown.outcome,
        "end_ms": flown.instants[-1].now_ms,
        "separation_m": _nearest_m(mission, verdicts),
        "log": digest_of(states),
        "mission_hash": name,
        "drawn": {},
        "judge": _beside(judged, verdicts),
    }


class _Row(NamedTuple):
    """A verdict on one subject, from the monitor or (without a margin) the judge."""

    requirement: str
    item: str
    verdict: str
    note: str
    margin: float | None = None
    unit: str = ""
    time_ms: int | None = None


def _row(v: Verdict) -> _Row:
    return _Row(v.requirement, v.item, str(v.outcome), v.note, v.margin, v.unit, v.time_ms)


def _requirement(name: str, rows: list[_Row]) -> dict[str, Any]:
    """The worst of its rows; of these the one with the least margin."""
    mine = [row for row in rows if row.requirement == name]
    outcome = _worst(row.verdict for row in mine)
    telling = [row for row in mine if row.verdict == outcome]
    nothing = _Row(name, "the mission has nothing of the kind", outcome, "")
    one = min(telling, key=lambda r: inf if r.margin is None else r.margin, default=nothing)
    found = {"verdict": outcome, "margin": one.margin, "unit": one.unit, "time_ms": one.time_ms,
             "item": one.item}  # fmt: skip
    return found if outcome == Outcome.HOLDS else {**found, "note": one.note}


def _worst(verdicts: Iterable[str]) -> str:
    """The worst verdict; `holds` if there is none, for example without zones."""
    return str(worst([Outcome.HOLDS, *map(Outcome, verdicts)]))


def _nearest_m(mission: Mission, verdicts: list[Verdict]) -> float | None:
    """The least distance of any pair."""
    margins = [v.margin for v in verdicts if v.requirement == "G2" and v.margin is not None]
    return min(margins) + mission.daa.well_clear.dthr_m if margins else None


def _beside(judged: list[Judged], verdicts: list[Verdict]) -> dict[str, Any]:
    """The judge's verdicts, and where they differ from the monitor's or the flight's."""
    theirs = {(v.requirement, v.item): str(v.outcome) for v in verdicts}
    mine = {(row.guarantee, row.item): row for row in judged if row.guarantee != "G3"}
    for key in _met_nobody(mine, verdicts):
        del theirs[key]
    apart = [
        {
            "guarantee": key[0], "item": key[1], "note": row.note if row else "no such row",
            "judge": row.verdict if row else "nothing", "monitor": theirs.get(key, "nothing"),
        }
        for key in sorted({*mine, *theirs})
        if (row := mine.get(key)) is None or row.verdict != theirs.get(key, str(Outcome.HOLDS))
    ]  # fmt: skip
    guarantees = {
        name: _worst(r.verdict for r in judged if r.guarantee == name) for name in REQUIREMENTS
    }
    return {
        "verdict": _worst(guarantees.values()),
        "guarantees": guarantees,
        "disagreements": [d for d in apart if not _agree(d["judge"], d["monitor"])],
        "differences": len(apart),
        "rows": len(judged),
    }


def _met_nobody(
    mine: dict[tuple[str, str], Judged], verdicts: list[Verdict]
) -> list[tuple[str, str]]:
    """The monitor's rows that a vehicle met no traffic, where the judge's rows on each pair hold."""
    if any(row.guarantee == "G2" and row.verdict != Outcome.HOLDS for row in mine.values()):
        return []
    return [
        (v.requirement, v.item)
        for v in verdicts
        if v.outcome is Outcome.HOLDS
        and [v.item] == [alone_item(own) for own in v.vehicles]
        and (v.requirement, v.item) not in mine
    ]


EXCUSED = (str(Outcome.VIOLATED), str(Outcome.EXCUSED))
"""Not a disagreement: the judge has no verdict `excused`."""


def _agree(judge: str, monitor: str) -> bool:
    return (judge, monitor) == EXCUSED or str(Outcome.UNKNOWN) in (judge, monitor)
