"""Compiles kernels in advance on all cores, so that their comparison only has to load the machine code.

Compilation takes longer than all comparisons together, and its results are reused by flights: its time is reported
separately.
"""

from __future__ import annotations

import contextlib
import functools
import importlib
from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np

from cratous.core.kernel import entry_of
from cratous.core.readings.machine.compiled import KINDS, compiled
from cratous.proofs.engine import worker_processes
from cratous.proofs.engine.terms import leaves
from cratous.proofs.running import arguments
from cratous.proofs.running.theorem import Function

PER_PROCESS = 8
"""The number of parts per process into which the functions are divided: some take far longer than others."""


def compile_ahead(masks: Mapping[Function, frozenset[int]], jobs: int) -> None:
    """Compile the kernels among these functions for the array types with which they are compared.

    masks: positions of bit masks, by function. A kernel that cannot be compiled is left to the comparison, which
    reports the reason.
    """
    names = sorted(masks)
    if not names:
        return
    begin_compiler()
    count = min(PER_PROCESS * jobs, len(names))
    tasks = [partial(_some, names[k::count], masks) for k in range(count)]
    for _ in worker_processes.each(tasks, jobs):
        pass


@functools.cache
def begin_compiler() -> None:
    """Load the compiler in this process, so that processes forked from it need not."""
    from numba import njit

    njit(lambda x: x)(0.0)


def _some(names: Sequence[Function], masks: Mapping[Function, frozenset[int]]) -> None:
    for module, name in names:
        with contextlib.suppress(Exception):
            _compile((module, name), masks[module, name])


def _compile(key: Function, masks: frozenset[int]) -> None:
    module, name = key
    function = vars(importlib.import_module(module))[name]
    if entry_of(function) is None:
        return
    row = arguments.rows(function, masks, ())[0]
    kinds = arguments.leaves_of(arguments.kinds_of(function))
    ones = [np.array([v], dtype=KINDS[k]) for v, k in zip(leaves(row), kinds, strict=True)]
    compiled(function)(*ones)
