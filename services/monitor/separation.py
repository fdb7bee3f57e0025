"""G2: well clear between every protected vehicle and every other aircraft, at every instant.

A loss is a violation unless `core.excuse.watch` finds that no avoiding manoeuvre existed; then it
is excused, with the refused manoeuvres as evidence.

Each pair and step is one question to the kernel `violation_within`: is well clear lost at any
instant of the step if both fly straight? Positions are taken as the exact rationals that the
doubles represent, so the answer is exact between the samples too. Lengths and times are scaled so
that all are integers: the answer is the same and is computed much faster.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from cratous.core.excuse.record import Scene
from cratous.core.excuse.watch import LossWatch, pair_excused
from cratous.core.excuse.way_out import is_excused, way_out
from cratous.core.kernel import Vec2, qualified
from cratous.core.well_clear import StandardThresholds, violation_within
from cratous.services.monitor.excuses import evidence, sentence
from cratous.services.monitor.observation import Ending, Presence
from cratous.services.monitor.required_rows import Watched, alone_item, pair_item, pairs_of
from cratous.services.monitor.samples import Sample
from cratous.spec.mission import Mission
from cratous.spec.mission.guarantees import Kind, Outcome, Verdict


@dataclass
class Pair:
    """Observations of one pair of aircraft."""

    checks: int = 0
    lost_ms: int | None = None
    lost_steps: int = 0
    nearest_m: float = math.inf
    nearest_ms: int = 0
    miss_m: float = math.inf
    """Least predicted miss distance over the steps in which well clear was lost: modified tau can
    signal a loss while the aircraft are still far apart.
    """
    level: bool = False
    measured: Sample | None = None
    """The ownship's sample at the end of the last step that was measured."""


def _relative(own: Sample, other: Sample) -> tuple[Fraction, Fraction, Fraction]:
    a, b = own.position, other.position
    return (
        Fraction(a.north_m) - Fraction(b.north_m),
        Fraction(a.east_m) - Fraction(b.east_m),
        Fraction(a.alt_m) - Fraction(b.alt_m),
    )


class WholeUnits:
    """Scales questions to `violation_within` to integers, for arbitrary thresholds [m, s].

    The kernel's answer does not depend on the units of length and time. Times are in fractions of a
    millisecond, lengths in fractions of a metre times the span, so that velocities are integers
    too.
    """

    def __init__(self, thresholds: StandardThresholds) -> None:
        dthr, zthr, tthr, tcoa = (Fraction(x) for x in thresholds)
        self._lengths = dthr, zthr
        self._part = math.lcm(dthr.denominator, zthr.denominator)
        times = tthr * 1000, tcoa * 1000
        self._parts_of_ms = math.lcm(*(x.denominator for x in times))
        self._times = [int(x * self._parts_of_ms) for x in times]
        self._newest: dict[int, tuple[Sample, list[tuple[int, int]]]] = {}

    def ratios(self, number: int, sample: Sample) -> list[tuple[int, int]]:
        """Numerators and denominators of a position; the newest is cached, since one step begins
        where the last ended.
        """
        kept = self._newest.get(number)
        if kept is not None and kept[0] is sample:
            return kept[1]
        found = [x.as_integer_ratio() for x in sample.position[:3]]
        self._newest[number] = sample, found
        return found

    def step(self, before: dict[int, Sample], after: dict[int, Sample]) -> WholeStep:
        """The step of all aircraft sampled at both ends of it."""
        return WholeStep(self, before, after)

    def thresholds(self, unit: int, span: int) -> StandardThresholds:
        """The thresholds as integers. unit: length units per metre; span: duration of the step in time units."""
        dthr, zthr = (int(x * unit) * span for x in self._lengths)
        return StandardThresholds(dthr, zthr, *self._times)

    @property
    def part(self) -> int:
        """Length units per metre for which the thresholds are integers."""
        return self._part

    @property
    def parts_of_ms(self) -> int:
        """Time units per millisecond for which the thresholds are integers."""
        return self._parts_of_ms


class WholeStep:
    """One step of many aircraft in integers; each position is converted once."""

    def __init__(
        self, units: WholeUnits, before: dict[int, Sample], after: dict[int, Sample]
    ) -> None:
        self._before, self._after = before, after
        seen = before.keys() & after.keys()
        ratios = {i: units.ratios(i, before[i]) + units.ratios(i, after[i]) for i in seen}
        parts = {below for found in ratios.values() for _, below in found}
        unit = math.lcm(units.part, *parts)
        self._at = {i: [n * (unit // below) for n, below in r] for i, r in ratios.items()}
        self._units, self._unit = units, unit
        self._by_span: dict[int, StandardThresholds] = {}
        self._of_own: dict[int, tuple[int, StandardThresholds]] = {}

    def lost(self, own: int, other: int) -> bool:
        """Whether two aircraft lose well clear during the step."""
        asked = self._of_own.get(own)
        span, thresholds = asked if asked is not None else self._asked(own)
        a0, a1, a2, a3, a4, a5 = self._at[own]
        b0, b1, b2, b3, b4, b5 = self._at[other]
        x, y, z = a0 - b0, a1 - b1, a2 - b2
        # as Vec2(x, y), in half the time
        s: Any = tuple.__new__(Vec2, (x * span, y * span))
        v = tuple.__new__(Vec2, (a3 - b3 - x, a4 - b4 - y))
        return bool(violation_within(s, v, z * span, a5 - b5 - z, thresholds, span))

    def _asked(self, own: int) -> tuple[int, StandardThresholds]:
        """Duration of an aircraft's step in time units, and the thresholds scaled for it."""
        took_ms = self._after[own].time_ms - self._before[own].time_ms
        span = took_ms * self._units.parts_of_ms
        if span <= 0:
            raise ValueError(f"a span of {took_ms} ms")
        if span not in self._by_span:
            self._by_span[span] = self._units.thresholds(self._unit, span)
        self._of_own[own] = span, self._by_span[span]
        return self._of_own[own]


class SeparationWatch:
    """Watches well clear for every protected vehicle. `presence`: observation spans of each aircraft."""

    def __init__(self, mission: Mission, presence: Presence) -> None:
        self._mission, self._presence = mission, presence
        self._protected = sorted(v.id for v in mission.vehicles if v.protected)
        self._ours = frozenset(self._protected)
        volume = mission.daa.well_clear
        self._volume = volume
        self._units = WholeUnits(
            StandardThresholds(volume.dthr_m, volume.zthr_m, volume.tthr_s, volume.tcoa_s)
        )
        self.pairs: dict[tuple[int, int], Pair] = {}
        self.violations: list[Verdict] = []
        protected = {v.id: v for v in mission.vehicles if v.protected}
        self._losses = LossWatch(
            protected, volume, mission.daa.lookahead_s, mission.frame.terrain_m
        )

    def step(self, before: dict[int, Sample], after: dict[int, Sample]) -> None:
        """Check every pair that was in the air at both ends of the step."""
        lost = set()
        whole: WholeStep | None = None
        there = sorted(number for number in after if number in before)
        for own in self._protected:
            if own not in before or own not in after:
                continue
            for other in there:
                if other == own or (other < own and other in self._ours):  # each pair once
                    continue
                whole = whole or self._units.step(before, after)
                if self._check((own, other), before, after, whole.lost(own, other)):
                    lost.add((own, other))
        self._losses.step(_scene(before), _scene(after), frozenset(lost))

    def _check(
        self, key: tuple[int, int], before: dict[int, Sample], after: dict[int, Sample], lost: bool
    ) -> bool:
        own, other = key
        pair = self.pairs.get(key)
        if pair is None:
            pair = self.pairs[key] = Pair()
        pair.checks += 1
        if pair.measured is not before[own]:  # otherwise the end of the previous step was measured
            self._measure(pair, before[own], before[other])
        self._measure(pair, after[own], after[other])
        pair.measured = after[own]
        if lost:
            pair.lost_steps += 1
            s0, s1 = _relative(before[own], before[other]), _relative(after[own], after[other])
            h = Fraction(after[own].time_ms - before[own].time_ms, 1000)
            v = [(b - a) / h for a, b in zip(s0, s1, strict=True)]
            pair.miss_m = min(pair.miss_m, _miss(*map(float, (*s0[:2], *v[:2]))))
            if pair.lost_ms is None:
                pair.lost_ms = before[own].time_ms
                self.violations.append(self._verdict(own, other, pair, "", judge=False))
        return lost

    def _measure(self, pair: Pair, own: Sample, other: Sample) -> None:
        """Least horizontal distance while within ZTHR; for display only."""
        a, b = own.position, other.position
        if abs(a.alt_m - b.alt_m) <= self._volume.zthr_m:
            distance = math.dist(a[:2], b[:2])
            if distance < pair.nearest_m:
                pair.nearest_m, pair.nearest_ms = distance, own.time_ms

    def _verdict(
        self, own: int, other: int, pair: Pair, unseen: str, judge: bool = True
    ) -> Verdict:
        lost = pair.lost_ms is not None
        losses = self._losses.losses((own, other)) if lost and judge else []
        excused = pair_excused(losses)
        margin = None
        note = f"never within ZTHR {self._volume.zthr_m:g} m of altitude"
        if pair.nearest_m < math.inf:
            margin = pair.nearest_m - self._volume.dthr_m
            note = f"nearest {pair.nearest_m:.1f} m at {pair.nearest_ms / 1000:.2f} s"
        if lost:
            # a loss implies a predicted miss of at most DTHR; rounding in doubles may exceed it
            # slightly
            margin = min(0.0, min(pair.nearest_m, pair.miss_m) - self._volume.dthr_m)
            note = (
                f"lost at {(pair.lost_ms or 0) / 1000:.2f} s, in {pair.lost_steps} "
                f"step{'' if pair.lost_steps == 1 else 's'}, headed for a miss by "
                f"{pair.miss_m:.1f} m; {note}; "
                f"{sentence(losses)}"
            )
        asked = [violation_within, *((way_out, is_excused) if losses else ())]
        outcome = Outcome.HOLDS
        if lost:
            outcome = Outcome.EXCUSED if excused else Outcome.VIOLATED
        if unseen and outcome is not Outcome.VIOLATED:
            outcome, note = Outcome.UNKNOWN, f"{note}; {unseen}"
        return Verdict(
            "G2",
            pair_item(own, other),
            outcome,
            Kind.EXACT,
            note,
            time_ms=pair.lost_ms if lost else pair.nearest_ms,
            vehicles=(own, other),
            margin=margin,
            unit="m" if margin is not None else "",
            checks=pair.checks,
            method="violation_within, way_out" if losses else "violation_within",
            kernels=tuple(map(qualified, asked)),
            evidence=evidence(losses) if losses else None,
        )

    def verdicts(self, seen: Watched, ending: Ending) -> list[Verdict]:
        """One verdict for each observed pair, and one for each protected vehicle without traffic."""
        wanted = pairs_of(self._mission, seen.end_ms)
        found = []
        for key, pair in sorted(self.pairs.items()):
            spans = ((number, wanted[key]) for number in key) if key in wanted else ()
            gaps = (self._presence.unseen(number, span, ending) for number, span in spans)
            found.append(self._verdict(*key, pair, next(filter(None, gaps), "")))
        met, strangers = (
            {number for key in keys for number in key} for keys in (wanted, self.pairs)
        )
        for own in self._protected:
            if own not in met:
                unseen = self._presence.unseen(own, (0, seen.end_ms), ending)
                outcome = Outcome.UNKNOWN if unseen else Outcome.HOLDS
                note = "no other aircraft was in the air"
                if own in strangers:
                    note = "the mission has no other aircraft; those seen are rows of their own"
                note = unseen or note
                found.append(
                    Verdict("G2", alone_item(own), outcome, Kind.EXACT, note, vehicles=(own,))
                )
        return found


def _miss(x: float, y: float, vx: float, vy: float) -> float:
    """Least horizontal distance [m] under straight flight, from relative position and velocity."""
    if x * vx + y * vy >= 0:
        return math.hypot(x, y)
    return abs(x * vy - y * vx) / math.hypot(vx, vy)


def _scene(samples: dict[int, Sample]) -> Scene:
    """Positions of all aircraft: east, north, up."""
    time_ms = next(iter(samples.values())).time_ms
    return Scene(
        time_ms,
        {i: (s.position.east_m, s.position.north_m, s.position.alt_m) for i, s in samples.items()},
    )
