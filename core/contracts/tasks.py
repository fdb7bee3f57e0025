"""A task service's nine states as a transition kernel.

The table is that of `spec.contracts.tasks`: Init, Idle, SensorRequest, OptionRoutes, OptionsPublished, FinalRoutes,
OptionSelected, Active, Completed. The service passes events to the kernel and does what it returns.
"""

from typing import NamedTuple

from cratous.core.kernel import kernel


class Task(NamedTuple):
    """state: 0 to 8; request: id of its current request, 0 for none; kept: id of a newer request that is to be begun,
    0 for none.
    """

    state: int
    request: int
    kept: int


class Moved(NamedTuple):
    """The task afterwards, and its act.

    act: 0 nothing, 1 announce that it is ready, 2 request sensor footprints, 3 request option routes, 4 publish
    options, 5 request final routes, 6 publish its plan, 7 steer, 8 complete, 9 report a stale message.
    """

    task: Task
    act: int


@kernel(supports="task_step")
def task_requested(task: Task, request: int) -> Moved:
    """A request names the task; a newer one overrides, any other is stale."""
    if request <= task.request or request <= task.kept:
        return Moved(task, 9)
    if task.state == 0 or task.state == 8:
        return Moved(Task(task.state, task.request, request), 0)
    if task.state == 7:
        return Moved(Task(8, task.request, request), 8)
    return Moved(Task(2, request, 0), 2)


@kernel(supports="task_step")
def task_replied(task: Task, event: int, request: int) -> Moved:
    """An answer arrives: 3 sensor footprints, 4 option routes, 5 the choice, 6 final routes.

    Each leads from the state that awaits it to the next, in which the next item is requested or published; an answer
    to another request, or out of turn, is stale.
    """
    if request != task.request or event < 3 or event > 6 or event != task.state + 1:
        return Moved(task, 9)
    return Moved(Task(task.state + 1, task.request, task.kept), event)


@kernel(implements="contracts.tasks.row")
def task_step(task: Task, event: int, request: int) -> Moved:
    """One step of a task.

    event: 1 initialised, 2 requested, 3 to 6 as in `task_replied`, 7 listed by a vehicle's state,
    8 no longer listed, 9 its request was answered, 10 its plan is withdrawn, 11 go on.
    """
    if event == 2:
        return task_requested(task, request)
    if event >= 3 and event <= 6:
        return task_replied(task, event, request)
    if event == 1 and task.state == 0:
        return Moved(Task(1, task.request, task.kept), 1)
    if event == 7 and task.state == 6:
        return Moved(Task(7, task.request, task.kept), 7)
    if (event == 8 or event == 10) and task.state == 7:
        return Moved(Task(8, task.request, task.kept), 8)
    if event == 10 and task.state == 6:
        return Moved(Task(8, task.request, task.kept), 8)
    if event == 9 and task.state >= 2 and task.state <= 5 and request == task.request:
        return Moved(Task(1, task.request, task.kept), 0)
    if event == 11 and (task.state == 1 or task.state == 8):
        if task.kept != 0:
            return Moved(Task(2, task.kept, 0), 2)
        return Moved(Task(1, task.request, 0), 0)
    return Moved(task, 0)
