"""What a theorem's premises leave of the kernels that it uses: reachable paths and possible argument values.

A theorem about a few values of an argument does not cover the others, whatever its sentence says. So for each use of
a kernel it is determined whether each argument can take more than a few values under the premises (see
`argument_values`); an argument for which this is not shown counts as not varying.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple, get_type_hints

import z3

from cratous.core.kernel import entry_of, qualified
from cratous.proofs.engine.argument_values import FEW, Another, Given, Possible, Taken
from cratous.proofs.engine.claim import Claim
from cratous.proofs.engine.obligation_hash import Hasher
from cratous.proofs.engine.terms import free_names, known, leaves


def paths(claim: Claim, possible: Possible) -> tuple[tuple[str, tuple[bool, ...]], ...]:
    """For each kernel that is looked into: whether each of its paths is possible under the premises.

    A path that the solver cannot decide counts as possible: only a proof makes it dead.
    """
    found: dict[str, list[bool]] = {}
    for visit in claim.visits:
        if visit.context or entry_of(visit.function) is None:
            continue
        name, conditions = qualified(visit.function), visit.lifted.branches
        if len(conditions) == 1:
            continue  # a single path is not reported
        # arguments may be literals: the use with the most paths stands for the kernel
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


class Asked(NamedTuple):
    """How argument values are determined: by the solver, and by runs of the statement if it can be run."""

    possible: Possible
    another: Another
    taken: Taken | None = None


def varied(claim: Claim, ask: Asked) -> tuple[tuple[str, str], ...]:
    """For every use of a kernel, in order: how its arguments vary.

    ALL; or the written integers and truth values, where all other arguments vary (a row of a table); or NOT, followed
    by the number of values for an argument that takes a few (NOT 2). A kernel whose definition is not in the theorem
    gets NOT unasked, since the theorem does not vouch for it.
    """
    given = Given(_restricting(claim), ask.possible)
    restricted = set().union(*[free_names(premise) for premise in given.premises])
    uses = [run for run in getattr(claim, "runs", ()) if run.role == "kernel"]
    may_vouch = _beside_their_definitions(claim)
    places = {
        (number, position): term
        for number, run in enumerate(uses)
        if qualified(run.function) in may_vouch
        for position, term in enumerate(map(known, leaves(run.args)))
        if free_names(term)
    }
    terms = {term.get_id(): term for term in places.values()}
    varying = {key for key, t in terms.items() if z3.is_const(t) and str(t) not in restricted}
    open_ = {place: term for place, term in places.items() if term.get_id() not in varying}
    if open_ and ask.taken is not None:
        seed = Hasher().key("places", [*claim.premises, *claim.facts, *terms.values()])
        varying |= {places[place].get_id() for place in ask.taken(seed, open_)}
    asked = [term for key, term in terms.items() if key not in varying]
    varying |= given.many(asked) if asked else set()
    rest = [term for term in asked if term.get_id() not in varying]
    few = given.counts(rest, ask.another) if rest else {}
    varying |= {key for key, n in few.items() if n > FEW and not z3.is_real(terms[key])}
    found = [(qualified(run.function), run) for run in uses]
    return tuple((n, _how(run, varying, few) if n in may_vouch else NOT) for n, run in found)


def _beside_their_definitions(claim: Claim) -> set[str]:
    """The used kernels whose definition the theorem looks at, and those that are steps of others."""
    looked = {visit.function for visit in claim.visits} | claim.stubs.keys()
    modules = {f.__module__ for f in looked if hasattr(f, "__qualname__")}
    used = {run.function for run in getattr(claim, "runs", ()) if run.role == "kernel"}
    found = {qualified(kernel) for fold in getattr(claim, "folds", ()) for kernel in fold.kernels}
    for function in used:
        entry, name = entry_of(function), qualified(function)
        # the module only, since a fold of which it is a step may implement another definition there
        meant = "" if entry is None else entry.implements.rpartition(".")[0]
        if entry is not None and (
            entry.supports or f"{name.partition('.')[0]}.spec.{meant}" in modules
        ):
            found.add(name)
    return found


def _restricting(claim: Claim) -> list[z3.BoolRef]:
    """The premises; if they involve results, also what is known of these (square roots, opaque functions)."""
    premises = list(claim.premises)
    own = {claim.prefix + name for name in claim.names}
    results = set().union(*[free_names(premise) for premise in premises]) - own
    return [*premises, *claim.facts] if results else premises


def _how(run: Any, varying: set[int], few: Mapping[int, int]) -> str:
    kinds = [kind for one in _kinds(run.function) for kind in _leaf_kinds(one)]
    terms = [known(leaf) for leaf in leaves(run.args)]
    written = [
        kind in (int, bool) and not free_names(t) for t, kind in zip(terms, kinds, strict=True)
    ]
    left = [t for t, w in zip(terms, written, strict=True) if not w and t.get_id() not in varying]
    if left:
        counts = [few.get(t.get_id(), 1) for t in left]
        return NOT if min(counts) < 2 else f"{NOT} {min(counts)}"
    return ", ".join(str(t) for t, w in zip(terms, written, strict=True) if w) or ALL


def values_left(how: Iterable[str]) -> int:
    """The greatest number of values among uses that leave an argument only a few; 0 if there is none."""
    return max((int(one.removeprefix(NOT)) for one in how if one.startswith(f"{NOT} ")), default=0)


def _kinds(function: Callable[..., Any]) -> list[Any]:
    hints = get_type_hints(function)
    return [hints[name] for name in inspect.signature(function).parameters]


def _leaf_kinds(kind: Any) -> list[Any]:
    fields = getattr(kind, "_fields", ())
    hints = get_type_hints(kind) if fields else {}
    return [leaf for f in fields for leaf in _leaf_kinds(hints[f])] if fields else [kind]


def of_more_than_one(how: Iterable[str]) -> bool:
    """Whether these uses together are not limited to a few values of some argument."""
    found = set(how)
    if ALL in found:
        return True
    rows = [row.split(", ") for row in found if not row.startswith(NOT)]
    # a table: each written argument takes two values at least
    return len(rows) > 1 and all(len(set(column)) > 1 for column in zip(*rows, strict=False))
