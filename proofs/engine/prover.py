"""The prover: the only place that makes a `Theorem`.

A claim is proved if its premises are satisfiable and z3 finds the negation of every obligation unsatisfiable, within
a budget of solver resources (rlimit, never wall time). `unknown` is not proved. Every question is put to a solver in
a context of its own, so the answer and the effort depend on the question alone, not on what was asked before or on
how the work is spread. Each obligation can be written out as SMT-LIB for other solvers.
"""

from __future__ import annotations

import functools
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import z3

from cratous.core.kernel import entry_of, qualified
from cratous.core.kernel.sources import altered, ours, place, position
from cratous.proofs.engine import definition_subset, plain_numbers, reachable_paths
from cratous.proofs.engine.argument_values import Taken
from cratous.proofs.engine.cache import Answer, Cache
from cratous.proofs.engine.claim import Claim
from cratous.proofs.engine.counterexample import Model, Watched, story, telling
from cratous.proofs.engine.cpu_limit import OutOfTime, cpu_limit
from cratous.proofs.engine.lemma_calls import hangs_on_calls
from cratous.proofs.engine.lift import LiftError
from cratous.proofs.engine.obligation import Obligation
from cratous.proofs.engine.obligation_hash import Hasher
from cratous.proofs.engine.outcomes import Outcome, Owed, Ran, restored
from cratous.proofs.engine.smtlib import Seen, logic_of, question, smt2, sorts
from cratous.proofs.engine.solver_order import check, solvers
from cratous.proofs.engine.statement_errors import raised_there, slip_in
from cratous.proofs.engine.theorem_files import FOLDER, find, load_claim, load_lemma, theorem_files
from cratous.spec.errors import BadInput

RLIMIT = 60_000_000
FACTS_RLIMIT = 3_000_000
PATH_RLIMIT = 1_000_000
VALUES_RLIMIT = 300_000
STATE_CPU_S = 300
"""CPU seconds after which stating a theorem is aborted: far above what any needs."""
THEIRS = (
    ArithmeticError, AttributeError, LiftError, LookupError, NameError, OSError, TypeError, ValueError,
)  # fmt: skip
"""Errors that a theorem, a definition or a kernel may raise while it is stated."""
_KEY = object()
_NO_CACHE = Cache(None)


@dataclass(frozen=True)
class Theorem:
    """A claim with its outcomes. Only `prove` can make one.

    paths: for each kernel that it is about, which of its paths are reachable under the premises; varied: for each use
    of a kernel, in order, how its arguments vary (see `reachable_paths`); ran: the result of running it on numbers,
    None where it was not run; ended: time limits that ended questions about its premises, paths and arguments.
    """

    name: str
    sentence: str
    kernels: tuple[str, ...]
    lemmas: tuple[str, ...]
    premises: str
    outcomes: tuple[Outcome, ...]
    assumptions: tuple[tuple[str, str, str], ...]
    _key: Any = field(default=None, compare=False, repr=False)
    paths: tuple[tuple[str, tuple[bool, ...]], ...] = ()
    varied: tuple[tuple[str, str], ...] = ()
    ran: Ran | None = None
    ended: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self._key is not _KEY:
            raise TypeError("only the prover makes theorems")

    def after(self, ran: Ran) -> Theorem:
        """The same theorem with the result of running it on numbers."""
        return replace(self, ran=ran, _key=_KEY)

    @property
    def proved(self) -> bool:
        """True iff the premises are satisfiable, every obligation is proved, and running it found no difference."""
        decided = all(o.status == "proved" for o in self.outcomes)
        return (
            self.premises == "satisfiable" and decided and not (self.ran and self.ran.differences)
        )

    @property
    def uses(self) -> dict[tuple[str, int], str]:
        """How the arguments vary in each use of a kernel; uses are numbered per kernel (see `reachable_paths`)."""
        counted: dict[str, int] = {}
        found = {}
        for name, how in self.varied:
            counted[name] = counted.get(name, -1) + 1
            found[name, counted[name]] = how
        return found

    @property
    def rlimit(self) -> int:
        """Solver effort over all obligations."""
        return sum(o.rlimit for o in self.outcomes)

    @property
    def seconds(self) -> float:
        """CPU seconds of the solver over all obligations, from when each was last solved rather than recalled."""
        return sum(o.seconds for o in self.outcomes)


def restore(data: dict[str, Any]) -> Theorem:
    """A theorem from its stored fields (`proofs.ledger.proof_recall`).

    Raises KeyError, TypeError or ValueError for data that are not a theorem's.
    """
    outcomes = []
    for row in data["outcomes"]:
        owed = Owed(**row["obligation"])
        example = tuple((str(n), str(v)) for n, v in row["counterexample"])
        rest = {k: row[k] for k in ("status", "rlimit", "logic", "key", "seconds")}
        outcomes.append(Outcome(owed, counterexample=example, story=tuple(row["story"]), **rest))
    return Theorem(
        data["name"],
        data["sentence"],
        tuple(data["kernels"]),
        tuple(data["lemmas"]),
        data["premises"],
        tuple(outcomes),
        tuple((str(a), str(b), str(c)) for a, b, c in data["assumptions"]),
        _KEY,
        tuple((str(name), tuple(map(bool, seen))) for name, seen in data["paths"]),
        tuple((str(name), str(how)) for name, how in data["varied"]),
        restored(data["ran"]),
    )


@dataclass(frozen=True)
class _Memory:
    """What the questions of one theorem share: answers, hashes of terms, kinds of values in them.

    ended: which limits of time ended questions about premises, paths and arguments.
    """

    cache: Cache
    hasher: Hasher = field(default_factory=Hasher)
    seen: Seen = field(default_factory=dict)
    ended: list[str] = field(default_factory=list)


def _solvers(
    terms: list[z3.ExprRef], context: z3.Context, rlimit: int, seen: Seen
) -> Iterator[tuple[str, z3.Solver, int]]:
    kinds = sorts(terms, seen) & {"Real", "Int", "BitVec", "quantifier", "function"}
    return solvers(context, rlimit, polynomials=kinds == {"Real"})


def _maker(logic: str, context: z3.Context) -> z3.Solver:
    return z3.Solver(ctx=context) if logic == "ALL" else z3.SolverFor(logic, ctx=context)


def _ask(
    given: list[z3.BoolRef], rlimit: int, seen: Seen
) -> tuple[Answer, z3.ModelRef | None, z3.Context]:
    """The answer of the first solver that decides, and a model if it is sat.

    seen: the kinds of values found in terms so far (see `smtlib.sorts`).
    """
    context = z3.Context()
    # translated in order into an empty context, terms get the same numbers wherever this runs
    terms = [term.translate(context) for term in given]
    begun = time.process_time()
    spent, result, logic, model, ended = 0, "unknown", "ALL", None, ""
    for name, solver, effort in _solvers(given, context, rlimit, seen):
        solver.add(*terms)
        said = check(solver, context, effort)
        result, logic, spent = said.result, name, spent + said.spent
        if result != "unknown":
            model, ended = (solver.model() if result == "sat" else None), ""
            break
        ended = said.ended or ended
    answer = Answer(result, spent, round(time.process_time() - begun, 3), logic, ended)
    return answer, model, context


def _decide(claim: Claim, obligation: Obligation, rlimit: int, memory: _Memory) -> Outcome:
    asked, cache = question(obligation), memory.cache
    key = memory.hasher.key("unsat?", asked)
    answer = cache.get(key, rlimit)
    example: tuple[tuple[str, str], ...] = ()
    lines: list[str] = []
    if answer is None or answer.result == "sat":
        answer, found, context = _ask(asked, rlimit, memory.seen)
        if found is None:
            cache.put(key, rlimit, answer)
        else:
            terms = [term.translate(context) for term in asked]
            first = next(_solvers(asked, context, rlimit, memory.seen))[0]
            found = telling(terms, found, lambda: _maker(first, context))
            model = Model(found, context)
            values = [(str(d.name()), str(found[d])) for d in found.decls() if d.arity() == 0]
            example = tuple(sorted(values))
            lines = story(claim, model)
    status = {"unsat": "proved", "sat": "refuted"}.get(answer.result, "unknown")
    owed = Owed(obligation.kind, obligation.text)
    rest = (tuple(lines), answer.seconds, answer.ended)
    return Outcome(owed, status, answer.rlimit, answer.logic, example, key, *rest)


def _premises(claim: Claim, rlimit: int, memory: _Memory) -> str:
    """Whether the premises are satisfiable, together with everything that is taken as known.

    A contradiction among premises, assumptions and what lemmas say would prove anything. Where the solver cannot
    decide all together, the premises alone must be satisfiable.
    """
    for terms, budget in (
        ([*claim.premises, *claim.facts], min(rlimit, FACTS_RLIMIT)),
        (list(claim.premises), rlimit),
    ):
        result = _satisfiable(terms, budget, memory)
        if result != "unknown":
            break
    return {"sat": "satisfiable", "unsat": "contradictory"}.get(result, "unknown")


def prove(
    name: str,
    claim: Claim,
    sentence: str,
    *,
    rlimit: int = RLIMIT,
    cache: Cache = _NO_CACHE,
    tell: Callable[[int, int], None] | None = None,
    taken: Taken | None = None,
) -> Theorem:
    """Decide a stated claim; the returned theorem says what was proved and what was not.

    tell: called with (done, all) after each obligation; taken: see `argument_values`. Raises ValueError for a claim
    that names no kernel or shows nothing.
    """
    claim.settle()
    if not claim.kernels:
        raise ValueError(f"theorem {name}: it names no kernel (state it with c.use)")
    if not claim.obligations:
        raise ValueError(f"theorem {name}: it shows nothing (state it with c.show)")
    memory = _Memory(cache)
    premises = _premises(claim, rlimit, memory)
    outcomes = []
    for obligation in claim.obligations:
        outcomes.append(_decide(claim, obligation, rlimit, memory))
        if tell is not None:
            tell(len(outcomes), len(claim.obligations))

    def possible(terms: list[z3.BoolRef]) -> str:
        return _satisfiable(terms, min(rlimit, PATH_RLIMIT), memory)

    def near(terms: list[z3.BoolRef]) -> str:
        return _satisfiable(terms, min(rlimit, VALUES_RLIMIT), memory)

    def another(terms: list[z3.BoolRef], value: z3.ExprRef) -> z3.ExprRef | None:
        _, model, context = _ask(terms, min(rlimit, PATH_RLIMIT), memory.seen)
        if model is None:
            return None
        return model.eval(value.translate(context), model_completion=True).translate(value.ctx)

    theorem = Theorem(
        name,
        sentence,
        tuple(claim.kernels),
        tuple(claim.lemmas),
        premises,
        tuple(outcomes),
        tuple(claim.assumptions),
        _KEY,
        reachable_paths.paths(claim, possible),
        reachable_paths.varied(claim, reachable_paths.Asked(near, another, taken)),
    )
    return replace(theorem, ended=tuple(memory.ended), _key=_KEY)


def _satisfiable(terms: list[z3.BoolRef], rlimit: int, memory: _Memory) -> str:
    key = memory.hasher.key("sat?", terms)
    answer = memory.cache.get(key, rlimit)
    if answer is None:
        answer, *_ = _ask(terms, rlimit, memory.seen)
        memory.cache.put(key, rlimit, answer)
        if answer.ended and answer.ended not in memory.ended:
            memory.ended.append(answer.ended)
    return answer.result


def not_stated(name: str, folder: Path = FOLDER) -> BadInput:
    """The error for a theorem that cannot be stated within STATE_CPU_S."""
    return BadInput(
        "the theorem cannot be stated: its paths take too long to find",
        where=place(find(name, folder)),
        expected="less in one kernel: split it, and do not look into the part (c.opaque)",
        got=f"more than {STATE_CPU_S} s of CPU",
    )


def state(name: str, folder: Path = FOLDER) -> tuple[Watched, str]:
    """State the claim of a theorem file; returns it and its sentence. The kernels must be registered."""
    statement, sentence = load_claim(name, folder)
    # one lemma object each, since the statement is run more than once
    lemma = functools.cache(lambda other: load_lemma(other, folder))

    def stated(by: Callable[..., Any]) -> Watched:
        claim = Watched(load=lemma)
        by(claim)
        return claim

    where = place(find(name, folder))
    try:
        with cpu_limit(STATE_CPU_S, z3.main_ctx()):
            claim = stated(statement)
            claim.settle()
            plain_numbers.hold(stated, statement, claim.visits)
            hanging = sorted(n for n in claim.asking if hangs_on_calls(n, folder))
    except OutOfTime as error:
        raise not_stated(name, folder) from error
    except plain_numbers.Inexact as error:
        what = f"the theorem cannot be stated: {error.where}: {error.what}"
        raise BadInput(what, where=where, expected=error.expected, got=error.got) from error
    except Exception as error:
        # ctypes, through which z3 is called, changes the type of this error
        if isinstance(error, RecursionError) or "RecursionError" in str(error):
            raise BadInput(
                "the theorem cannot be stated: a term in it is nested too deeply to be read",
                where=where,
                expected="less in one kernel: split it, and do not look into the part (c.opaque)",
                got=f"more than {sys.getrecursionlimit()} levels",
            ) from error
        slip = slip_in(error, folder)
        if not slip and not isinstance(error, THEIRS) and not raised_there(error, folder):
            raise  # an error of the prover, not of the theorem
        said = str(error) or f"it raises {type(error).__name__}"
        raise BadInput(f"the theorem cannot be stated: {said}", where=slip or where) from error
    symbolic = [v.function for v in claim.visits if not definition_subset.on_numbers(v)]
    for function in dict.fromkeys([*symbolic, *claim.stubs]):
        if refused := definition_subset.refusals(function):
            raise BadInput(
                f"the theorem cannot be stated: {refused[0]}",
                where=position(function),
                expected="what the subset has (see docs/guides/own-kernel.md)",
            )
    wrong = {n for f in {v.function for v in claim.visits} if ours(f) for n in altered(f)}
    if wrong:
        raise BadInput(
            f"the code that runs is not its file's: {', '.join(sorted(wrong))}",
            where=where,
            expected="functions as their files say (remove __pycache__)",
        )
    used: list[Any] = [run.function for run in claim.runs if run.role == "kernel"]
    for function in [*used, *claim.folds]:
        if entry_of(function) is None:
            raise BadInput(
                f"the theorem is about {function.__name__!r}, which is not registered",
                where=where,
                expected="a function marked with @kernel, or a fold made with fold(...)",
                got=qualified(function),
            )
    if not claim.kernels:
        raise BadInput(
            "the theorem names no kernel", where=where, expected="at least one c.use(kernel, ...)"
        )
    if not claim.obligations:
        raise BadInput(
            "the theorem shows nothing", where=where, expected="at least one c.show(...)"
        )
    if hanging:
        raise BadInput(
            f"{hanging[0]} is no lemma: what it shows is made of the calls of a function",
            where=where,
            expected="goals that are the same where c.calls(...) is empty",
        )
    return claim, sentence


def prove_file(
    name: str,
    *,
    folder: Path = FOLDER,
    rlimit: int = RLIMIT,
    cache: Cache = _NO_CACHE,
    tell: Callable[[int, int], None] | None = None,
) -> Theorem:
    """State and prove the theorem of one file."""
    claim, sentence = state(name, folder)
    return prove(name, claim, sentence, rlimit=rlimit, cache=cache, tell=tell)


__all__ = [
    "FOLDER", "RLIMIT", "Outcome", "Owed", "Theorem", "load_claim", "logic_of",
    "prove", "prove_file", "question", "smt2", "sorts", "state", "theorem_files",
]  # fmt: skip
