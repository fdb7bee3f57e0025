"""What is remembered from instant to instant, so that alerts do not flicker.

M of N: a level is shown if at least M of the last N raw levels reach it; the history begins with M
copies of the first. Persistence: a level that was raised stays for a while. The early alerting
time holds a level that is shown. History is forgotten after a gap, or if time does not go on.
"""

from __future__ import annotations

import itertools
from collections import deque
from dataclasses import dataclass, field

from cratous.core.daa_state import Band
from cratous.core.kernel import driver, kernel
from cratous.spec.daa import NONE, RECOVERY


@kernel(implements="daa_meaning.reached")
def count_reached(before: int, value: int, level: int) -> int:
    """How many values reach a level: one more if this one does."""
    if value >= level:
        return before + 1
    return before


@kernel(implements="daa_meaning.enough")
def enough(count: int, m: int) -> bool:
    """True iff at least m did."""
    return count >= m


@kernel(implements="daa_meaning.may_drop")
def may_drop(now_s: float, raised_s: float, persistence_s: float) -> bool:
    """True iff a level raised at raised_s may be lowered at now_s."""
    return now_s - raised_s >= persistence_s


@kernel(implements="daa_meaning.goes_on")
def goes_on(now_s: float, before_s: float, gap_s: float) -> bool:
    """True iff history counts: time has gone on, by at most gap_s (> 0: there is hysteresis)."""
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
        """The value by M of N."""
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


@dataclass
class BandMemory:
    """The last bands of one dimension; a value's region is shown by M of N of its regions."""

    m: int
    n: int
    persistence_s: float = 0.0
    last: deque[tuple[Band, ...]] = field(default_factory=deque)
    held: Band | None = None
    held_s: float = float("-inf")

    def filtered(self, bands: tuple[Band, ...], recovering: bool) -> tuple[Band, ...]:
        """The bands to show. RECOVERY counts as the most severe region, and is shown only while
        recovery is needed; then no value is shown as NONE."""
        if self.m <= 0 or self.n < self.m:
            return bands
        self.last.append(bands)
        while len(self.last) > self.n:
            self.last.popleft()
        if len(self.last) < self.m:
            return bands
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
            if region == NONE and recovering:
                region = RECOVERY
            elif region == RECOVERY and not recovering:
                region = NONE
            if found and found[-1].region == region:
                found[-1] = found[-1]._replace(high=high)
            else:
                found.append(Band(low, high, region))
            low = high
        return tuple(found)

    def persistent(self, bands: tuple[Band, ...], own: float, now_s: float) -> tuple[Band, ...]:
        """The bands with the conflict band of the own value held for the persistence time.

        Where the own value would become free (NONE) sooner than this after it came into
        conflict, the last band that it was in is laid over milder ones.
        """
        if self.persistence_s <= 0:
            return bands
        now = next((b for b in bands if b.low <= own < b.high), None)
        if now is not None and NONE < now.region < RECOVERY:
            if self.held is None:
                self.held_s = now_s
            self.held = now
            return bands
        held = self.held
        if (
            now is None
            or now.region == RECOVERY
            or held is None
            or may_drop(now_s, self.held_s, self.persistence_s)
        ):
            self.held = None
            return bands
        edges = sorted({x for b in (*bands, held) for x in (b.low, b.high)})
        found: list[Band] = []
        for low, high in itertools.pairwise(edges):
            middle = (low + high) / 2
            region = next((b.region for b in bands if b.low <= middle < b.high), NONE)
            if held.low <= middle < held.high and (region == RECOVERY or region < held.region):
                region = held.region
            if found and found[-1].region == region:
                found[-1] = found[-1]._replace(high=high)
            elif high - low > SLIVER:
                found.append(Band(low, high, region))
        return tuple(found)
