"""The second solver: cvc5 on every obligation, as exported SMT-LIB text and nothing else.

Each obligation is read by cvc5 under its exact logic and, if that gives no answer, for polynomials by cylindrical
coverings alone, and under ALL, in another process with 5 s of CPU each. A theorem is `confirmed` if cvc5 finds every
obligation unsatisfiable, `contradicted` if it finds one satisfiable that z3 proved, else `no answer`. The verdicts
are kept in `proofs/recheck.json` by the hash of the obligation, for the proof inventory; a complete re-check starts
with the configuration that answered last time. Answers are stored one by one, so an interrupted run continues where
it stopped; obligations without an answer are put to cvc5 again.
"""

from __future__ import annotations

import importlib.metadata
import json
import multiprocessing
from collections.abc import Callable, Container, Iterable, Mapping
from dataclasses import dataclass, field
from functools import partial
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import Any

from cratous.core.files.whole_file import write_atomically
from cratous.core.kernel.sources import ROOT, digest
from cratous.proofs import second_solver
from cratous.proofs.engine import prover, worker_processes
from cratous.proofs.engine.claim import Claim
from cratous.proofs.engine.cpu_limit import of_the_user
from cratous.proofs.engine.smtlib import Seen
from cratous.proofs.mutation.keys import Store
from cratous.proofs.second_solver import Asker, Way
from cratous.spec.errors import BadInput

FILE = ROOT / "proofs" / "recheck.json"
CONFIRMED, NO_ANSWER, CONTRADICTED = "confirmed", "no answer", "contradicted"


@dataclass(frozen=True)
class Check:
    """cvc5's result for one obligation: verdict, the logic that answered, CPU seconds."""

    theorem: str
    number: int
    key: str
    text: str
    verdict: str
    logic: str
    seconds: float


@dataclass(frozen=True)
class Recheck:
    """All checks, and the solver that made them."""

    solver: str
    checks: tuple[Check, ...]

    def verdict(self, theorem: str) -> str:
        """confirmed, no answer or contradicted."""
        verdicts = {check.verdict for check in self.checks if check.theorem == theorem}
        if CONTRADICTED in verdicts:
            return CONTRADICTED
        return CONFIRMED if verdicts == {CONFIRMED} else NO_ANSWER

    def count(self, verdict: str) -> int:
        """How many theorems have this verdict."""
        return sum(self.verdict(name) == verdict for name in self.theorems)

    @property
    def theorems(self) -> list[str]:
        """Every theorem that was checked."""
        return list(dict.fromkeys(check.theorem for check in self.checks))


def version() -> str:
    """The installed cvc5; raises BadInput if there is none."""
    try:
        return "cvc5 " + importlib.metadata.version("cvc5")
    except importlib.metadata.PackageNotFoundError as error:
        raise BadInput(
            "the second solver is not installed", item="--recheck", expected="`pip install cvc5`"
        ) from error


def _named(way: Way) -> str:
    """The name of a solver configuration in `Check.logic`."""
    return " ".join([way[0], *way[1]])


@dataclass
class _Job:
    """One obligation to be checked, and the configurations to try."""

    theorem: str
    number: int
    key: str
    text: str
    smt: str = ""
    ways: list[Way] = field(default_factory=list)

    def first(self, logic: str) -> None:
        """Try the configuration with this `Check.logic` name first, if it is among them."""
        self.ways.sort(key=lambda way: _named(way) != logic)

    def check(self, verdict: str, logic: str, seconds: float) -> Check:
        return Check(
            self.theorem, self.number, self.key, self.text, verdict, logic, round(seconds, 2)
        )


def _proved(theorem: prover.Theorem) -> list[_Job]:
    return [
        _Job(theorem.name, number, outcome.key, f"{owed.kind}: {owed.text}")
        for number, outcome in enumerate(theorem.outcomes, 1)
        for owed in [outcome.obligation]
        if outcome.status == "proved"
    ]


def _jobs(theorem: prover.Theorem, folder: Path, known: Container[str]) -> list[_Job]:
    """The proved obligations; the theorem is stated and exported only where some are not known."""
    found = _proved(theorem)
    new = [job for job in found if job.key not in known]
    if not new:
        return found
    claim, sentence = prover.state(theorem.name, folder)
    if len(claim.obligations) != len(theorem.outcomes):
        raise ValueError(f"{theorem.name}: other obligations than those that were proved")
    _write(new, claim, sentence)
    return found


def written(
    theorem: prover.Theorem, claim: Claim, sentence: str, *, known: Container[str]
) -> list[_Job]:
    """The jobs for a theorem whose claim is at hand, as `recheck` would find them; known: keys that have a verdict."""
    found = _proved(theorem)
    _write([job for job in found if job.key not in known], claim, sentence)
    return found


def _write(jobs: Iterable[_Job], claim: Claim, sentence: str) -> None:
    """Set the SMT-LIB text and the configurations of these jobs."""
    seen: Seen = {}
    for job in jobs:
        obligation = claim.obligations[job.number - 1]
        logic = prover.logic_of(obligation, seen)
        job.ways = [(logic, {})]
        if logic in ("QF_NRA", "QF_NIRA", "QF_NIA", "QF_UFNRA", "QF_UFNIRA"):
            job.ways.append((logic, {"nl-ext": "none", "nl-cov": "true"}))
        if logic != "ALL":
            job.ways.append(("ALL", {}))
        job.smt = prover.smt2(obligation, sentence, seen)


def _ask(job: _Job, asker: Asker) -> tuple[str, str, float]:
    """Check one obligation, each configuration with its full budget."""
    spent = 0.0
    for way in job.ways:
        answer, seconds = asker.ask(job.smt, way)
        spent += seconds
        if answer != "unknown":
            verdict = CONFIRMED if answer == "unsat" else CONTRADICTED
            return verdict, _named(way), spent
    return NO_ANSWER, "", spent


def _stored(job: _Job, store: Store, solver: str, asker: Asker) -> tuple[str, str, float]:
    """The stored answer, or cvc5's; that there was none within the time limit is stored too."""
    key = digest(["cvc5", solver, job.key])
    none = digest(
        [
            "cvc5",
            solver,
            job.key,
            f"none in {second_solver.CPU_SECONDS} s",
            *sorted(map(str, job.ways)),
        ]
    )
    kept = store.get(key) or store.get(none)
    if kept is not None:
        return kept["verdict"], kept["logic"], 0.0
    try:
        verdict, logic, seconds = _ask(job, asker)
    except second_solver.Stopped:
        return NO_ANSWER, "", 0.0  # not stored: the time limit was not reached
    found = {"verdict": verdict, "logic": logic}
    store.put(none if verdict == NO_ANSWER else key, found)
    return verdict, logic, seconds


def _worker(jobs: list[_Job], taken: Any, out: Connection, store: Store, solver: str) -> None:
    """Take the next job until none is left, so that no worker waits for the long jobs of another."""
    asker = Asker()
    while True:
        with taken.get_lock():
            number, taken.value = taken.value, taken.value + 1
        if number >= len(jobs):
            break
        out.send(jobs[number].check(*_stored(jobs[number], store, solver, asker)))
    asker.end()
    out.close()


def _said(record: dict[str, Any] | None) -> dict[str, dict[str, Any]]:
    """The verdicts of a record, if they are from this version of the solver."""
    if record is None or record.get("solver") != version():
        return {}
    return dict(record["obligations"])


def writer(record: dict[str, Any], *, again: bool) -> Callable[[prover.Theorem, Claim, str], Any]:
    """`written`, for the obligations that a re-check with this record would ask."""
    return partial(written, known=frozenset() if again else frozenset(_said(record)))


def recheck(
    theorems: Iterable[prover.Theorem],
    *,
    folder: Path = prover.FOLDER,
    jobs: int = 1,
    tell: Callable[[Check, int, int], None] | None = None,
    record: dict[str, Any] | None = None,
    again: bool = False,
    store: Store | None = None,
    texts: Mapping[str, list[Any]] | None = None,
) -> Recheck:
    """Put every proved obligation to cvc5.

    tell: called with each check, the number done, and the total. record: verdicts as `read` returns them; what this
    version of the solver has a verdict on there is not asked again, or, with `again`, is asked first with the
    configuration that answered then. store: where answers are kept between runs; by default nowhere. texts: the
    results of `written` while the theorems were proved.
    """
    if of_the_user() <= second_solver.CPU_SECONDS:
        raise BadInput(
            "the second solver has not its time: CPU time is limited (ulimit -t)",
            expected=f"more than {second_solver.CPU_SECONDS} s",
            got=f"{of_the_user():.0f} s",
        )
    solver = version()
    kept = store or Store(None)
    before = _said(record)
    known = {} if again else before
    import cvc5  # noqa: F401  (once here, so that the forked solvers have it already)

    ready = dict(texts or {})
    asked = list(theorems)
    rest = [theorem for theorem in asked if theorem.name not in ready]
    tasks = [partial(_jobs, theorem, folder, set(known)) for theorem in rest]
    for number, some in worker_processes.each(tasks, jobs):
        ready[rest[number].name] = some
    wanted: list[_Job] = [job for theorem in asked for job in ready[theorem.name]]
    for job in wanted:
        job.first(before.get(job.key, {"logic": ""})["logic"])
    # theorems may share an obligation: it is asked once
    todo = list({job.key: job for job in wanted if job.key not in known}.values())
    fork = multiprocessing.get_context("fork")
    pipes: list[tuple[Connection, Any]] = []
    taken = fork.Value("q", 0)
    for _ in range(jobs):
        here, there = fork.Pipe(duplex=False)
        process = fork.Process(target=_worker, args=(todo, taken, there, kept, solver))
        process.start()
        there.close()
        pipes.append((here, process))
    done: list[Check] = []
    open_pipes = [pipe for pipe, _ in pipes]
    while open_pipes:
        for pipe in wait(open_pipes):
            assert isinstance(pipe, Connection)
            try:
                check = pipe.recv()
            except EOFError:
                open_pipes.remove(pipe)
                continue
            done.append(check)
            if tell is not None:
                tell(check, len(done), len(todo))
    for _, process in pipes:
        process.join()
    if len(done) != len(todo):
        raise RuntimeError(f"the second solver was stopped after {len(done)} of {len(todo)}")
    said = {check.key: check for check in done}
    for job in wanted:
        if job.key in known and job.key not in said:
            said[job.key] = job.check(known[job.key]["cvc5"], known[job.key]["logic"], 0.0)
    checks = [
        job.check(said[job.key].verdict, said[job.key].logic, said[job.key].seconds)
        for job in wanted
    ]
    return Recheck(solver, tuple(checks))


def text(found: Recheck, theorems: Iterable[prover.Theorem]) -> str:
    """The verdicts by hash of the obligation, with z3's effort, as the text of `proofs/recheck.json`."""
    spent = {theorem.name: theorem.rlimit for theorem in theorems}
    obligations: dict[str, dict[str, Any]] = {}
    for check in found.checks:
        row = obligations.setdefault(
            check.key, {"cvc5": check.verdict, "logic": check.logic, "of": []}
        )
        row["of"].append(f"{check.theorem} {check.number}: {check.text}")
    for row in obligations.values():
        row["of"].sort()
    summary = {
        name: {"cvc5": found.verdict(name), "z3_effort": spent[name]}
        for name in sorted(found.theorems)
    }
    data = {"solver": found.solver, "theorems": summary, "obligations": obligations}
    return json.dumps(data, indent=1, sort_keys=True) + "\n"


def write(
    found: Recheck,
    theorems: Iterable[prover.Theorem],
    path: Path = FILE,
    *,
    whole: bool = True,
) -> None:
    """Write the verdicts; those of a part of the theorems (not `whole`) replace only these.

    Raises BadInput where results of two versions of the solver would be mixed.
    """
    new = text(found, theorems)
    if not whole and path.is_file():
        new = _joined(read(path), json.loads(new), path)
    write_atomically(path, new)


def _joined(old: dict[str, Any], new: dict[str, Any], path: Path) -> str:
    if old["solver"] != new["solver"]:
        raise BadInput(
            "the verdicts that are there come from another solver",
            where=path.name,
            expected=f"{new['solver']}, or a re-check of all theorems",
            got=old["solver"],
        )
    mine = set(new["theorems"])
    rows: dict[str, dict[str, Any]] = {}
    for key, row in old["obligations"].items():
        others = [name for name in row["of"] if name.split(" ")[0] not in mine]
        if others:
            rows[key] = {**row, "of": others}
    for key, row in new["obligations"].items():
        shared = rows.get(key, {"of": []})["of"]
        rows[key] = {**row, "of": sorted([*shared, *row["of"]])}
    known = {**old["theorems"], **new["theorems"]}
    data = {"solver": new["solver"], "theorems": known, "obligations": rows}
    return json.dumps(data, indent=1, sort_keys=True) + "\n"


def read(path: Path = FILE) -> dict[str, Any]:
    """The verdicts of the last full re-check; empty where there is none."""
    if not path.is_file():
        return {"solver": "", "theorems": {}, "obligations": {}}
    return dict(json.loads(path.read_text(encoding="utf-8")))
