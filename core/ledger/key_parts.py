"""The parts of a key: the roots and borders of the walks over readings and prover, and the versions."""

from __future__ import annotations

import functools
import importlib.metadata

from cratous.core.readings.machine.compiled import FLAGS

PARTS = {
    "source": "its source or that of something it calls",
    "spec": "its definition in spec",
    "theorems": "its theorems",
    "prover": "the prover",
    "readings": "the readings (machine code, the exact reading, the registry, this gate)",
    "flags": "the compiler flags or the versions of numba, llvmlite, numpy",
}
PROVENANCE = ("solver",)
"""Stored beside the parts of a key, and no reason to refuse: a proof remains valid with another z3."""
READINGS = (
    "core.kernel.kernel",
    "core.kernel.driver",
    "core.kernel.fold",
    "core.compiled.compiled",
    "core.compiled.exact",
    "core.readings.machine.compiled.machine",
    "core.readings.exact.exactly",
    "core.readings.exact.folds.folded",
    "core.readings.enclosed.enclosed",
    "core.readings.tiered.swift",
    "core.readings.tiered.within",
    "core.readings.tiered.at_once",
    "core.ledger.require",
)
"""How a kernel is marked, compiled, read exactly, and checked against the ledger: with all dependencies."""
PROVER = (
    "proofs.claim.Claim",
    "proofs.engine.prover.prove_file",
    "proofs.engine.subset.lint_all",
    "proofs.ledger.records",
    "proofs.ledger.prove_all",
    "proofs.ledger.problems",
)
"""The code that decides that something is proved: with all dependencies, part of the key of every proof."""
REMEMBERS = (
    "proofs.engine.cache.Cache",
    "proofs.engine.counterexample.story",
    "proofs.engine.counterexample.telling",
    "proofs.engine.statement_errors.slip_in",
    "proofs.ledger.proof_recall.Recall",
)
"""Code that only prints or caches: a prover with an empty cache decides the same without it."""
COMPILER = ("numba", "llvmlite", "numpy")
MISSING = "missing"
"""Represents a missing part, for which the gate refuses."""


@functools.cache
def version(name: str) -> str:
    """The installed version of a distribution."""
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return "not installed"


def solver_version() -> str:
    """The installed z3."""
    return f"z3 {version('z3-solver')}"


def compiler() -> str:
    """How machine code is compiled: numba's flags, and the versions that determine their meaning."""
    return "; ".join([FLAGS, *(f"{name} {version(name)}" for name in COMPILER)])
