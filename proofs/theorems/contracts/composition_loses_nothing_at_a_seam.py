"""What one planning service publishes is what the next one waits for, at every seam: a published
request starts each of its tasks, whatever they were doing; sensor footprints, routes, options, the
matrix, the assignment, each task's part and the plan follow one from the other; and the plan reaches
the line while it waits for it, so that it is passed on; for any number of tasks."""

from cratous.core.contracts.building import Building, building_step
from cratous.core.contracts.checklists import collector_step
from cratous.core.contracts.requests import Line, line_step
from cratous.core.contracts.tasks import Task, task_step
from cratous.proofs.claim import Claim
from cratous.spec.contracts import tasks


def claim(c: Claim) -> None:
    line = Line(c.integer("taken"), c.integer("answered"), c.boolean("busy"), c.integer("sent_ms"))
    now, later, limit = c.integer("now_ms"), c.integer("later_ms"), c.integer("limit_ms")
    c.premise(c.all_of(line.answered >= 0, line.answered < line.taken, line.taken <= 2**60))
    c.premise(c.negation(line.busy))
    out = c.use(line_step, line, 3, 0, now, limit)
    c.show(c.all_of(out.act == 2, out.ticket == line.answered), "the line publishes")
    # the id of a request is its ticket plus one; every task has only seen earlier ones
    request = out.ticket + 1
    task = Task(c.integer("state"), c.integer("request"), c.integer("kept"))
    c.premise(c.all_of(task.state >= 1, task.state <= 8))
    c.premise(c.all_of(task.request >= 0, task.request < request))
    c.premise(c.all_of(task.kept >= 0, task.kept < request))
    told = c.use(task_step, task, tasks.REQUESTED, request)
    at_once = told.act == tasks.ASK_SENSORS
    on = c.use(task_step, told.task, tasks.PROCEED, request)
    begun = c.when(at_once, told.task, on.task)
    c.show(c.any_of(at_once, on.act == tasks.ASK_SENSORS), "the task begins")
    c.show(c.all_of(begun.state == 2, begun.request == request, begun.kept == 0), "with this one")
    routes = c.use(task_step, Task(2, request, 0), tasks.SENSORS_KNOWN, request)
    c.show(routes.act == tasks.ASK_ROUTES, "footprints lead to routes")
    options = c.use(task_step, routes.task, tasks.ROUTES_KNOWN, request)
    c.show(options.act == tasks.PUBLISH_OPTIONS, "routes lead to options")
    asked = c.use(collector_step, 1, True, c.boolean("some_routes"))
    c.show(c.all_of(asked.act == 1, asked.stage == 2), "the last options lead to routes between")
    handed = c.use(collector_step, asked.stage, True, True)
    c.show(c.all_of(handed.act == 2, handed.stage == 3), "the last routes lead to the matrix")
    count = c.integer("count")
    c.premise(c.all_of(count >= 1, count <= 2**60))
    first = c.use(building_step, Building(0, 0, 0), 1, count)
    c.show(c.all_of(first.act == 1, first.part == 0), "the assignment leads to the first part")
    chosen = c.use(task_step, options.task, tasks.CHOSEN, request)
    c.show(chosen.act == tasks.ASK_FINAL, "its task asks for final routes")
    planned = c.use(task_step, chosen.task, tasks.FINAL_KNOWN, request)
    c.show(planned.act == tasks.PUBLISH_PLAN, "and publishes its part")
    at = c.integer("at")
    c.premise(c.all_of(at >= 0, at < count))
    part = c.use(building_step, Building(1, count, at), 2, at)
    c.show(part.done, "which is awaited")
    asks = c.all_of(part.act == 1, part.part == at + 1, part.building.at == at + 1)
    c.show(c.implies(at + 1 < count, asks), "the next part is asked for")
    c.show(c.implies(at + 1 == count, part.act == 2), "the last one leads to the plan")
    answer = c.use(line_step, out.line, 2, request - 1, later, limit)
    passed = c.all_of(answer.act == 3, answer.ticket == out.ticket)
    c.show(c.all_of(passed, c.negation(answer.line.busy)), "the plan is passed on")
    c.show(answer.line.answered == line.answered + 1, "and the line is free for the next")
