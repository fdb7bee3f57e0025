"""A task in any of its nine states moves exactly as the table of the definition says, for every event,
and does nothing else; what concerns another request than its own, or is no event, changes nothing."""

from cratous.core.contracts.tasks import Task, task_replied, task_requested, task_step
from cratous.proofs.claim import Claim
from cratous.spec.contracts import tasks


def claim(c: Claim) -> None:
    request, kept, about = c.integer("request"), c.integer("kept"), c.integer("about")
    unknown = c.integer("unknown")
    c.premise(c.all_of(request >= 0, kept >= 0))
    c.premise(c.any_of(kept == 0, kept > request))
    c.premise(c.any_of(unknown < min(tasks.EVENTS), unknown > max(tasks.EVENTS)))
    for state in tasks.STATES:
        moved = c.use(task_step, Task(state, request, kept), unknown, about)
        same = c.all_of(moved.task.request == request, moved.task.kept == kept)
        nothing = c.all_of(moved.task.state == state, same, moved.act == tasks.NOTHING)
        c.show(nothing, f"state {state}, no event")
        for event in tasks.EVENTS:
            moved = c.use(task_step, Task(state, request, kept), event, about)
            after, act = c.define(tasks.row, state, event)
            same = c.all_of(moved.task.request == request, moved.task.kept == kept)
            as_said = c.all_of(moved.task.state == after, moved.act == act)
            nothing = c.all_of(moved.task.state == state, same)
            text = f"state {state}, event {event}"
            if event == tasks.REQUESTED:
                direct = c.use(task_requested, Task(state, request, kept), about)
                c.step(c.same(direct, moved), f"{text}: one kernel")
                newer = c.all_of(about > request, about > kept)
                if state in tasks.KEPT_IN or after == tasks.COMPLETED:
                    ids = c.all_of(moved.task.request == request, moved.task.kept == about)
                else:
                    ids = c.all_of(moved.task.request == about, moved.task.kept == 0)
                c.show(c.implies(newer, c.all_of(as_said, ids)), text)
                stale = c.all_of(nothing, moved.act == tasks.STALE)
                c.show(c.implies(c.negation(newer), stale), f"{text}, an older request")
            elif event in tasks.ABOUT_ITS_REQUEST:
                if event in tasks.REPLIES:
                    direct = c.use(task_replied, Task(state, request, kept), event, about)
                    c.step(c.same(direct, moved), f"{text}: one kernel")
                c.show(c.implies(about == request, c.all_of(as_said, same)), text)
                word = tasks.STALE if event in tasks.REPLIES else tasks.NOTHING
                c.show(
                    c.implies(about != request, c.all_of(nothing, moved.act == word)),
                    f"{text}, of another request",
                )
            elif event == tasks.PROCEED and state in (tasks.IDLE, tasks.COMPLETED):
                begun = c.all_of(
                    moved.task.state == tasks.SENSOR_REQUEST,
                    moved.task.request == kept,
                    moved.task.kept == 0,
                    moved.act == tasks.ASK_SENSORS,
                )
                idle = c.all_of(moved.task.state == tasks.IDLE, same, moved.act == tasks.NOTHING)
                c.show(c.when(kept != 0, begun, idle), text)
            else:
                c.show(c.all_of(as_said, same), text)
