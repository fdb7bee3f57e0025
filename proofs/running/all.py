"""Compares each function that theorems look into once, and records the results with the theorems."""

from __future__ import annotations

import importlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial

from cratous.core.kernel.sources import ours
from cratous.proofs.engine import worker_processes
from cratous.proofs.engine.outcomes import Ran
from cratous.proofs.engine.prover import Theorem
from cratous.proofs.running.compiling import PER_PROCESS, begin_compiler
from cratous.proofs.running.readings import Compared, Row, compare
from cratous.proofs.running.theorem import Function, Functions

ROWS = 24
"""The most arguments taken from theorems for one function."""


def compare_all(
    looked_into: Iterable[Functions], jobs: int, *, machine: bool = True
) -> dict[Function, Compared]:
    """Compare the readings of all functions; jobs: number of processes."""
    masks: dict[Function, frozenset[int]] = {}
    rows: dict[Function, tuple[Row, ...]] = {}
    for one in looked_into:
        for key, bits in one.masks.items():
            masks[key] = masks.get(key, frozenset()) | bits
            rows[key] = (*rows.get(key, ()), *one.rows.get(key, ()))[:ROWS]
    names = sorted(masks)
    if machine and names:
        begin_compiler()
    # some take far longer than others, so the work is dealt out in small parts
    count = min(PER_PROCESS * jobs, len(names))
    parts = [names[k::count] for k in range(count)]
    tasks = [partial(_some, part, masks, rows, machine) for part in parts]
    return {
        key: found for _, some in worker_processes.each(tasks, jobs) for key, found in some.items()
    }


def _some(
    names: Sequence[Function],
    masks: Mapping[Function, frozenset[int]],
    rows: Mapping[Function, tuple[Row, ...]],
    machine: bool,
) -> dict[Function, Compared]:
    found = {}
    for key in names:
        module, name = key
        function = vars(importlib.import_module(module)).get(name)
        if function is None or not ours(function):
            why = "its module has no such function when it is imported anew"
            found[key] = Compared(f"{module}.{name}", (), (), (why,))
        else:
            found[key] = compare(function, masks[key], rows.get(key, ()), machine=machine)
    return found


def told(theorem: Theorem, functions: Functions, compared: Mapping[Function, Compared]) -> Theorem:
    """The theorem with the comparison results of the functions that it looks into."""
    ran = theorem.ran or Ran()
    some = [compared[key] for key in sorted(functions.masks)]
    differences = (*ran.differences, *(text for one in some for text in one.differences))
    left_out = tuple(f"{one.name}: {text}" for one in some for text in one.left_out)
    return theorem.after(replace(ran, differences=differences, left_out=left_out))
