"""The cost of chains of an instance under all rules: upper limits between tasks, whole laps, tasks already flown.

The compiled searches use the instance without those rules. Here a complete list of moves gets its best times
(`core.assignment.earliest_times`), or is refused together with the number of its first moves that suffice for that.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from cratous.core.assignment.compiled import CHILD, machine_searching
from cratous.core.assignment.earliest_times import Unmet, Visit, earliest, least_starts
from cratous.core.assignment.instance import Instance
from cratous.core.assignment.layers import Ahead, first_state
from cratous.core.assignment.refutation import bound
from cratous.core.assignment.steps import weighted
from cratous.spec.constraint_rows import Row

Moves = tuple[tuple[int, int], ...]
ANY_WAIT_MS = 1 << 40


@dataclass
class Settler:
    """The rules of one branch beyond its instance.

    tasks: ids by the instance's numbers; rows: all that constrain times; laps: per option (shortest, longest time of
    one lap, None for any wait); done: (task id, start, end) of tasks already flown; unsure: how often the choices of
    a schedule were too many to try them all.
    """

    instance: Instance
    ahead: Ahead | None
    tasks: tuple[int, ...]
    rows: tuple[Row, ...]
    laps: tuple[tuple[int, int | None], ...]
    done: tuple[tuple[int, int, int], ...] = ()
    unsure: int = 0

    def visits(self, moves: Sequence[tuple[int, int]]) -> list[Visit]:
        """The tasks already flown, then the moves, as visits in chains."""
        i = self.instance
        made = [Visit(t, -1, 0, end - start, 0, 0, 0, start) for t, start, end in self.done]
        last, at = [-1] * i.vehicles, [i.duration.size] * i.vehicles
        for v, o in moves:
            lap, most = self.laps[o]
            made.append(
                Visit(
                    self.tasks[i.task[o]], last[v], int(i.travel[v, at[v], o]),
                    int(i.duration[o]), lap, ANY_WAIT_MS if most is None else most,
                    int(i.ready[v]),
                )
            )  # fmt: skip
            last[v], at[v] = len(made) - 1, o
        return made

    def legs(self, moves: Sequence[tuple[int, int]]) -> int:
        """The cost of the legs of the moves, apart from their times."""
        at, sum_of = [self.instance.duration.size] * self.instance.vehicles, 0
        for v, o in moves:
            sum_of += int(self.instance.added[v, at[v], o])
            at[v] = o
        return sum_of

    def settle(
        self, moves: Sequence[tuple[int, int]], limit: int
    ) -> tuple[int, list[tuple[int, int, int, int, int]] | None]:
        """(cost, (vehicle, option, arrival, start, end) of each move at its best time), or
        (limit, None) if nothing costs less than the limit."""
        visits, legs, shift = self.visits(moves), self.legs(moves), len(self.done)
        last: dict[int, int] = {}
        for k, (v, _) in enumerate(moves):
            last[v] = k + shift
        long = [visits[k].duration_ms for k in last.values()]
        per = (int(self.instance.weight[0]), int(self.instance.weight[1]))

        def cost(start: list[int]) -> int:
            ends = [start[k] + d for k, d in zip(last.values(), long, strict=True)]
            return weighted(max(ends, default=0), sum(ends), legs, *per)

        times = earliest(visits, self.rows, cost, limit)
        if isinstance(times, Unmet):
            self.unsure += not times.sure
            return limit, None
        found = [
            (v, o, times.arrive_ms[k], times.start_ms[k], times.end_ms[k])
            for k, (v, o) in enumerate(moves, shift)
        ]
        self.unsure += not times.sure
        return cost(list(times.start_ms)), found

    def judge(self, moves: Moves, limit: int) -> tuple[int, int]:
        """The judge for `chains_below`: the cost, or the limit and how many moves suffice for it."""
        cost, found = self.settle(moves, limit)
        if found is not None:
            return cost, 0
        if self.ahead is None or not self._hopeless(moves, limit):
            return limit, len(moves)
        low, high = 0, len(moves)
        while high - low > 1:
            middle = (low + high) // 2
            if self._hopeless(moves[:middle], limit):
                high = middle
            else:
                low = middle
        return limit, high

    def _hopeless(self, moves: Moves, limit: int) -> bool:
        """Whether certainly nothing that begins with these moves costs less than the limit."""
        i, visits = self.instance, self.visits(moves)
        assert self.ahead is not None
        start = least_starts(visits, self.rows)
        if start is None:
            return True
        state, shift = first_state(i), len(self.done)
        at = [i.duration.size] * i.vehicles
        for k, (v, o) in enumerate(moves, shift):
            state[0] |= 1 << int(i.task[o])
            state[1 + i.vehicles + v] = start[k] + visits[k].duration_ms
            state[2 + 2 * i.vehicles] += int(i.added[v, at[v], o])
            state[1 + v] = at[v] = o
        return int(machine_searching(i, bound, CHILD)(state, i, self.ahead)) >= limit
