"""Spans over which each aircraft was observed without a gap: nothing is claimed about the rest."""

from __future__ import annotations

from typing import NamedTuple

from cratous.core.authority.timeliness import in_time
from cratous.services.monitor.samples import Sample
from cratous.spec.mission import Traffic

Span = tuple[int, int]


class Ending(NamedTuple):
    """Time of the last message [ms], and whether the mission had ended by then."""

    at_ms: int
    over: bool


class Presence:
    """Spans over which each aircraft was sampled with no gap longer than the simulation step."""

    def __init__(self, step_ms: int) -> None:
        self.step_ms = step_ms
        self._spans: dict[int, list[Span]] = {}

    def step(self, before: dict[int, Sample], after: dict[int, Sample]) -> None:
        """Process two successive samples: aircraft in both were observed in between."""
        for number in before.keys() & after.keys():
            begin, end = before[number].time_ms, after[number].time_ms
            if not in_time(begin, end, self.step_ms):
                continue
            spans = self._spans.setdefault(number, [])
            if spans and spans[-1][1] == begin:
                spans[-1] = (spans[-1][0], end)
            else:
                spans.append((begin, end))

    def unseen(self, number: int, wanted: Span, ending: Ending) -> str:
        """Observation gaps of the aircraft between two instants, in words; empty if none."""
        here, until = wanted
        for begin, end in self._spans.get(number, ()):
            if begin > here:
                break
            here = max(here, end)
        if here < until:
            back = min((b for b, _ in self._spans.get(number, ()) if b > here), default=until)
            return f"aircraft {number} was not observed from {_s(here)} to {_s(min(back, until))}"
        if not ending.over:
            return f"the messages stop at {_s(ending.at_ms)}, before the mission ends"
        return ""


def in_the_air(traffic: Traffic, step_ms: int, end_ms: int) -> Span | None:
    """First and last instant at which a traffic aircraft is present; None if it never is."""
    first = -(-max(traffic.appears_ms, 0) // step_ms) * step_ms
    last = end_ms if traffic.vanishes_ms is None else min(traffic.vanishes_ms, end_ms)
    last = last // step_ms * step_ms
    return (first, last) if first <= last else None


def _s(time_ms: int) -> str:
    return f"{time_ms / 1000:.2f} s"
