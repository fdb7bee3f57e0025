"""The state of each task in flight, with the codes of `core.executive`."""

from __future__ import annotations

from collections.abc import Container

from cratous.core.executive.steps import task_after
from cratous.spec.executive import BEGUN, ENDED, FAIL, FAILED, LEFT


def life(task_id: int, starts: Container[int], ends: Container[int], failed: Container[int]) -> int:
    """The state of a task, given the tasks that have begun, ended and failed."""
    if task_id in ends:
        return ENDED
    if task_id in failed:
        return FAILED
    return BEGUN if task_id in starts else LEFT


def fails(
    task_id: int, starts: Container[int], ends: Container[int], failed: Container[int]
) -> bool:
    """Whether giving up a task makes it fail; a settled task keeps its state."""
    before = life(task_id, starts, ends, failed)
    return task_after(before, FAIL) != before
