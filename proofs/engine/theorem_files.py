"""The files of theorems: one file per claim, named after it, with the proved sentence as its docstring."""

from __future__ import annotations

import ast
import os
import sys
import types
from collections.abc import Callable
from pathlib import Path

from cratous.core.kernel.names import near
from cratous.core.kernel.sources import place
from cratous.core.ledger.package_home import PRODUCT, Home
from cratous.proofs.engine import theorem_subset, theorem_values
from cratous.proofs.engine.claim import Claim
from cratous.spec.errors import BadInput

FOLDER = PRODUCT.theorems
_LISTED: dict[Path, dict[str, Path]] = {}
"""The theorems of each folder, as last listed."""


def home_folder(home: Home) -> Path:
    """Where the theorems of a home lie; raises BadInput if there is no such folder."""
    if not home.theorems.is_dir():
        raise BadInput(
            "the package has no theorems", where=home.name, expected="a folder `theorems`"
        )
    return home.theorems


def theorem_files(folder: Path = FOLDER) -> dict[str, Path]:
    """File of every theorem by name, in order of name; raises BadInput for two of one name."""
    found: dict[str, Path] = {}
    for at, folders, files in os.walk(folder):
        folders.sort()
        # the same as `theorem_name`, computed once per folder
        around = "".join(f"{part}_" for part in Path(at).relative_to(folder).parts)
        for file in sorted(files):
            if not file.endswith(".py") or file.startswith("_"):
                continue
            name, path = f"{around}{file.removesuffix('.py')}", Path(at, file)
            if name in found:
                places = f"{place(found[name])} and {place(path)}"
                raise BadInput(f"two theorems are called {name!r}", where=places)
            found[name] = path
    _LISTED[folder] = dict(sorted(found.items()))
    return dict(_LISTED[folder])


def _listed(name: str, folder: Path) -> Path | None:
    """The file of this name in a folder; the folder is listed again only where the name was not found."""
    found = _LISTED.get(folder, {}).get(name)
    return found if found is not None and found.is_file() else theorem_files(folder).get(name)


def package_of(folder: Path) -> str:
    """The package whose theorems are in this folder."""
    return PRODUCT.name if folder == FOLDER else folder.parent.name


def find(name: str, folder: Path) -> Path:
    """The file of a theorem: of this folder, else of the product.

    name: the name of its file, or `package.name`. Raises BadInput if there is none.
    """
    package, _, plain = name.rpartition(".")
    places = [place for place in (folder, FOLDER) if package in ("", package_of(place))]
    for one in places:
        found = _listed(plain, one)
        if found is not None:
            return found
    known = [n for one in {folder, FOLDER} for n in theorem_files(one)]
    raise BadInput(
        f"there is no theorem called {name!r}",
        where=place(folder),
        expected=" or ".join(near(plain, known))
        or "the name of a file of this folder, without .py",
    )


def load_lemma(name: str, folder: Path) -> Callable[[Claim], None]:
    """The claim of a theorem that another theorem of this folder uses as a lemma.

    Raises BadInput where both the package and the product have a theorem of this name.
    """
    if folder != FOLDER and all(name in theorem_files(one) for one in (folder, FOLDER)):
        raise BadInput(
            f"two theorems are called {name!r}",
            where=f"{place(find(name, folder))} and {place(find(name, FOLDER))}",
            expected=f"{package_of(folder)}.{name} or {PRODUCT.name}.{name}",
        )
    return load_claim(name, folder)[0]


def load_claim(name: str, folder: Path = FOLDER) -> tuple[Callable[[Claim], None], str]:
    """The function `claim` of a theorem file, and its sentence; raises BadInput for a file without them."""
    path = find(name, folder)
    try:
        module, parsed = _module(path, folder)
    except ImportError as error:
        raise BadInput(
            f"the theorem imports what is not there: {error}", where=place(path)
        ) from error
    except SyntaxError as error:
        line = f"{place(path)}:{error.lineno}"
        raise BadInput(f"the theorem is no Python: {error.msg}", where=line) from error
    sentence = " ".join((ast.get_docstring(parsed) or "").split())
    if not sentence:
        raise BadInput(
            "the theorem has no docstring", where=place(path), expected="the sentence it proves"
        )
    if not callable(getattr(module, "claim", None)):
        raise BadInput("the theorem states nothing", where=place(path), expected="def claim(c)")
    return module.claim, sentence


def _module(path: Path, folder: Path) -> tuple[types.ModuleType, ast.Module]:
    """The module of a theorem file, executed once, and its present syntax tree."""
    text = path.read_text(encoding="utf-8")
    parsed = ast.parse(text)
    inside = "cratous.proofs" if path.is_relative_to(FOLDER) else package_of(folder)
    home = FOLDER if path.is_relative_to(FOLDER) else folder
    name = ".".join((inside, "theorems", *path.relative_to(home).with_suffix("").parts))
    module = sys.modules.get(name)
    if module is None or getattr(module, "__file__", None) != str(path):
        module = types.ModuleType(name)
        module.__file__ = str(path)
        theorem_subset.check(parsed, path)
        # from source text, never from byte code: what is proved is what is written
        exec(compile(text, str(path), "exec", dont_inherit=True), module.__dict__)
        theorem_values.check_values(module.__dict__, parsed, path)
        sys.modules[name] = module
    return module, parsed
