"""The well-clear predicate, plain and exact, compared with C on plain doubles: one core, one run.

The C function is compiled here with `gcc -O3 -march=native` into a temporary folder; it has no branches, reads the
same arrays and writes the same bytes. Exact verdicts are checked against rationals on a sample before anything is
measured. Times are the least of several rounds in which all contenders take turns.
"""

from __future__ import annotations

import ctypes
import functools
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import numpy as np
from table import alone, least

from cratous.core.kernel import Vec2
from cratous.core.readings.exact import exactly
from cratous.core.readings.machine.compiled import compiled
from cratous.core.well_clear import horizontal_violation

N = 1_000_000
BOUNDARY = 50_000
OUTSIDE = 2_000
ROUNDS = 25
SOURCE = r"""
void horizontal_violation(long n, const double *restrict x, const double *restrict y,
                          const double *restrict u, const double *restrict v, double d, double t,
                          unsigned char *restrict out)
{
    const double dd = d * d;
    for (long i = 0; i < n; i++) {
        const double ss = x[i] * x[i] + y[i] * y[i], vv = u[i] * u[i] + v[i] * v[i];
        const double sv = x[i] * u[i] + y[i] * v[i], c = x[i] * v[i] - y[i] * u[i];
        out[i] = (ss <= dd) | ((sv < 0) & (c * c <= dd * vv) & (dd - ss >= t * sv));
    }
}
"""
Columns = list[np.ndarray]


def c_function(folder: Path) -> Callable[[Columns, float, float, np.ndarray], None]:
    """The peer; raises RuntimeError without a compiler."""
    compiler = shutil.which("gcc")
    if compiler is None:
        raise RuntimeError("no gcc")
    source, library = folder / "plain.c", folder / "plain.so"
    source.write_text(SOURCE, encoding="utf-8")
    command = [compiler, "-O3", "-march=native", "-shared", "-fPIC", "-o", str(library)]
    subprocess.run([*command, str(source)], check=True)
    function = ctypes.CDLL(str(library)).horizontal_violation
    function.restype = None
    pointer, double = ctypes.c_void_p, ctypes.c_double
    function.argtypes = [ctypes.c_long, *[pointer] * 4, double, double, pointer]

    def call(columns: Columns, d: float, t: float, out: np.ndarray) -> None:
        function(out.size, *[c.ctypes.data for c in columns], d, t, out.ctypes.data)

    return call


def random_states(rng: np.random.Generator) -> Columns:
    """Relative states of ordinary traffic [m, m/s]."""
    return [*(rng.normal(size=(2, N)) * 1500), *(rng.normal(size=(2, N)) * 30)]


def nudged(values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Values shifted by up to two units in the last place."""
    moved: np.ndarray = values.view(np.int64) + rng.integers(-2, 3, values.size)
    return moved.view(np.float64)


def on_circle(rng: np.random.Generator, n: int, low: int, high: int) -> Columns:
    """States where |s| is DTHR, up to two units in the last place of x; DTHR is 2^low to 2^high."""
    d = rng.uniform(1, 2, n) * 2.0 ** rng.integers(low, high, n)
    angle = rng.uniform(0.0, 0.3, n)
    x, y = nudged(d * np.cos(angle), rng), d * np.sin(angle)
    speed = 2.0 ** rng.integers(low // 4, high // 4 + 1, n)
    return [x, y, *(rng.normal(size=(2, n)) * speed), d, rng.uniform(1, 30, n)]


def on_tau(rng: np.random.Generator, n: int, low: int, high: int) -> Columns:
    """States where tau_mod is TTHR, up to two units in the last place, on a course through the circle."""
    scale = 2.0 ** rng.integers(low, high, n)
    x, y = rng.uniform(1000, 2000, (2, n)) * scale
    u, v = -x / rng.uniform(30, 31, n), -y / rng.uniform(30, 31, n)
    d = rng.uniform(500, 1000, n) * scale
    return [x, y, u, v, d, nudged((d * d - x * x - y * y) / (x * u + y * v), rng)]


def tangent(rng: np.random.Generator, n: int, low: int, high: int) -> Columns:
    """States whose course is exactly tangent to the circle (integers times a power of two)."""
    k, away, speed = rng.integers(1, 1000, (3, n)) * 2.0 ** rng.integers(low, high, n)
    still = np.full(n, 2.0**20)
    return [3 * k + 4 * away, 4 * k - 3 * away, -4 * speed, 3 * speed, 5 * k, still]


def wide_tangent(rng: np.random.Generator, n: int, low: int, high: int) -> Columns:
    """The same with integers of up to 53 bits: ties that no pair of doubles can represent."""
    k, away, speed = rng.integers(1, 2**50, (3, n)) * 2.0 ** rng.integers(low, high, n)
    still = np.full(n, 2.0**20)
    return [3 * k + 4 * away, 4 * k - 3 * away, -4 * speed, 3 * speed, 5 * k, still]


def check(columns: Columns, verdicts: np.ndarray, sample: int = 500) -> int:
    """Compare a sample with rationals; returns the number of errors of plain doubles."""
    plain = compiled(horizontal_violation)(*columns)
    wrong = 0
    for i in range(0, verdicts.size, max(1, verdicts.size // sample)):
        x, y, u, v, d, t = (Fraction(float(c[i])) for c in columns)
        wanted = horizontal_violation(Vec2(x, y), Vec2(u, v), d, t)
        if bool(verdicts[i]) != wanted:
            raise SystemExit(f"state {i}: the exact reading is wrong")
        wrong += bool(plain[i]) != wanted
    return wrong


def rows() -> list[tuple[str, float, str, float]]:
    """(what, ns per state, peer or bound, ns per state of it)."""
    rng = np.random.default_rng(1)
    plain, exact = compiled(horizontal_violation), exactly(horizontal_violation)
    states, limits = random_states(rng), (150.0, 15.0)
    out = np.empty(N, dtype=np.uint8)
    verdicts = out.view(np.bool_)
    peer = "C, plain doubles, no branches"
    found = []
    with tempfile.TemporaryDirectory() as folder:
        c = c_function(Path(folder))
        c(states, *limits, out)
        if not np.array_equal(plain(*states, *limits), out.view(np.bool_)):
            raise SystemExit("compiled kernel and C differ")
        check([*states, np.full(N, limits[0]), np.full(N, limits[1])], exact(*states, *limits))
        ours, sure, theirs = least(
            [
                lambda: plain(*states, *limits, out=verdicts),
                lambda: exact(*states, *limits, out=verdicts),
                lambda: c(states, *limits, out),
            ],
            ROUNDS,
            N,
            time.perf_counter,
        )
    found.append(("horizontal violation, compiled, random", ours, peer, theirs))
    found.append(("horizontal violation, exact, random", sure, peer, theirs))
    for what, make, low, high in (
        ("on the circle, 2^-100 to 2^100", on_circle, -98, 98),
        ("on the tau boundary, 2^-88 to 2^88", on_tau, -88, 88),
        ("tangent to the circle, 2^-80 to 2^80", tangent, -80, 80),
        ("tangent to the circle, all bits, 2^-80 to 2^80", wide_tangent, -128, 28),
        ("on the circle, 2^-1020 to 2^-900", on_circle, -1020, -900),
        ("on the circle, 2^900 to 2^1020", on_circle, 900, 1020),
    ):
        inside = low > -200 and high < 200
        n = BOUNDARY if inside else OUTSIDE
        columns = make(rng, n, low, high)
        wrong = check(columns, exact(*columns))
        (taken,) = least([functools.partial(exact, *columns)], ROUNDS, n, time.perf_counter)
        share = f"bar (plain doubles: {wrong / 5:.0f} % wrong)"
        found.append((f"exact, every state {what}", taken, share, 500.0 if inside else 20_000.0))
    return found


if __name__ == "__main__":
    raise SystemExit(alone(rows))
