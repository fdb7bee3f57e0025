"""Parses process-algebra text while it is typed: its tree, or the error with its position."""

from __future__ import annotations

from collections.abc import Collection
from itertools import islice
from typing import Any

from cratous.spec import algebra as pa
from cratous.spec.algebra import meaning
from cratous.spec.algebra.errors import AlgebraError
from cratous.spec.errors import BadInput

MEANINGS = {
    ".": "one after the other ended",
    "~": "one after the other began",
    "|": "all, in any order",
    "+": "exactly one",
}
MOST_ROWS, MOST_BRANCHES = 40, 2


def relations(text: str, tasks: Collection[int]) -> dict[str, Any]:
    """tree, canonical text and constraints of the first branches; or error, with its offset in the
    text.

    tasks: the existing ids. An empty text means all tasks, in any order.
    """
    try:
        term = pa.parse(text, frozenset(tasks)) if text.strip() else pa.parallel_of(tasks)
    except AlgebraError as error:
        return {"error": {**error.data(), "offset": error.offset}}
    except BadInput as error:
        return {"error": {**error.data(), "offset": 0}}
    rows = [
        row.text
        for branch in islice(meaning.branches(term), MOST_BRANCHES)
        for row in meaning.rows(branch)
    ]
    return {
        "canonical": pa.format_term(term),
        "branches": meaning.count_branches(term),
        "rows": list(dict.fromkeys(rows))[:MOST_ROWS],
        "tree": _tree(term),
    }


def _tree(term: pa.Term) -> dict[str, Any]:
    suffix = str(term.suffix or "")
    if isinstance(term, pa.Atom):
        return {"text": f"p{term.task}", "suffix": suffix, "parts": []}
    parts = [_tree(part) for part in term.operands]
    return {"text": f"{term.op}  {MEANINGS[term.op]}", "suffix": suffix, "parts": parts}
