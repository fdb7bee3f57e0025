"""Runs one case: its package is written, proved as by `cratous prove --package`, and judged.

Each case runs in a process forked from the same state: its effects on the registry, on modules or on the prover
itself end with the process, and no verdict depends on earlier cases.
"""

from __future__ import annotations

import functools
import gc
import importlib
import os
import resource
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import z3

from cratous.core import ledger as gate
from cratous.core.ledger import records
from cratous.core.ledger.kept_keys import made_anew
from cratous.proofs import ledger
from cratous.proofs.engine import (
    definition_subset,
    prover,
    solver_memory,
    symbolic,
    worker_processes,
)
from cratous.proofs.engine.theorem_files import home_folder
from cratous.proofs.judgement import Judgement, judge
from cratous.proofs.ledger.report_formats import failure_text
from cratous.proofs.self_test.case import Case
from cratous.spec.errors import BadInput, CratousError

CPU_S = 60
"""CPU seconds after which a case is ended: far above what any needs."""


@dataclass(frozen=True)
class Trial:
    """The result of a case: accepted, refused or broken (the prover ended with an error of its own).

    reason: why it was refused; vouched: whether a ledger was left that vouches for all of its kernels.
    """

    case: Case
    verdict: str
    reason: str
    vouched: bool

    @property
    def wrong(self) -> str:
        """What differs from the required verdict, in one line; empty if nothing does."""
        said = " ".join(self.reason.split())
        if self.case.verdict == "open":
            return (
                ""
                if self.verdict == "accepted"
                else f"no longer open, it is {self.verdict}: {said}"
            )
        if self.verdict != self.case.verdict:
            return f"{self.verdict}{': ' if said else ''}{said}"
        if self.vouched != (self.verdict == "accepted"):
            return f"{self.verdict}, yet the ledger {'vouches' if self.vouched else 'does not'}"
        if unsaid := self.case.unsaid(self.reason):
            return f"refused for another reason ({'; '.join(unsaid)} not in it): {said}"
        return ""


def _reason(found: Judgement) -> str:
    lines = list(found.problems)
    for theorem in found.inventory.theorems:
        if not theorem.proved:
            lines.append(f"not proved: {theorem.name}: {failure_text(theorem)}")
    return "\n".join(lines)


def _vouches(package: str, folder: Path) -> bool:
    """Whether the gate, in another process, accepts the ledger and every kernel of the package."""
    _begin(folder)
    vars(gate)["keys_of"] = made_anew  # nothing else asks for this package's keys
    try:
        return not gate.check(home=gate.package(package)).problems
    except CratousError:
        return False


def _begin(folder: Path) -> None:
    """Prepare a forked process for a package in this folder; its output is discarded."""
    silence = os.open(os.devnull, os.O_WRONLY)
    os.dup2(silence, 1)
    os.dup2(silence, 2)
    sys.dont_write_bytecode = True
    sys.path.insert(0, str(folder))
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_S, CPU_S))


def _leave_out(what: str) -> None:
    """Switch off a part of the prover in this process, so that a case reaches the checks behind it."""
    if what == "subset":
        vars(ledger)["lint_all"] = lambda entries: []
        vars(definition_subset)["outside"] = lambda function: []
        vars(symbolic)["EXACT"] = symbolic.INT64


def _proved(package: str, folder: Path, without: str) -> tuple[str, str, bool]:
    """The verdict on a package in this folder, the reason, and whether a ledger could vouch for it.

    Machine code takes longer than all else: it is compared only where a part of the prover is left out. A ledger is
    written only where it could vouch: one that records a kernel of the package as not proved vouches for none,
    whatever its keys are.
    """
    _begin(folder)
    _leave_out(without)
    try:
        home = gate.package(package)
        entries = gate.load_all(home)
        names = list(prover.theorem_files(home_folder(home)))
        if not names:
            raise BadInput("the package has no theorems", where=home.name)
        found = judge(names, home, jobs=1, machine=bool(without))
        refuted = {k for t in found.inventory.theorems if not t.proved for k in t.kernels}
        could = found.binds and refuted.isdisjoint(entries)
        if could:
            said = ledger.text(found.inventory, home, found.grounds, found.statements)
            records.write(said, home.records)
        return ("accepted" if found.holds else "refused"), _reason(found), could
    except CratousError as error:
        return "refused", str(error), True  # the case may have written a ledger itself
    except BaseException as error:  # a case may raise anything
        return "broken", f"{type(error).__name__}: {error}", True


def attempt(case: Case) -> Trial:
    """Run one case, in a folder and in processes of its own."""
    package = f"tried_{case.kind}_{case.name}"
    with tempfile.TemporaryDirectory(prefix="cratous-") as made:
        folder = Path(made).resolve()
        case.write(folder, package)
        try:
            verdict, reason, could = worker_processes.call(
                partial(_proved, package, folder, case.without)
            )
            written = any((folder / package / "ledger").rglob("*.json"))
            vouched = (
                could and written and worker_processes.call(partial(_vouches, package, folder))
            )
        except Exception as error:  # it ended its process, or the gate met something unexpected
            return Trial(case, "broken", f"{type(error).__name__}: {error}", False)
        # the name used in the case: the package's long name contains other words
        return Trial(case, verdict, reason.replace(package, "pkg"), vouched)


def attempts(cases: Sequence[Case], jobs: int = 1) -> Iterator[Trial]:
    """Run these cases, `jobs` at once; results in the order of completion."""
    prepare()
    plain = [case for case in cases if not case.without]
    # the compiler doubles the size of a process, and few cases need it
    for some in (plain, [case for case in cases if case.without]):
        if some and some is not plain:
            importlib.import_module("numba")
        if jobs == 1:  # each case has processes of its own anyway
            yield from map(attempt, some)
            continue
        tried: Sequence[Callable[[], Trial]] = [partial(attempt, case) for case in some]
        for _, trial in worker_processes.each(tried, jobs):
            yield trial


@functools.cache
def prepare() -> None:
    """Read what every ledger hashes, and initialise the solver, so that forked processes need not."""
    gate.check()
    _ = gate.Keys().shared  # the tables of all modules from which keys are made
    solver_memory.keep()
    z3.Solver(ctx=z3.main_ctx()).check()
    gc.collect()
    gc.freeze()  # otherwise each process copies the pages that its garbage collector visits
    gc.disable()  # forked processes end before garbage collection pays off
