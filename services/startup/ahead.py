"""A first plan does not compile one loop after the other: processes of their own compile beside the gate.

    python -m cratous.services.startup.ahead routes

Nothing is decided here: each process makes machine code of the text that the kernels' source gives, into the
cache, as the planner itself would a little later. If one fails or is late, the planner compiles as ever.
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
from cratous.core.assignment.layers import look_ahead, tables
from cratous.core.geofence.mission_leg_arrays import table
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
from cratous.services.planning import coming
from cratous.services.planning.assign_warm import simple_instance
from cratous.services.planning.detours import expected
from cratous.services.processes.leash import ENDS_WITH, end_with_parent
from cratous.spec.assignment.search import TIME
from cratous.spec.mission import AREAS, Mission

MANY_TASKS = 5
"""A mission of so many tasks has ways enough that CPython does not search them."""
SQUARES = "squares"
"""Machine code of `SQUARE_LOOPS`, which any mission with an area uses."""
SQUARE_LOOPS = (grid_squares, mark_seen)
WAIT_S = 120.0
"""A process that compiles is not waited for any longer."""


def begin(missions: Iterable[Mission]) -> None:
    """Have compiled what the plans of these missions need, if that is much and there is a core for it."""
    known = [*missions]
    large = [one for one in known if len(one.tasks) >= MANY_TASKS]
    if _cores() == 1:
        return
    if any(task.kind in AREAS for one in known for task in one.tasks):
        _begin_squares()
    if large:
        begin_all(around=any(map(expected, large)))


def _begin_squares() -> None:
    """Have compiled what any area's squares need."""
    if all(map(is_kept, SQUARE_LOOPS)):
        return
    ended = _waiter(_start([__name__, SQUARES]), WAIT_S)
    for loop in SQUARE_LOOPS:
        tiered.expect(loop, ended)


def begin_all(around: bool = False) -> None:
    """Have compiled what every larger plan needs, unless it is kept. around: many ways will lead around zones."""
    for name in (coming.AROUND if around else coming.ROUTES, coming.ASSIGNMENT):
        if not is_kept(LOOPS[name]):
            coming.expect(name, _waiter(_start([__name__, name]), WAIT_S))


def beside(module: list[str], stands_back: int) -> None:
    """Have a module of ours compile behind what this process does, which uses it once that has ended."""
    process = _start(module)
    with contextlib.suppress(OSError):  # it has ended already
        own = os.getpriority(os.PRIO_PROCESS, 0)
        os.setpriority(os.PRIO_PROCESS, process.pid, own + stands_back)
    threading.Thread(target=_waiter(process, None), daemon=True).start()


def _cores() -> int:
    """Those that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _start(module: list[str]) -> subprocess.Popen[bytes]:
    """Start a CRATOUS module with arguments, as a process that does not outlive this one."""
    from cratous.bridge.text_protocol.keys import without_keys

    place = str(Path(cratous.__file__).absolute().parents[1])
    paths = [*filter(None, [os.environ.get("PYTHONPATH")]), place]
    process = subprocess.Popen(
        # no module of the present folder comes first
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
        is_kept.cache_clear()  # what was not kept may be now

    return wait


def _end(process: subprocess.Popen[bytes]) -> None:
    """What nobody has waited for is not needed any more; it ends by itself, and tidies up."""
    if process.poll() is None:
        process.terminate()


def make_routes() -> None:
    """Direct routes, of no poses: what is compiled depends on the types alone."""
    none = np.empty((0, 4))
    machine(direct_many)(none, none, Turning(1.0, math.inf, 1.0), table(()), _no_routes())


def make_around() -> None:
    """Routes around zones, of no poses."""
    none, rings = np.empty((0, 4)), np.empty((0, 0, 2))
    nothing = Rings(rings, np.empty(0, np.int64), np.empty((0, 0, 0), np.int8))
    machine(route_many)(none, none, Turning(1.0, math.inf, 1.0), table(()), nothing, _no_routes())


def _no_routes() -> Routed:
    whole = np.empty(0, np.int64)
    return Routed(whole, np.empty(0), whole, np.empty((1, LINKS_MOST + 2, 4)))


def make_squares() -> None:
    """The squares of an area, and those that footprints see, of no area."""
    none = np.empty((0, 4))
    machine(grid_squares)(none, 0.0, 0.0, 0, 0, 1.0, np.empty((0, 2)))
    machine(mark_seen)(np.empty((0, 2)), 0.5, np.empty((0, 4, 2)), np.empty(0, np.bool_))


def make_assignment() -> None:
    """Bounds, tables and the improvement at random of a little problem."""
    instance = simple_instance(TIME)
    _, moves = greedy(instance)
    assert moves is not None
    improve(instance, moves, 1, 1)
    tables(instance, look_ahead(instance), 9)


MAKERS = {
    coming.ROUTES: make_routes,
    coming.AROUND: make_around,
    coming.ASSIGNMENT: make_assignment,
    SQUARES: make_squares,
}
LOOPS: dict[str, Callable[..., object]] = {
    coming.ROUTES: direct_many,
    coming.AROUND: route_many,
    coming.ASSIGNMENT: anneal,
}
"""What is in the cache once its maker has ended well."""

if __name__ == "__main__":
    end_with_parent()
    gc.disable()  # the compiler leaves little garbage, and looking for it takes a tenth of its time
    MAKERS[sys.argv[1]]()
