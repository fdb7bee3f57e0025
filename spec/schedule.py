"""What it means that times of tasks satisfy a constraint. Milliseconds after mission start.

A task runs at every instant from its start to its end, both included. The definitions speak of
instants; the kernels (`core.timing`) of starts and ends.
"""

from __future__ import annotations

AFTER_END, AFTER_START, WITHIN_END, WITHIN_START, NOT_BEFORE, NOT_AFTER = 1, 2, 3, 4, 5, 6
"""Row kinds. With the reference group's latest end (1, 3) or earliest start (2, 4) as `ref`:

1, 2: the task starts at ref + lo or later; 3, 4: it ends at ref + hi or earlier;
5: it starts at lo or later; 6: it ends at hi or earlier.
"""
