"""A first plan does not compile one loop after the other: processes of their own compile beside the gate.

    python -m cratous.services.startup.ahead routes

Nothing is decided here: each process makes machine code of the text that the kernels' source gives, into the
cache, as the planner itself would a little later. If one fails or is late, the planner compiles as ever.
"""

from __future__ import annotations

import atexit
import contextlib
import math
import os
import subprocess
import sys
from collections.abc import Callable

import numpy as np

from cratous.core.assignment.anytime import greedy, improve
from cratous.core.assignment.layers import look_ahead, tables
from cratous.core.geofence.mission_leg_arrays import table
from cratous.core.readings.machine.compiled import is_kept, machine
from cratous.core.routing.bulk import LINKS_MOST, Routed, Turning, direct_many
from cratous.services.planning import coming
from cratous.services.planning.assign import simple_instance
from cratous.services.processes.leash import ENDS_WITH, end_with_parent
from cratous.spec.assignment.search import TIME

MANY_TASKS = 5
"""A mission of so many tasks has ways enough that CPython does not search them."""
WAIT_S = 120.0
"""A process that compiles is not waited for any longer."""


def begin(tasks: int) -> None:
    """Have compiled what the plan of so many tasks needs, if that is much and there is a core for it."""
    if tasks >= MANY_TASKS and (os.cpu_count() or 1) > 1:
        begin_all()


def begin_all() -> None:
    """Have compiled what every larger plan needs, unless it is kept."""
    if is_kept(direct_many):
        return
    for name in MAKERS:
        coming.expect(name, _waiter(start([__name__, name])))


def start(module: list[str], stands_back: int = 0) -> subprocess.Popen[bytes]:
    """A module of ours with its arguments, as a process that does not outlive this one."""
    command = [sys.executable, "-m", *module]
    if stands_back:
        command = ["nice", "-n", str(stands_back), *command]
    process = subprocess.Popen(
        command, env={**os.environ, ENDS_WITH: str(os.getpid())},
        stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    atexit.register(_end, process)
    return process


def _waiter(process: subprocess.Popen[bytes]) -> Callable[[], None]:
    def wait() -> None:
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(WAIT_S)

    return wait


def _end(process: subprocess.Popen[bytes]) -> None:
    """What nobody has waited for is not needed any more; it ends by itself, and tidies up."""
    if process.poll() is None:
        process.terminate()


def make_routes() -> None:
    """Direct routes, of no poses: what is compiled depends on the types alone."""
    none = np.empty((0, 4))
    whole = np.empty(0, np.int64)
    found = Routed(whole, np.empty(0), whole, np.empty((1, LINKS_MOST + 2, 4)))
    machine(direct_many)(none, none, Turning(1.0, math.inf, 1.0), table(()), found)


def make_assignment() -> None:
    """Bounds, tables and the improvement at random of a little problem."""
    instance = simple_instance(TIME)
    _, moves = greedy(instance)
    assert moves is not None
    improve(instance, moves, 1, 1)
    tables(instance, look_ahead(instance), 9)


MAKERS = {coming.ROUTES: make_routes, coming.ASSIGNMENT: make_assignment}

if __name__ == "__main__":
    end_with_parent()
    MAKERS[sys.argv[1]]()
