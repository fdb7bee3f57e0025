"""Whether a mutant is equivalent: equal everywhere, or wherever the theorems apply."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from typing import Any, get_type_hints

import z3

from cratous.proofs.engine.lift import LiftError, Visit, lift
from cratous.proofs.engine.symbolic import SymMask, _raw
from cratous.proofs.engine.terms import free_names, fresh, known
from cratous.proofs.mutation.inputs import shaped
from cratous.proofs.mutation.solver_queries import ask, values
from cratous.proofs.mutation.statements import claim_of, in_place
from cratous.proofs.mutation.terms import FAR, NEAR, SAME, flat, is_free, premise_text

EVERYWHERE = "equal everywhere"


class Equality:
    """Compares mutants of one function with the original, in the calls that theorems look into."""

    def __init__(self, original: Any, visits: Mapping[str, list[Visit]]) -> None:
        self.original, self.visits = original, visits

    def masks(self) -> frozenset[int]:
        """Positions of the arguments that are bit masks."""
        calls = [visit.args for visits in self.visits.values() for visit in visits]
        return frozenset(k for args in calls for k, a in enumerate(args) if isinstance(a, SymMask))

    def equivalent(self, mutant: Any) -> tuple[str, str, tuple[Any, ...] | None]:
        """Whether mutant and original are equal everywhere, or in all calls that the theorems make.

        Returns verdict, note, and an input on which the two differ if the solver found one.
        """
        if self.everywhere(mutant, FAR):
            return "equivalent", EVERYWHERE, None
        leaves, domain = self._domain(mutant)
        premises = {premise_text(p) for p in domain}
        undecided = False
        for name in self.visits:
            claim = claim_of(name)
            for visit in self.visits[name]:
                given = [*claim.premises, *claim.facts, *visit.context, *visit.granted]
                if leaves and _lies_in(domain, leaves, visit.args, given):
                    continue
                # once a call is undecided, the remaining ones can only show a difference
                answer, row = self._differs(mutant, visit.args, given, NEAR if undecided else SAME)
                if answer == "sat":
                    return "survived", "differs for values that a theorem allows", row
                undecided = undecided or answer != "unsat"
                premises.update(premise_text(p) for p in (*claim.premises, *visit.granted))
        if not undecided:
            return "equivalent", f"equal wherever {'; '.join(sorted(premises))}", None
        return "undecided", "neither refuted nor proved equivalent within the budget", None

    def everywhere(self, mutant: Any, effort: int) -> bool:
        """Whether it is proved, with this effort, that the two agree on all arguments."""
        hints = get_type_hints(self.original)
        masks = self.masks()
        symbols = tuple(
            SymMask(z3.BitVec(name, 64)) if k in masks else fresh(name, hints[name])
            for k, name in enumerate(inspect.signature(self.original).parameters)
        )
        try:
            return self._differs(mutant, symbols, [], effort)[0] == "unsat"
        except (LiftError, TypeError):
            return False  # some arguments must be literals, as in the theorems

    def _domain(self, mutant: Any) -> tuple[list[z3.ExprRef], list[z3.BoolRef]]:
        """The arguments' names, and premises on the arguments alone under which the two agree.

        They are those of a theorem about arbitrary arguments; a caller's arguments need only satisfy them, which is
        far easier to decide than the equality itself. Empty if there are none.
        """
        for name in self.visits:
            for visit in self.visits[name]:
                if not all(is_free(leaf) for leaf in flat(visit.args)):
                    continue
                leaves = [_raw(leaf) for leaf in flat(visit.args)]
                names = {str(leaf) for leaf in leaves}
                held = [*claim_of(name).premises, *visit.granted]
                own = [p for p in held if free_names(p) <= names]
                if self._differs(mutant, visit.args, own, SAME)[0] == "unsat":
                    return leaves, own
        return [], []

    def _differs(
        self, mutant: Any, args: tuple[Any, ...], given: list[z3.BoolRef], rlimit: int
    ) -> tuple[str, tuple[Any, ...] | None]:
        """`unsat` if the two agree on these arguments; with `sat`, values for which they differ."""
        one = lift(self.original, *args)
        with in_place(self.original, mutant):
            other = lift(self.original, *args)
        facts = [*given, *one.roots, *other.roots]
        wanted = [_raw(leaf) for leaf in flat(args)]
        answer, found = values([*facts, _unequal(one.value, other.value)], NEAR, wanted)
        if answer == "unknown":
            # path by path there are more questions, but much easier ones
            for condition, value in zip(one.branches, one.values, strict=True):
                for condition_too, value_too in zip(other.branches, other.values, strict=True):
                    both = [*facts, condition, condition_too, _unequal(value, value_too)]
                    answer, found = values(both, rlimit, wanted)
                    if answer != "unsat":
                        break
                else:
                    continue
                break
        if found is None:
            return answer, None
        hints = get_type_hints(self.original)
        kinds = [hints[name] for name in inspect.signature(self.original).parameters]
        return answer, shaped(kinds, iter(found))


def _lies_in(
    domain: list[z3.BoolRef],
    leaves: list[z3.ExprRef],
    args: tuple[Any, ...],
    given: list[z3.BoolRef],
) -> bool:
    """Whether these arguments satisfy the premises, given `given`."""
    pairs = list(zip(leaves, [known(leaf) for leaf in flat(args)], strict=True))
    if any(one.sort() != other.sort() for one, other in pairs):
        return False
    wanted = [z3.substitute(premise, *pairs) for premise in domain]
    return all(ask([*given, z3.Not(premise)], FAR) == "unsat" for premise in wanted)


def _unequal(one: Any, other: Any) -> z3.BoolRef:
    pairs = zip(flat(one), flat(other), strict=True)
    return z3.Or(*[_raw(a) != _raw(b) for a, b in pairs])
