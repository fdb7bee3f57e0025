"""Calls in processes forked from the present state; their results are returned.

The statement of a theorem may depend on what the solver was asked before (numbers of terms, pruned paths). Stated in
a fresh fork it is the same for the prover, the second solver and the export.
"""

from __future__ import annotations

import multiprocessing
import signal
from collections.abc import Callable, Iterator, Sequence
from multiprocessing.connection import Connection, wait
from typing import Any, TypeVar

from cratous.proofs.engine.cpu_limit import may_be_killed

T = TypeVar("T")


class Ended(RuntimeError):
    """A process ended without a result."""

    def __init__(self, code: int | None) -> None:
        self.code = code
        self.out_of_time = code == -signal.SIGXCPU
        why = "its CPU time was used up" if self.out_of_time else f"code {code}"
        super().__init__(f"a process ended without a result: {why}")


def _child(function: Callable[[], T], out: Connection) -> None:
    may_be_killed()
    try:
        out.send((True, function()))
    except Exception as error:
        out.send((False, error))
    finally:
        out.close()


def _start(function: Callable[[], Any]) -> tuple[Connection, Any]:
    fork = multiprocessing.get_context("fork")
    here, there = fork.Pipe(duplex=False)
    process = fork.Process(target=_child, args=(function, there))
    process.start()
    there.close()
    return here, process


def _finish(here: Connection, process: Any) -> Any:
    try:
        good, result = here.recv()
    except EOFError as error:
        process.join()
        raise Ended(process.exitcode) from error
    finally:
        here.close()
    process.join()
    if not good:
        raise result
    return result


def call(function: Callable[[], T]) -> T:
    """The function's result; raises what it raises."""
    result: T = _finish(*_start(function))
    return result


def each(functions: Sequence[Callable[[], T]], jobs: int) -> Iterator[tuple[int, T]]:
    """Index and result of every function in the order of completion; `jobs` run at once.

    Raises the error of the first to fail; those still running are terminated.
    """
    waiting = list(reversed(range(len(functions))))
    running: dict[Connection, tuple[int, Any]] = {}
    try:
        while waiting or running:
            while waiting and len(running) < max(1, jobs):
                number = waiting.pop()
                here, process = _start(functions[number])
                running[here] = (number, process)
            for ready in wait(list(running)):
                assert isinstance(ready, Connection)
                number, process = running.pop(ready)
                yield number, _finish(ready, process)
    finally:
        for _, process in running.values():
            process.terminate()
