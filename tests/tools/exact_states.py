"""States for the tests of the exact reading: at random, on a grid, on boundaries; their true verdicts."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, get_type_hints

import numpy as np

from cratous.core.readings import exact as reading
from cratous.core.readings.exact.float_filter import UNDECIDED
from cratous.core.readings.graph import program
from cratous.core.readings.graph.nodes import leaves
from cratous.core.readings.machine.domain import nonnegative
from cratous.proofs.methods import rounding

KERNELS = {
    name: kernel
    for name, (kernel, made) in rounding.filters().items()
    if len(made.results) == 1 and leaves(program(kernel).result)[0].kind != "float"
}


def on_rationals(kernel: Any, columns: list[np.ndarray]) -> list[Any]:
    """The kernel itself on the rationals that the doubles are."""

    def built(kind: Any, row: list[Any]) -> Any:
        if hasattr(kind, "_fields"):
            return kind(*[built(k, row) for k in get_type_hints(kind).values()])
        value = row.pop(0)
        return Fraction(value) if kind is float else value

    hints = [k for n, k in get_type_hints(kernel).items() if n != "return"]
    rows = zip(*[column.tolist() for column in columns], strict=True)
    return [kernel(*[built(k, left) for k in hints]) for left in map(list, rows)]


def states(kernel: Any, kind: str, n: int, seed: int) -> list[np.ndarray]:
    """Columns of one kind for any kernel."""
    rng = np.random.default_rng(seed)
    scale = {"random": 1.0, "grid": 1.0, "subnormal": 5e-324, "tiny": 2.0**-500,
             "huge": 2.0**990, "mixed": 1.0}[kind]  # fmt: skip
    columns = []
    for column in program(kernel).columns:
        if column.kind == "bool":
            columns.append(rng.random(n) < 0.5)
        elif column.kind == "int":
            columns.append(rng.integers(-1, 2, n))
        elif kind == "random":
            columns.append(rng.normal(size=n) * 100)
        elif kind == "mixed":
            columns.append(rng.integers(-3, 4, n) * 2.0 ** rng.integers(-1070, 1020, n))
        else:
            columns.append(rng.integers(-4, 5, n) * scale)
    meant = nonnegative(kernel)
    labels = program(kernel).labels
    return [
        np.abs(c) if n.split(".")[0] in meant else c for n, c in zip(labels, columns, strict=True)
    ]


def on_circle(n: int, low: int = -90, high: int = 90) -> list[np.ndarray]:
    """Well-clear states within two units in the last place of the circle |s| = DTHR."""
    rng = np.random.default_rng(5)
    d = rng.uniform(1, 2, n) * 2.0 ** rng.integers(low, high, n)
    angle = rng.uniform(0.01, 0.7, n)
    x, y = d * np.cos(angle), d * np.sin(angle)
    x = (x.view(np.int64) + rng.integers(-2, 3, n)).view(np.float64)
    u, v = rng.normal(size=(2, n)) * 30
    return [x, y, u, v, d, rng.uniform(1, 30, n)]


def on_tau(n: int) -> list[np.ndarray]:
    """States within two units in the last place of tau_mod = TTHR, passing within DTHR."""
    rng = np.random.default_rng(6)
    scale = 2.0 ** rng.integers(-60, 60, n)
    x, y = rng.normal(size=(2, n)) * 1500 * scale
    u, v = -x / rng.uniform(30, 31, n), -y / rng.uniform(30, 31, n)
    d = rng.uniform(100, 1000, n) * scale
    t = (d * d - x * x - y * y) / (x * u + y * v)
    t = (t.view(np.int64) + rng.integers(-2, 3, n)).view(np.float64)
    return [column[t >= 0] for column in (x, y, u, v, d, t)]


def tangent(n: int) -> list[np.ndarray]:
    """Integer states whose course touches the circle exactly: direction (-4, 3), foot k (3, 4)."""
    k, away, speed = np.random.default_rng(7).integers(1, 1000, (3, n)).astype(float)
    return [3 * k + 4 * away, 4 * k - 3 * away, -4 * speed, 3 * speed, 5 * k, np.full(n, 1e6)]


def wide_tangent(n: int) -> list[np.ndarray]:
    """The same with integers of 53 bits: ties that no two doubles hold."""
    k, away, speed = np.random.default_rng(8).integers(2**49, 2**50, (3, n)).astype(float)
    return [3 * k + 4 * away, 4 * k - 3 * away, -4 * speed, 3 * speed, 5 * k, np.full(n, 1e6)]


BOUNDARIES = {
    "on the circle": on_circle,
    "on tau": on_tau,
    "tangent": tangent,
    "tangent, wide": wide_tangent,
}


def undecided(kernel: Any, columns: list[np.ndarray]) -> float:
    """The share of states that the filter leaves open."""
    code = np.empty(columns[0].size, dtype=np.uint8)
    reading._filter_map(reading._filter_of(kernel), frozenset())(code, *columns)
    return float((code == UNDECIDED).mean())
