"""Folds that are made of other kernels than the files of their modules say.

A fold is an object, and a statement such as `object.__setattr__(total, "step", other)` can give it another
step after it was registered; or its module calls another fold so. Both are functions as written, so only
the text tells which of them was meant. The start is a value, which is part of the key; of a kind that
adds or compares in its own way it would be another value than it looks.
"""

from __future__ import annotations

import ast
import functools
import inspect
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_type_hints

from cratous.core.kernel import Fold

PARTS = ("step", "finish")


@functools.cache
def _written(file: str) -> dict[str, tuple[str, dict[str, str]]]:
    """By the name of each fold that a file makes in a statement: the variable, and the parts as written."""
    found: dict[str, tuple[str, dict[str, str]]] = {}
    for statement in ast.parse(Path(file).read_bytes()).body:
        if isinstance(statement, ast.AnnAssign):
            targets: list[ast.expr] = [statement.target]
        elif isinstance(statement, ast.Assign):
            targets = statement.targets
        else:
            continue
        call = statement.value
        if not isinstance(call, ast.Call) or not isinstance(targets[0], ast.Name):
            continue
        given = {word.arg: word.value for word in call.keywords if word.arg}
        name = given.get("name")
        if "step" in given and isinstance(name, ast.Constant):
            parts = {part: ast.unparse(given[part]) for part in PARTS if part in given}
            found[str(name.value)] = (targets[0].id, parts)
    return found


def other_parts(fold: Fold[Any]) -> Iterator[str]:
    """What of a registered fold is another thing than its file says; nothing where all is as written."""
    module = sys.modules[fold.module]
    written = _written(str(module.__file__)).get(fold.name)
    if type(fold) is not Fold or written is None:
        yield "it is no fold that a statement of its module makes"
        return
    variable, parts = written
    if vars(module).get(variable) is not fold:
        yield f"its module calls something else {variable}"
    if not _plain(fold.start, _first(fold.step)):
        yield "its start has another kind than int, bool or the record that its step takes"
    for part in PARTS:
        meant = _named(module, parts.get(part, "None"))
        if getattr(fold, part) is not meant:
            yield f"its {part} is not {parts.get(part, 'None')}"


def _first(step: Any) -> Any:
    """The type of a step's first argument."""
    hints = get_type_hints(step)
    return hints.get(next(iter(inspect.signature(step).parameters), ""))


def _plain(start: Any, kind: Any) -> bool:
    """A start that means what it looks like: integers, truth values, records of them of this type."""
    if type(start) in (int, bool):
        return True
    hints = get_type_hints(kind) if type(start) is kind and isinstance(start, tuple) else {}
    fields = getattr(kind, "_fields", ())
    return bool(hints) and all(
        _plain(value, hints.get(name)) for name, value in zip(fields, start, strict=True)
    )


def _named(module: Any, text: str) -> Any:
    """What a name with its attributes means in a module; the module itself where it means nothing."""
    if text == "None":
        return None
    value = module
    for part in text.split("."):
        value = getattr(value, part, module)
    return value
