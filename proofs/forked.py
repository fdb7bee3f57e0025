"""One call in a process forked from the present state; its result comes back.

What a theorem's statement looks like may depend on what the solver was asked before (numbers of
terms, pruned paths). Stated in a fresh fork it is the same for the prover, the second solver and
the export.
"""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import TypeVar

T = TypeVar("T")


def _child(function: Callable[[], T], out: Connection) -> None:
    try:
        out.send((True, function()))
    except Exception as error:
        out.send((False, error))
    finally:
        out.close()


def call(function: Callable[[], T]) -> T:
    """The function's result; raises what it raises."""
    here, there = (fork := multiprocessing.get_context("fork")).Pipe(duplex=False)
    process = fork.Process(target=_child, args=(function, there), daemon=True)
    process.start()
    there.close()
    try:
        good, result = here.recv()
    except EOFError as error:
        process.join()
        raise RuntimeError(f"a process ended with code {process.exitcode}") from error
    process.join()
    here.close()
    if not good:
        raise result
    return result
