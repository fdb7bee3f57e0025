"""Tasks that a plan leaves out, in flight: each is told by name when it is left out, and again for another reason.

While something is to come by which a later plan may take such a task up (a vehicle joins, the wind changes, a zone
ends) it waits for that; else it fails. What has failed is settled, and is not flown again.
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
"""While changes of these kinds are to come a task that is left out is not given up."""
NOBODY = 0
"""The vehicle of a task that was given to none."""


def awaited(to_come: Iterable[Change]) -> str:
    """What is to come by which a task that is left out may be taken up, in words; "" if nothing is."""
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
    """The tasks that are left out from now on, with reasons, and a TaskProgress for those that are new or have
    another reason than before.

    settled: tasks that have begun, ended and failed; before: those left out until now; chains: of the
    plan before; until: what they wait for (`awaited`), "" if they fail.
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
            # one that waits is nobody's for now
            said.append(
                task_progress(task, NOBODY, now_ms, "Waiting", served, why)
                if until
                else task_progress(task, vehicle, now_ms, "Failed", served, why)
            )
    return found, said


def no_longer_awaited(
    left: Mapping[int, str], chains: Mapping[int, Chain], now_ms: int
) -> tuple[dict[int, str], list[Any]]:
    """The tasks left out that still wait when the flight ends, each with its reason, and a TaskProgress for each."""
    found, said = {}, []
    for task, why in left.items():
        if why.startswith(WAITS):
            found[task] = f"{LEFT_OUT}{_reasons(why)}"
            vehicle, served = _flown_by(task, chains)
            said.append(task_progress(task, vehicle, now_ms, "Failed", served, found[task]))
    return found, said


def _reasons(why: str) -> str:
    """What was said of a task that is left out, without how it stands."""
    return why.partition(": ")[2]


def _with_first(reason: str, before: str) -> str:
    """Why a task is left out now, and why it first was where that is another reason. before: what was said last."""
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
    """Whose task it was, and how much of it had been flown."""
    for number, chain in sorted(chains.items()):
        left = [item.task_id for item in chain.items[max(chain.k, 0) :]]
        if task in left:
            return number, chain.by_plan().served() if left[0] == task else 0.0
    return NOBODY, 0.0


def nothing_of(plan: Plan, tasks: Iterable[tuple[int, str]]) -> PartialPlan:
    """An empty plan: no vehicle has work left. tasks: the remaining tasks, each with the reason."""
    empty = replace(plan, items=(), rows=(), chosen=())
    return partial(empty, tuple(LeftOut(task, why) for task, why in tasks), True)
