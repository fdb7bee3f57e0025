"""Hashes of everything that a mutation result depends on, and the store of results under them.

A target's key covers the function and all that it calls, every theorem that could look into it (with its lemmas,
definitions and kernels), the code that judges, and the solver. A mutant's key adds its text. So a verdict is
recomputed only when something it depends on has changed, and `proofs/mutation/mutation.json` can be compared with the
code without asking the solver.
"""

from __future__ import annotations

import fnmatch
import functools
import importlib
import json
import os
from pathlib import Path
from typing import Any

from cratous.core.kernel import REGISTRY
from cratous.core.kernel.sources import constants, digest
from cratous.core.ledger import keys as ledger_keys
from cratous.core.ledger.definition_hash import Border, Walk, walk
from cratous.core.ledger.key_parts import solver_version
from cratous.core.ledger.lookup_exceptions import EXCUSED
from cratous.core.ledger.package_home import PRODUCT, Home
from cratous.proofs.engine.theorem_files import theorem_files

GENERATED = "filter_*"
"""Theorems that compare a kernel with code generated from it. They do not count as killing: every fault differs from
what was generated before, so they would hide each missing theorem."""

JUDGES = (
    "proofs.mutation.judgement.judge_target",
    "proofs.mutation.premises.judge_premises",
)
"""The functions that produce verdicts, and with them all they depend on, including the prover."""

REGISTERED = "each function and theorem that is judged is a part of the target's key by itself"
COMPILED = "it looks into the function that is judged, and the target's key follows the names in it"
LOOKED_UP: dict[str, tuple[tuple[str, ...], str]] = {
    "proofs.mutation.judgement.judge_target": (("load_all",), REGISTERED),
    "proofs.mutation.premises.judge_premises": (("load_all",), REGISTERED),
    "proofs.mutation.statements.targets": (("REGISTRY",), REGISTERED),
    "proofs.mutation.operators._function": (("exec", "modules"), COMPILED),
    "proofs.mutation.operators._Types": (("__globals__",), COMPILED),
    "proofs.mutation.keys.Store.get": (("read_text",), "what lies there is found by its key"),
}
"""Dynamic look-ups of the judging code that its key need not follow, as in `core.ledger.lookup_exceptions`."""


class Keys:
    """Keys of the targets of one home; theorems: those that may kill, by default all."""

    def __init__(self, home: Home = PRODUCT, theorems: list[str] | None = None) -> None:
        self.home, self.folder = home, home.theorems
        names = list(theorem_files(home.theorems)) if theorems is None else theorems
        self.theorems = [n for n in names if not fnmatch.fnmatch(n, GENERATED)]
        self._keys = ledger_keys.Keys(home)
        self._reach: dict[str, frozenset[str]] = {}

    @functools.cached_property
    def judging(self) -> str:
        """The key of the code that produces verdicts, and of the solver."""
        own, prover, readings = self.judges, self._keys.prover, self._keys.readings
        return digest([own.digest, prover.digest, readings.digest, solver_version()])

    @functools.cached_property
    def judges(self) -> Walk:
        """The walk over the code that produces verdicts, up to the prover and the readings."""
        prover, readings = self._keys.prover, self._keys.readings
        border = Border(
            frozenset((*prover.places, *readings.places)),
            lambda p: f"prover {prover.places.get(p)} readings {readings.places.get(p)}",
            prover.attributes | readings.attributes,
            (*prover.classes, *readings.classes),
        )
        own = {f"cratous.{name}": frozenset(words) for name, (words, _) in LOOKED_UP.items()}
        roots = [place for name in JUDGES for place in self._keys.places(f"cratous.{name}")]
        return walk(self._keys.tree, roots, border, excused={**EXCUSED, **own})

    def target(self, key: str, target: Any) -> str:
        """The key of a function or fold; key: its qualified name."""
        users = [n for n in self.theorems if key in self.reach(n)]
        found = self._keys.function(key)
        source = [found.digest if found else "missing", *constants(target)]
        said = sorted(self._keys.theorem(name) for name in users)
        return digest(["target", *source, "theorems", *said, self.judging])

    def mutant(self, target_key: str, text: str) -> str:
        """The key of a verdict on one mutant."""
        return digest(["mutant", target_key, text])

    def premises(self, theorem: str) -> str:
        """The key of the verdicts on a theorem's premises."""
        return digest(["premises", self._keys.theorem(theorem), self.judging])

    def reach(self, theorem: str) -> frozenset[str]:
        """Qualified names of all functions and folds that a theorem or one of its lemmas could look into.

        Taken from the names in it, so it may be more than what the theorem uses.
        """
        if theorem not in self._reach:
            self._reach[theorem] = self._keys.functions(theorem)
        return self._reach[theorem]


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
    """Verdicts by key, one small file each; a file that is damaged or belongs to another key counts as absent."""

    def __init__(self, folder: Path | None) -> None:
        self.folder = folder

    def get(self, key: str) -> dict[str, Any] | None:
        """The verdict stored under the key, or None."""
        if self.folder is None:
            return None
        try:
            data = json.loads((self.folder / key[:2] / key).read_text(encoding="utf-8"))
            return dict(data["found"]) if data["key"] == key else None
        except (OSError, ValueError, KeyError, TypeError):
            return None

    def put(self, key: str, found: dict[str, Any]) -> None:
        """Store a verdict atomically."""
        if self.folder is None:
            return
        file = self.folder / key[:2] / key
        file.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        part = file.with_name(f"{key}.{os.getpid()}")
        part.write_text(json.dumps({"key": key, "found": found}), encoding="utf-8")
        part.replace(file)
