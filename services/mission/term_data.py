"""A mission's relations as data for the kernels, checked by printing them back to the text.

So neither the parser nor the conversion of its tree has to be trusted: data that do not print to the
mission's text, apart from blanks and leading zeros, are rejected.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from cratous.core.algebra.terms import Node
from cratous.spec.algebra import Atom, Suffix, Term
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission
from cratous.spec.mission.asked import term_of

OPERATORS = {".": 1, "~": 2, "|": 3, "+": 4}
SIGNS = {code: sign for sign, code in OPERATORS.items()}
KINDS = {"absolute": 1, "relative": 2}
MARKS = {1: "_", 2: "-"}


def nodes_of(term: Term) -> tuple[Node, ...]:
    """A term's nodes in postfix order."""
    found: list[Node] = []
    todo: list[tuple[Term, bool]] = [(term, False)]
    while todo:
        part, inside = todo.pop()
        if isinstance(part, Atom):
            found.append(Node(0, 0, part.task, *_timing(part.suffix)))
        elif inside:
            code = OPERATORS[part.op]
            found.append(Node(code, len(part.operands), 0, *_timing(part.suffix)))
        else:
            todo.append((part, True))
            todo += [(operand, False) for operand in reversed(part.operands)]
    return tuple(found)


def _timing(suffix: Suffix | None) -> tuple[int, int, int]:
    return (0, 0, 0) if suffix is None else (KINDS[suffix.kind], suffix.t1_ms, suffix.t2_ms)


def text_of(nodes: Sequence[Node]) -> str:
    """The text of the nodes, without blanks."""
    done: list[str] = []
    for node in nodes:
        if node.op:
            first = len(done) - node.arity
            text = f"{SIGNS[node.op]}({''.join(done[first:])})"
            del done[first:]
        else:
            text = f"p{node.task}"
        if node.timing:
            text += f"{MARKS[node.timing]}[{node.t1_ms}-{node.t2_ms}]"
        done.append(text)
    return "".join(done)


def plain(text: str) -> str:
    """A text of the process algebra without blanks and leading zeros, which have no meaning."""
    return re.sub(r"(?<!\d)0+(?=\d)", "", re.sub(r"\s+", "", text))


def checked_nodes(term: Term, text: str) -> tuple[Node, ...]:
    """The nodes of a text's term. Raises BadInput unless they print to that text."""
    nodes = nodes_of(term)
    said, wanted = text_of(nodes), plain(text)
    if said != wanted:
        raise BadInput(
            "the relations as data are not those of the text",
            where="process algebra",
            expected=wanted,
            got=said,
        )
    return nodes


def mission_nodes(mission: Mission) -> tuple[Node, ...]:
    """The relations of a mission as checked data; all its tasks in any order if it has none.

    No nodes for a mission without tasks.
    """
    term = term_of(mission)
    if term is None:
        return ()
    text = mission.relations
    if not text.strip():
        text = f"|({' '.join(f'p{task.id}' for task in mission.tasks)})"
    return checked_nodes(term, text)
