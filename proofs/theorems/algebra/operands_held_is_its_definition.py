"""A term with any number of operands was done as it permits exactly if its operands were: of `+` one that
has all tasks that were begun, else each, at no instant begun before the operand before lets it; and it is
done whole if one such operand of `+`, or else each, is. This is the step of the induction over a
term, from the operands to the whole."""

from typing import Any

from cratous.core.algebra.steps import NOTHING, Operands, Part, Ran, operand_added, operands_held
from cratous.proofs.claim import Claim
from cratous.spec.algebra.operators import allowed_with, whole_with


def model_step(model: Any, part: Any, op: Any) -> Any:
    # the operand's start is the instant that shows whether it waited
    first, allowed, whole, before = model
    allowed = allowed_with(part.ran.start, op, first, allowed, before, part)
    return Operands(False, allowed, whole_with(op, first, whole, part), part)


def model_result(model: Any) -> Any:
    return (model.allowed, model.whole)


def part_of(c: Claim, name: str) -> Part:
    ran = Ran(c.boolean(f"{name}.some"), c.whole(f"{name}.start"), c.whole(f"{name}.end"))
    fits, allowed = c.boolean(f"{name}.fits"), c.boolean(f"{name}.allowed")
    return Part(fits, allowed, c.boolean(f"{name}.whole"), ran)


def so_far(c: Claim, name: str) -> Operands:
    first, allowed = c.boolean(f"{name}.first"), c.boolean(f"{name}.all")
    return Operands(first, allowed, c.boolean(f"{name}.every"), part_of(c, name))


def claim(c: Claim) -> None:
    op, t, part = c.integer("op"), c.whole("t"), part_of(c, "part")
    known = so_far(c, "known")
    after = c.use(operand_added, known, part, op)
    given = (op, known.first, known.allowed, known.before, part)
    at_t = c.define(allowed_with, t, *given)
    at_start = c.define(allowed_with, part.ran.start, *given)
    c.show(c.implies(after.allowed, at_t), "if it was, it is seen at every instant")
    c.show(c.implies(at_start, after.allowed), "if not, the operand's start shows it")
    whole = c.define(whole_with, op, known.first, known.whole, part)
    c.show(c.same(after.whole, whole), "whether it is done whole")
    c.fold(
        operands_held,
        acc=so_far(c, "acc"),
        model=so_far(c, "model"),
        item=(part,),
        context=(op,),
        model_start=NOTHING,
        model_step=model_step,
        model_finish=model_result,
        relation=c.same,
    )
