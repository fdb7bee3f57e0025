"""Import of requirements in C2PO, the language of R2U2: the common subset. Grammar: `c2po.lark`.

A time unit is one sample. Mission-time logic evaluates phi of `phi U[a,b] psi` only from the lower
bound on, so it is read as `F[a,a](phi U[0,b-a] psi)`. Other features of C2PO (structures, sets,
definitions, arithmetic, contracts, since with a lower bound above 0) are refused, one requirement
at a time.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cratous.services.requirements import formula as formulas
from cratous.services.requirements import specification
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import CONFIG_BYTES, at_most, integer_of

if TYPE_CHECKING:
    from lark import Lark

MAX_BOUND = 10**9
NESTED = 200
SECTION = re.compile(r"^[ \t]*(INPUT|FTSPEC|PTSPEC|DEFINE|STRUCT|ENUM|ATOMIC)\b", re.MULTILINE)
DECLARED = re.compile(
    r"\s*([A-Za-z_]\w*(?:\s*,\s*[A-Za-z_]\w*)*)\s*:\s*(bool|int|float)\s*", re.ASCII
)
ONE_SIDED: dict[str, Callable[[formulas.Formula, int, int], formulas.Formula]] = {
    "G": formulas.globally,
    "F": formulas.eventually,
    "H": formulas.historically,
    "O": formulas.once,
}


def read(text: str, where: str = "C2PO") -> specification.Specification:
    """The requirements of a text. Raises BadInput if there is none, or if a signal is declared twice."""
    at_most(len(text.encode()), CONFIG_BYTES, "the requirements are too long", where)
    text = re.sub(r"--[^\n]*", lambda m: " " * len(m.group()), text)
    types: dict[str, str] = {}
    found: list[tuple[int, str]] = []
    marks = list(SECTION.finditer(text))
    for mark, following in zip(marks, [*marks[1:], None][: len(marks)], strict=True):
        end = following.start() if following else len(text)
        if mark.group(1) == "INPUT":
            _declare(text, mark.end(), end, types, where)
        elif mark.group(1) in ("FTSPEC", "PTSPEC"):
            found += _pieces(text, mark.end(), end)
    if not found:
        raise BadInput("there is no requirement", where=where, expected="FTSPEC or PTSPEC")
    made = [_requirement(n, at, piece, text, types, where) for n, (at, piece) in enumerate(found)]
    return specification.Specification(
        {name: specification.Signal(kind) for name, kind in types.items()}, tuple(made)
    )


def _pieces(text: str, start: int, end: int) -> Iterator[tuple[int, str]]:
    """(offset, text) of each statement ended by a semicolon, and of the text after the last one."""
    for piece in text[start:end].split(";"):
        if piece.strip():
            yield start + len(piece) - len(piece.lstrip()), piece.strip()
        start += len(piece) + 1


def _declare(text: str, start: int, end: int, types: dict[str, str], where: str) -> None:
    for _, piece in _pieces(text, start, end):
        found = DECLARED.fullmatch(piece)
        if not found:
            continue  # of another type: requirements that use it are refused
        for name in re.split(r"\s*,\s*", found.group(1)):
            if name in types:
                raise BadInput("a signal is declared twice", where=where, item=name)
            types[name] = found.group(2)


def _requirement(
    number: int, at: int, piece: str, text: str, types: dict[str, str], where: str
) -> specification.Requirement:
    try:
        name, formula = _formula(piece, types)
        return specification.Requirement(name or str(number), piece, formula)
    except _Wrong as no:
        line, column, caret = specification.caret_of(text, at + no.offset)
        place = f"{where}, line {line}, column {column}"
        refused = specification.NotRead(no.what, place, caret, expected=no.expected, got=no.got)
        return specification.Requirement(str(number), piece, refused)


class _Wrong(Exception):
    def __init__(self, what: str, offset: int, expected: str = "", got: str = "") -> None:
        self.what, self.offset, self.expected, self.got = what, offset, expected, got


def _formula(piece: str, types: dict[str, str]) -> tuple[str, formulas.Formula]:
    from lark.exceptions import UnexpectedCharacters, UnexpectedInput, VisitError

    try:
        tree = _parser().parse(piece)
        return _build(tree, types)
    except UnexpectedInput as error:
        offset = error.pos_in_stream if error.pos_in_stream is not None else len(piece)
        offset = len(piece) if offset < 0 else offset
        token = None if isinstance(error, UnexpectedCharacters) else getattr(error, "token", None)
        if token is not None and token.type == "$END":
            offset, token = len(piece), None
        got = str(token or piece[offset : offset + 1]) or "the end of the requirement"
        raise _Wrong(
            "this is not in the part of C2PO that is read", offset, "a formula", got[:30]
        ) from None
    except VisitError as error:
        if isinstance(error.orig_exc, _Wrong):
            raise error.orig_exc from None
        raise


def _build(tree: Any, types: dict[str, str]) -> tuple[str, formulas.Formula]:
    made: list[Any] = []
    for node in tree.iter_subtrees():  # children before parents
        node.made = _made(node, types)
        made.append(node)
    result: tuple[str, formulas.Formula] = tree.made
    return result


def _made(node: Any, types: dict[str, str]) -> Any:
    got = [getattr(child, "made", child) for child in node.children]
    kind = str(node.data)
    if kind == "start":
        return (str(got[0]) if len(got) > 1 else "", got[-1])
    if kind == "bounds":
        return _bounds(got)
    if kind in ("signal", "truth"):
        return _signal(got[0], kind == "truth", types)
    if kind in ("number", "negative"):
        return _number(got[0], kind == "negative")
    if kind == "constant":
        return formulas.TRUE if got[0] == "true" else formulas.FALSE
    if kind == "compare":
        return formulas.compared(got[0], str(got[1]), got[2])
    if kind == "negation":
        return formulas.Not(got[0])
    if kind == "unary":
        return ONE_SIDED[str(got[0])](got[2], *got[1])
    if kind == "binary":
        return _two_sided(*got)
    if kind in ("either", "both"):
        return formulas.Join(got[0], got[1], kind == "both")
    return (formulas.iff if kind == "iff" else formulas.implies)(got[0], got[1])


def _bounds(tokens: list[Any]) -> tuple[int, int]:
    values = []
    for token in tokens:
        value = integer_of(str(token), 0, MAX_BOUND)
        if value is None:
            raise _Wrong(
                "a bound is too large", token.start_pos, f"up to {MAX_BOUND}", str(token)[:30]
            )
        values.append(value)
    low, high = values if len(values) > 1 else (0, values[0])
    if low > high:
        got = f"[{low},{high}]"
        raise _Wrong("these bounds are empty", tokens[0].start_pos, "the lower first", got)
    return low, high


def _signal(token: Any, truth: bool, types: dict[str, str]) -> Any:
    kind = types.get(str(token))
    wanted = "a signal that INPUT declares as " + ("bool" if truth else "int or float")
    if kind is None or (kind == "bool") != truth:
        raise _Wrong("this is no such signal", token.start_pos, wanted, str(token)[:30])
    return formulas.Reaches(str(token), 1.0) if truth else str(token)


def _number(token: Any, negative: bool) -> float:
    value = float(str(token)) if len(token) <= 300 else float("inf")
    if value == float("inf"):
        raise _Wrong("the number is too large", token.start_pos, "a double", str(token)[:30])
    return -value if negative else value


def _two_sided(
    phi: formulas.Formula, operator: Any, bounds: tuple[int, int], psi: formulas.Formula
) -> formulas.Formula:
    low, high = bounds
    if operator in ("R", "T"):  # by duality
        phi, psi = formulas.Not(phi), formulas.Not(psi)
    if operator in ("U", "R"):
        made: formulas.Formula = formulas.Bounded(phi, psi, 0, high - low, False)
        made = formulas.eventually(made, low, low) if low else made
    elif low:
        raise _Wrong(
            "a since from a lower bound above 0 is not read: phi may count from it or from 0",
            operator.start_pos,
            f"{operator}[0,{high}]",
            f"{operator}[{low},{high}]",
        )
    else:
        made = formulas.Bounded(phi, psi, 0, high, True)
    return formulas.Not(made) if operator in ("R", "T") else made


@cache
def _parser() -> Lark:
    from lark import Lark

    grammar = Path(__file__).with_name("c2po.lark").read_text(encoding="utf-8")
    return Lark(grammar, parser="lalr", propagate_positions=False, maybe_placeholders=False)
