"""Watches all assumptions in the messages of one flight."""

from __future__ import annotations

from typing import Any

from cratous.services.assumptions.ahead import AheadWatch
from cratous.services.assumptions.authority import CommandWatch, SteeringWatch
from cratous.services.assumptions.link import (
    ChangeWatch,
    ClockWatch,
    DeliveryWatch,
    PeriodWatch,
)
from cratous.services.assumptions.listing import LISTING, Assumption
from cratous.services.assumptions.mission_end import AwayWatch, EndWatch, SettledWatch
from cratous.services.assumptions.motion import IntruderWatch, Positions, TrackingWatch
from cratous.services.assumptions.observations import (
    Message,
    Observed,
    Record,
    Watch,
)
from cratous.services.assumptions.path_deviation import NearLegsWatch
from cratous.services.assumptions.permitted import PermittedWatch
from cratous.services.assumptions.sensed import SensedWatch
from cratous.services.assumptions.service_assumptions import ServedWatch
from cratous.services.assumptions.takeover_ends import HeardWatch, WayBackWatch
from cratous.services.assumptions.takeover_limit import GivenUpWatch
from cratous.spec.mission import Mission


class AssumptionWatch:
    """All assumptions of one flight. Feed it messages with `tap`, ask for `rows` at the end.

    on_board: each ICAROUS reports what it hears, as in `cratous run` in one process.
    """

    def __init__(self, mission: Mission, on_board: bool = True) -> None:
        positions = Positions()
        ahead, intruder, tracking = (
            AheadWatch(mission, positions),
            IntruderWatch(mission, positions),
            TrackingWatch(mission, positions),
        )
        sensed = SensedWatch(mission)
        others = (ahead, intruder, tracking, sensed)
        self._watches: tuple[Watch, ...] = (
            CommandWatch(mission),
            SteeringWatch(mission),
            ClockWatch(),
            PeriodWatch(mission),
            DeliveryWatch(mission),
            ChangeWatch(mission),
            EndWatch(mission),
            AwayWatch(mission),
            SettledWatch(),
            GivenUpWatch(mission),
            ServedWatch(mission),
            HeardWatch(mission, on_board),
            WayBackWatch(mission, on_board),
            *others,
            NearLegsWatch(mission),
            PermittedWatch(mission, others),
        )
        self._records: dict[str, Record] = {}
        for watch in self._watches:
            self._records |= watch.records()
        self._fresh: list[Record] = []
        for one in self._records.values():
            one.fresh = self._fresh
        self._by_kind: dict[str, tuple[Watch, ...]] = {}
        self._ended = False

    def tap(self, kind: str, envelope: Any) -> list[dict[str, Any]]:
        """Process the next message, of type kind; returns the rows of the assumptions that it breaks."""
        if self._ended:
            return []
        source = getattr(envelope, "source", "")
        # as Message(...), in a third of the time
        message = tuple.__new__(Message, (kind, envelope.time_ms, source, envelope.body))
        watches = self._by_kind.get(kind)
        if watches is None:
            asked = (w for w in self._watches if not w.kinds or kind in w.kinds)
            watches = self._by_kind[kind] = tuple(asked)
        for watch in watches:
            watch.message(message)
        if kind == "MissionEnd":
            self._ended = True
            for watch in self._watches:
                watch.end(envelope.time_ms)
        return self._newly_broken(envelope.time_ms) if self._fresh else []

    def _newly_broken(self, at_ms: int) -> list[dict[str, Any]]:
        fresh = {name for name, one in self._records.items() for new in self._fresh if one is new}
        self._fresh.clear()
        return [row for row in self.rows(at_ms, self._ended) if row["name"] in fresh]

    def rows(self, at_ms: int, over: bool) -> list[dict[str, Any]]:
        """One row for each assumption, as plain data, in the order of the listing.

        at_ms: end of the messages [ms]; over: the mission has ended by then.
        """
        return [_row(one, self._records[one.name].observed(at_ms, over)) for one in LISTING]


def _row(one: Assumption, seen: Observed) -> dict[str, Any]:
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
