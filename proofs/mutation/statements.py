"""The theorems as mutation states them: unchanged, and with a mutant in a function's place."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import z3

from cratous.core.kernel import REGISTRY, Fold, qualified
from cratous.core.ledger.package_home import PRODUCT, Home
from cratous.proofs.engine.claim import Claim
from cratous.proofs.engine.lift import REPLACED, LiftError
from cratous.proofs.engine.obligation import Obligation
from cratous.proofs.engine.theorem_files import FOLDER, load_claim, load_lemma


@dataclass(frozen=True)
class _Stated:
    name: str
    claim: Claim
    seen: frozenset[tuple[int, ...]]


_FOLDER = [FOLDER]


def theorems_from(folder: Path) -> None:
    """Read theorems from this folder from now on; lemmas also from the product's."""
    if folder != _FOLDER[0]:
        _FOLDER[0] = folder
        stated.cache_clear()


def state(name: str, **how: Any) -> Claim:
    """The claim of a theorem, stated anew; how: see the fields of `Claim`."""
    folder = _FOLDER[0]
    statement = load_claim(name, folder)[0]
    claim = Claim(load=lambda other: load_lemma(other, folder), **how)
    statement(claim)
    claim.settle()
    return claim


def ids(obligation: Obligation) -> tuple[int, ...]:
    """Identifies an obligation within one process."""
    return (obligation.goal.get_id(), *sorted({g.get_id() for g in obligation.given}))


@cache
def stated(name: str) -> _Stated:
    """A theorem as it stands, with its obligations, which were proved."""
    claim = state(name)
    return _Stated(name, claim, frozenset(ids(o) for o in claim.obligations))


def targets(names: Iterable[str], home: Home = PRODUCT) -> dict[str, tuple[Any, list[str]]]:
    """Function or fold of this home by qualified name, with the theorems that look into it."""
    found: dict[str, tuple[Any, list[str]]] = {}

    def add(target: Any, theorem: str) -> None:
        if qualified(target).split(".")[0] != home.name:
            return
        users = found.setdefault(qualified(target), (target, []))[1]
        if theorem not in users:
            users.append(theorem)

    for name in names:
        claim = stated(name).claim
        for visit in claim.visits:
            if not {"proofs", "theorems"} & set(visit.function.__module__.split(".")[1:2]):
                add(visit.function, name)
        for kernel in claim.kernels:
            entry = REGISTRY.get(kernel)
            if entry is not None and isinstance(entry.function, Fold):
                add(entry.function, name)
    return dict(sorted(found.items()))


def claim_of(name: str) -> Claim:
    """The stated claim of a theorem as it stands."""
    return stated(name).claim


class Stillborn(Exception):
    """The mutant cannot be lifted."""


@contextmanager
def in_place(original: Any, mutant: Any) -> Iterator[None]:
    """Within this, the original is lifted as the mutant; raises Stillborn."""
    REPLACED[original] = mutant
    try:
        yield
    except (LiftError, TypeError, z3.Z3Exception) as error:
        raise Stillborn(f"{type(error).__name__}: {error}") from error
    finally:
        del REPLACED[original]
