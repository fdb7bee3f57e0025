"""Tasks that a plan leaves out, in flight: reported by name when they are left out, and when the reason
changes.

While a change is to come that could let a later plan include such a task (a vehicle joins, the wind changes,
a zone ends), it waits for that; otherwise it fails. A failed task is settled and not flown again.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from typing import Any

from cratous.services.flight.chain import Chain
from cratous.services.flight.commands import task_progress
from cratous.services.flight.task_states import fails
from cratous.spec.mission import Change
from cratous.spec.mission.changes import VEHICLE_JOINS, WIND, ZONE_ENDS, words
from cratous.spec.mission.plan import LeftOut, PartialPlan, Plan, left_out_of, partial
from cratous.spec.records import replace

LEFT_OUT, WAITS, AT_FIRST = "left out: ", "waits, as ", "; when it was first left out: "
BRINGS_BACK = (VEHICLE_JOINS, WIND, ZONE_ENDS)
"""While changes of these kinds are to come, a task that is left out has not failed."""
NOBODY = 0
"""Vehicle id of a task that was assigned to none."""


def awaited(to_come: Iterable[Change]) -> str:
    """The coming changes for which tasks that are left out wait, in words; "" if there are none."""
    return ", ".join(
        f"{words(change)} at {change.at_ms / 1000:.2f} s"
        for change in to_come
        if change.kind in BRINGS_BACK
    )


def leave_out(
    plan: Plan,
    settled: tuple[Container[int], Container[int], Mapping[int, str]],
    before: Mapping[int, str],
    chains: Mapping[int, Chain],
    now_ms: int,
    until: str = "",
) -> tuple[dict[int, str], list[Any]]:
    """The tasks left out from now on, with reasons, and a TaskProgress for each with a new reason.

    settled: tasks that have begun, ended and failed; before: those left out until now; chains: of the
    previous plan; until: what they wait for (`awaited`), "" if they fail.
    """
    starts, ends, failed = settled
    found, said = {}, []
    for one in left_out_of(plan):
        task = one.task_id
        head = f"{WAITS}{until}: " if until else LEFT_OUT
        why = f"{head}{_with_first(one.reason, before.get(task, ''))}"
        if task in before or fails(task, starts, ends, failed):
            found[task] = why
        if task in found and before.get(task) != why:
            vehicle, served = _flown_by(task, chains)
            # a waiting task is assigned to no vehicle
            said.append(
                task_progress(task, NOBODY, now_ms, "Waiting", served, why)
                if until
                else task_progress(task, vehicle, now_ms, "Failed", served, why)
            )
    return found, said


def no_longer_awaited(
    left: Mapping[int, str], chains: Mapping[int, Chain], now_ms: int
) -> tuple[dict[int, str], list[Any]]:
    """The left-out tasks that still wait when the flight ends, each with its reason, and a TaskProgress for
    each.
    """
    found, said = {}, []
    for task, why in left.items():
        if why.startswith(WAITS):
            found[task] = f"{LEFT_OUT}{_reasons(why)}"
            vehicle, served = _flown_by(task, chains)
            said.append(task_progress(task, vehicle, now_ms, "Failed", served, found[task]))
    return found, said


def _reasons(why: str) -> str:
    """The reason in a message about a task that is left out."""
    return why.partition(": ")[2]


def _with_first(reason: str, before: str) -> str:
    """Why a task is left out now, followed by the first reason if that differs. before: the last message."""
    first = before.partition(AT_FIRST)[2] or _reasons(before)
    return reason + (f"{AT_FIRST}{first}" if first not in ("", reason) else "")


def unfinished(
    tasks: Iterable[int],
    settled: tuple[Container[int], Container[int], Mapping[int, str]],
    chains: Mapping[int, Chain],
    now_ms: int,
    why: str,
) -> tuple[list[int], list[Any]]:
    """The tasks without a final status when the flight ends, and a TaskProgress for each.

    settled: tasks that have begun, ended and failed (left out included).
    """
    starts, ends, failed = settled
    found, said = [], []
    for task in tasks:
        if fails(task, starts, ends, failed):
            found.append(task)
            vehicle, served = _flown_by(task, chains)
            said.append(task_progress(task, vehicle, now_ms, "Failed", served, why))
    return found, said


def _flown_by(task: int, chains: Mapping[int, Chain]) -> tuple[int, float]:
    """The vehicle that the task was assigned to, and the flown fraction of its path."""
    for number, chain in sorted(chains.items()):
        left = [item.task_id for item in chain.items[max(chain.k, 0) :]]
        if task in left:
            return number, chain.by_plan().served() if left[0] == task else 0.0
    return NOBODY, 0.0


def nothing_of(plan: Plan, tasks: Iterable[tuple[int, str]]) -> PartialPlan:
    """An empty plan: no vehicle has work left. tasks: the remaining tasks, each with the reason."""
    empty = replace(plan, items=(), rows=(), chosen=())
    return partial(empty, tuple(LeftOut(task, why) for task, why in tasks), True)
