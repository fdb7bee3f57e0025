"""Checking a refutation from its origins alone: the states are recomputed and every omission is checked.

The search itself is not trusted. What is checked: from the first state on, every child of every state is listed,
covered by a listed state, or ruled out by a bound; so whatever costs less than the limit ends in a listed last state.
The steps are the proved kernels of `core.assignment.steps`.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cratous.core.assignment.compiled import CHILD, STATES_MOST, is_brief, machine_after
from cratous.core.assignment.instance import Instance
from cratous.core.assignment.layers import first_state, look_ahead, search_below
from cratous.core.assignment.refutation import closed, cost_now
from cratous.core.assignment.search_records import REFUTES
from cratous.core.kernel import driver


@driver(checked_by=REFUTES)
def least_cost(instance: Instance, limit: int, origins: Sequence[np.ndarray]) -> tuple[int, str]:
    """(no completion costs less than this, the fault found): the first is valid only if the second is ""."""
    i = instance
    search = search_below(i, look_ahead(i), limit)
    layer = first_state(i)[None, :]
    brief, listed = is_brief(i), 0
    for depth in range(i.tasks):
        if len(layer) == 0:
            return limit, ""
        if depth >= len(origins):
            return 0, f"the states after {depth} tasks are not listed"
        origin = np.ascontiguousarray(origins[depth], np.int64).reshape(-1, 3)
        into = np.empty((len(origin), layer.shape[1]), np.int64)
        table = np.empty(1 << max(4, (2 * len(origin)).bit_length()), np.int64)
        if depth + 1 == i.tasks:
            search = search._replace(deals=0)
        listed += len(origin)
        steps = CHILD * len(layer) * i.may.size
        found = machine_after(brief and listed <= STATES_MOST, i, closed, steps)(
            layer, origin, into, table, np.empty(len(origin), np.int64), limit, search
        )
        if found >= 0:
            return 0, f"layer {depth + 1}: a child of state {found} is missing"
        if found < -1:
            return 0, f"layer {depth + 1}: entry {-2 - found} is no possible move"
        layer = into
    costs = [int(cost_now(s, i.vehicles, i.duration.size, i.weight)) for s in layer]
    return min([limit, *costs]), ""
