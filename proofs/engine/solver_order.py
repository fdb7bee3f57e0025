"""Which solvers a question is put to, in which order, and with how much effort each.

z3's own strategy for polynomials goes from one order of variables to the next by wall time, so its
answer would depend on what else the machine does. Here each way has a share of the effort (rlimit).
What z3 does not count as effort (arithmetic on numbers of a million digits) a guard ends, by CPU
time: the next way is tried, and where none is left the answer is `unknown`.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator

import z3

ORDERS = (3, 0, 4)
"""Orders of variables for polynomials (z3's numbers), the most promising first."""
SEEDS = (0, 1, 2)
"""Random seeds of the general solver: the first has all of the effort, the others a share."""
SHARES = (30, 6)
GUARD_S, GUARD_RATE = 5.0, 200_000
"""CPU seconds after which a question is ended, and effort that adds one: many times the usual."""


def solvers(
    context: z3.Context, rlimit: int, *, polynomials: bool, shares: tuple[int, ...] = SHARES
) -> Iterator[tuple[str, z3.Solver, int]]:
    """Logic, solver and effort of each way that is worth trying, most promising first.

    polynomials: the question has reals alone, without functions and quantifiers. shares: parts of
    the effort that each order of variables may spend before the first has all of it.
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


def check(solver: z3.Solver, context: z3.Context, effort: int) -> str:
    """`sat`, `unsat` or `unknown`, within the effort and the guard."""
    solver.set("rlimit", effort)
    latest = time.process_time() + GUARD_S + effort / GUARD_RATE
    done = threading.Event()

    def watch() -> None:
        while not done.wait(0.5):
            if time.process_time() > latest:
                context.interrupt()
                return

    watcher = threading.Thread(target=watch, daemon=True)
    watcher.start()
    try:
        return str(solver.check())
    finally:
        done.set()
        # it must not interrupt the next question
        watcher.join()
