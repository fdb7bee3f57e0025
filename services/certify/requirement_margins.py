"""How close the comparisons of a user requirement came to their bounds, in the unit of their signals."""

from __future__ import annotations

from typing import Any

from cratous.services.requirements.formula import Formula, Join, Not, Reaches
from cratous.services.requirements.outcome import Margin, Outcome
from cratous.services.requirements.specification import NotRead

Data = dict[str, Any]


def margins(one: Outcome) -> list[Data]:
    """Least and greatest difference of the two sides of each comparison; None where never defined."""
    return [
        {
            "of": f"{m.left} - {_side(m)}",
            "unit": m.unit,
            "least": m.least if m.at >= 0 else None,
            "least_s": m.at / 1e9 if m.at >= 0 else None,
            "greatest": m.greatest if m.at >= 0 else None,
            "greatest_s": m.greatest_at / 1e9 if m.at >= 0 else None,
        }
        for m in one.margins
    ]


def _side(margin: Margin) -> str:
    if isinstance(margin.right, str):
        return margin.right
    return f"{margin.right:g}" + ("" if margin.unit == "1" else f" {margin.unit}")


def least_margin(one: Outcome) -> tuple[float | None, str]:
    """For a requirement that is a conjunction of comparisons in one unit: the worst margin over all
    samples, negative if violated, and its unit; otherwise (None, "").
    """
    formula = one.requirement.formula
    asked = [] if isinstance(formula, NotRead) else _asked(formula)
    by_sides = {frozenset((m.left, m.right)): m for m in one.margins}
    found: list[float] = []
    units: set[str] = set()
    for low, high in asked or ():
        margin = by_sides.get(frozenset((low, high)))
        if margin is None or margin.at < 0:
            return None, ""
        units.add(margin.unit)
        found.append(margin.least if margin.right == low else -margin.greatest)
    return (min(found), units.pop()) if len(units) == 1 else (None, "")


def _asked(formula: Formula) -> list[tuple[str | float, str | float]] | None:
    """Pairs of sides of which the second has to reach or exceed the first; None for any other formula."""
    found: list[tuple[str | float, str | float]] = []
    todo: list[Formula] = [formula]
    while todo:
        one = todo.pop()
        if isinstance(one, Reaches):
            found.append((one.right, one.left))
        elif isinstance(one, Not) and isinstance(one.phi, Reaches):
            found.append((one.phi.left, one.phi.right))
        elif isinstance(one, Not) and isinstance(one.phi, Not):
            todo.append(one.phi.phi)
        elif isinstance(one, Join) and one.is_and:
            todo += [one.phi, one.psi]
        else:
            return None
    return found
