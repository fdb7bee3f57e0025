"""A formula of FRET's export as a requirement on every sample. Grammar: `fret.lark`.

FRET evaluates a formula once: at the first sample if it is future-time (`ft`), at the last if
past-time (`pt`). So `G phi`, `LAST V phi` and `H phi` require phi at every sample, and any other
future-time formula applies to the first sample only. Unbounded operators are accepted in past time;
in future time they are refused, as no sample decides them.
"""

from __future__ import annotations

from functools import cache, reduce
from typing import TYPE_CHECKING, Any, NamedTuple

from cratous.services.requirements import formula as formulas
from cratous.services.requirements.fret_nodes import term, tree_of
from cratous.services.requirements.fret_terms import EARLIER, EVER, Names, Wrong, grammar
from cratous.spec.files.limits import integer_of

if TYPE_CHECKING:
    from lark import Lark

MAX_BOUND = 10**9
FIRST = formulas.Not(EARLIER)


class Kind(NamedTuple):
    """ahead: the formula is evaluated at the first sample, otherwise at the last; counted: a bound
    is a number of samples, otherwise samples have times, and bounds and the previous sample are
    refused; next: X is allowed.
    """

    ahead: bool
    counted: bool
    next: bool


def asked(text: str, names: Names, kind: Kind) -> formulas.Formula:
    """The requirement that a formula expresses; Wrong, with the position, if it cannot be expressed."""
    tree = tree_of(_parser(), text, "FRET's formulas")
    for node in tree.iter_subtrees():  # children before parents
        node.made = _made(node, names, kind)
    if tree.children[0].data == "constant":  # FRET's output where it has no formula
        raise Wrong("the formula says nothing of any sample", 0, got=text)
    return _top(tree.children[0], kind)


def _top(tree: Any, kind: Kind) -> formulas.Formula:
    """The per-sample requirement for a formula that FRET evaluates once."""
    todo, found = [tree], []
    while todo:
        node = todo.pop()
        if node.data == "both" and (edge := _edge(kind, *node.children)) is not None:
            found.append(edge)
        elif node.data == "both":
            todo += reversed(node.children)
        elif (inner := _under(node, kind)) is not None:
            found.append(_sure(inner.made))
        elif kind.ahead:
            found.append(formulas.Join(EARLIER, _sure(node.made), False))
        else:
            raise Wrong("it is asked of the last sample alone", node.meta.start_pos, "H ...")
    return reduce(lambda a, b: formulas.Join(a, b, True), found)


def _edge(kind: Kind, turns: Any, begins: Any) -> formulas.Formula | None:
    """For `G ((!c & X c) -> X phi) & (c -> phi)`: phi at each sample at which c becomes true; otherwise None."""
    inner = _under(turns, kind)
    if inner is None or not (inner.data == begins.data == "implies") or not kind.counted:
        return None
    before, after = inner.children
    c, phi = begins.children
    if before.data != "both" or before.children[0].data != "negation":
        return None
    later = [before.children[1], after]
    if any(one.data != "unary" or one.children[0] != "X" for one in later):
        return None
    pairs = [(before.children[0].children[0], c), (later[0].children[1], c),
             (later[1].children[-1], phi)]  # fmt: skip
    sides = [(_sure(a.made), _sure(b.made)) for a, b in pairs]
    if not all(formulas.same(*pair) for pair in sides):
        return None
    return formulas.implies(became(c.made), phi.made)


def became(c: formulas.Formula) -> formulas.Formula:
    """c holds but did not at the previous sample, or there is none; only for counted samples."""
    return formulas.Join(c, formulas.Not(formulas.once(c, 1, 1)), True)


def _under(node: Any, kind: Kind) -> Any:
    """The part that has to hold at every sample; None if the formula has no such form."""
    if node.data == "unary" and len(node.children) == 2:
        return node.children[1] if node.children[0] == ("G" if kind.ahead else "H") else None
    if node.data == "binary" and len(node.children) == 3 and kind.ahead:
        left, operator, right = node.children
        is_last = left.data == "truth" and left.children[0] == "LAST"
        return right if is_last and operator == "V" else None
    return None


def _sure(made: Any) -> formulas.Formula:
    if isinstance(made, Wrong):
        raise made
    found: formulas.Formula = made
    return found


def _made(node: Any, names: Names, kind: Kind) -> Any:
    """The formula of a node, or the reason why there is none, raised only if the node is used."""
    got = [getattr(child, "made", child) for child in node.children]
    if node.data == "either" and _is_more(kind, *node.children):
        return got[0]
    wrong = next((one for one in got if isinstance(one, Wrong)), None)
    if wrong is not None:
        return wrong
    try:
        return _node(node, got, names, kind)
    except Wrong as no:
        return no


def _is_more(kind: Kind, some: Any, whole: Any) -> bool:
    """For `G[0,5] phi | G phi`: the second implies the first, so the disjunction equals the first."""
    inner = _under(whole, kind)
    if inner is None or isinstance(some.made, Wrong) or isinstance(inner.made, Wrong):
        return False
    is_some = some.data == "unary" and some.children[0] == "G" and len(some.children) > 2
    return is_some and formulas.same(some.children[2].made, inner.made)


def _node(node: Any, got: list[Any], names: Names, kind: Kind) -> Any:
    data = str(node.data)
    if data == "start":
        return None
    if data in ("between", "up_to"):
        return _bounds(data, got)
    if data == "unary":
        return _unary(got, kind)
    if data == "binary":
        return _binary(got, kind)
    if data == "truth" and got[0] == "FTP":
        return FIRST
    if data == "truth" and got[0] == "LAST":
        raise Wrong("no sample is known to be the last", got[0].start_pos, got="LAST")
    return term(data, got, names, int(node.meta.start_pos))


def _bounds(data: str, tokens: list[Any]) -> tuple[int, int]:
    relation = "" if data == "between" else str(tokens.pop(0))
    values = []
    for token in tokens:
        value = integer_of(str(token), 0, MAX_BOUND)
        if value is None:
            raise Wrong("a bound is too large", token.start_pos, f"up to {MAX_BOUND}", str(token))
        values.append(value)
    last = values[-1] - (relation == "<")
    low = last if relation == "=" else 0 if relation else values[0]
    if low > last or relation not in ("", "<", "<=", "="):
        got = " ".join([relation, *map(str, values)])
        raise Wrong("these bounds are empty or none", tokens[0].start_pos, "[0,5] or [<=5]", got)
    return low, last


def _unary(got: list[Any], kind: Kind) -> formulas.Formula:
    operator, phi = got[0], got[-1]
    at = operator.start_pos
    if operator in ("X", "Y", "Z"):
        if len(got) > 2:
            raise Wrong("one sample on has no bounds", at, got=str(operator))
        # with or without a previous sample: also valid for samples with times
        if operator == "Y" and phi == formulas.TRUE:
            return EARLIER
        if operator == "Z" and phi == formulas.FALSE:
            return FIRST
        if not kind.counted:
            raise Wrong("samples have times, so none is the next one", at, got=str(operator))
        if operator == "X" and not kind.next:
            raise Wrong("what is asked of the sample before has another formula", at, got="X")
        if operator == "Z":
            return formulas.Not(formulas.once(formulas.Not(phi), 1, 1))
        return (formulas.eventually if operator == "X" else formulas.once)(phi, 1, 1)
    low, high = _within(got[1] if len(got) > 2 else None, operator, kind)
    made = {
        "G": formulas.globally, "F": formulas.eventually,
        "H": formulas.historically, "O": formulas.once,
    }  # fmt: skip
    return made[str(operator)](phi, low, high)


def _binary(got: list[Any], kind: Kind) -> formulas.Formula:
    phi, operator, psi = got[0], got[1], got[-1]
    low, high = _within(got[2] if len(got) > 3 else None, operator, kind)
    if low:
        what = "of a bound above 0 it is not sure from where the first side counts"
        raise Wrong(what, operator.start_pos, f"{operator}[0,{high}]")
    is_dual = operator in ("V", "T")
    if is_dual:
        phi, psi = formulas.Not(phi), formulas.Not(psi)
    made = formulas.Bounded(phi, psi, 0, high, operator in ("S", "T"))
    return formulas.Not(made) if is_dual else made


def _within(bounds: tuple[int, int] | None, operator: Any, kind: Kind) -> tuple[int, int]:
    at = operator.start_pos
    if bounds is None:
        if operator in ("G", "F", "U", "V"):
            raise Wrong(
                "what is ahead has no bound, so no sample decides it", at, got=str(operator)
            )
        return 0, EVER
    if not kind.counted:
        what = "its bounds count time points, and samples have times: the formula has no unit"
        raise Wrong(what, at, got=f"{operator}[{bounds[0]},{bounds[1]}]")
    return bounds


@cache
def _parser() -> Lark:
    return grammar("fret.lark")
