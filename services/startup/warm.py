"""The work of `cratous warm`: compiling the kernels that the runtime uses on arrays, in named steps.

It is part of the set-up, so that no mission waits for the compiler. `ensure_planning` requests it where a
service with response times starts with an empty cache: in separate processes, since the compiler takes a
minute and more memory than planning itself.
"""

from __future__ import annotations

import hashlib
import sys
import tempfile
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path

from cratous.core import ledger
from cratous.core.files.private_cache import private_cache
from cratous.core.geofence.planar import orient
from cratous.core.kernel.sources import ROOT
from cratous.core.readings.machine.compiled import compiled
from cratous.core.readings.tiered import at_once
from cratous.core.well_clear import horizontal_violation, violation, violation_within
from cratous.services.planning import assign_warm, pending_compilation
from cratous.services.requirements import finished_trace
from cratous.services.requirements.evaluation import TRUE
from cratous.services.requirements.formula import Always, Bounded, Join, Not, Reaches
from cratous.services.requirements.outcome import Outcome
from cratous.services.requirements.specification import Requirement
from cratous.services.startup import ahead, sample_missions
from cratous.spec.daa.parameters import DCPA, Spread

ENCOUNTER = """NAME sx sy sz trk gs vs time
unitless [nmi] [nmi] [ft] [deg] [knot] [fpm] [s]
own 0 0 5000 0 150 0 0
north 0.3 4 5300 180 180 -150 0
east 4 2.5 5100 270 200 0 0
"""
"""Two intruders in conflict: alerts, bands in all dimensions, reasons, and the search for a resolution."""


def warm_kernels() -> None:
    """Compile well clear and orientation over arrays."""
    zero = 0.0
    state = (100.0, zero, -10.0, zero)
    compiled(horizontal_violation)(*state, 50.0, 10.0)
    compiled(violation)(*state, zero, zero, 50.0, 30.0, 10.0, zero)
    compiled(violation_within)(*state, zero, zero, 50.0, 30.0, 10.0, zero, 60.0)
    compiled(orient)(*state, zero, zero)


def warm_planning() -> None:
    """Compile what planning a mission calls, and record that for `ensure_planning`."""
    with at_once():
        sample_missions.plan(sample_missions.TASKS)
    _mark().parent.mkdir(exist_ok=True, mode=0o700)
    _mark().touch()


def warm_daa() -> None:
    """Compile what detect and avoid and its judges call."""
    from cratous.services.daa import named_or_file, run
    from cratous.services.daa.excuse import judge_step
    from cratous.services.daa.explain import explain

    near = Spread(0.5, 20.0, 5.0, 200.0)
    known = named_or_file("do_365b").parameters
    spread = tuple(
        a._replace(levels=tuple(one._replace(spread=near) for one in a.levels))
        for a in known.alerters
    )
    with tempfile.TemporaryDirectory() as folder, at_once():
        file = Path(folder) / "encounter.daa"
        file.write_text(ENCOUNTER, encoding="utf-8")
        for step in run(file, known):
            explain(step.parameters, step.instant)
            judge_step(step)
            step.instant.last_times(step.parameters, 0)
        # with levels for spread bands, and coordination of the ownship
        sided = replace(known, alerters=spread, conflict_crit=True, urgency_strategy=DCPA)
        for step in run(file, sided):
            explain(step.parameters, step.instant)


def warm_requirements() -> None:
    """Compile the evaluation of requirements over a whole trace, at two samples."""
    columns = finished_trace.Columns("x")
    for time in (0, 1):
        columns.add(time, {"x": 1.0})
    reaches = Reaches("x", 0.0)
    since = Bounded(reaches, Join(reaches, Not(reaches), True), 0, 1, True)
    formula = Bounded(since, Always(TRUE), 0, 1, False)
    finished_trace.Whole(columns).fill(Outcome(Requirement("", "", formula), 1), formula)


def warm_gate() -> None:
    """Load what the gate reads, whatever its verdict."""
    ledger.require(allow_unproved=True)


BESIDE = 10
"""Lower priority (`nice`) of background compilation."""
Step = tuple[str, Callable[[], None]]
PLANNING: tuple[Step, ...] = (
    ("the searches of the assignment", assign_warm.warm),
    ("the loops of planning", warm_planning),
)
OTHERS: tuple[Step, ...] = (
    ("detect and avoid", warm_daa),
    ("well clear over arrays", warm_kernels),
    ("requirements over a whole trace", warm_requirements),
    ("what the gate reads", warm_gate),
)
CHAINS = (PLANNING, OTHERS)
"""Chains that may be compiled in parallel: steps of one chain share kernels, those of different chains hardly
any.
"""


def compile_all(chains: Sequence[Sequence[Step]], cores: int, say: Callable[[str], None]) -> None:
    """Execute all steps of these chains, in parallel processes on several cores; `say` receives the name of
    each completed step.
    """
    if cores == 1 or len(chains) == 1:
        for name, step in (step for chain in chains for step in chain):
            step()
            say(name)
        return
    with ProcessPoolExecutor(min(cores, len(chains)), mp_context=get_context("spawn")) as pool:
        for done in as_completed([pool.submit(_taken, chain) for chain in chains]):
            for name in done.result():
                say(name)


def _taken(chain: Sequence[Step]) -> list[str]:
    for _, step in chain:
        step()
    return [name for name, _ in chain]


def ensure_planning(say: Callable[[str], None]) -> None:
    """Ensure that planning's loops are compiled; `say` is told if that takes time.

    What every larger plan needs is waited for; the rest is compiled while this process runs, but not beyond
    its end: the next process continues.
    """
    if _mark().is_file():
        return
    say(
        "the planning loops are compiled, once for this version and machine: some are waited for, "
        "the rest is compiled meanwhile (`cratous warm` does it ahead)"
    )
    ahead.begin_all()  # on a single core too: the service must not stall on compilation
    for name in (pending_compilation.ROUTES, pending_compilation.ASSIGNMENT):
        pending_compilation.ready(name)
    ahead.beside(["cratous", "warm", "--planning", "--quiet"], BESIDE)


def _mark() -> Path:
    """A file that exists once planning is compiled; its name hashes the loops' sources and the compiler."""
    sha = hashlib.sha256(f"{sys.version} {ledger.compiler()}".encode())
    for file in sorted((ROOT / "core").rglob("*.py")):
        sha.update(file.read_bytes())
    return private_cache() / "warm" / sha.hexdigest()
