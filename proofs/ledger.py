"""Proves all theorems and writes what came of it into `core/ledger.json`.

The file holds facts only (no times, no machine): it is the same on every machine that proves the
same code with the same solver, so CI can compare it byte by byte.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cratous.core import ledger as gate
from cratous.core.kernel import REGISTRY
from cratous.proofs import prover
from cratous.proofs.subset import Finding, lint_all


@dataclass(frozen=True)
class Inventory:
    """What a run of the prover found: theorems, lint findings, kernels without a theorem."""

    theorems: tuple[prover.Theorem, ...]
    findings: tuple[Finding, ...]
    bare: tuple[str, ...]

    @property
    def holds(self) -> bool:
        """True iff everything is proved and nothing is missing."""
        return all(t.proved for t in self.theorems) and not self.findings and not self.bare


def prove_all(
    names: Iterable[str], tell: Callable[[prover.Theorem], None] | None = None
) -> Inventory:
    """Prove these theorems, and look for kernels that no theorem names."""
    gate.load_all()
    theorems = []
    for name in names:
        theorem = prover.prove_file(name)
        theorems.append(theorem)
        if tell is not None:
            tell(theorem)
    named = {kernel for theorem in theorems for kernel in theorem.kernels}
    strangers = sorted(kernel for kernel in named if kernel not in REGISTRY)
    if strangers:
        raise ValueError(f"theorems name what is not registered: {', '.join(strangers)}")
    bare = [n for n, e in sorted(REGISTRY.items()) if e.kind != "driver" and n not in named]
    return Inventory(tuple(theorems), tuple(lint_all()), tuple(bare))


def _theorem_record(theorem: prover.Theorem) -> dict[str, Any]:
    return {
        "sentence": theorem.sentence,
        "kernels": sorted(theorem.kernels),
        "lemmas": sorted(set(theorem.lemmas)),
        "status": "proved" if theorem.proved else "not proved",
        "premises": theorem.premises,
        "obligations": len(theorem.outcomes),
        "assumptions": [list(a) for a in theorem.assumptions],
    }


def records(inventory: Inventory) -> dict[str, Any]:
    """The ledger as data."""
    theorems = {t.name: _theorem_record(t) for t in inventory.theorems}
    kernels: dict[str, Any] = {}
    for name, entry in gate.load_all().items():
        own = sorted(t for t, record in theorems.items() if name in record["kernels"])
        checkers = [u for u in entry.uses if entry.kind == "driver"]
        good = bool(own) and all(theorems[t]["status"] == "proved" for t in own)
        if entry.kind == "driver":
            good = bool(checkers) and all(u in REGISTRY for u in checkers)
        kernels[name] = {
            "kind": entry.kind,
            "implements": entry.implements,
            "checked_by": checkers,
            "theorems": own,
            "status": "proved" if good else "not proved",
            "key": gate.key_parts(entry, own, theorems),
        }
    data = {"solver": gate.solver_version(), "kernels": kernels, "theorems": theorems}
    return {**data, "seal": gate.seal(data)}


def text(inventory: Inventory) -> str:
    """The ledger as it is written."""
    return json.dumps(records(inventory), indent=1, sort_keys=True) + "\n"


def write(inventory: Inventory, path: Path = gate.LEDGER) -> bool:
    """Write the ledger; True iff it differs from what was there."""
    new = text(inventory)
    old = path.read_text(encoding="utf-8") if path.is_file() else ""
    if new == old:
        return False
    part = path.with_suffix(".part")
    part.write_text(new, encoding="utf-8")
    part.replace(path)
    return True
