"""What a theorem's premises leave of the kernels that it uses: their paths, and their arguments.

A theorem about one value of an argument says nothing of the others, whatever its sentence says. So of
each use of a kernel it is asked whether each argument can take two different values under the
premises; what the solver cannot show to vary does not.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable
from typing import Any, get_type_hints

import z3

from cratous.core.kernel import entry_of, qualified
from cratous.proofs.engine.claim import Claim
from cratous.proofs.engine.terms import free_names, free_values, known, leaves

Possible = Callable[[list[z3.BoolRef]], str]
"""sat, unsat or unknown."""


def paths(claim: Claim, possible: Possible) -> tuple[tuple[str, tuple[bool, ...]], ...]:
    """For each kernel that is looked into: is each of its paths possible under the premises?

    A path that the solver cannot judge counts as possible: only a proof makes it dead.
    """
    found: dict[str, list[bool]] = {}
    for visit in claim.visits:
        if visit.context or entry_of(visit.function) is None:
            continue
        name, conditions = qualified(visit.function), visit.lifted.branches
        if len(conditions) == 1:
            continue  # nothing is said of the only one
        # arguments may be literals: the uses with the most paths are the kernel's
        if len(conditions) > len(found.get(name, [])):
            found[name] = [False] * len(conditions)
        seen = found[name]
        for number, condition in enumerate(conditions):
            if len(conditions) == len(seen) and not seen[number]:
                terms = [*claim.premises, *visit.lifted.roots, condition]
                seen[number] = possible(terms) != "unsat"
    return tuple((name, tuple(seen)) for name, seen in sorted(found.items()) if len(seen) > 1)


ALL = "all"
NOT = "not"


def varied(claim: Claim, possible: Possible) -> tuple[tuple[str, str], ...]:
    """Of every use of a kernel, in order: how its arguments vary.

    ALL; or the integers and truth values that are written down, where all others vary (a row of a
    table); or NOT.
    """
    premises = list(claim.premises)
    restricted = set().union(*[free_names(premise) for premise in premises])
    uses = [run for run in getattr(claim, "runs", ()) if run.role == "kernel"]
    terms = {t.get_id(): t for run in uses for t in map(known, leaves(run.args)) if free_names(t)}
    free = {key for key, t in terms.items() if z3.is_const(t) and str(t) not in restricted}
    asked = [term for key, term in terms.items() if key not in free]
    varying = free | (_two_values(premises, asked, possible) if asked else set())
    return tuple((qualified(run.function), _how(run, varying)) for run in uses)


def _how(run: Any, varying: set[int]) -> str:
    kinds = [kind for one in _kinds(run.function) for kind in _leaf_kinds(one)]
    terms = [known(leaf) for leaf in leaves(run.args)]
    written = [
        kind in (int, bool) and not free_names(t) for t, kind in zip(terms, kinds, strict=True)
    ]
    if not all(w or t.get_id() in varying for w, t in zip(written, terms, strict=True)):
        return NOT
    return ", ".join(str(t) for t, w in zip(terms, written, strict=True) if w) or ALL


def _kinds(function: Callable[..., Any]) -> list[Any]:
    hints = get_type_hints(function)
    return [hints[name] for name in inspect.signature(function).parameters]


def _leaf_kinds(kind: Any) -> list[Any]:
    fields = getattr(kind, "_fields", ())
    hints = get_type_hints(kind) if fields else {}
    return [leaf for f in fields for leaf in _leaf_kinds(hints[f])] if fields else [kind]


def of_more_than_one(how: Iterable[str]) -> bool:
    """These uses are not all for one value of some argument."""
    found = set(how)
    if ALL in found:
        return True
    rows = [row.split(", ") for row in found - {NOT}]
    # a table: each argument that is written down takes two values at least
    return len(rows) > 1 and all(len(set(column)) > 1 for column in zip(*rows, strict=False))


def _two_values(
    premises: list[z3.BoolRef], terms: list[z3.ExprRef], possible: Possible
) -> set[int]:
    """Those terms that take two values where the premises hold; all are asked at once first."""
    others = [(v, z3.Const(f"{v}!other", v.sort())) for v in free_values([*premises, *terms])]
    twice = [*premises, *[z3.substitute(premise, *others) for premise in premises]]
    apart = {term.get_id(): term != z3.substitute(term, *others) for term in terms}
    if possible([*twice, *apart.values()]) == "sat":
        return set(apart)
    return {key for key, differs in apart.items() if possible([*twice, differs]) == "sat"}
