"""Benchmark results as a table, measured on one core."""

from __future__ import annotations

import os
import time
from collections.abc import Callable

Rows = list[tuple[str, float, str, float]]
"""(what, ours [ns], peer, its time [ns])."""


def on_one_core() -> None:
    """Bind this process to one core, where the system supports it."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})


def least(
    runs: list[Callable[[], object]],
    rounds: int,
    n: int,
    clock: Callable[[], float] = time.process_time,
) -> list[float]:
    """Least time of each run by a clock in seconds, by default CPU time [ns per each of n]; the runs take turns."""
    times = [[0.0] * rounds for _ in runs]
    for k in range(rounds):
        for row, run in zip(times, runs, strict=True):
            start = clock()
            run()
            row[k] = clock() - start
    return [min(row) / n * 1e9 for row in times]


def markdown(rows: Rows) -> list[str]:
    """The table's line for each row."""
    lines = []
    for what, ours, peer, theirs in rows:
        digits = 2 if ours < 10 else 0
        ns = [f"{value:,.{digits}f}" for value in (ours, theirs)]
        lines.append(f"| {what} | {ns[0]} | {peer} | {ns[1]} | {theirs / ours:.2f} |")
    return lines


def alone(rows: Callable[[], Rows]) -> int:
    """Measure one file's rows and print them."""
    on_one_core()
    print("\n".join(markdown(rows())))
    return 0
