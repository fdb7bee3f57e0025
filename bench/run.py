"""Benchmarks: ratios of two things measured in one run, on one core; prints a table.

The well-clear rows are those of `exact_well_clear.py` and `interval_well_clear.py`, where the peer is C; those of
points in polygons are those of `containment.py`, by CPU time; those of messages are in `lmcp_codec.py`, the one of
the message logger in `day_of_traffic.py`, those of routes and plans in `planning.py`, those of bands and alerts,
compared with recorded figures, in `daa.py`, those of requirements in `requirements_monitor.py`.

`python bench/run.py --write` puts the table into bench/README.md.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from cratous.core.files.whole_file import write_atomically
from cratous.core.geofence.planar import edges_of, locate
from cratous.core.kernel import Vec2
from cratous.core.readings.exact import exact, exactly
from cratous.core.readings.machine.compiled import compiled
from cratous.core.well_clear import StandardThresholds, horizontal_violation, violation_within

sys.path.insert(0, str(Path(__file__).resolve().parent))

import containment
import daa
import day_of_traffic
import exact_well_clear
import interval_well_clear
import lmcp_codec
import planning
import requirements_monitor
from table import markdown, on_one_core

README = Path(__file__).resolve().parent / "README.md"
MARK, END = "<!-- table -->", "<!-- end of table -->"
N = 1_000_000


def best(run: Callable[[], object], repeat: int = 5) -> float:
    """Least time of several runs [s]."""
    times = []
    for _ in range(repeat):
        start = time.perf_counter()
        run()
        times.append(time.perf_counter() - start)
    return min(times)


def numpy_horizontal(
    x: np.ndarray, y: np.ndarray, u: np.ndarray, v: np.ndarray, d: float, t: float
) -> np.ndarray:
    """The peer of the compiled predicate: the same formula in numpy."""
    ss, vv, sv, cross = x * x + y * y, u * u + v * v, x * u + y * v, x * v - y * u
    return (ss <= d * d) | ((sv < 0) & (cross * cross <= d * d * vv) & (d * d - ss >= t * sv))


def rows() -> list[tuple[str, float, str, float]]:
    """(what, ns each, peer, ns each of the peer)."""
    rng = np.random.default_rng(1)
    x, y = rng.normal(size=(2, N)) * 1500
    u, v = rng.normal(size=(2, N)) * 30
    sz, vz = rng.normal(size=N) * 80, rng.normal(size=N) * 3
    predicate, within = compiled(horizontal_violation), compiled(violation_within)
    predicate(x[:2], y[:2], u[:2], v[:2], 150.0, 15.0)
    volume = StandardThresholds(150.0, 30.0, 15.0, 0.0)
    limits = (*volume, 60.0)
    within(x[:2], y[:2], u[:2], v[:2], sz[:2], vz[:2], *limits)
    same = numpy_horizontal(x, y, u, v, 150.0, 15.0)
    if not np.array_equal(predicate(x, y, u, v, 150.0, 15.0), same):
        raise SystemExit("the two predicates differ")
    a = best(lambda: predicate(x, y, u, v, 150.0, 15.0)) / N * 1e9
    b = best(lambda: numpy_horizontal(x, y, u, v, 150.0, 15.0)) / N * 1e9
    found = [("well clear now, compiled", a, "the same in numpy", b)]
    some = range(2000)
    states = [(Vec2(x[i], y[i]), Vec2(u[i], v[i]), sz[i], vz[i]) for i in some]
    plain = best(lambda: [violation_within(*s, volume, 60.0) for s in states]) / len(states) * 1e9
    a = best(lambda: within(x, y, u, v, sz, vz, *limits)) / N * 1e9
    found.append(("well clear within 60 s, compiled", a, "CPython, doubles", plain))
    rational = [tuple(map(float, (*s[0], *s[1], s[2], s[3]))) for s in states]
    ready = [(Vec2(p, q), Vec2(r, s), z, w) for p, q, r, s, z, w in rational]
    a = (
        best(lambda: [exact(violation_within, *s, volume, 60.0) for s in ready[:300]], 3)
        / 300
        * 1e9
    )
    found.append(("well clear within 60 s, exact, one by one", a, "CPython, doubles", plain))
    sure = exactly(violation_within)
    sure(x[:2], y[:2], u[:2], v[:2], sz[:2], vz[:2], *limits)
    a = best(lambda: sure(x, y, u, v, sz, vz, *limits)) / N * 1e9
    found.append(("well clear within 60 s, exact", a, "CPython, doubles", plain))
    import shapely

    angles = np.linspace(0, 2 * np.pi, 11)[:-1]
    ring = [(float(np.cos(t)) * 500, float(np.sin(t)) * 500) for t in angles]
    edges, shape = edges_of(ring), shapely.Polygon(ring)
    points = [Vec2(float(p), float(q)) for p, q in zip(x[:300], y[:300], strict=True)]
    a = best(lambda: [exact(locate, edges, p) for p in points], 3) / 300 * 1e9
    b = best(lambda: [shape.contains(shapely.Point(p)) for p in points], 3) / 300 * 1e9
    found.append(("point in 10-gon, exact, one by one", a, "shapely contains, one by one", b))
    wells = exact_well_clear.rows() + interval_well_clear.rows()
    messages = lmcp_codec.rows() + day_of_traffic.rows()
    monitor = requirements_monitor.measured()
    return wells + containment.rows() + found + messages + planning.rows() + daa.rows() + monitor


def table() -> str:
    """The table as Markdown."""
    head = ["| what | ns each | peer | ns each | peer / ours |", "|---|---|---|---|---|"]
    return "\n".join([*head, *markdown(rows())])


def main() -> int:
    """Measure, print, and with --write store the table."""
    on_one_core()
    text = table()
    print(text)
    if "--write" in sys.argv:
        before, rest = README.read_text(encoding="utf-8").split(MARK)
        after = rest.split(END)[1]
        write_atomically(README, f"{before}{MARK}\n{text}\n{END}{after}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
