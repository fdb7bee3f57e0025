"""Converts incoming values to samples: held values, and missing, late or out-of-order samples.

A value that is not known at a sample is unknown there and reported: a value that is no number, one
older than its signal's hold time, a sample that is not later than the previous one, and a gap
between samples, into which an unknown sample is inserted.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import isfinite

from cratous.services.logs.source import DOUBTS, NO_END
from cratous.services.requirements.specification import Signal, Specification

Sample = dict[str, float | None]
Row = tuple[int, Mapping[str, float | None]]
"""Time [ns], and the values by signal that arrived then; None: a message without a value."""
SAYS = {
    "gap": "samples are further apart than the trace says",
    "order": "a sample is not later than the one before, and was left out",
    "before": "samples before every signal had come are not judged",
    "missing": "a sample has no value",
    "stale": "the newest value is older than it is held",
    "never": "no value ever came",
    **DOUBTS,
    "cut": "the connection was lost, and messages with it",
    "silent": "nothing came any more before the watch ended",
    "refused": "bytes came that are no message",
    "left out": "bytes came too fast to be looked at",
    "faster": "a signal changes faster than its rate, so nothing is known of it between samples",
    "unsealed": "lines came that no key here authenticates: whoever reaches the bridge may have said them",
}
SECOND = 10**9
UNAUTHENTICATED = "not authenticated"
"""Suffix of the source of a message that any peer of the bridge could have sent, as logged by a tap."""
NOT_WHOLE = ("gap", "order", *DOUBTS, "cut", "silent", "refused", "left out", "faster")
"""Kinds of findings after which nothing holds, since the trace is incomplete."""


@dataclass
class Finding:
    """A fault of the samples. kind: a key of `SAYS`; signal: "" for all; first_ns: -1 for never."""

    kind: str
    signal: str
    first_ns: int
    count: int = 1

    @property
    def text(self) -> str:
        """The finding in words."""
        where = f" first at {self.first_ns / 1e9:g} s" if self.first_ns >= 0 else ""
        times = f", {self.count} times," if self.count > 1 else ("," if where else "")
        return f"{self.signal or 'trace'}: {SAYS[self.kind]}{times}{where}"


class Sampling:
    """Makes the samples of a trace; `findings` grows in the process."""

    def __init__(self, spec: Specification, names: Iterable[str]) -> None:
        self.gap_ns = spec.gap_ns
        self.signals: dict[str, Signal] = {name: spec.signals[name] for name in sorted(names)}
        self.held: dict[str, tuple[int, float | None]] = {}
        self._known: dict[str, tuple[int, float]] = {}
        """For each signal with a rate the last value that is a number."""
        self.seen: set[str] = set()
        self.last = -1
        self.has_begun, self._before = not spec.begins_with_all, -1
        self._found: dict[tuple[str, str], Finding] = {}
        self.unauthenticated: set[str] = set()
        """Signals with a value from an unauthenticated source."""

    @property
    def findings(self) -> list[Finding]:
        """All findings so far, including signals without any value."""
        never = [Finding("never", name, -1, 1) for name in self.signals if name not in self.seen]
        gone = {one.signal for one in never}
        found = list(self._found.values())  # samples may arrive in another thread
        return [f for f in found if f.signal not in gone] + never

    @property
    def is_whole(self) -> bool:
        """Whether no sample was omitted or late, and no message of the trace is known to be missing."""
        return not any(kind in NOT_WHOLE for kind, _ in self._found)

    @property
    def lacks(self) -> str:
        """Why nothing holds, apart from a missing end, in words; empty if there is no such reason."""
        kinds = {kind for kind, _ in self._found}.intersection(NOT_WHOLE) - NO_END
        said = ["samples or messages are missing"] if kinds - {"faster"} else []
        if "faster" in kinds:
            said.append("a signal changes faster than its rate")
        return " and ".join(said)

    @property
    def stops(self) -> str:
        """How a log without a mission end ends, in words."""
        is_cut = ("cut off", "") in self._found
        return "the flight was cut off" if is_cut else "the log has no end of its mission"

    def samples(self, rows: Iterable[Row]) -> Iterator[tuple[int, Sample]]:
        """The samples of the rows, with increasing times."""
        for time, row in rows:
            if time <= max(self.last, self._before):
                self.find("order", "", time)
                continue
            if not self.has_begun:
                for name in row.keys() & self.signals.keys():
                    self._value(name, time, row)
                if len(self.seen) < len(self.signals):
                    self.find("before", "", time)
                    self._before = time
                    continue
                self.has_begun = True
            if self.is_late(time):
                self.find("gap", "", self.last)
                # unknown from the time at which the next sample was due
                yield self.last + self.gap_ns, dict.fromkeys(self.signals)
            self.last = time
            yield time, {name: self._value(name, time, row) for name in self.signals}

    def is_late(self, time: int) -> bool:
        """Whether a time [ns] is further from the last sample than the trace's maximum gap."""
        return self.gap_ns > 0 and self.last >= 0 and time - self.last > self.gap_ns

    def _value(self, name: str, time: int, row: Mapping[str, float | None]) -> float | None:
        if name in row:
            value = row[name]
            known = value if value is not None and isfinite(value) else None
            self._faster(name, time, known)
            # an invalid value replaces the held one
            self.held[name] = time, known
            if known is None:
                self.find("missing", name, time)
            else:
                self.seen.add(name)
            return known
        since, last = self.held.get(name, (time, None))
        if last is None or time - since > self.signals[name].hold_ns:
            is_stale = last is not None and self.signals[name].hold_ns > 0
            self.find("stale" if is_stale else "missing", name, time)
            return None
        return last

    def _faster(self, name: str, time: int, known: float | None) -> None:
        """Report a signal that has changed faster than its rate since its last value."""
        rate = self.signals[name].rate
        if not rate or known is None:
            return
        since, last = self._known.get(name, (time, known))
        self._known[name] = time, known
        if abs(Fraction(known) - Fraction(last)) * SECOND > rate * (time - since):
            self.find("faster", name, time)

    def told_by(self, source: str, names: Iterable[str], time: int) -> None:
        """Record the source of values of these signals at a time [ns]."""
        if source.endswith(UNAUTHENTICATED):
            self.unauthenticated.update(names)
            if ("unsealed", "") not in self._found:
                self.find("unsealed", "", time)

    def find(self, kind: str, signal: str = "", time: int = -1) -> None:
        """Record a fault, at a time [ns] if it has one."""
        found = self._found.get((kind, signal))
        if found is None:
            self._found[kind, signal] = Finding(kind, signal, time)
        else:
            found.count += 1
