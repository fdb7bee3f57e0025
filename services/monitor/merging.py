"""G1 of vehicles that merge: any two pass the fix at least the separation time apart, judged by their positions.

A vehicle passes the fix when it is nearest to it during a stay in the entry zone, once per stay. Between two states it
flies straight. Passing times are rounded to milliseconds in both directions; if the verdict depends on the rounding,
it is unknown, and so it is for a pair of which one did not pass: nothing was compared.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import product
from typing import Any

from cratous.core.geofence.distance import edge_distance, leg_within
from cratous.core.geofence.passages import foot
from cratous.core.kernel import Vec2, qualified
from cratous.core.merging.grants import room_beside
from cratous.services.mission.merging import merging_of
from cratous.services.monitor.observation import Ending, Presence
from cratous.services.monitor.required_rows import merge_item, merging_pairs
from cratous.services.monitor.samples import Sample
from cratous.spec.mission import Mission
from cratous.spec.mission.guarantees import Kind, Outcome, Verdict

SOME_REQUEST = 1
DECIDE: tuple[Any, ...] = (leg_within, edge_distance, foot, room_beside)
KERNELS = tuple(qualified(kernel) for kernel in DECIDE)


@dataclass
class Stays:
    """Stays of one vehicle in the entry zone. found: of each, the least distance squared [m2] and its time [ms];
    inside: whether the last leg reached the zone.
    """

    found: list[tuple[float, float]] = field(default_factory=list)
    inside: bool = False


class MergeWatch:
    """Watches when each vehicle that merges passes the fix; no rows for a mission without a fix."""

    def __init__(self, mission: Mission, presence: Presence) -> None:
        self._mission, self._merging, self._presence = mission, merging_of(mission), presence
        members = () if self._merging is None else self._merging.vehicles
        self._stays = {number: Stays() for number in members}

    def step(self, before: dict[int, Sample], after: dict[int, Sample]) -> None:
        """Take in the samples of two successive instants."""
        merging = self._merging
        if merging is None:
            return
        fix = Vec2(merging.north_m, merging.east_m)
        for number, stays in self._stays.items():
            if number not in before or number not in after:
                stays.inside = False
                continue
            one, two = before[number], after[number]
            (a, b, _), (c, d, _) = one.position, two.position
            p, q = Vec2(a, b), Vec2(c, d)
            if not leg_within(p, q, fix, fix, merging.entry_m):
                stays.inside = False
                continue
            squared = edge_distance(fix, p, q)
            share = foot(p, q, fix)
            part = min(max(share.num / share.den, 0.0), 1.0) if share.den > 0 else 0.0
            at = squared.num / squared.den, one.time_ms + part * (two.time_ms - one.time_ms)
            if not stays.inside:
                stays.found.append(at)
            elif at[0] < stays.found[-1][0]:
                stays.found[-1] = at
            stays.inside = True

    def verdicts(self, ending: Ending) -> list[Verdict]:
        """One verdict for each pair of vehicles that merge."""
        return [self._verdict(*pair, ending) for pair in merging_pairs(self._mission)]

    def _verdict(self, one: int, other: int, ending: Ending) -> Verdict:
        merging = self._merging
        assert merging is not None
        ours, theirs = ([at for _, at in self._stays[n].found] for n in (one, other))
        gaps = [sorted(pair) for pair in product(ours, theirs)]
        least = min(gaps, key=lambda gap: gap[1] - gap[0], default=None)
        sure = all(_apart(math.ceil(a), math.floor(b), merging.separation_ms) for a, b in gaps)
        maybe = all(_apart(math.floor(a), math.ceil(b), merging.separation_ms) for a, b in gaps)
        outcome = Outcome.HOLDS if sure else Outcome.UNKNOWN if maybe else Outcome.VIOLATED
        names = [self._words(one, ours), self._words(other, theirs)]
        doubts = (self._presence.unseen(n, (0, ending.at_ms), ending) for n in (one, other))
        doubt = next((text for text in doubts if text), "")
        doubt = doubt or ("" if gaps else "no two passages to compare")
        if outcome is Outcome.HOLDS and doubt:
            outcome, names = Outcome.UNKNOWN, [doubt, *names]
        margin = None if least is None else (least[1] - least[0] - merging.separation_ms) / 1000
        return Verdict(
            "G1", merge_item(merging.name, one, other), outcome, Kind.OBSERVED, "; ".join(names),
            time_ms=None if least is None else math.floor(least[1]), vehicles=(one, other),
            margin=margin, unit="" if margin is None else "s", checks=len(gaps),
            kernels=KERNELS if gaps else (),
        )  # fmt: skip

    def _words(self, number: int, passed: list[float]) -> str:
        when = " and ".join(f"{at / 1000:.2f} s" for at in passed)
        return f"vehicle {number} passed at {when}" if passed else f"vehicle {number} did not pass"


def _apart(one_ms: int, other_ms: int, separation_ms: int) -> bool:
    return room_beside(True, SOME_REQUEST, one_ms, other_ms, separation_ms)
