"""Observations of one assumption: held, broken since an instant, or not observed with the reason."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from sys import float_info
from typing import Any, NamedTuple, Protocol

from cratous.core.authority.timeliness import in_time
from cratous.core.kernel import qualified
from cratous.services.assumptions.listing import State
from cratous.spec.mission import Mission
from cratous.spec.mission.changes import VEHICLE_LOST

ANY_LATER = 2**60
"""As a bound of `in_time`: no upper limit [ms], so it only tests the order of two times."""
EVERY: tuple[str, ...] = ()
"""As `Watch.kinds`: messages of every type."""


class Break(NamedTuple):
    """First break of an assumption: time [ms after mission start], vehicle (0: none), and description."""

    since_ms: int
    vehicle_id: int
    text: str


class Observed(NamedTuple):
    """extreme: worst observed value, and bound: worst assumed value, in `unit`; None without a
    measure; checks: number of observations; note: why it is not observed, or how it broke.
    """

    state: State
    broken: Break | None
    extreme: float | None
    bound: float | None
    unit: str
    note: str
    checks: int
    kernels: tuple[str, ...]


@dataclass
class Record:
    """The record of a watch. unseen: why nothing can be observed, empty otherwise; extreme: worst value so far."""

    unit: str = ""
    bound: float | None = None
    kernels: Iterable[Any] = ()
    unseen: str = ""
    extreme: float | None = None
    checks: int = 0
    broken: Break | None = None
    waits: str = "nothing that rests on it has happened"
    gaps: list[str] = field(default_factory=list)
    fresh: list[Record] = field(default_factory=list, repr=False, compare=False)
    """List to which the record appends itself when it breaks."""

    def see(self, value: float | None) -> None:
        """Count one observation and its measured value, if any."""
        self.checks += 1
        if value is not None:
            # NaN counts as the largest deviation
            value = float_info.max if value != value else value
            most = value if self.extreme is None else max(self.extreme, value)
            self.extreme = min(most, float_info.max)

    def see_again(self, value: float, times: int) -> None:
        """Count `times` further observations whose value does not exceed the extreme, unless it is the first."""
        if self.extreme is None:
            self.see(value)
            times -= 1
        self.checks += times

    def check(self, holds: bool, since_ms: int, vehicle_id: int, text: str) -> None:
        """Record the answer of a kernel; the first negative one is kept."""
        if not holds and self.broken is None:
            self.broken = Break(since_ms, vehicle_id, text)
            self.fresh.append(self)

    def unseen_between(self, who: str, last_ms: int, now_ms: int, step_ms: int) -> None:
        """Note a gap of more than one step [ms] between two samples of an aircraft; only the first is kept."""
        if not self.gaps and not in_time(last_ms, now_ms, step_ms):
            self.gaps.append(
                f"{who} was not seen from {last_ms / 1000:.2f} s to {now_ms / 1000:.2f} s"
            )

    def observed(self, at_ms: int, over: bool) -> Observed:
        """The result. at_ms: end of the messages [ms]; over: the mission has ended by then."""
        names = tuple(sorted(map(qualified, self.kernels))) if self.checks else ()
        measures = (self.extreme, self.bound if self.checks else None, self.unit)
        if self.broken is not None:
            return Observed(
                State.BROKEN, self.broken, *measures, self.broken.text, self.checks, names
            )
        why = self.unseen or ("" if self.checks else self.waits)
        if not why and not over:
            why = f"the messages stop at {at_ms / 1000:.2f} s, before the mission ends"
        why = why or "; ".join(self.gaps)
        state = State.NOT_OBSERVED if why else State.HELD
        return Observed(state, None, *measures, why, self.checks, names)


def gone_ms(mission: Mission) -> dict[int, int]:
    """Time at which each aircraft that is lost or vanishes disappears [ms]; the others are omitted."""
    lost = {c.vehicle: c.at_ms for c in mission.changes if c.kind == VEHICLE_LOST}
    vanish = {t.id: t.vanishes_ms for t in mission.traffic if t.vanishes_ms is not None}
    return {**lost, **vanish}


class Message(NamedTuple):
    """A message as a watch receives it. kind: its type without the series; source: sender, empty if
    unknown; body: object with the fields of its type.
    """

    kind: str
    time_ms: int
    source: str
    body: Any


class Watch(Protocol):
    """Watches one assumption, or several observed in the same messages. kinds: their types, or EVERY."""

    @property
    def kinds(self) -> tuple[str, ...]:
        """The message types that the watch needs; others have no effect on it."""

    def message(self, message: Message) -> None:
        """Process the next message of the log."""

    def end(self, at_ms: int) -> None:
        """The messages end at at_ms [ms]."""

    def records(self) -> dict[str, Record]:
        """The observations so far, by name of the assumption."""
