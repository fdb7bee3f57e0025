"""Keeps the data needed to judge a loss, and judges each loss once its aftermath is known.

Definitions: `spec.excuse`. The record extends over the look-ahead before a loss and after it; then, or when the
flight is over, `core.excuse.record` judges it. If both aircraft of a pair are protected, the loss is excused only if
neither had a way out.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from cratous.core.excuse.record import Loss, Record, Scene, judge_loss
from cratous.core.excuse.way_out import is_excused, way_out
from cratous.spec.mission import Vehicle, WellClear

Pair = tuple[int, int]


class Pending(NamedTuple):
    """A loss that is not judged yet: the pair, its time, and when the pair's preceding loss ended."""

    pair: Pair
    lost_ms: int
    after_ms: int | None


class LossWatch:
    """Judges the losses of well clear of protected vehicles."""

    def __init__(
        self,
        protected: Mapping[int, Vehicle],
        volume: WellClear,
        lookahead_s: float,
        floor_m: float,
    ) -> None:
        self._protected, self._volume = protected, volume
        self._lookahead_s, self._floor_m = lookahead_s, floor_m
        self._reach_ms = round(lookahead_s * 1000)
        self._scenes: list[Scene] = []
        self._earlier: frozenset[int] = frozenset()
        self._ongoing: frozenset[Pair] = frozenset()
        self._ended: dict[Pair, int] = {}
        self._pending: list[Pending] = []
        self._judged: dict[Pair, list[Loss]] = {}

    def step(self, before: Scene, after: Scene, lost: frozenset[Pair]) -> None:
        """Add one step of the record, and the pairs that lost well clear in it."""
        if not self._scenes or self._scenes[-1].time_ms != before.time_ms:
            self._scenes.append(before)
        self._scenes.append(after)
        for pair in sorted(lost - self._ongoing):
            if self._excusable(pair):
                self._pending.append(Pending(pair, before.time_ms, self._ended.get(pair)))
        self._ongoing = lost
        for pair in lost:
            self._ended[pair] = after.time_ms
        ripe = [x for x in self._pending if x.lost_ms + self._reach_ms <= after.time_ms]
        for one in ripe:
            self._pending.remove(one)
            self._judged.setdefault(one.pair, []).extend(self._judge(one))
        self._forget(after.time_ms)

    def _excusable(self, pair: Pair) -> bool:
        """Whether the pair can still be excused: a pair with a loss that is not excused is violated."""
        return all(loss.excused for loss in self._judged.get(pair, []))

    def _judge(self, one: Pending) -> list[Loss]:
        """The judgement of a loss, for each protected aircraft of the pair."""
        k = next(i for i, s in enumerate(self._scenes) if s.time_ms == one.lost_ms)
        found = []
        for own, other in (one.pair, one.pair[::-1]):
            if own in self._protected:
                found.append(
                    judge_loss(
                        Record(self._scenes, one.after_ms, self._earlier), k,
                        self._protected[own], other, self._volume, self._lookahead_s, self._floor_m,
                    )
                )  # fmt: skip
                if not found[-1].excused:
                    break
        return found

    def _forget(self, now_ms: int) -> None:
        """Drop scenes that no judgement needs any more."""
        oldest_ms = min([now_ms, *(x.lost_ms for x in self._pending)]) - self._reach_ms
        keep = next((i for i, s in enumerate(self._scenes) if s.time_ms >= oldest_ms), 0)
        # one scene more: for the velocity before the first one
        for scene in self._scenes[: max(keep - 2, 0)]:
            self._earlier |= scene.places.keys()
        del self._scenes[: max(keep - 2, 0)]

    def losses(self, pair: Pair) -> list[Loss]:
        """The judgements of all losses of a pair, as far as the record extends now."""
        found = list(self._judged.get(pair, []))
        for one in self._pending:
            if one.pair == pair and all(loss.excused for loss in found):
                found += self._judge(one)
        return found


def pair_answer(losses: list[Loss]) -> int:
    """The answer for a pair: no way out only if there was none at any of its losses."""
    return int(way_out([(loss.answer,) for loss in losses]))


def pair_excused(losses: list[Loss]) -> bool:
    """Whether every loss of the pair is excused; False if none was judged."""
    return bool(is_excused(pair_answer(losses)))
