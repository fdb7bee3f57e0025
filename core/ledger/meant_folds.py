"""Folds that consist of other kernels than the files of their modules say.

A fold is an object, and a statement such as `object.__setattr__(total, "step", other)` can replace its step after
registration; or its module may bind its name to another fold. Both steps are functions as written, so only the text
shows which of them was meant. The start is a value and part of the key; if its type defines its own addition or
comparison, it may behave differently from what its text shows.
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
    """For each fold defined in a file, by name: the variable, and the parts as written."""
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
    """The parts of a registered fold that differ from its file; empty if none does."""
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
    """Whether a start consists only of integers, truth values and records of this type."""
    if type(start) in (int, bool):
        return True
    hints = get_type_hints(kind) if type(start) is kind and isinstance(start, tuple) else {}
    fields = getattr(kind, "_fields", ())
    return bool(hints) and all(
        _plain(value, hints.get(name)) for name, value in zip(fields, start, strict=True)
    )


def _named(module: Any, text: str) -> Any:
    """What a dotted name refers to in a module; the module itself if nothing."""
    if text == "None":
        return None
    value = module
    for part in text.split("."):
        value = getattr(value, part, module)
    return value
