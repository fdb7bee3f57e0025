"""Models that the solver found for earlier questions: where one satisfies a new question, none is asked.

A model answers only that conditions are satisfiable, never that they are not: each condition is evaluated in it, and
must come out true.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

import z3

MOST = 12
"""The most models that are tried for a question."""
DIGITS = 60
"""Models with longer numbers are not kept: arithmetic on them may take longer than asking the solver."""


class Models:
    """The latest models of one context, the one that last served first."""

    def __init__(self) -> None:
        self._kept: deque[z3.ModelRef] = deque(maxlen=MOST)

    def keep(self, model: z3.ModelRef) -> None:
        """Keep a model for later questions, unless its numbers are irrational or long."""
        if all(_is_short(model[value]) for value in model.decls()):
            self._kept.appendleft(model)

    def satisfy(self, conditions: Sequence[z3.BoolRef]) -> bool:
        """Whether a kept model satisfies all of these conditions."""
        for model in self._kept:
            # the last condition is new, the others often hold
            if all(_is_true(model, condition) for condition in reversed(conditions)):
                self._kept.remove(model)
                self._kept.appendleft(model)
                return True
        return False


def _is_true(model: z3.ModelRef, condition: z3.BoolRef) -> bool:
    try:
        found = model.eval(condition, model_completion=True)
    except z3.Z3Exception:  # the context was interrupted, and no question has been put to it since
        return False
    return bool(z3.is_true(found))


def _is_short(value: object) -> bool:
    if not isinstance(value, z3.ExprRef) or z3.is_algebraic_value(value):
        return False  # a function's interpretation, or an irrational number
    return not z3.is_arith(value) or len(value.as_string()) <= DIGITS
