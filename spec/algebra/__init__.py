"""The process algebra: terms, and the parser with its errors. Grammar: `process_algebra.lark`.

    .(p1 |(p2 p3)_[1000-1500] +(p4 p5))-[0-60000]

A term is an operator with one or more operands, or a task `p<id>`; any term may carry one timing
suffix in milliseconds. The meaning of terms: `spec.algebra.meaning`. A text that is not exactly one
term is refused with its place and what was expected: nothing is skipped, guessed or repaired.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cache, lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from cratous.spec.algebra.errors import TERM, AlgebraError, Refusal, clip, explain
from cratous.spec.errors import BadInput
from cratous.spec.schedule import TIME_LIMIT_MS

if TYPE_CHECKING:
    from lark import Lark

Span = tuple[int, int]
SEQUENTIAL, TILDE, PARALLEL, ALTERNATIVE = ".", "~", "|", "+"
ABSOLUTE, RELATIVE = "absolute", "relative"
MAX_DEPTH = 200
MAX_TASK_ID = 2**63 - 1
MAX_TIME_MS = TIME_LIMIT_MS - 1
_KEPT_LENGTH = 2000


@dataclass(frozen=True)
class Suffix:
    """A timing `_[t1-t2]` (absolute) or `-[t1-t2]` (relative) in ms, with 0 <= t1 <= t2."""

    kind: str
    t1_ms: int
    t2_ms: int
    span: Span = field(default=(0, 0), compare=False)

    def __str__(self) -> str:
        mark = "_" if self.kind == ABSOLUTE else "-"
        return f"{mark}[{self.t1_ms}-{self.t2_ms}]"


@dataclass(frozen=True)
class Atom:
    """A task. `span` is its place (start, end) in the text, suffix included; not compared."""

    task: int
    suffix: Suffix | None = None
    span: Span = field(default=(0, 0), compare=False)


@dataclass(frozen=True)
class Op:
    """An operator, one of `.` `~` `|` `+`, over one or more operands; `span` as in `Atom`."""

    op: str
    operands: tuple[Term, ...]
    suffix: Suffix | None = None
    span: Span = field(default=(0, 0), compare=False)


Term: TypeAlias = Atom | Op


def parse(
    text: str, known: frozenset[int] | None = None, *, where: str = "process algebra"
) -> Term:
    """Parse a text into a term.

    known: ids of the tasks that exist; None accepts any id. where: the source named in errors (for example a file).
    Raises AlgebraError, and no other error, for a text that is not a term.
    """
    try:
        term = _kept(text) if len(text) <= _KEPT_LENGTH else _read(text)
        if known is not None:
            _refuse_unknown(term, known)
    except Refusal as no:
        raise AlgebraError(
            no.what, text, no.offset, expected=no.expected, got=no.got, where=where
        ) from None
    return term


def format_term(term: Term) -> str:
    """The canonical text of a term: single blanks between operands, no other blanks. Inverse of `parse`."""
    parts: list[str] = []
    todo: list[Term | str] = [term]
    while todo:
        item = todo.pop()
        if isinstance(item, str):
            parts.append(item)
        elif isinstance(item, Atom):
            parts.append(f"p{item.task}{item.suffix or ''}")
        else:
            parts.append(f"{item.op}(")
            todo.append(f"){item.suffix or ''}")
            for position, operand in enumerate(reversed(item.operands)):
                todo += [" ", operand] if position else [operand]
    return "".join(parts)


def parallel_of(ids: Iterable[int]) -> Term:
    """A term with all these tasks in any order, the meaning of an empty text. Raises BadInput if there are none."""
    tasks = tuple(ids)
    if not tasks:
        raise BadInput("there is no task to do", expected="at least one task", got="none")
    return parse(f"|({' '.join(f'p{task}' for task in tasks)})")


def _read(text: str) -> Term:
    _refuse_blank_or_deep(text)
    term = _syntax(text)
    _refuse_twice(term)
    return term


_kept = lru_cache(256)(_read)  # one request is read by several services


def _syntax(text: str) -> Term:
    from lark.exceptions import UnexpectedInput, UnexpectedToken

    run: Any = _parser().parse_interactive(text)  # lark has no types here
    before = last = None
    try:
        for token in run.iter_parse():
            before, last = last, token
        term: Term = run.feed_eof(last)
    except UnexpectedInput as error:
        refused = isinstance(error, UnexpectedToken) and error.token is last
        raise explain(text, before if refused else last, run.accepts()) from None
    return term


@cache
def _parser() -> Lark:
    from lark import Lark, Transformer

    class Build(Transformer[Any, Any]):
        """Builds terms while parsing, so that no recursion is needed."""

        def start(self, children: list[Any]) -> Term:
            term: Term = children[0]
            return term

        def atom(self, children: list[Any]) -> Term:
            token, suffix = children[0], children[1] if len(children) > 1 else None
            task = _number(token[1:], token.start_pos, "task id", 1, MAX_TASK_ID)
            return Atom(task, suffix, (token.start_pos, _end(children[-1])))

        def composite(self, children: list[Any]) -> Term:
            operator = children[0]
            suffix = children[-1] if isinstance(children[-1], Suffix) else None
            operands = tuple(child for child in children if isinstance(child, Atom | Op))
            return Op(str(operator), operands, suffix, (operator.start_pos, _end(children[-1])))

        def absolute(self, children: list[Any]) -> Suffix:
            return _suffix(ABSOLUTE, children)

        def relative(self, children: list[Any]) -> Suffix:
            return _suffix(RELATIVE, children)

    grammar = Path(__file__).with_name("process_algebra.lark").read_text(encoding="utf-8")
    return Lark(grammar, parser="lalr", transformer=Build(), maybe_placeholders=False)


def _end(item: Any) -> int:
    end: int = item.span[1] if isinstance(item, Suffix) else item.end_pos
    return end


def _suffix(kind: str, children: list[Any]) -> Suffix:
    first, second = children[2], children[4]
    t1 = _number(first, first.start_pos, "time", 0, MAX_TIME_MS)
    t2 = _number(second, second.start_pos, "time", 0, MAX_TIME_MS)
    if t1 > t2:
        raise Refusal(
            "the timing window ends before it begins", first.start_pos,
            "[t1-t2] with t1 <= t2", f"[{t1}-{t2}]",
        )  # fmt: skip
    return Suffix(kind, t1, t2, (children[0].start_pos, children[-1].end_pos))


def _number(digits: str, offset: int, name: str, low: int, high: int) -> int:
    # A number with too many digits is refused before it is converted.
    significant = digits.lstrip("0")
    value = int(significant or "0") if len(significant) <= 19 else high + 1
    if not low <= value <= high:
        raise Refusal(
            f"{name} out of range", offset, f"a {name} from {low} to {high}", clip(digits)
        )
    return value


def _refuse_blank_or_deep(text: str) -> None:
    if not text.strip():
        raise Refusal("the text is empty", 0, TERM, "nothing")
    depth = 0
    for match in re.finditer(r"[()]", text):
        depth += 1 if match.group() == "(" else -1
        if depth > MAX_DEPTH:
            raise Refusal(
                "operators are nested too deep", match.start(),
                f"at most {MAX_DEPTH} levels", f"level {depth}",
            )  # fmt: skip


def _refuse_unknown(term: Term, known: frozenset[int]) -> None:
    for atom in atoms(term):
        if atom.task not in known:
            names = [f"p{task}" for task in sorted(known)]
            shown = " ".join(names[:10]) + (f" … ({len(names)} tasks)" if len(names) > 10 else "")
            raise Refusal(
                f"unknown task p{atom.task}", atom.span[0], f"one of {shown}" if names else "no task (there are none)",
                f"p{atom.task}",
            )  # fmt: skip


def atoms(term: Term) -> Iterable[Atom]:
    """The atoms of a term, in the order of the text."""
    todo: list[Term] = [term]
    while todo:
        item = todo.pop()
        if isinstance(item, Atom):
            yield item
        else:
            todo.extend(reversed(item.operands))


def _refuse_twice(term: Term) -> dict[int, Span]:
    """The first position of each task; raises for a task that occurs twice, except in different operands of one `+`."""
    if isinstance(term, Atom):
        return {term.task: term.span}
    seen: dict[int, Span] = {}
    for operand in term.operands:
        for task, span in _refuse_twice(operand).items():
            if task in seen and term.op != ALTERNATIVE:
                raise Refusal(
                    f"task p{task} stands twice in one branch", span[0],
                    "each task once, save in different operands of one +",
                    f"p{task} here and before, at character {seen[task][0] + 1}",
                )  # fmt: skip
            seen.setdefault(task, span)
    return seen
