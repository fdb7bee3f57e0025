"""Judging mutants: one function or fold, or the premises of one theorem, at a time.

A mutant is put in place of its original by `lift.REPLACED`, the theorems that look into the
function are stated anew, and only the obligations that differ from the proved ones are decided.
Inputs on which the two differ fix the question's variables first: such a question is small.
"""

from __future__ import annotations

import dataclasses
import inspect
import re
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, get_type_hints

import z3

from cratous.core import ledger as gate
from cratous.core.kernel import REGISTRY, Fold
from cratous.proofs import prover
from cratous.proofs.asking import ask, renew, values
from cratous.proofs.claim import Claim, Obligation, _free, _fresh, _known
from cratous.proofs.lift import REPLACED, LiftError, lift
from cratous.proofs.mutation_inputs import SAMPLES, compare, inputs, shaped
from cratous.proofs.mutation_inputs import run as run_once
from cratous.proofs.mutation_operators import Mutant, mutants
from cratous.proofs.mutation_report import PremiseResult, Result
from cratous.proofs.symbolic import SymMask, _raw

NEAR = 300_000
"""Effort for a question whose inputs are fixed."""
FAR = 3_000_000
"""Effort for an open question; a theorem that was dearer to prove gets twice its own, up to MOST."""
MOST = 10_000_000
SAME = 12_000_000
"""Effort to prove that a mutant is equivalent: seldom asked, and it spares a person the search."""


# -- the theorems as they stand -------------------------------------------------------------
@dataclass(frozen=True)
class _Stated:
    name: str
    claim: Claim
    seen: frozenset[tuple[int, ...]]


_FOLDER = [prover.FOLDER]


def theorems_from(folder: Path) -> None:
    """Read theorems from this folder from now on; lemmas also from the product's."""
    if folder != _FOLDER[0]:
        _FOLDER[0] = folder
        stated.cache_clear()


def _state(name: str, **how: Any) -> Claim:
    folder = _FOLDER[0]
    statement = prover.load_claim(name, folder)[0]
    claim = Claim(load=lambda other: prover.load_claim(other, folder)[0], **how)
    statement(claim)
    return claim


def _ids(obligation: Obligation) -> tuple[int, ...]:
    return (obligation.goal.get_id(), *sorted({g.get_id() for g in obligation.given}))


@cache
def stated(name: str) -> _Stated:
    """A theorem as it stands, with the obligations that were proved."""
    claim = _state(name)
    return _Stated(name, claim, frozenset(_ids(o) for o in claim.obligations))


def targets(names: Iterable[str]) -> dict[str, tuple[Any, list[str]]]:
    """Function or fold by `module.name`, with those of these theorems that look into it."""
    found: dict[str, tuple[Any, list[str]]] = {}

    def add(target: Any, module: str, theorem: str) -> None:
        key = f"{module.removeprefix('cratous.')}.{target.__name__}"
        users = found.setdefault(key, (target, []))[1]
        if theorem not in users:
            users.append(theorem)

    for name in names:
        claim = stated(name).claim
        for visit in claim.visits:
            module = visit.function.__module__
            if ".proofs" not in module:
                add(visit.function, module, name)
        for kernel in claim.kernels:
            entry = REGISTRY.get(kernel)
            if entry is not None and isinstance(entry.function, Fold):
                add(entry.function, entry.function.step.__module__, name)
    return dict(sorted(found.items()))


# -- one target's inputs as equations ---------------------------------------------------------
def _flat(value: Any) -> list[Any]:
    return [x for part in value for x in _flat(part)] if isinstance(value, tuple) else [value]


def _is_free(value: Any) -> bool:
    """An arbitrary value, which an input fixes at once."""
    term = _known(value)
    return z3.is_const(term) and term.decl().kind() == z3.Z3_OP_UNINTERPRETED


def _equal(args: tuple[Any, ...], row: tuple) -> list[z3.BoolRef]:
    """The arguments of a visit have these values."""
    equations = []
    for one, value in zip(_flat(args), _flat(row), strict=True):
        term = _raw(one)
        if isinstance(one, SymMask):
            equations.append(term == z3.BitVecVal(value, 64))
        elif isinstance(value, bool):
            equations.append(term if value else z3.Not(term))
        else:
            equations.append(term == (z3.RealVal(str(value)) if z3.is_real(term) else value))
    return equations


@contextmanager
def _in_place(original: Any, mutant: Any) -> Iterator[None]:
    REPLACED[original] = mutant
    try:
        yield
    finally:
        del REPLACED[original]


# -- one target -------------------------------------------------------------------------------
class Target:
    """A function or fold under mutation, with the theorems that may notice."""

    def __init__(self, key: str, original: Any, users: list[str], effort: Mapping[str, int]):
        self.key, self.original, self.effort = key, original, effort
        entry = REGISTRY.get(original.__name__)
        mine = entry is not None and entry.function is original
        self.kind = (entry.kind if entry is not None else "") if mine else "definition"
        self.visits = {n: [v for v in claim_of(n).visits if v.function is original] for n in users}
        self.users = sorted(users, key=self._promise)
        if not isinstance(original, Fold):
            self.rows = inputs(original, self._masks(), SAMPLES)
            self.results = [run_once(original, row) for row in self.rows]

    def _promise(self, name: str) -> tuple[bool, bool, int, str]:
        """Theorems that name the kernel first, those with free arguments, then the cheap ones."""
        calls = [v.args for v in self.visits[name]]
        free = any(all(_is_free(leaf) for leaf in _flat(args)) for args in calls)
        named = self.original.__name__ in claim_of(name).kernels
        return not named, not free, self.effort[name], name

    def _masks(self) -> frozenset[int]:
        calls = [visit.args for visits in self.visits.values() for visit in visits]
        return frozenset(k for args in calls for k, a in enumerate(args) if isinstance(a, SymMask))

    def judge(self, mutant: Mutant) -> Result:
        """The verdict on one mutant."""
        home = inspect.getsourcefile(self.original) if callable(self.original) else None
        place = f"{'/'.join(Path(str(home)).parts[-2:])}:{mutant.line}"

        def verdict(what: str, by: str = "", note: str = "") -> Result:
            return Result(self.key, self.kind, mutant.operator, place, mutant.diff, what, by, note)

        seen = compare(mutant.function, self.rows, self.results)
        if seen.stillborn:
            return verdict("stillborn", note=seen.stillborn)
        try:
            rows = self.allowed(seen.inputs)
            by = self.refuted(mutant.function, rows)
            if by:
                return verdict("killed", by)
            if rows:
                return verdict("survived", note=f"differs at {_row(rows[0])}")
            what, note, row = self.equivalent(mutant.function)
            if what == "survived" and row:
                # the solver found an input that the grids have not: it starts from there
                by = self.refuted(mutant.function, [row])
                return (
                    verdict("killed", by) if by else verdict(what, note=f"differs at {_row(row)}")
                )
            return verdict(what, note=note)
        except (LiftError, TypeError, z3.Z3Exception) as error:
            return verdict("stillborn", note=f"{type(error).__name__}: {error}")

    def refuted(self, mutant: Any, rows: list[tuple]) -> str:
        """The first theorem that is refuted with the mutant in place, or nothing.

        rows: inputs that tell mutant and original apart; a question about one of them is a small
        one. Cheap questions to all theorems come before dear ones to any.
        """
        changed = []
        for name in self.users:
            questions = self._questions(name, mutant)
            changed.append((name, questions))
            if self._refutes(name, questions, rows, NEAR, NEAR):
                return name
        for name, questions in changed:
            if self._refutes(name, questions, rows, FAR, _budget(self.effort[name])):
                return name
        return ""

    def _refutes(
        self, name: str, questions: list[list[z3.BoolRef]], rows: list[tuple], near: int, far: int
    ) -> bool:
        starts = [_equal(v.args, row) for row in rows for v in self.visits[name][:2]]
        return any(
            ask([*start, *question], near if start else far) == "sat"
            for start in [*starts, []]
            for question in questions
        )

    def _questions(self, name: str, mutant: Any) -> list[list[z3.BoolRef]]:
        """What has to be decided anew: the obligations that are not those that were proved."""
        with _in_place(self.original, mutant):
            claim = _state(name)
        known = stated(name).seen
        fresh = [o for o in claim.obligations if _ids(o) not in known]
        return [[*o.given, z3.Not(o.goal)] for o in fresh]

    def allowed(self, rows: tuple[tuple, ...]) -> list[tuple]:
        """Up to three of these inputs for which some theorem speaks about the function."""
        found = []
        for row in rows:
            if any(
                ask([*_equal(v.args, row), *claim_of(name).premises, *v.context], NEAR) == "sat"
                for name in self.users
                for v in self.visits[name][:4]
            ):
                found.append(row)
                if len(found) == 3:
                    break
        return found

    def equivalent(self, mutant: Any) -> tuple[str, str, tuple | None]:
        """Equal everywhere, or in all calls that the theorems make; else what is known, and where.

        Gives verdict, note, and an input on which the two differ if the solver found one.
        """
        hints = get_type_hints(self.original)
        masks = self._masks()
        symbols = tuple(
            SymMask(z3.BitVec(name, 64)) if k in masks else _fresh(name, hints[name])
            for k, name in enumerate(inspect.signature(self.original).parameters)
        )
        if self._differs(mutant, symbols, [], FAR)[0] == "unsat":
            return "equivalent", "equal everywhere", None
        leaves, domain = self._domain(mutant)
        premises = {_text(p) for p in domain}
        undecided = False
        for name in self.users:
            claim = claim_of(name)
            for visit in self.visits[name]:
                given = [*claim.premises, *claim.facts, *visit.context]
                if leaves and _lies_in(domain, leaves, visit.args, given):
                    continue
                answer, row = self._differs(mutant, visit.args, given, SAME)
                if answer == "sat":
                    return "survived", "differs for values that a theorem allows", row
                undecided = undecided or answer != "unsat"
                premises.update(_text(p) for p in claim.premises)
        if not undecided:
            return "equivalent", f"equal wherever {'; '.join(sorted(premises))}", None
        if all(self._holds(name, mutant) for name in self.users):
            return "undecided", "every theorem holds with it; equality is not decided", None
        return "undecided", "neither refuted nor proved equivalent within the budget", None

    def _domain(self, mutant: Any) -> tuple[list[z3.ExprRef], list[z3.BoolRef]]:
        """Premises on the arguments alone under which the two agree, and the arguments' names.

        They are those of a theorem about arbitrary arguments; a caller's arguments need only
        satisfy them, which is far easier to decide than the equality itself. Empty if there are
        none.
        """
        for name in self.users:
            for visit in self.visits[name]:
                if not all(_is_free(leaf) for leaf in _flat(visit.args)):
                    continue
                leaves = [_raw(leaf) for leaf in _flat(visit.args)]
                names = {str(leaf) for leaf in leaves}
                own = [p for p in claim_of(name).premises if _free(p) <= names]
                if self._differs(mutant, visit.args, own, SAME)[0] == "unsat":
                    return leaves, own
        return [], []

    def _holds(self, name: str, mutant: Any) -> bool:
        budget = _budget(self.effort[name])
        return all(ask(question, budget) == "unsat" for question in self._questions(name, mutant))

    def _differs(
        self, mutant: Any, args: tuple, given: list[z3.BoolRef], rlimit: int
    ) -> tuple[str, tuple | None]:
        """`unsat` if the two agree on these arguments; with `sat`, values where they do not."""
        one = lift(self.original, *args)
        with _in_place(self.original, mutant):
            other = lift(self.original, *args)
        known = [*given, *one.roots, *other.roots]
        wanted = [_raw(leaf) for leaf in _flat(args)]
        answer, found = values([*known, _unequal(one.value, other.value)], NEAR, wanted)
        if answer == "unknown":
            # path by path the questions are more, and much easier
            for condition, value in zip(one.branches, one.values, strict=True):
                for condition_too, value_too in zip(other.branches, other.values, strict=True):
                    both = [*known, condition, condition_too, _unequal(value, value_too)]
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

    def starts(self) -> list[Result]:
        """The verdicts on other starts of a fold."""
        found = []
        for text, start in _other_starts(self.original.start):
            mutant = dataclasses.replace(self.original, start=start)
            by = self.refuted(mutant, [])
            diff = f"- start={self.original.start} + start={text}"
            verdict = "killed" if by else "survived"
            found.append(Result(self.key, "fold", "start", self.key, diff, verdict, by))
        return found


def _lies_in(
    domain: list[z3.BoolRef], leaves: list[z3.ExprRef], args: tuple, given: list[z3.BoolRef]
) -> bool:
    """Do these arguments satisfy the premises, where `given` holds?"""
    pairs = list(zip(leaves, [_known(leaf) for leaf in _flat(args)], strict=True))
    if any(one.sort() != other.sort() for one, other in pairs):
        return False
    wanted = [z3.substitute(premise, *pairs) for premise in domain]
    return all(ask([*given, z3.Not(premise)], FAR) == "unsat" for premise in wanted)


def _unequal(one: Any, other: Any) -> z3.BoolRef:
    pairs = zip(_flat(one), _flat(other), strict=True)
    return z3.Or(*[_raw(a) != _raw(b) for a, b in pairs])


def claim_of(name: str) -> Claim:
    """A theorem as it stands, stated."""
    return stated(name).claim


def _budget(effort: int) -> int:
    return max(FAR, min(2 * effort, MOST))


def _row(row: tuple) -> str:
    return ", ".join(str(value) for value in _flat(row))


def _text(term: z3.ExprRef) -> str:
    """A premise as a reader takes it in: in one line, the range of integers in words."""
    text = " ".join(str(term).split())
    ranged = re.fullmatch(rf"And\((\S+) >= -{2**61}, (\S+) <= {2**61}\)", text)
    turned = re.fullmatch(r"(-?\d+) (<=?) (.*)", text)
    if turned:
        return f"{turned[3]} {turned[2].replace('<', '>')} {turned[1]}"
    return f"{ranged[1]} has at most 62 bits" if ranged else text


def _other_starts(start: Any) -> Iterator[tuple[str, Any]]:
    if isinstance(start, tuple):
        for k, part in enumerate(start):
            for _, other in _other_starts(part):
                parts = [*start[:k], other, *start[k + 1 :]]
                made = type(start)(*parts) if hasattr(start, "_fields") else tuple(parts)
                yield str(made), made
    elif isinstance(start, bool):
        yield str(not start), not start
    else:
        yield from ((str(start + step), start + step) for step in (1, -1))


def judge_target(key: str, users: list[str], effort: dict[str, int], folder: Path) -> list[Result]:
    """The verdicts on all mutants of one function, or on the starts of one fold.

    key: `module.name` as `targets` gives it; users: the theorems that may notice, which hold as
    they stand; effort: the rlimit that each of them took.
    """
    gate.load_all()
    renew()
    theorems_from(folder)
    original = targets(users)[key][0]
    target = Target(key, original, users, effort)
    if isinstance(original, Fold):
        return target.starts()
    return [target.judge(mutant) for mutant in mutants(original)]


# -- premises -----------------------------------------------------------------------------------
def judge_premises(name: str, effort: int, folder: Path) -> list[PremiseResult]:
    """What each premise of one theorem is worth."""
    gate.load_all()
    renew()
    theorems_from(folder)
    claim = stated(name).claim
    budget = _budget(effort)

    def without(**how: Any) -> str:
        answers = []
        for obligation in _state(name, **how).obligations:
            answers.append(ask([*obligation.given, z3.Not(obligation.goal)], budget))
            if answers[-1] == "sat":
                return "matters"
        return "unused" if all(a == "unsat" for a in answers) else "undecided"

    found = []
    for number, premise in enumerate(claim.premises):
        weaker = _weaker(premise)
        dropped = without(dropped=frozenset({number}))
        weakened = "-"
        if weaker is not None and dropped != "unused":

            def swap(k: int, term: z3.BoolRef, at: int = number) -> z3.BoolRef:
                other = _weaker(term) if k == at else None
                return term if other is None else other

            weakened = without(weakened=swap)
        found.append(PremiseResult(name, _text(premise), dropped, weakened))
    return found


def _weaker(premise: z3.BoolRef) -> z3.BoolRef | None:
    """A premise that allows a little more: `>` becomes `>=`, `>=` allows one less."""
    if z3.is_gt(premise):
        return premise.arg(0) >= premise.arg(1)
    if z3.is_lt(premise):
        return premise.arg(0) <= premise.arg(1)
    if z3.is_ge(premise):
        return premise.arg(0) + 1 >= premise.arg(1)
    if z3.is_le(premise):
        return premise.arg(0) <= premise.arg(1) + 1
    return None
