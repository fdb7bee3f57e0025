"""The assumptions of the system theorems, watched in the messages of a flight.

`listing` says which there are and what rests on each; a watch keeps what was seen of those that can be. An
assumption that is broken violates no requirement by itself: it says for which of them no theorem speaks any more.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from cratous.services.assumptions.authority import CommandWatch, SteeringWatch
from cratous.services.assumptions.link import (
    ChangeWatch,
    ClockWatch,
    DeliveryWatch,
    PeriodWatch,
)
from cratous.services.assumptions.listing import LISTING, Assumption
from cratous.services.assumptions.mission_end import EndWatch, SettledWatch
from cratous.services.assumptions.motion import IntruderWatch, TrackingWatch
from cratous.services.assumptions.observed import (
    Message,
    Observed,
    Record,
    State,
    Watch,
)
from cratous.spec.mission import Mission

__all__ = ["AssumptionWatch", "lines", "sentence"]


class AssumptionWatch:
    """All assumptions of one flight. Feed it messages with `tap`, ask for `rows` at the end."""

    def __init__(self, mission: Mission) -> None:
        self._watches: tuple[Watch, ...] = (
            CommandWatch(mission),
            SteeringWatch(mission),
            ClockWatch(),
            PeriodWatch(mission),
            DeliveryWatch(mission),
            ChangeWatch(mission),
            EndWatch(mission),
            SettledWatch(),
            IntruderWatch(mission),
            TrackingWatch(mission),
        )
        self._records: dict[str, Record] = {}
        for watch in self._watches:
            self._records |= watch.records()
        self._told: set[str] = set()
        self._ended = False

    def tap(self, kind: str, envelope: Any) -> list[dict[str, Any]]:
        """The next message, of this type; returns the rows of the assumptions that it breaks."""
        if self._ended:
            return []
        source = getattr(envelope, "source", "")
        message = Message(kind, envelope.time_ms, source, envelope.body)
        for watch in self._watches:
            watch.message(message)
        if kind == "MissionEnd":
            self._ended = True
            for watch in self._watches:
                watch.end(envelope.time_ms)
        return self._newly_broken(envelope.time_ms)

    def _newly_broken(self, at_ms: int) -> list[dict[str, Any]]:
        broken = {name for name, one in self._records.items() if one.broken is not None}
        fresh = broken - self._told
        self._told |= fresh
        return (
            [row for row in self.rows(at_ms, self._ended) if row["name"] in fresh] if fresh else []
        )

    def rows(self, at_ms: int, over: bool) -> list[dict[str, Any]]:
        """One row for each assumption, as plain data, in the order of the listing.

        at_ms: when the messages end; over: the mission has ended by then.
        """
        return [
            _row(one, self._records[one.name].observed(at_ms, over) if one.watch else None)
            for one in LISTING
        ]


def _row(one: Assumption, seen: Observed | None) -> dict[str, Any]:
    if seen is None:
        seen = Observed(State.NOT_OBSERVED, None, None, None, "", one.why_not, 0, ())
    broken = seen.broken
    return {
        "name": one.name,
        "text": one.text,
        "theorems": list(one.theorems),
        "guarantees": list(one.guarantees),
        "state": str(seen.state),
        "since_ms": broken.since_ms if broken else None,
        "vehicle": (broken.vehicle_id or None) if broken else None,
        "observed": seen.extreme,
        "bound": seen.bound,
        "unit": seen.unit,
        "note": seen.note,
        "lost": one.lost if broken else "",
        "stands": one.stands if broken else "",
        "checks": seen.checks,
        "kernels": list(seen.kernels),
    }


def sentence(row: dict[str, Any]) -> str:
    """A broken assumption in one line, for people."""
    guarantees = " and ".join(row["guarantees"])
    return (
        f"broken at {row['since_ms'] / 1000:.2f} s: {row['text']}: {row['note']}; {guarantees} without ground since: "
        f"{row['lost']}; still holds: {row['stands']}"
    )


def measured(row: dict[str, Any]) -> str:
    """The worst that was seen and the worst that is assumed, with the unit; empty where there is no measure."""
    if row["observed"] is None or row["bound"] is None:
        return ""
    return f"{row['observed']:.4g} of {row['bound']:.4g} {row['unit']}"


def lines(rows: Iterable[dict[str, Any]]) -> Iterator[str]:
    """All assumptions for people: one line each."""
    for row in rows:
        if row["state"] == State.BROKEN:
            yield f"assumption {row['name']}: {sentence(row)}"
            continue
        said = "; ".join(part for part in (measured(row), row["note"]) if part)
        yield f"assumption {row['name']}: {row['state']}{f' ({said})' if said else ''}"
