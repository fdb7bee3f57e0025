"""Text on a plan for the command line: assignments, quality, and tasks left out."""

from __future__ import annotations

from cratous.spec.mission import Mission
from cratous.spec.mission.guarantees import Outcome, Verdict, worst
from cratous.spec.mission.plan import (
    COST_UNITS,
    PartialPlan,
    Plan,
    cost_text,
    in_part_of,
    left_out_of,
)


def plan_line(mission: Mission, plan: Plan, checks: list[Verdict]) -> str:
    """One line on a plan and the result of its check."""
    chains = []
    for vehicle in dict.fromkeys(item.vehicle_id for item in plan.items):
        tasks = " ".join(f"p{item.task_id}" for item in plan.chain(vehicle))
        chains.append(f"vehicle {vehicle}: {tasks}")
    outcome = worst([check.outcome for check in checks])
    good = sum(check.outcome is Outcome.HOLDS for check in checks)
    part = "a part of what is asked for, " if left_out_of(plan) or in_part_of(plan) else ""
    return (
        f"plan: {'; '.join(chains)}; {part}"
        f"{plan.makespan_ms / 1000:.1f} s, {_cost(mission, plan)}{standing(mission, plan)}; "
        f"{good} of {len(checks)} constraints hold ({outcome})"
    )


def left_out_lines(plan: Plan) -> list[str]:
    """A line for each task left out or done in part, and whether more could be done."""
    left = left_out_of(plan)
    lines = [f"in part: {one.text}" for one in in_part_of(plan)]
    for one in left:
        lines.append(f"{'waits for a vehicle' if one.waits else 'left out'}: {one.text}")
        lines += [f"  task {one.task_id} could be done: {r.text}" for r in one.remedies if r.tried]
    if left and not (isinstance(plan, PartialPlan) and plan.sure):
        lines.append("whether more could be done is not certain")
    return lines


def _cost(mission: Mission, plan: Plan) -> str:
    """The cost in words, if it is not a time."""
    from cratous.services.pipeline.plan import cost_of

    if COST_UNITS[plan.cost] == "ms":
        return ""
    return f"{cost_text(plan.cost, cost_of(plan, mission))}, "


def standing(mission: Mission, plan: Plan) -> str:
    """Quality of a plan, as far as its certificate shows it."""
    from cratous.services.pipeline.plan import cost_of

    if plan.status == "optimal":
        return "optimal"
    if plan.bound <= 0:
        return "no bound known"
    cost = cost_of(plan, mission)
    return f"gap {100 * (cost - plan.bound) / cost:.1f} %"
