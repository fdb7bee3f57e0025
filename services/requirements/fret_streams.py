"""Previous-sample operators of FRET definitions, in Lustre, for counted samples: `a -> b`, `pre a`,
`if c then a else b`, on numbers and truth values. A `pre` needs a value at the first sample: by
`->`.
"""

from __future__ import annotations

from typing import Any

from cratous.services.requirements import formula as formulas
from cratous.services.requirements.arithmetic import (
    AND,
    BEFORE,
    BEGINS,
    CHOICE,
    NAMED,
    NOT,
    OR,
    REACHES,
    Side,
    Term,
)
from cratous.services.requirements.formula import Always, Bounded, Formula, Join, Not, Reaches
from cratous.services.requirements.fret_nodes import LONGEST
from cratous.services.requirements.fret_terms import EARLIER, EVER, TRUTHS, Names, Wrong, value_in
from cratous.services.requirements.units import Quantity


def stream(node: Any, got: list[Any], names: Names) -> Any:
    """The formula or term of a node of `STREAMS`; Wrong if samples are not counted, if its parts
    are of different kinds, or if it is too long.
    """
    at = int(node.meta.start_pos)
    if not names.counted:
        raise Wrong("samples have times, so none is the one before", at)
    kind, sides = str(node.data), list(got)
    choice = [sides.pop(0)] if kind == "choice" else []
    truths = [isinstance(side, TRUTHS) for side in sides]
    if any(truths) != all(truths):
        raise Wrong("a truth value and a number stand for one another", at)
    if all(truths):
        return _truth(kind, choice + sides)
    return _number(kind, choice, sides, names, at)


def _truth(kind: str, got: list[Formula]) -> Formula:
    if kind == "before":
        return formulas.once(got[0], 1, 1)
    chosen, one, other = got if kind == "choice" else (Not(EARLIER), *got)
    return Join(Join(chosen, one, True), Join(Not(chosen), other, True), False)


def _number(kind: str, choice: list[Any], sides: list[Any], names: Names, at: int) -> Term:
    units = [_unit(side, names) for side in sides]
    unit = next(filter(None, units), "")
    if any(
        one != unit
        for one, side in zip(units, sides, strict=True)
        if not isinstance(side, Quantity)
    ):
        raise Wrong("numbers of two units stand for one another", at)
    whole = all(_is_whole(side, names) for side in sides)
    made = [value_in(one, unit, at) if isinstance(one, Quantity) else one for one in sides]
    said = [one.text if isinstance(one, Term) else str(one) for one in made]
    if kind == "before":
        return _short(Term(BEFORE, tuple(made), f"(pre {said[0]})", unit, whole), at)
    if kind == "begins":
        return _short(Term(BEGINS, tuple(made), f"({said[0]} -> {said[1]})", unit, whole), at)
    chosen = truth_side(choice[0], names, at)
    head = f"if {chosen.text if isinstance(chosen, Term) else chosen}"
    text = f"({head} then {said[0]} else {said[1]})"
    return _short(Term(CHOICE, (chosen, *made), text, unit, whole), at)


def _short(term: Term, at: int) -> Term:
    if len(term.text) > LONGEST:
        raise Wrong("what is calculated is too long", at, f"{LONGEST} characters")
    return term


def _unit(side: Any, names: Names) -> str:
    if isinstance(side, Quantity | Term):
        return side.unit
    return names.signals[side].unit


def _is_whole(side: Any, names: Names) -> bool:
    if isinstance(side, Quantity):
        return side.value.denominator == 1 and not {".", "e", "E"} & set(side.text)
    return side.whole if isinstance(side, Term) else names.signals[side].kind == "int"


def truth_side(phi: Formula, names: Names, at: int) -> Side:
    """A formula over this sample and the previous one as a numeric side: 1 where it holds, otherwise 0."""
    made: dict[int, Side] = {}
    for one in formulas.parts(phi):  # children before parents
        below = [made[id(child)] for child in formulas.children(one)]
        made[id(one)] = _side(one, below, names, at)
    return made[id(phi)]


def _side(one: Formula, below: list[Side], names: Names, at: int) -> Side:
    if isinstance(one, Always):
        return float(one.verdict == 2)
    if isinstance(one, Reaches):
        sides = [_calculated(side, names) for side in (one.left, one.right)]
        if isinstance(one.left, str) and names.signals[one.left].kind == "bool":
            return sides[0]
        return _joined(REACHES, sides, ">=", at)
    if isinstance(one, Not):
        return _short(Term(NOT, (below[0],), f"(not {_said(below[0])})", "", True), at)
    if isinstance(one, Join):
        return _joined(*((AND, below, "and") if one.is_and else (OR, below, "or")), at)
    is_last = isinstance(one, Bounded) and one.past and one.phi == formulas.TRUE
    if is_last and (one.low, one.high) == (1, 1):
        before = Term(BEFORE, (below[1],), f"(pre {_said(below[1])})", "", True)
        return _short(Term(BEGINS, (0.0, before), f"(0.0 -> {before.text})", "", True), at)
    if is_last and (one.low, one.high) == (1, EVER) and one.psi == formulas.TRUE:
        return Term(BEGINS, (0.0, 1.0), "(0.0 -> 1.0)", "", True)
    raise Wrong("a condition looks further back than one sample", at)


def _joined(kind: str, sides: list[Side], sign: str, at: int) -> Side:
    text = f"({_said(sides[0])} {sign} {_said(sides[1])})"
    return _short(Term(kind, tuple(sides), text, "", True), at)


def _calculated(side: str | float, names: Names) -> Side:
    """A side of a comparison, with a computed signal replaced by its term."""
    made = names.signals[side].made if isinstance(side, str) else None
    return side if made is None else made


def _said(side: Side) -> str:
    return side.text if isinstance(side, Term) else str(side)


def named(name: str, term: Term) -> Term:
    """A term that refers to its own previous value by its name."""
    return Term(NAMED, (term,), name, term.unit, term.whole)


def begun(tree: Any) -> None:
    """Wrong if a `pre` has no value at the first sample."""
    late: dict[int, bool] = {}
    for node in tree.iter_subtrees():  # children before parents
        below = [late[id(child)] for child in node.children if hasattr(child, "data")]
        kind = str(node.data)
        if (kind == "before" and any(below)) or (kind in ("begins", "start") and below[0]):
            expected = "a value before ->"
            raise Wrong(
                "`pre` has no value at the first sample", int(node.meta.start_pos), expected
            )
        late[id(node)] = kind == "before" or (kind != "begins" and any(below))


def only_before(tree: Any, name: str) -> bool:
    """True if a name occurs only under `pre`, and as a number."""
    todo = [(tree, False)]
    while todo:
        node, late = todo.pop()
        kind = str(node.data)
        is_it = kind in ("truth", "name") and str(node.children[0]) == name
        if is_it and (kind == "truth" or not late):
            return False
        late = late or kind == "before"
        todo += [(child, late) for child in node.children if hasattr(child, "data")]
    return True
