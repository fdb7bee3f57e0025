"""At how many samples a requirement asked something: where what it depends on is not so it asks nothing."""

from __future__ import annotations

from dataclasses import replace

from cratous.services.requirements.formula import Formula, Join, Not
from cratous.services.requirements.specification import Requirement, Specification


def depends_on(one: Requirement) -> Formula | None:
    """For `a implies b` the condition a; for any other form none."""
    formula = one.formula
    if isinstance(formula, Join) and not formula.is_and and isinstance(formula.phi, Not):
        return formula.phi.phi
    return None


def with_asked(spec: Specification) -> Specification:
    """The same requirements, and behind them what each of them depends on, under its name."""
    asked = [
        Requirement(one.name, "", antecedent)
        for one in spec.requirements
        if (antecedent := depends_on(one)) is not None
    ]
    return replace(spec, requirements=(*spec.requirements, *asked))
