"""What a mutation result depends on, as hashes; and the store of results by them.

A target's key covers the function and all that it calls, every theorem that could look into it
(with its lemmas, definitions and kernels), the code that judges, and the solver. A mutant's adds
its text. So a verdict is asked again exactly when something changed that could change it, and
`proofs/mutation/mutation.json` can be held against the code without asking the solver.
"""

from __future__ import annotations

import fnmatch
import functools
import importlib
import inspect
import json
import os
from pathlib import Path
from typing import Any

from cratous.core import ledger as gate
from cratous.core.kernel import REGISTRY, Fold
from cratous.core.kernel.sources import (
    ROOT,
    closure,
    digest,
    files_digest,
    function_parts,
    imported,
    module_file,
    ours,
    reached,
)
from cratous.core.ledger import PRODUCT, Home
from cratous.proofs.engine.theorem_files import theorem_files

GENERATED = "filter_*"
"""Theorems that hold a kernel against what is generated from it. They never kill: every fault
differs from what was generated before it was made, so they would hide each missing theorem."""

JUDGES = ("mutation/judgement.py", "mutation/premises.py")


@functools.cache
def judging() -> str:
    """The code that reaches verdicts, and the solver."""
    roots = [ROOT / "proofs" / name for name in JUDGES]
    files = [file for file in closure(*roots) if file.is_relative_to(ROOT / "proofs")]
    return digest([files_digest(files), gate.solver_version()])


class Keys:
    """Keys of the targets of one home; theorems: those that may kill, by default all."""

    def __init__(self, home: Home = PRODUCT, theorems: list[str] | None = None) -> None:
        self.home, self.folder = home, home.theorems
        names = list(theorem_files(home.theorems)) if theorems is None else theorems
        self.theorems = [n for n in names if not fnmatch.fnmatch(n, GENERATED)]
        self._reach = {name: reach(name, home) for name in self.theorems}
        self._digest = {n: gate.theorem_digest([n], {}, home) for n in self.theorems}

    def target(self, key: str, target: Any) -> str:
        """The key of a function or fold; key: its qualified name."""
        names = sorted(n for n in self.theorems if key in self._reach[n])
        users = [f"{name}={self._digest[name]}" for name in names]
        return digest(["target", key, *function_parts(target), *users, judging()])

    def mutant(self, target_key: str, text: str) -> str:
        """The key of a verdict on one mutant."""
        return digest(["mutant", target_key, text])

    def premises(self, theorem: str) -> str:
        """The key of what the premises of a theorem are worth."""
        return digest(["premises", theorem, self._digest[theorem], judging()])


def reach(theorem: str, home: Home = PRODUCT) -> frozenset[str]:
    """Qualified names of all functions and folds that a theorem or a lemma of it could look into.

    Read off the imports, so it is more rather than less than what the theorem really uses.
    """
    found: set[str] = set()
    known = gate.theorem_names(home)
    todo, seen = [theorem], set()
    while todo:
        name = todo.pop()
        file = gate.theorem_file(name, home)
        if name in seen or file is None:
            continue
        seen.add(name)
        found |= _reach_of(file)
        todo += gate.mentioned(file) & known
    return frozenset(found)


@functools.cache
def _reach_of(file: Path) -> frozenset[str]:
    found: set[str] = set()
    for module, name in set(imported(file)):
        submodule = module_file(f"{module}.{name}") if name else module_file(module)
        source = submodule or module_file(module)
        if source is None:
            continue
        loaded = importlib.import_module(f"{module}.{name}" if submodule and name else module)
        values = vars(loaded).values() if submodule else [getattr(loaded, name, None)]
        for value in values:
            function = inspect.isfunction(value) or inspect.isclass(value)
            if isinstance(value, Fold) or (function and ours(value)):
                found |= {name.removeprefix("fold ") for name in reached(value)}
    return frozenset(found)


def find(key: str) -> Any:
    """The function or fold of this qualified name; None if there is none."""
    module, _, name = key.rpartition(".")
    entry = REGISTRY.get(key)
    if entry is not None:
        return entry.function
    try:
        return getattr(importlib.import_module(module), name, None)
    except (ImportError, ValueError):
        return None


class Store:
    """Verdicts by key, one small file each; what is damaged or another's counts as absent."""

    def __init__(self, folder: Path | None) -> None:
        self.folder = folder

    def get(self, key: str) -> dict[str, Any] | None:
        """What was stored under the key."""
        if self.folder is None:
            return None
        try:
            data = json.loads((self.folder / key[:2] / key).read_text(encoding="utf-8"))
            return dict(data["found"]) if data["key"] == key else None
        except (OSError, ValueError, KeyError, TypeError):
            return None

    def put(self, key: str, found: dict[str, Any]) -> None:
        """Store it, whole or not at all."""
        if self.folder is None:
            return
        file = self.folder / key[:2] / key
        file.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        part = file.with_name(f"{key}.{os.getpid()}")
        part.write_text(json.dumps({"key": key, "found": found}), encoding="utf-8")
        part.replace(file)
