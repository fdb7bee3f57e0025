"""One case tried: its package is written, proved as `cratous prove --package` does it, and judged.

Each is tried in a process forked from one state: what a case does to the registry, to modules or
to the prover itself is gone with it, and no verdict depends on the cases before.
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
"""CPU seconds after which a case is ended: many times what any takes."""


@dataclass(frozen=True)
class Trial:
    """What came of a case: accepted, refused or broken (the prover ended in an error of its own).

    reason: why it was refused; vouched: a ledger was left that vouches for all of its kernels.
    """

    case: Case
    verdict: str
    reason: str
    vouched: bool

    @property
    def wrong(self) -> str:
        """What is not as it must be, in one line; nothing where all is."""
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
    """The gate of another process finds a ledger, and nothing against any kernel of the package."""
    _begin(folder)
    vars(gate)["keys_of"] = made_anew  # nobody asks for this package's keys again
    try:
        return not gate.check(home=gate.package(package)).problems
    except CratousError:
        return False


def _begin(folder: Path) -> None:
    """Prepare a forked process for a package that lies in this folder; what it prints is not heard."""
    silence = os.open(os.devnull, os.O_WRONLY)
    os.dup2(silence, 1)
    os.dup2(silence, 2)
    sys.dont_write_bytecode = True
    sys.path.insert(0, str(folder))
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_S, CPU_S))


def _leave_out(what: str) -> None:
    """Switch off a part of the prover in this process, so that a case meets what comes after it."""
    if what == "subset":
        vars(ledger)["lint_all"] = lambda entries: []
        vars(definition_subset)["outside"] = lambda function: []
        vars(symbolic)["EXACT"] = symbolic.INT64


def _proved(package: str, folder: Path, without: str) -> tuple[str, str, bool]:
    """The verdict on a package that lies in this folder, the reason, whether a ledger could vouch.

    Machine code takes longer than all else: it is compared where a part of the prover is left out.

    A ledger is written only where it could: one that says of a kernel of the package that it is not
    proved vouches for none, whatever its keys are.
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
        return "refused", str(error), True  # it may have written one itself
    except BaseException as error:  # a case may raise whatever it likes
        return "broken", f"{type(error).__name__}: {error}", True


def attempt(case: Case) -> Trial:
    """Try one case, in a folder and in processes of its own."""
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
        except Exception as error:  # it ended its process, or the gate met what it does not expect
            return Trial(case, "broken", f"{type(error).__name__}: {error}", False)
        # as the case calls it: the package's long name has words of its own
        return Trial(case, verdict, reason.replace(package, "pkg"), vouched)


def attempts(cases: Sequence[Case], jobs: int = 1) -> Iterator[Trial]:
    """Try these cases, so many at once; the trials come as they are done."""
    prepare()
    plain = [case for case in cases if not case.without]
    # the compiler makes a process twice as large, and few of them need it
    for some in (plain, [case for case in cases if case.without]):
        if some and some is not plain:
            importlib.import_module("numba")
        if jobs == 1:  # each has processes of its own anyway
            yield from map(attempt, some)
            continue
        tried: Sequence[Callable[[], Trial]] = [partial(attempt, case) for case in some]
        for _, trial in worker_processes.each(tried, jobs):
            yield trial


@functools.cache
def prepare() -> None:
    """Read what every ledger hashes, and wake the solver, so that forked processes find it done."""
    gate.check()
    _ = gate.Keys().shared  # the tables of all modules that a key is made from
    solver_memory.keep()
    z3.Solver(ctx=z3.main_ctx()).check()
    gc.collect()
    gc.freeze()  # else each process copies what its collector looks at
    gc.disable()  # what is forked from here ends before its garbage is worth looking for
