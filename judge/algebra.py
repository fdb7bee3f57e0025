"""The process algebra, with a recursive-descent parser.

.(a b)  b starts no earlier than a ends      |(a b)  both, in any order
~(a b)  b starts no earlier than a starts    +(a b)  exactly one
e_[t1-t2], e-[t1-t2]  timing in ms, absolute and relative; p7 is task 7
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from cratous.spec.errors import BadInput

TOKEN = re.compile(r"\s*(p[0-9]+|[.~|+()\[\]_-]|[0-9]+)")
DEEPEST = 200
MOST_MS = 2**61


@dataclass(frozen=True)
class Window:
    """A time window from `first` to `last` [ms], relative to mission start or to the previous operand."""

    relative: bool
    first: int
    last: int

    def __str__(self) -> str:
        return f"{'-' if self.relative else '_'}[{self.first}-{self.last}]"


@dataclass(frozen=True)
class Term:
    """A task (empty operator) or an operator with operands, optionally with a time window."""

    operator: str
    task: int
    operands: tuple[Term, ...]
    window: Window | None

    def __str__(self) -> str:
        inner = f"p{self.task}"
        if self.operator:
            inner = f"{self.operator}({' '.join(map(str, self.operands))})"
        return f"{inner}{self.window or ''}"

    def tasks(self) -> list[int]:
        """Its tasks without duplicates, in the order of the text."""
        if not self.operator:
            return [self.task]
        return list(dict.fromkeys(t for operand in self.operands for t in operand.tasks()))


class _Reader:
    def __init__(self, text: str) -> None:
        self.text, self.at = text, 0
        self.parts: list[str] = []
        while text[self.at :].strip():
            match = TOKEN.match(text, self.at)
            if match is None:
                raise self.wrong("p<id>, an operator, a bracket or a number")
            self.parts.append(match.group(1))
            self.at = match.end()
        self.k = 0

    def wrong(self, expected: str) -> BadInput:
        done = " ".join(self.parts[: getattr(self, "k", 0)])
        return BadInput(
            "not a term of the process algebra", item="relations", expected=expected,
            got=f"{self.text[:80]!r} after {done[-40:]!r}",
        )  # fmt: skip

    def peek(self) -> str:
        return self.parts[self.k] if self.k < len(self.parts) else ""

    def take(self, *expected: str) -> str:
        part = self.peek()
        if not part or (expected and part not in expected):
            raise self.wrong(" or ".join(expected) or "more")
        self.k += 1
        return str(part)

    def number(self) -> int:
        part = self.take()
        if not part.isdigit() or len(part) > 25 or int(part) >= MOST_MS:
            raise self.wrong("a number of milliseconds")
        return int(part)

    def term(self, depth: int = 0) -> Term:
        if depth > DEEPEST:
            raise self.wrong(f"at most {DEEPEST} levels")
        head = self.take()
        if head[0] == "p":
            if len(head) > 25:
                raise self.wrong("a task's id")
            return Term("", int(head[1:]), (), self.window())
        if head not in (".", "~", "|", "+"):
            raise self.wrong("an operator or a task")
        self.take("(")
        operands = [self.term(depth + 1)]
        while self.peek() != ")":
            operands.append(self.term(depth + 1))
        self.take(")")
        found = Term(head, 0, tuple(operands), self.window())
        if head != "+":
            tasks = [t for operand in operands for t in operand.tasks()]
            if len(set(tasks)) < len(tasks):
                raise self.wrong("each task once, save in different operands of one +")
        return found

    def window(self) -> Window | None:
        if self.peek() not in ("_", "-"):
            return None
        relative = self.take() == "-"
        self.take("[")
        first = self.number()
        self.take("-")
        last = self.number()
        self.take("]")
        if first > last:
            raise self.wrong("a window that ends no earlier than it begins")
        return Window(relative, first, last)


def parse(text: str) -> Term:
    """The term that the whole text represents; BadInput if it is invalid."""
    reader = _Reader(text)
    found = reader.term()
    if reader.k < len(reader.parts):
        raise reader.wrong("nothing more")
    return found


def all_of(tasks: list[int]) -> Term:
    """All these tasks, in any order."""
    return Term("|", 0, tuple(Term("", task, (), None) for task in tasks), None)


def without(term: Term, gone: set[int]) -> Term | None:
    """The term without these tasks; None if nothing is left."""
    if not term.operator:
        return None if term.task in gone else term
    parts = tuple(p for p in (without(operand, gone) for operand in term.operands) if p)
    return Term(term.operator, 0, parts, term.window) if parts else None
