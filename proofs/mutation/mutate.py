"""Mutation testing: whether some theorem detects every small fault of a kernel, a definition or a fold.

Each mutant of `mutation.operators` replaces its original wherever the theorems use it. First both run on inputs of
small grids; inputs that distinguish them are starting points for the solver. Then the theorems about the function are
stated anew, and only what differs from the proved statement is decided. The verdicts:

killed      a theorem is refuted with the mutant in place
survived    the mutant behaves differently, and no theorem is refuted: one is missing
equivalent  the solver proves that mutant and original agree, everywhere or wherever the theorems
            (of kernel and callers) apply; which of the two is recorded
undecided   neither refuted nor proved equivalent within the budget; not counted as killed
stillborn   the mutant cannot be run or lifted; listed separately, and not counted

The budget is solver effort (rlimit), the order is fixed, and each mutant is judged in a process
forked from one state: the result does not depend on the machine, on the number of processes, or
on what was known before. Every verdict is stored as soon as it is found (`proofs/mutation/keys.py`), so
an interrupted run continues where it stopped, and after a change only affected verdicts are recomputed.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable
from functools import partial
from typing import Any

from cratous.core import ledger as gate
from cratous.core.files.private_cache import private_cache
from cratous.core.kernel.names import fits
from cratous.core.ledger.package_home import Home
from cratous.proofs.engine import cache, prover, worker_processes
from cratous.proofs.mutation.judgement import judge_target
from cratous.proofs.mutation.keys import Keys, Store
from cratous.proofs.mutation.premises import judge_premises
from cratous.proofs.mutation.report import MutationReport
from cratous.proofs.mutation.results import VERDICTS, PremiseResult, Result
from cratous.proofs.mutation.statements import targets, theorems_from
from cratous.spec.errors import BadInput

__all__ = [
    "VERDICTS",
    "MutationReport",
    "PremiseResult",
    "Result",
    "chosen",
    "part",
    "run",
    "standard",
]


def standard() -> Store:
    """The store of verdicts of this user and machine."""
    return Store(private_cache() / "mutation")


def chosen(
    names: Iterable[str] = ("*",), keys: Keys | None = None, about: Iterable[str] = ()
) -> dict[str, list[str]]:
    """The targets whose name, or an end of it, matches a pattern, with the theorems that may kill their mutants.

    about: theorems; the kernels and folds that they are about are chosen too.
    """
    return _chosen(names, keys or Keys(), about, ())[0]


def _chosen(
    names: Iterable[str], keys: Keys, about: Iterable[str], skip: Container[str]
) -> tuple[dict[str, list[str]], list[str]]:
    """The result of `chosen`, and every theorem that could use a target, judging by what it imports.

    Some of these use none, because they do not look into it. skip: targets and theorems; a theorem in `skip` whose
    targets are all in `skip` is not stated.
    """
    patterns, theorems = list(names), set(about)

    def named(key: str) -> bool:
        return any(fits(key, pattern) for pattern in patterns)

    def look() -> tuple[dict[str, list[str]], list[str]]:
        gate.load_all(keys.home)
        theorems_from(keys.folder)
        mine = set(targets(sorted(theorems), keys.home))

        def could_meet(theorem: str) -> bool:
            wanted = {k for k in keys.reach(theorem) if named(k) or k in mine}
            return bool(wanted) if theorem not in skip else any(k not in skip for k in wanted)

        # only theorems that could look into a target are stated
        near = [n for n in keys.theorems if could_meet(n)]
        there = targets(near, keys.home)
        return {k: users for k, (_, users) in there.items() if named(k) or k in mine}, near

    # in a process of its own, so that every judgement starts from a state without terms
    return worker_processes.call(look)


def run(
    names: Iterable[str] = ("*",),
    tell: Callable[[str, list[Any]], None] | None = None,
    jobs: int = 1,
    *,
    keys: Keys | None = None,
    about: Iterable[str] = (),
    premises: bool = True,
    store: Store | None = None,
    skip: Container[str] = (),
) -> MutationReport:
    """Mutate the functions whose name, or an end of it, matches one of the patterns `names`.

    tell(target, results) is called as each target or theorem is done. jobs: processes. keys: of the home and of the
    theorems that may kill, by default all of the product that are not generated. about: mutate what these theorems
    look into as well. store: known verdicts; by default those of this user and machine. skip: targets, and theorems
    for their premises, that are not to be judged. Raises ValueError if one of the theorems is not proved as it
    stands.
    """
    keys = keys or Keys()
    home = keys.home
    gate.load_all(home)
    known = standard() if store is None else store
    met_by, near = _chosen(names, keys, about, skip)
    work = {key: users for key, users in met_by.items() if key not in skip}
    weighed = [name for name in near if name not in skip] if premises else []
    effort = _effort(sorted({*weighed, *(n for users in work.values() for n in users)}), home, jobs)
    # the longest first, so that no process waits for one that began late
    order = sorted(work, key=lambda key: -sum(effort[name] for name in work[key]))
    calls: list[tuple[str, Callable[[], list[Any]]]] = []
    for key in order:
        spent = {name: effort[name] for name in work[key]}
        calls.append((key, partial(_judge, key, work[key], spent, keys, known)))
    for name in weighed:
        calls.append((name, partial(judge_premises, name, effort[name], keys, known)))
    rows: dict[str, list[Any]] = {}
    for number, found in worker_processes.each([call for _, call in calls], jobs):
        rows[calls[number][0]] = found
        if tell is not None:
            tell(calls[number][0], found)
    return MutationReport(
        tuple(result for key in work for result in rows[key]),
        tuple(row for name in weighed for row in rows[name]),
        tuple(weighed),
    )


def _judge(
    key: str, users: list[str], effort: dict[str, int], keys: Keys, store: Store
) -> list[Result]:
    try:
        return judge_target(key, users, effort, keys, store)
    except (ArithmeticError, TypeError) as error:
        # on plain numbers Python itself raises where the solver would get an obligation
        raise BadInput(
            f"its mutants cannot be judged: {error}",
            where=key,
            expected="theorems that give it symbolic numbers (`c.real(...)` and a premise)",
            got=f"plain numbers in one of {', '.join(users)}",
        ) from error


def part(name: str, results: list[Any]) -> MutationReport:
    """The results that `tell` of `run` received for one target, or for the premises of one theorem, as a report."""
    if "." in name:
        return MutationReport(tuple(results), ())
    return MutationReport((), tuple(results), (name,))


def _effort(names: list[str], home: Home, jobs: int) -> dict[str, int]:
    """The effort (rlimit) each theorem took to prove; raises ValueError if one is not proved as it stands."""
    kept = cache.standard()
    calls = [partial(prover.prove_file, n, folder=home.theorems, cache=kept) for n in names]
    proved = {names[number]: theorem for number, theorem in worker_processes.each(calls, jobs)}
    broken = [name for name in names if not proved[name].proved]
    if broken:
        raise ValueError(f"not proved as they stand, so no mutant can be judged: {broken}")
    return {name: theorem.rlimit for name, theorem in proved.items()}
