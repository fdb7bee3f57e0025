"""Parses a requirements file into a tree by `language.lark`; syntax errors are explained in words."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cratous.services.requirements.fret_terms import Wrong

if TYPE_CHECKING:
    from lark import Lark

NESTED = 200


def refuse_deep(text: str) -> None:
    """Wrong if parentheses are nested too deeply."""
    depth = 0
    for found in re.finditer(r'"[^"\n]*"|#[^\n]*|[()]', text):
        depth += {"(": 1, ")": -1}.get(found.group(), 0)
        if depth > NESTED:
            raise Wrong("the formula is nested too deeply", found.start(), f"{NESTED} levels")


def parsed(text: str) -> Any:
    """The tree of a text; Wrong, with the position, for a syntax error."""
    from lark.exceptions import UnexpectedCharacters, UnexpectedInput

    try:
        return _parser().parse(text)
    except UnexpectedInput as error:
        offset = error.pos_in_stream if error.pos_in_stream is not None else len(text)
        token = None if isinstance(error, UnexpectedCharacters) else getattr(error, "token", None)
        if offset < 0 or (token is not None and token.type == "$END"):
            offset, token = len(text.rstrip()), None
        got = str(token or text[offset : offset + 1]) or "the end of the file"
        known = sorted(getattr(error, "expected", None) or getattr(error, "allowed", None) or ())
        raise Wrong("this cannot stand here", offset, _in_words(known), got) from None


WORDS = {
    "UNIT": "a unit", "NAME": "a name", "NUMBER": "a number", "RELATION": "a comparison",
    "ID": "the requirement's id", "ORIGIN": "TYPE[FIELD=VALUE].FIELD", "BOOL": "bool",
    "UNARY": "always, eventually, historically or once", "BINARY": "until or since",
    "STRING": "a text in quotes", "LPAR": "(", "RPAR": ")", "COLON": ":", "COMMA": ",",
    "CONSTANT": "true or false", "PARAMETER": "$PARAMETER", "NUMERAL": "id", "FUNCTION": "abs, sqrt, sin or cos",
    "PLUS": "+", "MINUS": "-", "STAR": "*", "SLASH": "/", "$END": "the end of the file",
}  # fmt: skip


def _in_words(known: list[str]) -> str:
    return ", ".join(WORDS.get(name, name.lower()) for name in known[:12])


@cache
def _parser() -> Lark:
    from lark import Lark

    grammar = Path(__file__).with_name("language.lark").read_text(encoding="utf-8")
    return Lark(grammar, parser="lalr", propagate_positions=True, maybe_placeholders=False)
