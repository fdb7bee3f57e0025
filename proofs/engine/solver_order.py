"""Which solvers a question is put to, in which order, and with how much effort each.

z3's own strategy for polynomials switches from one order of variables to the next by wall time, so its answer would
depend on the load of the machine. Here each solver has a share of the effort (rlimit). Work that z3 does not count as
effort (arithmetic on numbers of a million digits) is ended by a watchdog on CPU time: the next solver is tried, and
where none is left the answer is `unknown`. A question that does not react to the interrupt ends with its process
(`cpu_limit.ends_within`); the parent then repeats the work with each question in a process of its own (`ask_apart`).
If that process is ended, the answer is `unknown`, with the limit that ended it.
"""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Iterator
from functools import partial
from typing import NamedTuple

import z3

from cratous.proofs.engine import worker_processes
from cratous.proofs.engine.cpu_limit import ends_within, what_ended

ORDERS = (3, 0, 4)
"""Orders of variables for polynomials (z3's numbers), the most promising first."""
SEEDS = (0, 1, 2)
"""Random seeds of the general solver: the first gets the full effort, the others a share."""
SHARES = (30, 6)
GUARD_S, GUARD_RATE = 5.0, 200_000
"""CPU seconds after which a question is ended, and the effort that adds one second: far above the usual."""
LOOK_S = 0.5
"""Wall seconds between two readings of the CPU clock."""
_ASKS_APART: set[int] = set()


def solvers(
    context: z3.Context, rlimit: int, *, polynomials: bool, shares: tuple[int, ...] = SHARES
) -> Iterator[tuple[str, z3.Solver, int]]:
    """Logic, solver and effort of each attempt, most promising first.

    polynomials: the question has reals only, without functions and quantifiers. shares: divisors of the effort that
    each order of variables may spend before the first has all of it.
    """
    if polynomials:
        ladder = [(order, rlimit // part) for part in shares for order in ORDERS]
        for order, effort in (*ladder, (ORDERS[0], rlimit)):
            tactic = z3.Tactic("qfnra-nlsat", context)
            chosen = z3.With(tactic, variable_ordering_strategy=order, ctx=context)
            yield "QF_NRA", chosen.solver(), effort
    for seed in SEEDS:
        solver = z3.Solver(ctx=context)
        solver.set("random_seed", seed)
        yield "ALL", solver, rlimit if seed == SEEDS[0] else rlimit // shares[-1]


class Said(NamedTuple):
    """`sat`, `unsat` or `unknown`, and the effort spent (rlimit).

    ended: which time limit ended the question, in words; another run may find an answer, so this result is not
    cached. Empty where the solver answered within its effort.
    """

    result: str
    spent: int
    ended: str = ""


def ask_apart() -> None:
    """From now on this process asks each question in a process of its own."""
    _ASKS_APART.add(os.getpid())


def most_cpu_s(effort: int) -> float:
    """The CPU time [s] after which a question of this effort is interrupted."""
    return GUARD_S + effort / GUARD_RATE


def check(solver: z3.Solver, context: z3.Context, effort: int) -> Said:
    """The solver's answer within the effort and the CPU limit; if sat, the model is in the solver."""
    if os.getpid() in _ASKS_APART:
        try:
            said = worker_processes.call(partial(_check, solver, context, effort))
        except worker_processes.Ended as error:
            return Said("unknown", 0, what_ended(error.code, most_cpu_s(effort)))
        if said.result != "sat":
            return said
        # it terminates, and a model cannot be returned from another process
    return _check(solver, context, effort)


def _check(solver: z3.Solver, context: z3.Context, effort: int) -> Said:
    solver.set("rlimit", effort)
    before = _effort_so_far(solver)
    seconds = most_cpu_s(effort)
    latest = time.process_time() + seconds
    done, over = threading.Event(), threading.Event()

    def watch() -> None:
        # repeated until it takes effect: between two steps of the solver an interrupt is lost
        while not done.wait(LOOK_S):
            if time.process_time() > latest:
                over.set()
                context.interrupt()

    watcher = threading.Thread(target=watch, daemon=True)
    watcher.start()
    try:
        with ends_within(seconds):
            result = str(solver.check())
    finally:
        done.set()
        # it must not interrupt the next question
        watcher.join()
    late = result == "unknown" and over.is_set()
    ended = f"interrupted after {seconds:.0f} s of CPU, the prover's own limit" if late else ""
    return Said(result, max(0, _effort_so_far(solver) - before), ended)


def _effort_so_far(solver: z3.Solver) -> int:
    return next((int(value) for key, value in solver.statistics() if key == "rlimit count"), 0)
