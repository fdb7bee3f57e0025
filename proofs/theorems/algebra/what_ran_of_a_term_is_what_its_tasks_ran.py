"""For every term, at every instant some task of it has begun, and all of it that ever runs has ended, exactly as
the earliest start and the latest end say that the kernel finds; by induction on the term."""

from typing import Any

from cratous.core.algebra.steps import Ran, ran_with
from cratous.proofs.claim import Claim
from cratous.proofs.methods.terms import every_term
from cratous.spec.algebra.operators import Seen, seen


def claim(c: Claim) -> None:
    t, ran = c.integer("t"), c.boolean("ran")
    start, end = c.integer("start"), c.integer("end")

    def ran_of(name: str) -> Any:
        return Ran(c.boolean(f"{name}.some"), c.whole(f"{name}.start"), c.whole(f"{name}.end"))

    def seen_of(name: str) -> Any:
        return Seen(c.boolean(f"{name}.begun"), c.boolean(f"{name}.ended"))

    def together(one: Any, other: Any) -> Any:
        # some task of several terms has begun if one of any has; all have ended if those of each have
        return Seen(c.any_of(one.begun, other.begun), c.all_of(one.ended, other.ended))

    def related(value: Any, meaning: Any) -> Any:
        return c.same(c.define(seen, t, value), meaning)

    task_begun, task_ended = c.all_of(ran, start <= t), c.any_of(c.negation(ran), end <= t)
    every_term(
        c,
        task=(Ran(ran, start, end), Seen(task_begun, task_ended)),
        none=(Ran(False, 0, 0), Seen(False, True)),
        so_far=(ran_of("before"), seen_of("seen_before")),
        operand=(ran_of("operand"), seen_of("seen_operand")),
        add=(lambda value, operand: c.use(ran_with, value, operand), together),
        whole=(lambda value: value, lambda value: value),
        related=related,
        alike=related,
        node=(),
        text="what ran",
    )
