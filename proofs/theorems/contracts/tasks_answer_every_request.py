"""A request that names a task is never lost, whatever state the task is in: it is begun at once, or kept
and begun as soon as the task is initialised or has completed; only a newer request takes its place.
And each answer that the task waits for brings it one state nearer to its plan."""

from cratous.core.contracts.tasks import Task, task_requested, task_step
from cratous.proofs.claim import Claim
from cratous.spec.contracts import tasks


def claim(c: Claim) -> None:
    state, request, kept = c.integer("state"), c.integer("request"), c.integer("kept")
    event, about = c.integer("event"), c.integer("about")
    task = Task(state, request, kept)

    def sound(task: Task) -> object:
        waits = c.any_of(task.state == 0, task.state == 1, task.state == 8)
        kept = c.any_of(task.kept == 0, c.all_of(task.kept > task.request, waits))
        return c.all_of(task.state >= 0, task.state <= 8, task.request >= 0, kept)

    c.premise(sound(task))
    c.premise(about >= 1)
    c.show(sound(Task(0, 0, 0)), "at the start")
    moved = c.use(task_step, task, event, about)
    after = moved.task
    c.show(sound(after), "after every event")
    told = c.use(task_requested, task, about)
    c.step(c.implies(event == tasks.REQUESTED, c.same(told, moved)), "one kernel")
    newer = c.all_of(event == tasks.REQUESTED, about > request, about > kept)
    begun = c.all_of(after.state == 2, after.request == about, moved.act == tasks.ASK_SENSORS)
    c.show(
        c.implies(newer, c.any_of(begun, after.kept == about)), "a newer request is begun or kept"
    )
    held = c.all_of(kept != 0, c.negation(newer))
    begins = c.all_of(after.state == 2, after.request == kept, moved.act == tasks.ASK_SENSORS)
    c.show(c.implies(held, c.any_of(after.kept == kept, begins)), "a kept one stays until begun")
    ready = c.all_of(kept != 0, state != 0, event == tasks.PROCEED)
    c.show(c.implies(ready, begins), "going on begins it")
    c.show(
        c.implies(c.all_of(kept != 0, state == 0, event == tasks.INITIALISED), after.state == 1),
        "once the task is initialised",
    )
    awaited = c.all_of(state >= 2, state <= 5, event == state + 1, about == request)
    c.show(c.implies(awaited, after.state == state + 1), "an awaited answer brings it on")
    c.show(
        c.implies(after.state == 6, c.any_of(state == 6, c.all_of(state == 5, event == 6))),
        "no plan without its final routes",
    )
    steered = c.all_of(state == 7, after.state != 7)
    c.show(c.implies(steered, moved.act == tasks.COMPLETE), "who steered says that it is over")
    c.show(
        c.implies(moved.act == tasks.COMPLETE, c.any_of(state == 6, state == 7)),
        "and nobody else does",
    )
