"""The planner's answer to the executive's in-flight plan request."""

from __future__ import annotations

from cratous.services.flight.messages import AskPlan, NotPlanned, Planned
from cratous.spec.errors import NoPlan


def planned(asked: AskPlan) -> Planned | NotPlanned:
    """Run the planning services on a request. Returns NotPlanned, with the reasons, where no plan exists."""
    from cratous.services.pipeline.plan import make_plan
    from cratous.services.planning.omitted_tasks import NothingDone

    try:
        plan = make_plan(
            asked.known,
            starts=dict(asked.starts),
            done=asked.done,
            now_ms=asked.now_ms,
            absent=dict(asked.absent),
            undone=dict(asked.undone),
            begun=asked.begun,
        )
    except NoPlan as error:
        of = error.of if isinstance(error, NothingDone) else {}
        return NotPlanned(str(error), tuple(sorted(of.items())))
    return Planned(plan)
