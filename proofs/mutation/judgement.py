"""Judges mutants: of one function or fold, or the premises of one theorem, at a time.

A mutant replaces its original through `lift.REPLACED`, the theorems that look into the function are stated anew, and
only the obligations that differ from the proved ones are decided. Inputs on which the two differ fix the question's
variables first, which keeps the question small.
"""

from __future__ import annotations

import dataclasses
from collections import Counter
from collections.abc import Iterator, Mapping
from functools import partial
from typing import Any

import z3

from cratous.core import ledger as gate
from cratous.core.kernel import Fold, entry_of, qualified
from cratous.core.kernel.sources import position
from cratous.proofs.engine import worker_processes
from cratous.proofs.engine.lift import Visit
from cratous.proofs.mutation.equivalence import EVERYWHERE, Equality
from cratous.proofs.mutation.inputs import SAMPLES, compare, inputs
from cratous.proofs.mutation.inputs import run as run_once
from cratous.proofs.mutation.keys import Keys, Store
from cratous.proofs.mutation.operators import Mutant, mutants
from cratous.proofs.mutation.results import Result
from cratous.proofs.mutation.sample_inputs import Point, points
from cratous.proofs.mutation.solver_queries import ask, renew
from cratous.proofs.mutation.statements import (
    Stillborn,
    claim_of,
    ids,
    in_place,
    state,
    stated,
    targets,
    theorems_from,
)
from cratous.proofs.mutation.terms import (
    FAR,
    GLANCE,
    NEAR,
    budget,
    equal,
    flat,
    is_free,
    row_text,
    with_values,
)

LOOKED_AT, MANY = 8, 100
"""The number of theorems searched for inputs that they allow, and the number of inputs that ends the search."""


class Target:
    """A function or fold under mutation, with the theorems that may detect its faults."""

    def __init__(self, key: str, original: Any, users: list[str], effort: Mapping[str, int]):
        self.key, self.original, self.effort = key, original, effort
        entry = entry_of(original)
        self.kind = "definition" if entry is None else entry.kind
        self.visits = {n: [v for v in claim_of(n).visits if v.function is original] for n in users}
        self.users = sorted(users, key=self._promise)
        self.equality = Equality(original, {name: self.visits[name] for name in self.users})
        self.place = position(original).rpartition(":")[0]
        self.points: list[Point] = []
        self.asked: dict[tuple[str, Any], list[list[z3.BoolRef]]] = {}
        if not isinstance(original, Fold):
            self.rows = inputs(original, self.equality.masks(), SAMPLES)
            self.results = [run_once(original, row) for row in self.rows]
            self.points = self._points()
            self.results_there = [run_once(original, point.row) for point in self.points]

    def _points(self) -> list[Point]:
        """Inputs allowed by those theorems that are most likely to detect a fault."""
        found = []
        for name in self.users[:LOOKED_AT]:
            for visit in self.visits[name][:2]:
                found += points(self.original, name, claim_of(name).premises, visit)
            if len(found) > MANY:
                break
        return found

    def learn(self, killers: Counter[str]) -> None:
        """Move the theorems that killed most of the mutants so far to the front."""
        self.users = sorted(self.users, key=lambda name: (-killers[name], *self._promise(name)))

    def _promise(self, name: str) -> tuple[bool, bool, int, str]:
        """Sort key: theorems that name the kernel first, then those with free arguments, then the cheap ones."""
        calls = [v.args for v in self.visits[name]]
        free = any(all(is_free(leaf) for leaf in flat(args)) for args in calls)
        named = qualified(self.original) in claim_of(name).kernels
        return not named, not free, self.effort[name], name

    def judge(self, mutant: Mutant) -> Result:
        """The verdict on one mutant."""

        def verdict(what: str, by: str = "", note: str = "") -> Result:
            place = f"{self.place}:{mutant.line}"
            return Result(self.key, self.kind, mutant.operator, place, mutant.diff, what, by, note)

        seen = compare(mutant.function, self.rows, self.results)
        if seen.stillborn:
            return verdict("stillborn", note=seen.stillborn)
        try:
            there = compare(mutant.function, [p.row for p in self.points], self.results_there)
            # an input that a theorem is known to allow makes that query unnecessary
            rows = list(there.inputs[:3]) or self.allowed(seen.inputs)
            if rows:
                by = self.refuted(mutant.function, rows)
                note = f"differs at {row_text(rows[0])}"
                return verdict("killed", by) if by else verdict("survived", note=note)
            # no input distinguishes the two: first cheap queries for equivalence and for a refutation
            if self.equality.everywhere(mutant.function, NEAR):
                return verdict("equivalent", note=EVERYWHERE)
            by = self.refuted_at_a_glance(mutant.function)
            if by:
                return verdict("killed", by)
            # most of the remaining mutants are equivalent where theorems apply
            what, note, row = self.equality.equivalent(mutant.function)
            if what == "equivalent":
                return verdict(what, note=note)
            # an input found by the solver but not on the grids serves as a starting point
            by = self.refuted(mutant.function, [row] if row else [], glanced=True)
            if by:
                return verdict("killed", by)
            if what == "survived" and row:
                return verdict(what, note=f"differs at {row_text(row)}")
            if what == "undecided" and all(self._holds(n, mutant.function) for n in self.users):
                note = "every theorem holds with it; equality is not decided"
            return verdict(what, note=note)
        except Stillborn as error:
            return verdict("stillborn", note=str(error))

    def refuted_at_a_glance(self, mutant: Any) -> str:
        """The first theorem refuted with little effort with the mutant in place, or an empty string."""
        for name in self.users:
            if self._refutes(name, self._questions(name, mutant), [], NEAR, NEAR):
                return name
        return ""

    def refuted(self, mutant: Any, rows: list[tuple[Any, ...]], glanced: bool = False) -> str:
        """The first theorem that is refuted with the mutant in place, or an empty string.

        rows: inputs that distinguish mutant and original; a question about one of them is small. Cheap questions to
        all theorems come before expensive ones. glanced: questions without an input were asked before
        (`refuted_at_a_glance`).
        """
        changed = []
        for name in self.users:
            questions = self._questions(name, mutant)
            changed.append((name, questions))
            if self._refutes(name, questions, rows, NEAR, 0 if glanced else NEAR):
                return name
        for name, questions in changed:
            if self._refutes(name, questions, rows, FAR, budget(self.effort[name])):
                return name
        return ""

    def _refutes(
        self,
        name: str,
        questions: list[list[z3.BoolRef]],
        rows: list[tuple[Any, ...]],
        near: int,
        far: int,
    ) -> bool:
        """Whether the theorem is refuted. near: effort with an input fixed; far: effort without one, 0 to skip."""
        starts = [[*p.values] for p in self.points if p.theorem == name and p.row in rows][:3]
        starts += [equal(v.args, row) for row in rows for v in self.visits[name][:2]]
        return any(
            ask([*start, *question], near if start else far) == "sat"
            for start in (*starts, *([[]] if far else []))
            for question in questions
        )

    def _questions(self, name: str, mutant: Any) -> list[list[z3.BoolRef]]:
        """The negated obligations that differ from those proved, and so have to be decided anew."""
        if (name, mutant) not in self.asked:
            self.asked[name, mutant] = self._stated_with(name, mutant)
        return self.asked[name, mutant]

    def _stated_with(self, name: str, mutant: Any) -> list[list[z3.BoolRef]]:
        with in_place(self.original, mutant):
            claim = state(name)
        proved = stated(name).seen
        changed = [o for o in claim.obligations if ids(o) not in proved]
        return [[*o.given, z3.Not(o.goal)] for o in changed]

    def _holds(self, name: str, mutant: Any) -> bool:
        most = budget(self.effort[name])
        return all(ask(question, most) == "unsat" for question in self._questions(name, mutant))

    def allowed(self, rows: tuple[tuple[Any, ...], ...]) -> list[tuple[Any, ...]]:
        """Up to three of these inputs for which some theorem makes a statement about the function.

        Most allowed inputs are recognised with little effort; if none is, a few get more.
        """
        visits = [(name, visit) for name in self.users for visit in self.visits[name][:4]]
        if self.points:
            # no known point distinguishes the two, so these inputs hardly will: little effort is enough,
            # and the comparison that follows finds an input that does
            return self._allowed(rows[:6], visits, GLANCE)
        return self._allowed(rows, visits, GLANCE) or self._allowed(rows[:2], visits, NEAR)

    def _allowed(
        self, rows: tuple[tuple[Any, ...], ...], visits: list[tuple[str, Visit]], effort: int
    ) -> list[tuple[Any, ...]]:
        found: list[tuple[Any, ...]] = []
        for row in rows:
            for number, (name, visit) in enumerate(visits):
                if self._allows(name, visit, row, effort):
                    found.append(row)
                    # a visit that allowed one input is likely to allow the next
                    visits.insert(0, visits.pop(number))
                    break
            if len(found) == 3:
                break
        return found

    def _allows(self, name: str, visit: Visit, row: tuple[Any, ...], effort: int) -> bool:
        """Whether the theorem's premises admit this input at the visit."""
        conditions = [*claim_of(name).premises, *visit.context, *visit.granted]
        # on a caller's path, or with further values of the theorem, the solver may have to decide
        plain = with_values(conditions, visit.args, row)
        if plain is False or (plain and not visit.context and not visit.granted):
            return plain
        return ask([*equal(visit.args, row), *conditions], effort) == "sat"

    def judge_start(self, mutant: Mutant) -> Result:
        """The verdict on a fold with another start value."""
        by = self.refuted(mutant.function, [])
        verdict = "killed" if by else "survived"
        return Result(self.key, "fold", mutant.operator, self.place, mutant.diff, verdict, by)


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


def faults(original: Any) -> Iterator[Mutant]:
    """Every mutant of a function, or every other start of a fold, in a fixed order."""
    if not isinstance(original, Fold):
        yield from mutants(original)
        return
    for text, start in _other_starts(original.start):
        other: Any = dataclasses.replace(original, start=start)
        diff = f"- start={original.start} + start={text}"
        yield Mutant("start", 0, diff, other, text)


def judge_target(
    key: str, users: list[str], effort: dict[str, int], keys: Keys, store: Store
) -> list[Result]:
    """The verdicts on all mutants of one function, or on the starts of one fold.

    key: the qualified name, as `targets` gives it; users: the theorems that may detect a fault, all proved; effort:
    the rlimit that each of them took. Verdicts in `store` are not recomputed, and each new verdict is stored at once;
    each mutant is judged in a process forked from the same state, so verdicts do not depend on which were known.
    """
    gate.load_all(keys.home)
    theorems_from(keys.folder)
    original = targets(users, keys.home)[key][0]
    target = Target(key, original, users, effort)
    judge = target.judge_start if isinstance(original, Fold) else target.judge
    base = keys.target(key, original)

    def ask_anew(mutant: Mutant) -> Result:
        renew()
        return judge(mutant)

    found = []
    killers: Counter[str] = Counter()
    for mutant in faults(original):
        target.learn(killers)
        name = keys.mutant(base, mutant.text)
        kept = store.get(name)
        if kept is None:
            result = worker_processes.call(partial(ask_anew, mutant))
            store.put(name, {"verdict": result.verdict, "by": result.by, "note": result.note})
        else:
            place = f"{target.place}:{mutant.line}" if mutant.line else target.place
            result = Result(key, target.kind, mutant.operator, place, mutant.diff, **kept)
        found.append(result)
        if result.by:
            killers[result.by] += 1
    return found
