"""Which parts of a violated formula are to blame: being as they were, they violate it at that sample, whatever the rest.

A formula is looked into as far as not, and, or reach: `a and b` is false by those of a and b that are, `a implies b` by a,
which holds, and b, which does not. A comparison and what has a time are parts that are not looked into.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

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

    def take(self, place: int, got: Sequence[tuple[int, int]]) -> None:
        """Verdicts of the part at a place; where the whole is decided already they are not kept."""
        if (known := self.kept[place]) is not None:
            known.update(row for row in got if row[0] > self.through)

    def decided(self, out: Sequence[tuple[int, int]]) -> bool:
        """The whole is decided at these samples. True as long as none was violated."""
        for time, verdict in out:
            if verdict == FALSE:
                self.found = tuple(self._why(time))
                return False
            self.through = time
            for known in self.kept:
                if known:
                    known.pop(time, None)
        return True

    def _verdict(self, part: Formula, time: int) -> int | None:
        return (self.kept[self.places[id(part)]] or {}).get(time)

    def _why(self, time: int) -> list[Part]:
        found: list[Part] = []
        todo, seen = [self.formula], set()
        while todo:
            one = todo.pop()
            if id(one) in seen:
                continue
            seen.add(id(one))
            verdict = self._verdict(one, time)
            if isinstance(one, Not):
                todo.append(one.phi)
            elif isinstance(one, Join):
                todo += [s for s in (one.psi, one.phi) if self._verdict(s, time) == verdict]
            elif verdict is not None:
                found.append((one, verdict))
        return found
