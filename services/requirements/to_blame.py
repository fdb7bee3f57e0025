"""Which parts of a violated formula are to blame: being as they were, they violate it at that sample, whatever the rest.

A formula is looked into as far as not, and, or reach: `a and b` is false by those of a and b that are, `a implies b` by a,
which holds, and b, which does not. A comparison and what has a time are parts that are not looked into.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial

from cratous.services.requirements.formula import Formula, Join, Not, children

FALSE, TRUE = 0, 2
NEVER = -(2**62)
Part = tuple[Formula, int]
"""A part, and its verdict at the sample."""


class Parts:
    """The verdicts of the parts at the samples at which the whole is not decided yet."""

    def __init__(self, formula: Formula, places: Mapping[int, int]) -> None:
        """places: of each part by its id, the last that of the whole."""
        self.formula, self.places = formula, places
        self.kept: list[dict[int, int] | None] = [None] * len(places)
        self.found: tuple[Part, ...] = ()
        self.through = NEVER
        """The last sample at which the whole is decided."""
        todo = [formula]
        while todo:
            one = todo.pop()
            if self.kept[places[id(one)]] is None:
                self.kept[places[id(one)]] = {}
                todo += children(one) if isinstance(one, Not | Join) else ()

    def all_decided(self, now: int, out: Sequence[tuple[int, int]]) -> bool:
        """Whether with the verdicts of the whole that came now nothing waits, and none is a violation."""
        if not out or out[-1][0] != now or FALSE in [verdict for _, verdict in out]:
            return False
        self.through = now
        for known in self.kept:
            if known:
                known.clear()
        return True

    def taken(
        self, parts: Sequence[tuple[int, Sequence[tuple[int, int]]]], out: Sequence[tuple[int, int]]
    ) -> bool:
        """What a sample has decided: of the parts by place, and of the whole. True as long as no violation was."""
        for place, got in parts:
            self.take(place, got)
        return self.decided(out)

    def take(self, place: int, got: Sequence[tuple[int, int]]) -> None:
        """Verdicts of the part at a place; where the whole is decided already they are not kept."""
        if (known := self.kept[place]) is not None:
            for time, verdict in got:
                if time > self.through:
                    known[time] = verdict

    def decided(self, out: Sequence[tuple[int, int]]) -> bool:
        """The whole is decided at these samples. True as long as none was violated."""
        for time, verdict in out:
            if verdict == FALSE:
                self.found = tuple(why(self.formula, partial(self._verdict, time)))
                return False
            self.through = time
            for known in self.kept:
                if known:
                    known.pop(time, None)
        return True

    def _verdict(self, time: int, part: Formula) -> int | None:
        return (self.kept[self.places[id(part)]] or {}).get(time)


def why(formula: Formula, verdict_of: Callable[[Formula], int | None]) -> list[Part]:
    """The parts that are to blame at a sample at which the formula is violated; verdict_of: of a part there, None where
    it is not known yet."""
    found: list[Part] = []
    todo, seen = [formula], set()
    while todo:
        one = todo.pop()
        if id(one) in seen:
            continue
        seen.add(id(one))
        verdict = verdict_of(one)
        if isinstance(one, Not):
            todo.append(one.phi)
        elif isinstance(one, Join):
            todo += [side for side in (one.psi, one.phi) if verdict_of(side) == verdict]
        elif verdict is not None:
            found.append((one, verdict))
    return found
