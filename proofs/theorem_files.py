"""The files of theorems: one file a claim, named by it, its docstring the sentence it proves."""

from __future__ import annotations

import ast
import sys
import types
from collections.abc import Callable
from pathlib import Path

from cratous.core.ledger import PRODUCT
from cratous.core.sources import place
from cratous.proofs.claim import Claim
from cratous.spec.errors import BadInput

FOLDER = PRODUCT.theorems


def theorem_files(folder: Path = FOLDER) -> dict[str, Path]:
    """Name to file of every theorem, in order of name."""
    return {p.stem: p for p in sorted(folder.glob("*.py")) if not p.stem.startswith("_")}


def find(name: str, folder: Path) -> Path:
    """The file of a theorem: in this folder, else in the product's. One name, one theorem."""
    found = [files[name] for files in map(theorem_files, {folder, FOLDER}) if name in files]
    if not found:
        raise BadInput(
            f"there is no theorem called {name!r}",
            where=place(folder),
            expected="the name of a file of this folder, without .py",
        )
    if len(found) > 1:
        places = " and ".join(sorted(place(path) for path in found))
        raise BadInput(f"two theorems are called {name!r}", where=places, expected="one id, one")
    return found[0]


def load_claim(name: str, folder: Path = FOLDER) -> tuple[Callable[[Claim], None], str]:
    """The function `claim` of a theorem file, and its sentence."""
    path = find(name, folder)
    text = path.read_text(encoding="utf-8")
    module_name = f"cratous.proofs.theorems.{name}"
    module = sys.modules.get(module_name)
    if module is None or getattr(module, "__file__", None) != str(path):
        module = types.ModuleType(module_name)
        module.__file__ = str(path)
        try:
            # from the text, never from byte code: what is proved is what is written
            exec(compile(text, str(path), "exec", dont_inherit=True), module.__dict__)
        except ImportError as error:
            raise BadInput(
                f"the theorem imports what is not there: {error}", where=place(path)
            ) from error
        except SyntaxError as error:
            line = f"{place(path)}:{error.lineno}"
            raise BadInput(f"the theorem is no Python: {error.msg}", where=line) from error
        sys.modules[module_name] = module
    sentence = " ".join((ast.get_docstring(ast.parse(text)) or "").split())
    if not sentence:
        raise BadInput(
            "the theorem has no docstring", where=place(path), expected="the sentence it proves"
        )
    if not callable(getattr(module, "claim", None)):
        raise BadInput("the theorem states nothing", where=place(path), expected="def claim(c)")
    return module.claim, sentence
