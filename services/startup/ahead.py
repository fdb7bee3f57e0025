"""Parallel compilation for the first plan: separate processes compile while the gate runs.

    python -m cratous.services.startup.ahead legs

Nothing is decided here: each process compiles the kernels' generated source into the cache, as the planner
itself would a little later, or reads what files define, as the gate does. If one fails or is late, that is done
as usual.
"""

from __future__ import annotations

import atexit
import contextlib
import gc
import math
import os
import subprocess
import sys
import threading
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np

import cratous
from cratous.core.assignment.annealing import anneal
from cratous.core.assignment.anytime import greedy, improve
from cratous.core.assignment.compiled import MODERATE_TASKS
from cratous.core.assignment.layers import look_ahead, tables
from cratous.core.files.private_cache import private_cache
from cratous.core.geofence.mission_leg_arrays import first_bad, table
from cratous.core.ledger import PRODUCT, Keys
from cratous.core.readings import tiered
from cratous.core.readings.machine.compiled import is_kept, machine
from cratous.core.routing.bulk import (
    LINKS_MOST,
    Rings,
    Routed,
    Turning,
    direct_many,
    route_many,
)
from cratous.core.tasks.coverage_arrays import grid_squares, mark_seen
from cratous.services.planning import pending_compilation
from cratous.services.planning.assign_warm import simple_instance
from cratous.services.planning.detours import expected
from cratous.services.processes.leash import ENDS_WITH, end_with_parent
from cratous.spec.assignment.search import TIME
from cratous.spec.mission import AREAS, Mission

SOME_TASKS = 3
"""With at least this many tasks, legs against zones are worth machine code of their own."""
MANY_TASKS = 5
"""With at least this many tasks, a mission has too large an assignment for CPython."""
MANY_ROUTES = 30
"""With at least this many tasks, a mission has too many routes for CPython."""
LEGS = "legs"
"""Machine code of legs against zones, used by all routes."""
TABLES = "tables"
"""What the files define on which the proofs rest (`core.ledger.tables`)."""
SQUARES = "squares"
"""Machine code of `SQUARE_LOOPS`, used by any mission with an area."""
SQUARE_LOOPS = (grid_squares, mark_seen)
WAIT_S = 120.0
"""Longest wait for a compiling process [s]."""
BEHIND = 10
"""Lower priority (`nice`) of compiling what may not be needed."""


def begin(missions: Iterable[Mission]) -> None:
    """Start compiling what the plans of these missions need, if they are large and another core is available."""
    known = [*missions]
    if _cores() == 1:
        return
    if not (private_cache() / "tables").is_dir():
        _start([__name__, TABLES])
    if any(one.zones and len(one.tasks) >= SOME_TASKS for one in known):
        _begin(LEGS, (first_bad,))
    if any(task.kind in AREAS for one in known for task in one.tasks):
        _begin(SQUARES, SQUARE_LOOPS)
    tasks = max((len(one.tasks) for one in known), default=0)
    if tasks >= MANY_TASKS:
        # of so many tasks CPython mostly solves the assignment sooner
        _begin_planning(pending_compilation.ASSIGNMENT, BEHIND * (tasks <= MODERATE_TASKS))
    large = [one for one in known if len(one.tasks) >= MANY_ROUTES]
    if large:
        name = (
            pending_compilation.AROUND if any(map(expected, large)) else pending_compilation.ROUTES
        )
        _begin_planning(name, BEHIND)  # CPython finds the routes of most missions sooner


def _begin(name: str, loops: tuple[Callable[..., object], ...]) -> None:
    """Start compiling these loops, unless they are cached."""
    if all(is_kept(loop) for loop in loops):
        return
    ended = _waiter(_start([__name__, name]), WAIT_S)
    for loop in loops:
        tiered.expect(loop, ended)


def begin_all() -> None:
    """Start compiling what every larger plan needs, unless it is cached."""
    _begin_planning(pending_compilation.ROUTES, BEHIND)
    _begin_planning(pending_compilation.ASSIGNMENT, 0)


def _begin_planning(name: str, stands_back: int) -> None:
    """Start compiling what the planner waits for, unless it is cached; stands_back: by how much its priority is lower."""
    if is_kept(LOOPS[name]):
        return
    process = _start([__name__, name])
    if stands_back:
        _stand_back(process, stands_back)
    pending_compilation.expect(name, _waiter(process, WAIT_S))


def beside(module: list[str], stands_back: int) -> None:
    """Have one of our modules compile at lower priority than this process, which uses the results later."""
    process = _start(module)
    _stand_back(process, stands_back)
    threading.Thread(target=_waiter(process, None), daemon=True).start()


def _stand_back(process: subprocess.Popen[bytes], by: int) -> None:
    """Lower a process's priority relative to this one (`nice`)."""
    with contextlib.suppress(OSError):  # it has ended already
        own = os.getpriority(os.PRIO_PROCESS, 0)
        os.setpriority(os.PRIO_PROCESS, process.pid, own + by)


def _cores() -> int:
    """Number of cores available to this process."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _start(module: list[str]) -> subprocess.Popen[bytes]:
    """Start a CRATOUS module with arguments, as a process that does not outlive this one."""
    from cratous.bridge.text_protocol.keys import without_keys

    place = str(Path(cratous.__file__).absolute().parents[1])
    paths = [*filter(None, [os.environ.get("PYTHONPATH")]), place]
    process = subprocess.Popen(
        # modules in the working directory must not take precedence
        [sys.executable, "-P", "-m", *module],
        env={
            **without_keys(os.environ), "PYTHONPATH": os.pathsep.join(paths), ENDS_WITH: str(os.getpid()),
        },
        stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    atexit.register(_end, process)
    return process


def _waiter(process: subprocess.Popen[bytes], limit_s: float | None) -> Callable[[], None]:
    def wait() -> None:
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(limit_s)

    return wait


def _end(process: subprocess.Popen[bytes]) -> None:
    """End a process that nothing has waited for; it terminates cleanly."""
    if process.poll() is None:
        process.terminate()


def make_routes() -> None:
    """Compile direct routes, on empty arrays: compilation depends on the types only."""
    none = np.empty((0, 4))
    machine(direct_many)(none, none, Turning(1.0, math.inf, 1.0), table(()), _no_routes())


def make_around() -> None:
    """Compile routes around zones, on empty arrays."""
    none, rings = np.empty((0, 4)), np.empty((0, 0, 2))
    nothing = Rings(rings, np.empty(0, np.int64), np.empty((0, 0, 0), np.int8))
    machine(route_many)(none, none, Turning(1.0, math.inf, 1.0), table(()), nothing, _no_routes())


def _no_routes() -> Routed:
    whole = np.empty(0, np.int64)
    return Routed(whole, np.empty(0), whole, np.empty((1, LINKS_MOST + 2, 4)))


def make_legs() -> None:
    """Compile legs against zones, on a single point without zones."""
    machine(first_bad)(np.zeros((1, 3)), table(()))


def make_tables() -> None:
    """Read what files define for the gate, the last files first: the gate, which begins with others, finds what has
    been read.
    """
    tree = Keys(PRODUCT).tree
    for name in reversed(tree.every_module):
        tree.table(name)


def make_squares() -> None:
    """Compile the squares of an area and their visibility in footprints, on empty arrays."""
    none = np.empty((0, 4))
    machine(grid_squares)(none, 0.0, 0.0, 0, 0, 1.0, np.empty((0, 2)))
    machine(mark_seen)(np.empty((0, 2)), 0.5, np.empty((0, 4, 2)), np.empty(0, np.bool_))


def make_assignment() -> None:
    """Compile bounds, tables and annealing, on a small problem."""
    instance = simple_instance(TIME)
    _, moves = greedy(instance)
    assert moves is not None
    improve(instance, moves, 1, 1)
    tables(instance, look_ahead(instance), 9)


MAKERS = {
    pending_compilation.ROUTES: make_routes,
    pending_compilation.AROUND: make_around,
    pending_compilation.ASSIGNMENT: make_assignment,
    SQUARES: make_squares,
    LEGS: make_legs,
    TABLES: make_tables,
}
LOOPS: dict[str, Callable[..., object]] = {
    pending_compilation.ROUTES: direct_many,
    pending_compilation.AROUND: route_many,
    pending_compilation.ASSIGNMENT: anneal,
}
"""The loop that is in the cache once its maker has succeeded."""

if __name__ == "__main__":
    end_with_parent()
    gc.disable()  # the compiler leaves little garbage, and collecting it takes a tenth of its time
    MAKERS[sys.argv[1]]()
