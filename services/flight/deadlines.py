"""Expected task times, speed adaptation to meet them, and what to do when a deadline cannot be met."""

from __future__ import annotations

from cratous.core.executive.steps import late_act
from cratous.services.flight.chain import Chain, Phase
from cratous.services.flight.executive_state import Asked, Config, Out, State
from cratous.services.flight.expectation import expected_times
from cratous.services.flight.speed_control import FASTEST, broken_rows, trimmed_speed_m_s
from cratous.services.flight.task_transitions import fail
from cratous.services.flight.timing import LOWER, opens_ms
from cratous.spec.constraint_rows import Row
from cratous.spec.executive import FOR_DEADLINE, PLAN_ANEW, STANDS_BY
from cratous.spec.mission.plan import PlanItem
from cratous.spec.records import replace

OPEN_MARGIN_MS = 60
"""Aim this much after the predicted opening [ms], so that rounding never costs an extra lap."""

Late = tuple[tuple[int, Row], ...]


def expected(state: State, factor: float, now_ms: int) -> tuple[dict[int, int], dict[int, int]]:
    """Expected starts and ends of all tasks [ms], with transits flown at `factor` times the planned speed."""
    starts, ends, failed = state.counted_starts(), dict(state.ends), dict(state.failed)
    chains, rows = state.by_vehicle(), state.plan.rows
    return expected_times(chains, rows, starts, ends, failed, factor, now_ms)


def opens(state: State, item: PlanItem, now_ms: int, margin_ms: int = 0) -> int:
    """When an item's task is expected to be allowed to begin [ms]; margin_ms is added if it must wait."""
    at_ms, rows = 0, [r for r in state.plan.rows if r.i == item.task_id and r.kind in LOWER]
    if rows:
        starts, ends = expected(state, 1.0, now_ms)
        starts.pop(item.task_id, None)
        at_ms = opens_ms(item.task_id, rows, starts, ends)
    if at_ms > 0:
        at_ms += margin_ms
    return max(at_ms, item.start_ms) if item.wait_ms > 0 else at_ms


def adapted(state: State, chain: Chain) -> Chain:
    """The chain with its speed adapted so that it passes the start pose when the task may begin."""
    item = chain.item
    if item is None or chain.suspended or chain.phase not in (Phase.TRANSIT, Phase.WAIT):
        return chain
    target, left = opens(state, item, state.now_ms, OPEN_MARGIN_MS), chain.left_m()
    spare = target - state.now_ms
    speed = trimmed_speed_m_s(item, chain.vehicle, left, spare, state.hurry)
    if abs(speed - chain.speed_m_s) > 0.02 * item.speed_m_s or (
        left < 10 * item.speed_m_s and abs(speed - chain.speed_m_s) > 0.002 * item.speed_m_s
    ):
        return replace(chain, speed_m_s=speed, version=chain.version + 1)
    return chain


def watch(state: State) -> tuple[State, Late]:
    """The tasks that miss a deadline even at the fastest speed, each with the row that it breaks."""
    state = replace(state, hurry=bool(_broken(state, 1.0)))
    return state, tuple(_broken(state, FASTEST)) if state.hurry else ()


def _broken(state: State, factor: float) -> list[tuple[int, Row]]:
    """Unsettled tasks that would break an upper bound at this speed factor, with the row."""
    if all(row.kind in LOWER for row in state.plan.rows):
        return []
    starts, ends = expected(state, factor, state.now_ms)
    settled = dict(state.ends).keys() | dict(state.failed).keys()
    return broken_rows(state.plan.rows, starts, ends, settled)


def act_on(
    config: Config, state: State, late: Late, versions: tuple[tuple[int, int], ...], out: Out
) -> State:
    """Act on each late task as the kernel `late_act` decides, stopping at the first that requires a new plan."""
    for k, (task_id, row) in enumerate(late):
        act = late_act(_under_way(state, task_id), True, _torn(state))
        if act == STANDS_BY:
            continue
        if act == PLAN_ANEW:
            asked = Asked(FOR_DEADLINE, "", row.text, late[k:], versions)
            return replace(state, asked=asked)
        state = fail(config, state, task_id, _missed(row), out)
    return state


def give_up_first(config: Config, state: State, late: Late, out: Out) -> State:
    """No plan exists for the first late task: it fails."""
    task_id, row = late[0]
    return fail(config, state, task_id, _missed(row), out)


def _missed(row: Row) -> str:
    return f"{row.text}: cannot be met any more"


def _under_way(state: State, task_id: int) -> bool:
    """Whether a task is being flown."""
    return any(
        c.phase is Phase.TASK and c.item is not None and c.item.task_id == task_id
        for c in (chain.by_plan() for chain in state.chains)
    )


def _torn(state: State) -> bool:
    """Whether a new plan now would interrupt a task, or some vehicle is suspended or holds for an operator."""
    return any(c.suspended or c.holds or c.phase is Phase.TASK for c in state.chains)
