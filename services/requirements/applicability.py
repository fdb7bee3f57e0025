"""Counts the samples at which a requirement `a implies b` applies, that is, at which its condition a holds."""

from __future__ import annotations

from dataclasses import replace

from cratous.services.requirements.formula import Formula, Join, Not
from cratous.services.requirements.specification import Requirement, Specification


def depends_on(one: Requirement) -> Formula | None:
    """For `a implies b` the condition a; None for any other form."""
    formula = one.formula
    if isinstance(formula, Join) and not formula.is_and and isinstance(formula.phi, Not):
        return formula.phi.phi
    return None


def with_asked(spec: Specification) -> Specification:
    """The same requirements, followed by the condition of each that has one, under the requirement's name."""
    asked = [
        Requirement(one.name, "", antecedent)
        for one in spec.requirements
        if (antecedent := depends_on(one)) is not None
    ]
    return replace(spec, requirements=(*spec.requirements, *asked))
