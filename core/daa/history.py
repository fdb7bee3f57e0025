"""History from instant to instant (hysteresis), so that alerts do not flicker.

M of N: a level is shown if at least M of the last N raw levels reach it; the history begins with M copies of the
first. Persistence: a level that was raised stays for a time. The early alerting time holds a level that is shown.
History is reset after a gap, or if time does not advance.
"""

from __future__ import annotations

import itertools
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field

from cratous.core.daa.state import Band
from cratous.core.kernel import driver, kernel
from cratous.spec.daa.parameters import NONE, RECOVERY


@kernel(
    implements="daa.meaning.reached",
    restates="M of N: how many of the last N values count",
)
def count_reached(before: int, value: int, level: int) -> int:
    """The number of values that reach a level, with one more value."""
    if value >= level:
        return before + 1
    return before


@kernel(
    implements="daa.meaning.enough",
    restates="M of N: the number that raises an alert",
)
def enough(count: int, m: int) -> bool:
    """True iff the count is at least m."""
    return count >= m


@kernel(implements="daa.meaning.may_drop")
def may_drop(now_s: float, raised_s: float, persistence_s: float) -> bool:
    """True iff a level raised at raised_s may be lowered at now_s."""
    return now_s - raised_s >= persistence_s


@kernel(implements="daa.meaning.goes_on")
def goes_on(now_s: float, before_s: float, gap_s: float) -> bool:
    """True iff history is valid: time has advanced, by at most gap_s (> 0: there is hysteresis)."""
    return now_s > before_s and now_s - before_s <= gap_s


@driver(checked_by=("count_reached", "enough"))
def m_of_n(values: deque[int], m: int) -> int:
    """The highest value that at least m of them reach; 0 if none."""
    for level in sorted(set(values), reverse=True):
        count = 0
        for value in values:
            count = count_reached(count, value, level)
        if enough(count, m):
            return level
    return 0


@dataclass
class Shown:
    """History of one value: the last N, what is shown, and when it was raised."""

    m: int
    n: int
    values: deque[int] = field(default_factory=deque)
    level: int = 0
    raised_s: float = float("-inf")

    def filtered(self, raw: int) -> int:
        """The raw value filtered by M of N."""
        if self.m <= 0 or self.n < self.m:
            return raw
        if not self.values:
            self.values.extend([raw] * self.m)
        else:
            self.values.append(raw)
        while len(self.values) > self.n:
            self.values.popleft()
        return m_of_n(self.values, self.m)

    def update(self, raw: int, now_s: float, persistence_s: float) -> int:
        """The level to show now."""
        level = self.filtered(raw)
        if level > self.level or (
            level < self.level and may_drop(now_s, self.raised_s, persistence_s)
        ):
            self.level, self.raised_s = level, now_s
        return self.level


SLIVER = 1e-4
"""Bands narrower than this (rad, m/s, m) come from rounding of the own value; they are dropped."""
EDGE = 1e-7
"""A value this near to an edge counts as on it."""


def laid_over(bands: Sequence[Band], over: Sequence[Band]) -> tuple[Band, ...]:
    """The bands overlaid with others where these are more severe; RECOVERY counts as the most severe."""
    edges = sorted({x for b in (*bands, *over) for x in (b.low, b.high)})
    found: list[Band] = []
    for low, high in itertools.pairwise(edges):
        middle = (low + high) / 2
        region = next((b.region for b in bands if b.low <= middle < b.high), NONE)
        region = max([region, *(b.region for b in over if b.low <= middle < b.high)])
        if found and found[-1].region == region:
            found[-1] = found[-1]._replace(high=high)
        elif high - low > SLIVER:
            found.append(Band(low, high, region))
    return tuple(found)


def resolved(bands: Sequence[Band], recovering: bool) -> tuple[Band, ...]:
    """The bands with conflict-free values as RECOVERY while recovery is needed, and as NONE otherwise."""
    found: list[Band] = []
    for band in bands:
        region = band.region
        if region in (NONE, RECOVERY):
            region = RECOVERY if recovering else NONE
        if found and found[-1].region == region:
            found[-1] = found[-1]._replace(high=band.high)
        else:
            found.append(band._replace(region=region))
    return tuple(found)


@dataclass
class BandMemory:
    """The last bands of one dimension; a value's region is filtered by M of N.

    turn: the size of the circle for directions, else 0. held: the conflict band, or its two parts around 0, in which
    the own value was shown; held_s: since when.
    """

    m: int
    n: int
    persistence_s: float = 0.0
    turn: float = 0.0
    last: deque[tuple[Band, ...]] = field(default_factory=deque)
    held: tuple[Band, ...] = ()
    held_s: float = float("-inf")

    def filtered(self, bands: tuple[Band, ...]) -> tuple[Band, ...]:
        """The bands by M of N; RECOVERY counts as the most severe region. The history begins with M
        copies of the first."""
        if self.m <= 0 or self.n < self.m:
            return bands
        if not self.last:
            self.last.extend([()] * (self.n - self.m))
            self.last.extendleft([bands] * self.m)
        self.last.append(bands)
        self.last.popleft()
        edges = sorted({x for old in self.last for band in old for x in (band.low, band.high)})
        found: list[Band] = []
        low = edges[0]
        for high in edges[1:]:
            if high - low <= SLIVER:
                if found and high == edges[-1]:
                    found[-1] = found[-1]._replace(high=high)
                continue
            middle = (low + high) / 2
            regions = deque(
                band.region for old in self.last for band in old if band.low <= middle < band.high
            )
            region = m_of_n(regions, self.m)
            if found and found[-1].region == region:
                found[-1] = found[-1]._replace(high=high)
            else:
                found.append(Band(low, high, region))
            low = high
        return tuple(found)

    def at(self, bands: Sequence[Band], own: float) -> Band | None:
        """The band of the own value; on an edge the conflict-free one, or else the milder one."""
        near = [
            b
            for b in bands
            if b.low - EDGE <= own <= b.high + EDGE
            or (self.turn and min(abs(own - x) for x in (b.low, b.high)) >= self.turn - EDGE)
        ]
        return min(near, key=lambda b: b.region % RECOVERY, default=None)

    def shown(
        self, bands: tuple[Band, ...], recovering: bool, own: float, now_s: float
    ) -> tuple[Band, ...]:
        """The bands to show: filtered by M of N, and with the conflict band of the own value held for the persistence
        time since it was entered, if it would become milder sooner.
        """
        bands = self.filtered(bands)
        if self.persistence_s <= 0:
            return resolved(bands, recovering)
        now = self.at(bands, own)
        if not self.held:
            self.held_s = now_s
        elif now is not None:
            region = self.held[0].region
            if now.region < region and not may_drop(now_s, self.held_s, self.persistence_s):
                bands = laid_over(bands, self.held)
            elif region < now.region < RECOVERY:
                self.held_s = now_s
        bands = resolved(bands, recovering)
        now = self.at(bands, own)
        self.held = ()
        if now is not None and NONE < now.region < RECOVERY:
            self.held = (now,)
            ends = (bands[0], bands[-1])
            if self.turn and now in ends and ends[0].region == ends[1].region:
                self.held = tuple(dict.fromkeys(ends))
        return bands
