"""Whether the types at run time are those that the files write: numbers by their own names, records field by field.

The prover and the readings take types from what runs (`get_type_hints`); people read the files. A module that binds
`float` to another type, or changes annotations on import, would make theorems speak of other values than are read.
"""

from __future__ import annotations

import ast
import functools
import os
import sys
import types
from typing import Any, get_type_hints

from cratous.proofs.engine.module_source import parsed

NUMBERS = (float, int, bool)


def differing(node: ast.FunctionDef, kinds: dict[str, Any], scope: dict[str, Any]) -> list[str]:
    """The annotations of a function that are not what runs: `the type of 'x'`; also fields of its records.

    kinds: the types at run time, by argument, and of the result under `return`; scope: the globals of its module.
    """
    said = {f"the type of {a.arg!r}": (a.annotation, kinds.get(a.arg)) for a in node.args.args}
    said["the type of the result"] = (node.returns, kinds.get("return"))
    return [what for what, (text, kind) in said.items() if text and not _is(text, kind, scope)]


def _is(text: ast.expr, kind: Any, scope: dict[str, Any]) -> bool:
    """Whether an annotation names this type: a number by its own name, or a record that is itself as written."""
    if isinstance(text, ast.Constant) and isinstance(text.value, str):
        text = ast.parse(text.value, mode="eval").body
    if kind in NUMBERS:
        return isinstance(text, ast.Name) and text.id == kind.__name__ and text.id not in scope
    if isinstance(text, ast.Name):
        found = scope.get(text.id)
    elif isinstance(text, ast.Attribute) and isinstance(text.value, ast.Name):
        home = scope.get(text.value.id)
        found = vars(home).get(text.attr) if isinstance(home, types.ModuleType) else None
    else:
        found = None
    return found is not None and found is kind and record(kind)


@functools.cache
def record(kind: Any) -> bool:
    """Whether a record's fields are those that its class has in its file, of the types written there."""
    home = sys.modules.get(str(getattr(kind, "__module__", "")))
    file = getattr(home, "__file__", None)
    if home is None or file is None:
        return False
    body = parsed(file, os.stat(file).st_mtime_ns).body
    found = [n for n in body if isinstance(n, ast.ClassDef) and n.name == kind.__name__]
    if len(found) != 1:
        return False
    fields = [part for part in found[0].body if isinstance(part, ast.AnnAssign)]
    names = tuple(part.target.id for part in fields if isinstance(part.target, ast.Name))
    kinds = get_type_hints(kind)
    return names == getattr(kind, "_fields", ()) and all(
        _is(part.annotation, kinds.get(name), vars(home))
        for name, part in zip(names, fields, strict=True)
    )
