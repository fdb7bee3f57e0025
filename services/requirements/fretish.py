"""Writes requirements in FRETish, the structured English of FRET (NASA), where they have that form.

A requirement applies to every sample. So `c implies eventually within 5 s r` is `Whenever c the
system shall within 5 seconds satisfy r`: FRET's `whenever` applies at each instant at which c holds
(`when`, at each beginning), `within` means no later than, `for` throughout. FRETish has no units
and no unknown values: numbers are in the units of their signals.
"""

from __future__ import annotations

import re

from cratous.services.requirements.arithmetic import ONE, PRE, TWO, sources, terms
from cratous.services.requirements.formula import TRUE, Always, Bounded, Formula, Join, Not, Reaches
from cratous.services.requirements.specification import Specification

SYSTEM = "the system"
UNITS = ((3_600_000_000_000, "hours"), (60_000_000_000, "minutes"), (1_000_000_000, "seconds"),
         (1_000_000, "milliseconds"), (1000, "microseconds"))  # fmt: skip
"""The largest unit that gives an integer is used; FRETish has no finer one."""
WORDS = re.compile(
    r"after|always|and|at|before|during|eventually|except|false|for|hours?|if|immediately|in|is|(micro|milli)?(sec|second)s?|"
    r"minutes?|mode?|never|next|not|only|or|satisfy|shall|the|then|ticks?|timepoint|true|unless|until|upon|when|whenever|"
    r"where|while|within|xor",
    re.IGNORECASE,
)
"""Reserved words of FRETish: no signal can have these names."""
SAID = {*ONE, *TWO, PRE}
"""Kinds of computed numbers that a sentence can contain."""
DEEPEST, LONGEST = 200, 10_000
"""Maximum nesting levels and characters of a condition or response."""


class NoForm(Exception):
    """A formula that cannot be written in FRETish, or not by this module; the reason in words."""


def sentence(formula: Formula, spec: Specification) -> str:
    """The sentence of a requirement; NoForm with the reason if there is none."""
    if isinstance(formula, Join) and not formula.is_and and isinstance(formula.phi, Not):
        condition, asked = _said(formula.phi.phi, spec), formula.psi
        when, plain = f"Whenever {condition} {SYSTEM}", "immediately"
    else:
        when, asked, plain = SYSTEM.capitalize(), formula, "always"
    if isinstance(asked, Bounded) and asked.phi == TRUE and not asked.past:
        timing, response = f"within {_time(asked, spec)}", asked.psi
    elif (
        isinstance(asked, Not)
        and isinstance(asked.phi, Bounded)
        and asked.phi.phi == TRUE
        and isinstance(asked.phi.psi, Not)
        and not asked.phi.past
    ):
        timing, response = f"for {_time(asked.phi, spec)}", asked.phi.psi.phi
    else:
        timing, response = plain, asked
    if plain == "always" and timing != plain:
        # FRETish without a condition applies once, at the beginning
        when = f"Whenever true {SYSTEM}"
    return f"{when} shall {timing} satisfy {_said(response, spec)}"


def _time(timed: Bounded, spec: Specification) -> str:
    if timed.low:
        raise NoForm("a time that begins later has no form")
    if not spec.timed:
        return f"{timed.high} ticks"
    for size, unit in UNITS:
        if timed.high and timed.high % size == 0:
            return f"{timed.high // size} {unit}"
    raise NoForm("its time is no whole number of microseconds above 0")


def _said(formula: Formula, spec: Specification, level: int = 0) -> str:
    """A timeless condition; level: its nesting depth."""
    if level > DEEPEST:
        raise NoForm(f"it is nested more than {DEEPEST} levels deep")
    # `!x > 3` would be ambiguous
    while isinstance(formula, Not) and isinstance(formula.phi, Not):
        formula = formula.phi.phi
    if isinstance(formula, Always):
        return "true" if formula == TRUE else "false"
    if isinstance(formula, Reaches):
        return _compared(formula.left, ">=", formula.right, spec)
    if isinstance(formula, Not):
        one = formula.phi
        if isinstance(one, Reaches) and not _is_truth(one.left, spec):
            return _compared(one.left, "<", one.right, spec)
        return f"!{_said(one, spec, level + 1)}"
    if isinstance(formula, Join):
        sign = " & " if formula.is_and else " | "
        text = _said(formula.phi, spec, level + 1) + sign + _said(formula.psi, spec, level + 1)
        if len(text) > LONGEST:
            raise NoForm(f"its sentence is longer than {LONGEST} characters")
        return f"({text})" if level else text
    raise NoForm("a time within a condition or a response has no form")


def _compared(left: str | float, relation: str, right: str | float, spec: Specification) -> str:
    if _is_truth(left, spec):
        return _side(left, spec)
    if isinstance(left, float):  # FRETish puts the signal first
        turned = {">=": "<=", "<": ">"}[relation]
        return f"{_side(right, spec)} {turned} {_side(left, spec)}"
    return f"{_side(left, spec)} {relation} {_side(right, spec)}"


def _side(side: str | float, spec: Specification) -> str:
    """A signal or a number, whose exponent has no leading zeros."""
    if not isinstance(side, str):
        return re.sub(r"e([-+])0+", r"e\1", repr(side))
    for name in sources([side], spec.signals):
        if WORDS.fullmatch(name) or name.startswith("_") or "." in name:
            raise NoForm(f"FRETish has no signal of the name {name}")
    made = spec.signals[side].made
    if made is not None and any(one.kind not in SAID for one in terms(made)):
        raise NoForm(
            "numbers with units in what is calculated, and what FRET's definitions say in Lustre, have no form"
        )
    return side


def _is_truth(side: str | float, spec: Specification) -> bool:
    return isinstance(side, str) and spec.signals[side].kind == "bool"
