"""Evaluation of a formula sample by sample: queues between operators, with proved kernels for each
decision.

Every operator receives the verdicts of its parts in sample order and returns its own in that order,
each at the first sample that decides it. The amortised cost of a sample is constant for any
horizon: the oldest waiting sample is decided first, and while it waits all others wait
(`requirements_until_waits_in_order`).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from itertools import count
from math import isfinite
from typing import Any

from cratous.core.requirements import since
from cratous.core.requirements.until import Times, until_decided, until_times
from cratous.core.requirements.verdict import both, either, negated, reaches
from cratous.services.requirements.formula import (
    MAX_TIME,
    Always,
    Bounded,
    Formula,
    Join,
    Not,
    Reaches,
    parts,
)
from cratous.services.requirements.violating_parts import Part, Parts
from cratous.spec.errors import BadInput

Decided = list[tuple[int, int]]
"""Verdicts in order, each with the time of its sample."""
FALSE, UNKNOWN, TRUE, WAITS = range(4)
NEVER = -(2**62)


def in_order(time: int, last: int) -> int:
    """The time of a sample; BadInput unless it is later than the previous one and at most MAX_TIME."""
    if not last < time <= MAX_TIME:
        raise BadInput(
            "a sample is out of order",
            item="time",
            expected=f"above {last}, up to {MAX_TIME}",
            got=str(time),
        )
    return time


class TooManyWait(BadInput):
    """More samples wait for a verdict than declared: the trace is denser than its declared period."""


class _Leaf:
    """A constant, or a comparison of signals."""

    def __init__(self, formula: Always | Reaches) -> None:
        self.constant = formula.verdict if isinstance(formula, Always) else None
        sides = (formula.left, formula.right) if isinstance(formula, Reaches) else (0.0, 0.0)
        self.names = tuple(side if isinstance(side, str) else None for side in sides)
        self.numbers = tuple(0.0 if isinstance(side, str) else side for side in sides)

    def verdict(self, values: Mapping[str, float | None]) -> int:
        """The verdict at a sample with these values."""
        if self.constant is not None:
            return self.constant
        name, other = self.names
        left = values.get(name) if name is not None else self.numbers[0]
        right = values.get(other) if other is not None else self.numbers[1]
        # missing and non-finite values are unknown
        if left is None or right is None or not (isfinite(left) and isfinite(right)):
            return UNKNOWN
        return TRUE if reaches(left, right) else FALSE


class _Not:
    is_late = False
    size = 0

    def take(self, side: int, got: Decided) -> Decided:
        return [(time, negated(phi)) for time, phi in got]


class _Join:
    """And, or: decided by one side alone where that suffices."""

    is_late = False

    def __init__(self, formula: Join) -> None:
        self.join, self.alone = (both, FALSE) if formula.is_and else (either, TRUE)
        self.waiting: tuple[deque[tuple[int, int]], ...] = (deque(), deque())
        self.behind = [0, 0]
        """For each side, the number of coming verdicts that are no longer needed."""

    def take(self, side: int, got: Decided) -> Decided:
        skipped = min(self.behind[side], len(got))
        self.behind[side] -= skipped
        self.waiting[side].extend(got[skipped:])
        out: Decided = []
        left, right = self.waiting
        while left or right:
            if left and right:
                (time, phi), (_, psi) = left.popleft(), right.popleft()
                out.append((time, self.join(phi, psi)))
                continue
            given = 0 if left else 1
            time, verdict = self.waiting[given][0]
            if verdict != self.alone:
                break
            self.waiting[given].popleft()
            self.behind[1 - given] += 1
            out.append((time, verdict))
        return out

    @property
    def size(self) -> int:
        return max(len(self.waiting[0]), len(self.waiting[1]))


class _Paired:
    """An operator that needs both parts at a sample."""

    def __init__(self, formula: Bounded) -> None:
        self.low, self.high = formula.low, formula.high
        self.is_late = formula.past and formula.low > 0
        """It returns as many verdicts as it receives, with a delay while samples age."""
        self.phi = formula.phi.verdict if isinstance(formula.phi, Always) else None
        """The verdict of a constant phi, which needs no queue: only verdicts of psi arrive."""
        self.waiting: tuple[deque[tuple[int, int]], ...] = (deque(), deque())

    def take(self, side: int, got: Decided) -> Decided:
        out: Decided = []
        if self.phi is not None:
            for time, psi in got:
                self.step(time, self.phi, psi, out)
            return out
        left, right = self.waiting
        self.waiting[side].extend(got)
        while left and right:
            (time, phi), (_, psi) = left.popleft(), right.popleft()
            self.step(time, phi, psi, out)
        return out

    def step(self, time: int, phi: int, psi: int, out: Decided) -> None:
        raise NotImplementedError


class _Until(_Paired):
    def __init__(self, formula: Bounded) -> None:
        super().__init__(formula)
        self.times = Times(NEVER, NEVER)
        self.undecided: deque[int] = deque()
        self.joined = NEVER

    def take(self, side: int, got: Decided) -> Decided:
        if self.phi is not None:
            return self._take_all(self.phi, got)
        out = super().take(side, got)
        if not self.waiting[0] and self.waiting[1]:
            # psi may decide before phi is known (`requirements_until_is_decided_ahead_of_phi`)
            time, psi = self.waiting[1][0]
            self._join(time)
            self._decide(time, TRUE, psi, out)
        return out

    def _take_all(self, phi: int, got: Decided) -> Decided:
        """The same as repeated `step` for a constant phi: only the queue of undecided samples is needed."""
        out: Decided = []
        undecided, times, low, high = self.undecided, self.times, self.low, self.high
        for time, psi in got:
            undecided.append(time)
            while undecided:
                at = undecided[0]
                verdict = until_decided(times, time, phi, psi, at, low, high)
                if verdict == WAITS:
                    break
                undecided.popleft()
                out.append((at, verdict))
            times = until_times(times, time, phi, psi)
        self.times = times
        return out

    def step(self, time: int, phi: int, psi: int, out: Decided) -> None:
        self._join(time)
        self._decide(time, phi, psi, out)
        self.times = until_times(self.times, time, phi, psi)

    def _join(self, time: int) -> None:
        if time != self.joined:
            self.undecided.append(time)
            self.joined = time

    def _decide(self, time: int, phi: int, psi: int, out: Decided) -> None:
        while self.undecided:
            at = self.undecided[0]
            verdict = until_decided(self.times, time, phi, psi, at, self.low, self.high)
            if verdict == WAITS:
                break
            self.undecided.popleft()
            out.append((at, verdict))

    @property
    def size(self) -> int:
        return max(len(self.undecided), len(self.waiting[0]), len(self.waiting[1]))


class _Since(_Paired):
    def __init__(self, formula: Bounded) -> None:
        super().__init__(formula)
        self.found, self.broken = since.Found(NEVER - 1, NEVER - 1), since.Broken(NEVER, NEVER)
        self.young: deque[tuple[int, int]] = deque()
        """Samples that are not old enough yet, with their verdict of psi."""

    def step(self, time: int, phi: int, psi: int, out: Decided) -> None:
        if self.low:
            self.young.append((time, psi))
        else:
            self.found = since.since_found(self.found, time, psi)
        while self.young and since.is_due(self.young[0][0], time, self.low):
            self.found = since.since_found(self.found, *self.young.popleft())
        self.broken = since.since_broken(self.broken, time, phi)
        out.append((time, since.since_decided(self.found, self.broken, time, self.high)))

    @property
    def size(self) -> int:
        return max(len(self.young), len(self.waiting[0]), len(self.waiting[1]))


class Evaluation:
    """One formula over one trace.

    most: maximum number of samples waiting in any one queue; beyond it TooManyWait is raised.
    blames: record which parts cause the first violation (`blamed`).
    """

    def __init__(self, formula: Formula, most: int = 1_000_000, blames: bool = False) -> None:
        self.formula, self.most = formula, most
        self.last = -MAX_TIME - 1
        self.nodes: list[_Leaf | _Not | _Join | _Until | _Since] = []
        self.parents: list[list[tuple[int, int]]] = []
        number = count()
        places: dict[int, int] = {}
        for part in parts(formula):
            mine = places[id(part)] = next(number)
            self.parents.append([])
            if isinstance(part, Always | Reaches):
                self.nodes.append(_Leaf(part))
                continue
            if isinstance(part, Not):
                self.nodes.append(_Not())
                self.parents[places[id(part.phi)]].append((mine, 0))
                continue
            if isinstance(part, Join):
                self.nodes.append(_Join(part))
            else:
                self.nodes.append(_Since(part) if part.past else _Until(part))
                if isinstance(part.phi, Always):
                    self.parents[places[id(part.psi)]].append((mine, 1))
                    continue
            self.parents[places[id(part.phi)]].append((mine, 0))
            self.parents[places[id(part.psi)]].append((mine, 1))
        self.pending: list[list[tuple[int, Decided]]] = [[] for _ in self.nodes]
        """For each node the verdicts that its parts decided at this sample: (side, verdicts)."""
        self.parts = Parts(formula, places) if blames else None
        self._blaming = self.parts
        last = len(self.nodes) - 1
        self.order = [
            (place, node, type(node) is _Leaf, self.parents[place])
            for place, node in enumerate(self.nodes)
            # skip constants that no operator reads
            if self.parents[place] or place == last
        ]
        self.timeless = self._timeless()
        within = {
            place for place in self.timeless if place != last
            and all(parent in self.timeless for parent, _ in self.parents[place])
        }  # fmt: skip
        self.is_timeless = last in self.timeless
        self.within = sorted(within)
        """Timeless nodes inside the formula, read by timeless nodes only."""
        self.order_of_same = [
            # a timeless node keeps its verdict, so none is passed to it
            (place, node, is_leaf, [one for one in read_by if one[0] not in self.timeless])
            for place, node, is_leaf, read_by in self.order
            if place not in within
        ]
        self.verdicts = [WAITS for _ in self.nodes]
        """For timeless nodes, the verdict at the last sample."""

    def _timeless(self) -> set[int]:
        """The places of nodes whose verdict at a sample depends on that sample alone."""
        timed = {place for place, node in enumerate(self.nodes) if isinstance(node, _Paired)}
        for place in range(len(self.nodes)):  # children before parents
            if place in timed:
                timed.update(parent for parent, _ in self.parents[place])
        return {place for place, _, _, _ in self.order if place not in timed}

    def sample(self, time: int, values: Mapping[str, float | None], same: bool = False) -> Decided:
        """The verdicts that this sample decides: (time of the verdict's sample, 0, 1 or 2).

        time: later than that of the previous sample, in time units; values: of the signals; None,
        non-finite and missing signals are unknown; same: the values that the formula reads are
        unchanged since the previous sample. Raises BadInput for a time that is not later.
        """
        self.last = in_order(time, self.last)
        if same and self.is_timeless:
            return [(time, self.verdicts[-1])]
        # children before parents, so that one pass brings every verdict to the root
        got: Decided = []
        pending, verdicts, timeless = self.pending, self.verdicts, self.timeless
        taken: list[tuple[int, Decided]] = []
        node: Any
        for place, node, is_leaf, parents in self.order_of_same if same else self.order:
            if place in timeless:
                if not same:
                    if is_leaf:
                        verdicts[place] = node.verdict(values)
                    else:
                        verdicts[place] = self._taken(node, pending[place], time)[0][1]
                        pending[place].clear()
                got = [(time, verdicts[place])]
            elif rows := pending[place]:
                if len(rows) > 1:
                    got = self._taken(node, rows, time)
                else:
                    side, got = rows[0]
                    most = len(got)
                    got = node.take(side, got)
                    if len(got) < most or node.is_late:
                        self._bounded(node, time)
                rows.clear()
                if not got:
                    continue
            else:
                got = []
                continue
            taken.append((place, got))
            for parent, side in parents:
                pending[parent].append((side, got))
        if self._blaming is not None and not self._blaming.all_decided(time, got):
            if same:
                taken += [(place, [(time, verdicts[place])]) for place in self.within]
            if not self._blaming.taken(taken, got):
                self._blaming = None
        return got

    def _taken(self, node: Any, rows: list[tuple[int, Decided]], time: int) -> Decided:
        """The verdicts that a node derives from those of its parts."""
        found: Decided = []
        for side, got in rows:
            found += node.take(side, got)
        self._bounded(node, time)
        return found

    def _bounded(self, node: Any, time: int) -> None:
        """Raise TooManyWait if too many samples wait in a node or are not old enough yet."""
        if node.size > self.most:
            raise TooManyWait(
                "more samples wait for a verdict than were allowed for",
                item=f"time {time}",
                expected=f"at most {self.most}",
                got=str(node.size),
            )

    @property
    def blamed(self) -> tuple[Part, ...]:
        """The parts that cause the first violation; empty if there is none, or `blames` is not set."""
        return self.parts.found if self.parts else ()
