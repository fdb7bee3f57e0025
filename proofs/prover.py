"""The prover: the only place that makes a `Theorem`.

A claim is proved if its premises are satisfiable and z3 finds the negation of every obligation
unsatisfiable, within a budget of solver resources (rlimit, never wall time). `unknown` is not
proved. Each obligation can be written out as SMT-LIB for solvers that stand alone.
"""

from __future__ import annotations

import ast
import importlib.util
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import z3

from cratous.proofs.claim import Claim, Obligation

RLIMIT = 60_000_000
_KEY = object()


@dataclass(frozen=True)
class Outcome:
    """What the solver said of one obligation: proved, refuted, unknown; rlimit spent."""

    obligation: Obligation
    status: str
    rlimit: int
    logic: str
    counterexample: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True)
class Theorem:
    """A claim with its outcomes. Only `prove` can make one."""

    name: str
    sentence: str
    kernels: tuple[str, ...]
    lemmas: tuple[str, ...]
    premises: str
    outcomes: tuple[Outcome, ...]
    assumptions: tuple[tuple[str, str, str], ...]
    _key: Any = None

    def __post_init__(self) -> None:
        if self._key is not _KEY:
            raise TypeError("only the prover makes theorems")

    @property
    def proved(self) -> bool:
        """True iff the premises are satisfiable and every obligation is proved."""
        return self.premises == "satisfiable" and all(o.status == "proved" for o in self.outcomes)

    @property
    def rlimit(self) -> int:
        """Solver effort over all obligations."""
        return sum(o.rlimit for o in self.outcomes)


def _terms_have(kind: Callable[[Any], bool], terms: list[z3.ExprRef]) -> bool:
    seen: set[int] = set()
    todo = list(terms)
    while todo:
        term = todo.pop()
        if term.get_id() in seen:
            continue
        seen.add(term.get_id())
        if kind(term):
            return True
        todo += term.children()
    return False


def _solvers(terms: list[z3.ExprRef]) -> list[tuple[str, z3.Solver]]:
    """The solvers worth asking for these terms, most promising first."""
    ints = _terms_have(lambda t: bool(z3.is_int(t)), terms)
    bits = _terms_have(lambda t: bool(z3.is_bv(t)), terms)
    reals = _terms_have(lambda t: bool(z3.is_real(t)), terms)
    if reals and not ints and not bits:
        return [("QF_NRA", z3.SolverFor("QF_NRA")), ("ALL", z3.Solver())]
    return [("ALL", z3.Solver())]


def _ask(given: list[z3.BoolRef], rlimit: int) -> tuple[str, int, str, z3.ModelRef | None]:
    """sat, unsat or unknown, the effort, the logic that answered, and a model if sat."""
    spent, answer, logic, model = 0, "unknown", "ALL", None
    for name, solver in _solvers(list(given)):
        solver.set("rlimit", rlimit)
        solver.add(*given)
        before = _rlimit_count(solver)
        result = solver.check()
        spent += max(0, _rlimit_count(solver) - before)
        answer, logic = str(result), name
        if answer != "unknown":
            model = solver.model() if answer == "sat" else None
            break
    return answer, spent, logic, model


def _rlimit_count(solver: z3.Solver) -> int:
    statistics = solver.statistics()
    for key, value in statistics:
        if key == "rlimit count":
            return int(value)
    return 0


def _decide(obligation: Obligation, rlimit: int) -> Outcome:
    question = [*obligation.given, z3.Not(obligation.goal)]
    answer, spent, logic, model = _ask(question, rlimit)
    status = {"unsat": "proved", "sat": "refuted"}.get(answer, "unknown")
    example: tuple[tuple[str, str], ...] = ()
    if model is not None:
        values = [(str(d.name()), str(model[d])) for d in model.decls() if d.arity() == 0]
        example = tuple(sorted(values))
    return Outcome(obligation, status, spent, logic, example)


def prove(name: str, claim: Claim, sentence: str, *, rlimit: int = RLIMIT) -> Theorem:
    """Decide a stated claim; the returned theorem says what was proved and what was not."""
    if not claim.kernels:
        raise ValueError(f"theorem {name}: it names no kernel (state it with c.use)")
    if not claim.obligations:
        raise ValueError(f"theorem {name}: it shows nothing (state it with c.show)")
    answer, *_ = _ask(list(claim.premises), rlimit)
    premises = {"sat": "satisfiable", "unsat": "contradictory"}.get(answer, "unknown")
    outcomes = tuple(_decide(obligation, rlimit) for obligation in claim.obligations)
    return Theorem(
        name,
        sentence,
        tuple(claim.kernels),
        tuple(claim.lemmas),
        premises,
        outcomes,
        tuple(claim.assumptions),
        _KEY,
    )


def smt2(obligation: Obligation, title: str) -> str:
    """The obligation as SMT-LIB 2: `unsat` means proved."""
    solver = z3.Solver()
    solver.add(*obligation.given, z3.Not(obligation.goal))
    body = str(solver.to_smt2())
    return f"; {title}\n; {obligation.kind}: {obligation.text}\n; expected: unsat\n{body}"


# -- theorem files ----------------------------------------------------------------------
FOLDER = Path(__file__).resolve().parent / "theorems"


def theorem_files(folder: Path = FOLDER) -> dict[str, Path]:
    """Name to file of every theorem, in order of name."""
    return {p.stem: p for p in sorted(folder.glob("*.py")) if not p.stem.startswith("_")}


def load_claim(name: str, folder: Path = FOLDER) -> tuple[Callable[[Claim], None], str]:
    """The function `claim` of a theorem file, and its sentence."""
    path = theorem_files(folder).get(name)
    if path is None:
        raise ValueError(f"there is no theorem called {name!r} in {folder.name}/")
    module_name = f"cratous.proofs.theorems.{name}"
    module = sys.modules.get(module_name)
    if module is None or getattr(module, "__file__", None) != str(path):
        spec = importlib.util.spec_from_file_location(module_name, path)
        if spec is None or spec.loader is None:
            raise ValueError(f"theorem file {path.name} cannot be read")
        module = importlib.util.module_from_spec(spec)
        sys.modules[module_name] = module
        spec.loader.exec_module(module)
    sentence = " ".join((ast.get_docstring(ast.parse(path.read_text())) or "").split())
    if not sentence:
        raise ValueError(f"theorem file {path.name} has no docstring: it is the sentence")
    return module.claim, sentence


def prove_file(name: str, *, folder: Path = FOLDER, rlimit: int = RLIMIT) -> Theorem:
    """State and prove the theorem of one file."""
    statement, sentence = load_claim(name, folder)
    claim = Claim(load=lambda other: load_claim(other, folder)[0])
    statement(claim)
    return prove(name, claim, sentence, rlimit=rlimit)
