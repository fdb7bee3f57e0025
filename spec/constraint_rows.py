"""Constraints on the times of tasks, as data. Milliseconds after mission start."""

from __future__ import annotations

from typing import NamedTuple

AFTER_END, AFTER_START, WITHIN_END, WITHIN_START, NOT_BEFORE, NOT_AFTER = 1, 2, 3, 4, 5, 6
"""Kinds of constraint rows; `spec.schedule.row_holds` defines their meaning. `ref` is the reference group's latest
end (1, 3) or earliest start (2, 4):

1, 2: the task starts at ref + lo or later; 3, 4: it ends at ref + hi or earlier; 5: it starts at lo or later; 6: it
ends at hi or earlier.
"""


class Row(NamedTuple):
    """One constraint on the times of task `i`, as the checker kernel reads it.

    kind: one of the codes above; group: the reference tasks (empty for kinds 5 and 6), whose latest end (1, 3) or
    earliest start (2, 4) counts; lo, hi: bounds [ms]; text: the part of the user's input that it comes from.
    """

    kind: int
    i: int
    group: tuple[int, ...]
    lo: int
    hi: int
    text: str
