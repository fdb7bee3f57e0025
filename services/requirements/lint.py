"""Static checks of requirements, without a trace: asked of z3, with bounded effort.

A formula is unrolled over the samples of a trace with a fixed period, far from both ends, with
every signal free at each sample: unsatisfiable, valid, never-true antecedent, equivalent
requirements. What is too long for that, or undecided, is reported as unchecked, never as correct.
Computed signals are free too, so reported findings are right, but some may be missed.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING, Any

from cratous.services.requirements import formula as formulas
from cratous.services.requirements.arithmetic import sources
from cratous.services.requirements.specification import NotRead, Requirement, Specification

if TYPE_CHECKING:
    import z3

MOST_TERMS = 20_000
PAIRS = 500
RLIMIT = 2_000_000


@dataclass(frozen=True)
class Remark:
    """kind: unsatisfiable, valid, vacuous, duplicate, unused, unchecked; name: requirement or signal."""

    kind: str
    name: str
    text: str


class _TooLong(Exception):
    pass


def lint(spec: Specification) -> list[Remark]:
    """All findings on a requirements file, in its order."""
    read = [(one, one.formula) for one in spec.requirements if not isinstance(one.formula, NotRead)]
    read_in = {name for _, formula in read for name in formulas.signals(formula)}
    used = sources(read_in, spec.signals)
    found = [
        Remark("unused", name, f"signal {name} is in no requirement")
        for name, signal in spec.signals.items()
        if name not in used and signal.made is None
    ]
    period = spec.period_ns if spec.timed else 1
    written: list[tuple[Requirement, z3.BoolRef, tuple[str, ...]]] = []
    for one, formula in read:
        ask = _Asked(period)
        try:
            if not period and any(
                isinstance(part, formulas.Bounded) for part in formulas.parts(formula)
            ):
                raise _TooLong("nothing says how far samples are apart (trace every ...)")
            term = ask.term(formula)
            found += _about(one, formula, term, ask)
            written.append((one, term, formulas.signals(formula)))
        except _TooLong as why:
            text = f"{one.name} was not looked into: {why}"
            found.append(Remark("unchecked", one.name, text))
    return found + _duplicates(written)


def _about(
    one: Requirement, formula: formulas.Formula, term: z3.BoolRef, ask: _Asked
) -> list[Remark]:
    import z3

    never, always = _impossible(term), _impossible(z3.Not(term))
    if never is None or always is None:
        return [Remark("unchecked", one.name, f"{one.name} was not decided within its effort")]
    if never:
        text = f"{one.name} cannot be satisfied: every trace violates it at every sample"
        return [Remark("unsatisfiable", one.name, text)]
    if always:
        return [Remark("valid", one.name, f"{one.name} says nothing: every trace satisfies it")]
    if (
        isinstance(formula, formulas.Join)
        and not formula.is_and
        and isinstance(formula.phi, formulas.Not)
    ):
        idle = _impossible(ask.term(formula.phi.phi))
        if idle is None:
            return [Remark("unchecked", one.name, f"{one.name} was not decided within its effort")]
        if idle:
            text = f"{one.name} never asks for anything: what it depends on cannot happen"
            return [Remark("vacuous", one.name, text)]
    return []


def _duplicates(written: list[tuple[Requirement, z3.BoolRef, tuple[str, ...]]]) -> list[Remark]:
    import z3

    pairs = [(a, b) for a, b in combinations(written, 2) if a[2] == b[2]]
    found, open_pairs = [], max(0, len(pairs) - PAIRS)
    for (a, one, _), (b, other, _) in pairs[:PAIRS]:
        same = _impossible(z3.Xor(one, other))
        open_pairs += same is None
        if same:
            found.append(Remark("duplicate", b.name, f"{b.name} says the same as {a.name}"))
    if open_pairs:
        text = f"{open_pairs} pairs of requirements were not compared to the end"
        found.append(Remark("unchecked", "", text))
    return found


def _impossible(term: Any) -> bool | None:
    import z3

    solver = z3.Solver()
    solver.set("rlimit", RLIMIT)
    solver.add(term)
    answer = solver.check()
    return None if answer == z3.unknown else bool(answer == z3.unsat)


class _Asked:
    """Unrolls formulas over samples one period apart; sample 0 is the one at which they are evaluated."""

    def __init__(self, period: int) -> None:
        self.period = max(1, period)
        self.known: dict[tuple[int, int], Any] = {}
        self.terms = 0
        self.kept: list[formulas.Formula] = []

    def term(self, formula: formulas.Formula) -> Any:
        """The formula at sample 0; raises _TooLong if it needs too many terms."""
        self.kept.append(formula)  # keeps ids unique
        todo: list[tuple[formulas.Formula, int]] = [(formula, 0)]
        while todo:
            part, at = todo[-1]
            if (id(part), at) in self.known:
                todo.pop()
                continue
            needed = [
                pair for pair in self._needed(part, at) if (id(pair[0]), pair[1]) not in self.known
            ]
            if needed:
                todo += needed
                continue
            self.known[id(part), at] = self._made(part, at)
            todo.pop()
        return self.known[id(formula), 0]

    def _count(self, more: int) -> None:
        self.terms += more
        if self.terms > MOST_TERMS:
            raise _TooLong(f"it speaks of too many samples (above {MOST_TERMS} terms)")

    def _steps(self, part: formulas.Bounded) -> range:
        first, last = -(-part.low // self.period), part.high // self.period
        if last > MOST_TERMS:
            self._count(last)
        return range(first, last + 1)

    def _needed(self, part: formulas.Formula, at: int) -> list[tuple[formulas.Formula, int]]:
        if isinstance(part, formulas.Not):
            return [(part.phi, at)]
        if isinstance(part, formulas.Join):
            return [(part.phi, at), (part.psi, at)]
        if not isinstance(part, formulas.Bounded):
            return []
        way, steps = (-1 if part.past else 1), self._steps(part)
        self._count(2 * len(steps))
        phis = [(part.phi, at + way * k) for k in range(steps.stop - 1 if steps else 0)]
        return phis + [(part.psi, at + way * k) for k in steps]

    def _made(self, part: formulas.Formula, at: int) -> Any:
        import z3

        if isinstance(part, formulas.Always):
            return z3.BoolVal(part.verdict == 2)
        if isinstance(part, formulas.Reaches):
            left, right = (
                z3.Real(f"{side}@{at}") if isinstance(side, str) else z3.Q(*side.as_integer_ratio())
                for side in (part.left, part.right)
            )
            return left >= right
        if isinstance(part, formulas.Not):
            return z3.Not(self.known[id(part.phi), at])
        if isinstance(part, formulas.Join):
            both = [self.known[id(side), at] for side in (part.phi, part.psi)]
            return z3.And(*both) if part.is_and else z3.Or(*both)
        way = -1 if part.past else 1
        choices, kept = [], z3.BoolVal(True)
        steps = self._steps(part)
        for k in range(steps.stop if steps else 0):
            if k in steps:
                choices.append(z3.And(kept, self.known[id(part.psi), at + way * k]))
            if k < steps.stop - 1:
                kept = z3.And(kept, self.known[id(part.phi), at + way * k])
        return z3.Or(*choices) if choices else z3.BoolVal(False)
