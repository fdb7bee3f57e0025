"""For theorems on traces: an arbitrary sample, the query, and that a fold judges the sample as defined."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cratous.core.kernel import Fold
from cratous.proofs.claim import Claim
from cratous.spec.requirements.operators import Meant

START = -(2**62)
"""A time before every sample."""

Three = tuple[Any, Any, Any]


def any_sample(c: Claim) -> tuple[Three, Three]:
    """An arbitrary sample `time`, `phi`, `psi` with verdicts 0 to 2; arbitrary `at`, and `low` <= `high` from 0."""
    time, phi, psi = c.integer("time"), c.integer("phi"), c.integer("psi")
    at, low, high = c.integer("at"), c.integer("low"), c.integer("high")
    for verdict in (phi, psi):
        c.premise(verdict >= 0)
        c.premise(verdict <= 2)
    c.premise(low >= 0)
    c.premise(low <= high)
    return (time, phi, psi), (at, low, high)


def judged_as_meant(
    c: Claim,
    kernel: Fold[Any],
    acc: Any,
    step: Callable[..., Any],
    relation: Callable[[Any, Any], Any],
    asked: tuple[Three, Three],
) -> None:
    """Show by induction that a fold over a trace judges its samples as the definition does.

    acc: an arbitrary accumulator of the fold; step: of the definition; relation: between acc and the definition's own
    state, after any number of samples; asked: the sample, and the query.
    """
    sample, context = asked
    c.fold(
        kernel,
        acc=acc,
        model=Meant(c.whole("model_last"), c.whole("hold"), c.whole("value")),
        item=sample,
        context=context,
        model_start=Meant(START, 2, 0),
        model_step=step,
        model_finish=lambda m: m.value,
        relation=relation,
    )
