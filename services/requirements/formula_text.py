"""A part of a formula as text in the requirements language."""

from __future__ import annotations

from collections.abc import Sequence

from cratous.services.requirements import formula as form
from cratous.services.requirements.specification import Specification
from cratous.services.requirements.violating_parts import Part

DEEPEST, LONGEST, HELD = 5, 300, 2
LOOSE = ("and", "or", "implies", "until", "since", "within", "from")
"""Operators with unobvious precedence: parts that contain one get parentheses."""
UNKNOWN = form.Always(1)
UNITS = ((60 * 10**9, "min"), (10**9, "s"), (10**6, "ms"), (1000, "us"), (1, "ns"))


def said(formula: form.Formula, spec: Specification, level: int = 0) -> str:
    """The text of a formula; parts that are too deep or too long become `...`."""
    if level > DEEPEST:
        return "..."
    while isinstance(formula, form.Not) and isinstance(formula.phi, form.Not):
        formula = formula.phi.phi
    text = _said(formula, spec, level)
    return text if len(text) <= LONGEST else "..."


def facts(parts: Sequence[Part], spec: Specification) -> list[str]:
    """The parts that cause a violation, each as a formula that held."""
    texts = (said(part if verdict == HELD else form.Not(part), spec) for part, verdict in parts)
    return list(dict.fromkeys(texts))


def _said(formula: form.Formula, spec: Specification, level: int) -> str:
    if isinstance(formula, form.Always):
        return "true" if formula == form.TRUE else "false"
    if isinstance(formula, form.Reaches):
        return _compared(formula, ">=", spec)
    if _is_earlier(formula):
        return "this is not the first sample"
    if isinstance(formula, form.Bounded):
        return _timed(formula, spec, level, always=False)
    if isinstance(formula, form.Join):
        if isinstance(formula.psi, form.Join) and formula.psi.psi == UNKNOWN:
            return said(formula.phi, spec, level)  # rewritten with a margin: print the original
        left, word = formula.phi, "and" if formula.is_and else "or"
        if not formula.is_and and isinstance(left, form.Not):
            left, word = left.phi, "implies"
        return f"{_inner(left, spec, level)} {word} {_inner(formula.psi, spec, level)}"
    one = formula.phi
    if isinstance(one, form.Reaches) and not _is_truth(one, spec):
        return _compared(one, "<", spec)
    if _is_earlier(one):
        return "this is the first sample"
    if isinstance(one, form.Bounded) and one.phi == form.TRUE and isinstance(one.psi, form.Not):
        return _timed(one, spec, level, always=True)
    return f"not {_inner(one, spec, level)}"


def _is_earlier(one: form.Formula) -> bool:
    """Whether this is the formula for "there is a previous sample" of FRET's import."""
    return isinstance(one, form.Bounded) and form.same(one, form.once(form.TRUE, 1, form.MAX_TIME))


def _inner(formula: form.Formula, spec: Specification, level: int) -> str:
    text = said(formula, spec, level + 1)
    return f"({text})" if any(f" {word} " in text for word in LOOSE) else text


def _timed(one: form.Bounded, spec: Specification, level: int, always: bool) -> str:
    if always and isinstance(one.psi, form.Not):
        word = "historically" if one.past else "always"
        return f"{word} {_window(one, spec)} {_inner(one.psi.phi, spec, level)}"
    psi = _inner(one.psi, spec, level)
    if one.phi == form.TRUE:
        return f"{'once' if one.past else 'eventually'} {_window(one, spec)} {psi}"
    word = "since" if one.past else "until"
    return f"{_inner(one.phi, spec, level)} {word} {_window(one, spec)} {psi}"


def _window(one: form.Bounded, spec: Specification) -> str:
    high = _time(one.high, spec)
    return f"from {_time(one.low, spec)} to {high}" if one.low else f"within {high}"


def _time(time: int, spec: Specification) -> str:
    if time == form.MAX_TIME:  # the bound of operators without one
        return "all time"
    if not spec.timed:
        return f"{time} samples"
    size, unit = next(((s, u) for s, u in UNITS if time and time % s == 0), UNITS[1])
    return f"{time // size} {unit}"


def _compared(one: form.Reaches, relation: str, spec: Specification) -> str:
    if _is_truth(one, spec):
        return str(one.left)
    left, right = one.left, one.right
    if not isinstance(left, str):  # put the signal first
        left, right, relation = right, left, {">=": "<=", "<": ">"}[relation]
    unit = spec.signals[str(left)].unit
    number = "" if isinstance(right, str) or unit in ("", "1") else f" {unit}"
    side = right if isinstance(right, str) else f"{right:.9g}"
    return f"{left} {relation} {side}{number}"


def _is_truth(one: form.Reaches, spec: Specification) -> bool:
    return isinstance(one.left, str) and spec.signals[one.left].kind == "bool"
