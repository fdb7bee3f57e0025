"""The interval kernel of well clear over arrays compared with C on plain doubles: one core, one run.

The C function is compiled here with `gcc -O3 -march=native` into a temporary folder; it has no branches, reads the
same arrays, takes the same thresholds and writes the same two arrays. The results are compared bit by bit before
anything is measured. Times are the least of several rounds in which the contenders take turns.
"""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from cratous.core.readings.exact import exactly
from cratous.core.readings.machine.compiled import compiled
from cratous.core.well_clear import violation_during_taumod, violation_interval_taumod

sys.path.insert(0, str(Path(__file__).resolve().parent))
from table import alone, least

N = 1_000_000
ROUNDS = 25
LIMITS = (150.0, 30.0, 15.0, 20.0, 0.0, 0.0, 60.0)
SOURCE = r"""
#include <math.h>
#define MAX(a, b) ((b) > (a) ? (b) : (a))
#define MIN(a, b) ((b) < (a) ? (b) : (a))
void interval(long n, const double *restrict x, const double *restrict y, const double *restrict u,
              const double *restrict v, const double *restrict z, const double *restrict c,
              double d, double h, double tthr, double tcoa, double vmod, double begin, double end,
              double *restrict first, double *restrict last)
{
    const double dd = d * d;
    for (long i = 0; i < n; i++) {
        const double w = fabs(c[i]), up = c[i] < 0 ? 0 - z[i] : z[i];
        const double vin = (0 - up - MAX(h + vmod * w, tcoa * w)) / w, vout = (h - up) / w;
        const double va = w == 0 ? begin : MAX(vin, begin), vb = w == 0 ? end : MIN(vout, end);
        const double over = w == 0 ? fabs(z[i]) : 0;
        const double lo = over > h ? 1 : (va > vb ? 1 : va), hi = over > h ? 0 : (va > vb ? 0 : vb);
        const double vv = u[i] * u[i] + v[i] * v[i], sv = x[i] * u[i] + y[i] * v[i];
        const double cross = x[i] * v[i] - y[i] * u[i], ss = x[i] * x[i] + y[i] * y[i];
        const double far = vv == 0 ? ss : cross * cross, limit = vv == 0 ? dd : dd * vv;
        const double disc = MAX(dd * vv - cross * cross, 0), lead = tthr * vv;
        const double in = (0 - sv - (lead + sqrt(MAX(4 * disc + lead * lead, 0))) / 2) / vv;
        const double out = (sqrt(disc) - sv) / vv;
        const double a = vv == 0 ? lo : MAX(in, lo), b = vv == 0 ? hi : MIN(out, hi);
        first[i] = far > limit ? 1 : (a > b ? 1 : a);
        last[i] = far > limit ? 0 : (a > b ? 0 : b);
    }
}
"""
Columns = list[np.ndarray]


def c_function(folder: Path) -> Callable[[Columns, tuple[np.ndarray, np.ndarray]], None]:
    """The peer; raises RuntimeError without a compiler."""
    compiler = shutil.which("gcc")
    if compiler is None:
        raise RuntimeError("no gcc")
    source, library = folder / "interval.c", folder / "interval.so"
    source.write_text(SOURCE, encoding="utf-8")
    # no fused operations, so that the results equal the kernel's bit by bit
    flags = ["-O3", "-march=native", "-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math"]
    command = [compiler, *flags, "-shared", "-fPIC", "-o", str(library), str(source), "-lm"]
    subprocess.run(command, check=True)
    function = ctypes.CDLL(str(library)).interval
    function.restype = None
    function.argtypes = [
        ctypes.c_long, *[ctypes.c_void_p] * 6, *[ctypes.c_double] * 7, *[ctypes.c_void_p] * 2
    ]  # fmt: skip

    def call(columns: Columns, out: tuple[np.ndarray, np.ndarray]) -> None:
        inputs = [c.ctypes.data for c in columns]
        function(out[0].size, *inputs, *LIMITS, out[0].ctypes.data, out[1].ctypes.data)

    return call


def rows() -> list[tuple[str, float, str, float]]:
    """(what, ns per state, peer, ns per state of the peer)."""
    rng = np.random.default_rng(1)
    states: Columns = [*(rng.normal(size=(2, N)) * 1500), *(rng.normal(size=(2, N)) * 30)]
    states += [rng.normal(size=N) * 80, rng.normal(size=N) * 3]
    kernel, verdict = compiled(violation_interval_taumod), exactly(violation_during_taumod)
    ours, theirs = (np.empty(N), np.empty(N)), (np.empty(N), np.empty(N))
    with tempfile.TemporaryDirectory() as folder:
        c = c_function(Path(folder))
        odd = [column.copy() for column in states]
        for column in (2, 3, 5):
            odd[column][:1000] = 0.0  # some states without motion or climb
        kernel(*odd, *LIMITS, out=ours)
        c(odd, theirs)
        if not all(np.array_equal(a, b) for a, b in zip(ours, theirs, strict=True)):
            raise SystemExit("compiled kernel and C differ")
        kernel(*states, *LIMITS, out=ours)
        lost = verdict(*states, *LIMITS)
        wrong = int(np.count_nonzero(lost != (ours[0] <= ours[1])))
        if wrong > N // 1000:
            raise SystemExit(f"{wrong} spans on doubles are empty or not against the exact verdict")
        a, b, e = least(
            [
                lambda: kernel(*states, *LIMITS, out=ours),
                lambda: c(states, theirs),
                lambda: verdict(*states, *LIMITS, out=lost),
            ],
            ROUNDS,
            N,
            time.perf_counter,
        )
    peer = "C, plain doubles, no branches"
    return [
        ("well-clear interval over [B, T] in space, compiled", a, peer, b),
        ("the same question, exact verdict without division", e, peer, b),
    ]


if __name__ == "__main__":
    raise SystemExit(alone(rows))
