"""Proved theorems whose definitions have not changed: recalled without lifting their kernels again.

A theorem is kept under a hash of all definitions that could change the proof: its statement, its lemmas, all that
these reach, the prover, the readings; and of the versions of solver and Python. A theorem that asks for whatever is
registered depends on every kernel, fold and driver. Only proved theorems are kept; refuted and undecided ones are
decided anew. As with solver answers, CI begins with an empty cache.
"""

from __future__ import annotations

import functools
import json
import os
import platform
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path
from typing import Any

from cratous.core import ledger as gate
from cratous.core.kernel.sources import digest
from cratous.core.ledger.key_parts import MISSING
from cratous.core.ledger.keys import Keys
from cratous.core.ledger.package_home import PRODUCT, Home
from cratous.proofs.engine.prover import RLIMIT, Theorem, restore


class Recall:
    """Proved theorems of one home in a folder; without a folder nothing is kept.

    keys: by default computed from the files as they are when the first theorem is asked for.
    """

    def __init__(self, folder: Path | None, home: Home = PRODUCT, keys: Keys | None = None) -> None:
        self.folder, self.home = folder, home
        self._given = keys

    @functools.cached_property
    def keys(self) -> Keys:
        """The keys under which theorems are kept."""
        return self._given or Keys(self.home)

    @functools.cached_property
    def _registered(self) -> str:
        """A hash over all that is registered, with everything it depends on."""
        entries = gate.load_all(self.home) | gate.load_all()
        return digest(f"{n}={self.keys.source(entry)}" for n, entry in sorted(entries.items()))

    def key(self, name: str) -> str | None:
        """The hash under which a theorem is kept; None where its file, or a lemma's, is missing."""
        meaning = self.keys.theorem(name)
        if meaning == MISSING:
            return None
        # the kept data name kernels and lemmas, which a move renames
        names = sorted({*self.keys.functions(name), *self.keys.lemmas(name)})
        asked = self._registered if self.keys.asks_registry(name) else ""
        shared = [self.keys.shared[part] for part in ("prover", "readings", "solver")]
        versions = [platform.python_version(), str(RLIMIT)]
        return digest([self.home.name, name, meaning, *names, asked, *shared, *versions])

    def get(self, name: str) -> Theorem | None:
        """The theorem, if it was proved from exactly these definitions."""
        if self.folder is None:
            return None
        try:
            wanted = self.key(name)
        except SyntaxError:
            return None  # the prover reports the place
        if wanted is None:
            return None
        try:
            data = json.loads((self.folder / wanted[:2] / wanted).read_text(encoding="utf-8"))
            if data["key"] != wanted or data["name"] != name:
                return None
            theorem = restore(data["theorem"])
        except (OSError, ValueError, KeyError, TypeError):
            return None
        return theorem if theorem.proved and theorem.name == name else None

    def put(self, theorems: Iterable[Theorem]) -> None:
        """Keep the proved ones; a folder that cannot be written is no error.

        Not kept: a theorem one of whose lemmas has a computed name, and one with a question ended by a time limit,
        since another run may find more.
        """
        for theorem in theorems:
            if self.folder is None or not theorem.proved or theorem.ended:
                continue
            name = self.key(theorem.name)
            if name is None or not set(theorem.lemmas) <= self.keys.lemmas(theorem.name):
                continue
            file = self.folder / name[:2] / name
            if file.is_file():
                continue
            data: dict[str, Any] = asdict(theorem)
            data.pop("_key")
            text = json.dumps({"key": name, "name": theorem.name, "theorem": data})
            try:
                file.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
                part = file.with_name(f"{name}.{os.getpid()}")
                part.write_text(text, encoding="utf-8")
                part.replace(file)
            except OSError:
                return
