"""Which parts of a violated formula cause the violation: their verdicts violate it, whatever the
others.

Not, and, or are examined recursively: `a and b` is violated by those of a and b that are false, `a
implies b` by a, which holds, and b, which does not. Comparisons and temporal parts are not examined
further.
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
    """The verdicts of the parts at samples at which the whole formula is still undecided."""

    def __init__(self, formula: Formula, places: Mapping[int, int]) -> None:
        """places: index of each part by its id, the last that of the whole formula."""
        self.formula, self.places = formula, places
        self.kept: list[dict[int, int] | None] = [None] * len(places)
        self.found: tuple[Part, ...] = ()
        self.through = NEVER
        """The last sample at which the whole formula is decided."""
        todo = [formula]
        while todo:
            one = todo.pop()
            if self.kept[places[id(one)]] is None:
                self.kept[places[id(one)]] = {}
                todo += children(one) if isinstance(one, Not | Join) else ()

    def all_decided(self, now: int, out: Sequence[tuple[int, int]]) -> bool:
        """Whether the new verdicts decide everything up to now without a violation; then the parts
        are discarded.
        """
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
        """Record the verdicts of a sample: of parts by place, and of the whole. True while nothing is violated."""
        for place, got in parts:
            self.take(place, got)
        return self.decided(out)

    def take(self, place: int, got: Sequence[tuple[int, int]]) -> None:
        """Record verdicts of the part at a place, except where the whole formula is decided already."""
        if (known := self.kept[place]) is not None:
            for time, verdict in got:
                if time > self.through:
                    known[time] = verdict

    def decided(self, out: Sequence[tuple[int, int]]) -> bool:
        """The whole formula is decided at these samples. True while none is violated."""
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
    """The parts that cause the violation at a sample; verdict_of: verdict of a part there, None if
    not known yet.
    """
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
