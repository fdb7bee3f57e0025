"""The evidence for the status of each kernel, fold and driver (`core.ledger.status`)."""

from __future__ import annotations

from collections.abc import Mapping

from cratous.core.kernel import Entry
from cratous.core.ledger.package_home import Home
from cratous.core.ledger.status import Grounds
from cratous.proofs.statements.definitions import Proofs, relating
from cratous.proofs.statements.rechecked import rechecked_by


def grounds(entries: Mapping[str, Entry], home: Home, proofs: Proofs) -> dict[str, Grounds]:
    """The evidence by name; proofs: of all theorems of the home."""
    return {
        name: Grounds(rechecked_by=rechecked_by(entry))
        if entry.kind == "driver"
        else Grounds(against=tuple(t for t in relating(entry, home, proofs) if t in proofs.proved))
        for name, entry in entries.items()
    }
