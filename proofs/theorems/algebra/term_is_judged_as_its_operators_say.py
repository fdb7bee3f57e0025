"""For every term and all times, the kernels find that it was done as it permits, and that it is done whole,
exactly if its operators say so of its tasks: by induction on the term, under whatever windows, orders
and sets of tasks begun its nodes have."""

from typing import Any

from cratous.core.algebra.steps import (
    NOTHING,
    Held,
    Operands,
    Part,
    Ran,
    Window,
    operand_added,
    operands_result,
    task_held,
)
from cratous.proofs.claim import Claim
from cratous.proofs.methods.terms import every_term
from cratous.spec.algebra import operators


def claim(c: Claim) -> None:
    ran = Ran(c.boolean("task.some"), c.integer("task.start"), c.integer("task.end"))
    window, needed = Window(c.whole("first"), c.whole("last")), c.boolean("needed")
    c.premise(c.all_of(window.first >= -(2**62), window.first <= 2**62))
    c.premise(c.all_of(window.last >= -(2**62), window.last <= 2**62))
    op, fits = c.integer("op"), c.boolean("fits")
    of_operand = Ran(c.boolean("some"), c.integer("start"), c.integer("end"))

    def held(name: str) -> Any:
        return Held(c.boolean(f"{name}.allowed"), c.boolean(f"{name}.whole"))

    def operands(name: str) -> Any:
        before = Ran(c.boolean(f"{name}.some"), c.whole(f"{name}.start"), c.whole(f"{name}.end"))
        last = Part(
            c.boolean(f"{name}.fits"),
            c.boolean(f"{name}.last"),
            c.boolean(f"{name}.last_whole"),
            before,
        )
        return Operands(
            c.boolean(f"{name}.none"),
            c.boolean(f"{name}.allowed"),
            c.boolean(f"{name}.whole"),
            last,
        )

    def part(value: Any) -> Any:
        return Part(fits, value.allowed, value.whole, of_operand)

    def added(model: Any, value: Any) -> Any:
        # the operand's start is the instant that shows whether it waited (see `lets_begin`)
        one = part(value)
        given = (op, model.first, model.allowed, model.before, one)
        allowed = c.define(operators.allowed_with, of_operand.start, *given)
        whole = c.define(operators.whole_with, op, model.first, model.whole, one)
        return Operands(False, allowed, whole, one)

    # start and end are the instants that show whether a task kept to its window
    at_start = c.define(operators.task_is_held, ran.start, ran.start, needed, ran, window)
    at_end = c.define(operators.task_is_held, ran.start, ran.end, needed, ran, window)
    judged = Held(c.use(task_held, needed, ran, window), ran.some)
    every_term(
        c,
        task=(judged, Held(c.all_of(at_start, at_end), ran.some)),
        none=(NOTHING, NOTHING),
        so_far=(operands("known"), operands("meant")),
        operand=(held("operand"), held("meaning")),
        add=(lambda value, operand: c.use(operand_added, value, part(operand), op), added),
        whole=(
            lambda value: c.use(operands_result, value),
            lambda value: Held(value.allowed, value.whole),
        ),
        related=c.same,
        alike=c.same,
        node=(op, fits, of_operand),
        text="a term",
    )
