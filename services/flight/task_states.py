"""What has become of each task in flight, as the kernels of `core.executive` have it."""

from __future__ import annotations

from collections.abc import Container

from cratous.core.executive.steps import task_after
from cratous.spec.executive import BEGUN, ENDED, FAIL, FAILED, LEFT


def life(task_id: int, starts: Container[int], ends: Container[int], failed: Container[int]) -> int:
    """A task's state, from the lists of tasks that have begun, ended and failed."""
    if task_id in ends:
        return ENDED
    if task_id in failed:
        return FAILED
    return BEGUN if task_id in starts else LEFT


def fails(
    task_id: int, starts: Container[int], ends: Container[int], failed: Container[int]
) -> bool:
    """Whether a task that is given up fails by that; one that is settled stays as it is."""
    before = life(task_id, starts, ends, failed)
    return task_after(before, FAIL) != before
