"""What theorems relate, kept from one run to the next."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from cratous.core.kernel.sources import digest
from cratous.core.ledger.package_home import Home
from cratous.proofs.ledger.proof_recall import Recall
from cratous.proofs.ledger.text_cache import named
from cratous.proofs.statements import relations, sentences
from cratous.proofs.statements.relations import Relations


class Kept:
    """The relations of theorems, in a folder from one run to the next; without one they are read anew.

    They are kept as proved theorems are, under a hash of all that the statement depends on.
    """

    def __init__(self, folder: Path | None, home: Home) -> None:
        self.folder, self.home, self._recall = folder, home, Recall(None, home)

    def all(self, names: Iterable[str]) -> dict[str, Relations]:
        """The relations of these theorems, whose statements can be read."""
        return {name: self.get(name) for name in names}

    def get(self, name: str) -> Relations:
        """The relations of one theorem."""
        known = self._recall.key(name) if self.folder is not None else None
        if self.folder is None or known is None:
            return relations.relations(name, self.home.theorems)
        readers = (relations.__file__, sentences.__file__)
        wanted = digest([known, *(named(Path(reader).resolve()) for reader in readers)])
        file = self.folder / wanted[:2] / wanted
        try:
            return _restored(json.loads(file.read_text(encoding="utf-8")))
        except (OSError, ValueError, KeyError, TypeError):
            found = relations.relations(name, self.home.theorems)
        parts: dict[str, Any] = {part: sorted(getattr(found, part)) for part in PARTS}
        text = json.dumps({**parts, "statement": found.statement})
        try:
            file.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
            part = file.with_name(f"{wanted}.{os.getpid()}")
            part.write_text(text, encoding="utf-8")
            part.replace(file)
        except OSError:
            pass  # a folder that cannot be written is no error
        return found


PARTS = ("definitions", "together", "follows", "leads", "lemmas", "uses")


def _restored(data: dict[str, Any]) -> Relations:
    together, follows, leads = (
        frozenset((str(a), str(b)) for a, b in data[part]) for part in PARTS[1:4]
    )
    lemmas = tuple(map(str, data["lemmas"]))
    uses = frozenset((str(a), str(b), str(c), int(d)) for a, b, c, d in data["uses"])
    definitions, statement = frozenset(map(str, data["definitions"])), str(data["statement"])
    return Relations(definitions, together, follows, leads, lemmas, uses, statement)
