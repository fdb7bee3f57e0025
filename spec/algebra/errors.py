"""Errors in process-algebra texts: the position, the kind of mistake, and what was expected."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from cratous.spec.errors import BadInput

if TYPE_CHECKING:
    from lark import Token

TERM = "an operator . ~ | + or a task p<id>"
_WORDS = (
    ("OPERATOR", TERM),
    ("LPAR", '"("'),
    ("RPAR", '")"'),
    ("UNDERSCORE", "a timing _[t1-t2] or -[t1-t2]"),
    ("LSQB", '"["'),
    ("TIME", "a time in ms"),
    ("RSQB", '"]"'),
    ("$END", "the end of the text"),
)
EMPTY = "empty operator"
_CHUNK = re.compile(r"[^\W\d_]+\d*|\d+|.", re.DOTALL)


class AlgebraError(BadInput):
    """A text that is not a process algebra. line and column count from 1, offset from 0."""

    def __init__(
        self, what: str, text: str, offset: int, *, expected: str = "", got: str = "",
        where: str = "process algebra",
    ) -> None:  # fmt: skip
        self.text, self.offset = text, offset
        self.line = text.count("\n", 0, offset) + 1
        self.column = offset - (text.rfind("\n", 0, offset) + 1) + 1
        place = f"{where}, line {self.line}, column {self.column}"
        super().__init__(what, where=place, expected=expected, got=got)

    def caret(self) -> str:
        """Two lines: the line of the text (a window of it if it is long), and ^ below the place."""
        lines = self.text.split("\n")
        shown = "".join(c if c.isprintable() else " " for c in lines[self.line - 1])
        at = self.column - 1
        first = max(0, at - 60)
        window = shown[first : first + 90]
        before = "…" if first else ""
        after = "…" if first + 90 < len(shown) else ""
        return f"{before}{window}{after}\n{' ' * (len(before) + at - first)}^"

    def data(self) -> dict[str, str]:
        """The fields of every `BadInput`, and the caret."""
        return {**super().data(), "caret": self.caret()}


class Refusal(Exception):
    """What is wrong at an offset; `parse` adds the text."""

    def __init__(self, what: str, offset: int, expected: str = "", got: str = "") -> None:
        super().__init__(what)
        self.what, self.offset, self.expected, self.got = what, offset, expected, got


def clip(text: str) -> str:
    shown = "".join(c if c.isprintable() else "?" for c in text)
    return shown if len(shown) <= 30 else shown[:29] + "…"


def explain(text: str, last: Token | None, accepts: set[str]) -> Refusal:
    """The refusal for a text that stops being a valid term after the token `last`."""
    behind = 0 if last is None else (last.end_pos or 0)
    offset = behind + len(text[behind:]) - len(text[behind:].lstrip())
    chunk = _CHUNK.match(text, offset)
    got = chunk.group() if chunk else ""
    words = [word for terminal, word in _WORDS if terminal in accepts]
    if "DASH" in accepts and "UNDERSCORE" not in accepts:
        words.append('"-"')
    expected = " or ".join(words)
    what = _what(text, "" if last is None else str(last), accepts, got)
    if what == EMPTY:
        operator = text[: behind - 1].rstrip()[-1]
        what, expected = f"the operator {operator} has no operands", "at least one operand"
    return Refusal(what, offset, expected, f'"{clip(got)}"' if got else "the end of the text")


def _what(text: str, before: str, accepts: set[str], got: str) -> str:
    """The name of the mistake: `got` was found after `before`, where the parser accepts `accepts`."""
    if accepts & {"LSQB", "TIME", "RSQB"} or ("DASH" in accepts and "UNDERSCORE" not in accepts):
        return "this is not a timing"
    if before == "]" and got in ("_", "-"):
        return "a term takes only one timing"
    if "LPAR" in accepts:
        return f"the operator {before} has no operands in parentheses"
    if not got:
        return f"{_unclosed(text)} is never closed"
    if got == ")":
        return "there is a closing parenthesis too many" if before != "(" else EMPTY
    if "OPERATOR" not in accepts:
        return "the text goes on after its end; several terms need one operator around them"
    return _what_term(got)


def _what_term(got: str) -> str:
    """Why a term cannot begin with `got`."""
    if got == ",":
        return "operands are separated by blanks, not by commas"
    if re.fullmatch(r"P\d+", got):
        return "a task is written with a small p"
    if got == "p":
        return "a task needs its number directly after the p"
    if got.isdecimal():
        return "a task is written with a p before its number"
    if got == "(":
        return "an operator must stand before the parenthesis"
    if got in ("_", "-"):
        return "a timing stands behind its term"
    if len(got) == 1 and not got.isalnum():
        return f"{clip(got)} is not an operator"
    return "this is neither an operator nor a task"


def _unclosed(text: str) -> str:
    opened: list[int] = []
    for match in re.finditer(r"[()]", text):
        if match.group() == "(":
            opened.append(match.start())
        elif opened:
            opened.pop()
    return f"the parenthesis at character {opened[-1] + 1}" if opened else "a parenthesis"
