"""Routes per second, and time from request to response for missions of OpenUxAS, in CPU time.

Routes are between random poses, through a square of two kilometres with six keep-out zones inside a keep-in zone; the
peer is the same function run by CPython, and both give identical results before they are timed. Request to response
is `make_plan` on a loaded mission, the least of some runs after the first, which also reads the compiled kernels from
their cache; the bounds are the requirements. Missions are read from the folder `shared` beside the repository and
left out if it is absent.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from table import alone

from cratous.core.geofence.mission_leg_arrays import table
from cratous.core.readings.machine.compiled import machine
from cratous.core.routing import bulk as routing
from cratous.core.routing.visibility import Roadmap
from cratous.services.loading import load
from cratous.services.pipeline.plan import make_plan
from cratous.services.planning.zones import roadmaps
from cratous.spec.mission import Zone, ZoneKind

SHARED = Path(__file__).resolve().parents[2] / "shared" / "examples" / "openuxas"
MANY, FEW = 5_000, 100
BARS_MS = {"waterway": 50, "assigntasks": 1000}


def box(number: int, kind: ZoneKind, south: float, west: float, side: float) -> Zone:
    """A square zone."""
    corners = ((south, west), (south, west + side), (south + side, west + side))
    return Zone(number, kind, (*corners, (south + side, west)), 0.0, 5000.0)


def run(function: Callable[..., None], roadmap: Roadmap, count: int) -> tuple[float, np.ndarray]:
    """CPU seconds for `count` routes, and their lengths (0 where there is none)."""
    ends = np.random.default_rng(1).uniform(0, 2000, (2, count, 4))
    ends[:, :, 2] = 500.0
    ends[:, :, 3] /= 300.0
    codes, metres, links = np.zeros(count, np.int64), np.zeros(count), np.zeros(count, np.int64)
    rings, sizes = roadmap.ring_arrays
    seen = np.zeros((len(rings), rings.shape[1], rings.shape[1]), np.int8)
    begin = time.process_time()
    function(
        ends[0], ends[1], routing.Turning(80.0, np.inf, 0.5), table(roadmap.zones),
        routing.Rings(rings, sizes, seen),
        routing.Routed(codes, metres, links, np.zeros((1, routing.LINKS_MOST + 2, 4))),
    )  # fmt: skip
    return time.process_time() - begin, metres


def rows() -> list[tuple[str, float, str, float]]:
    """(what, ns each, peer, ns each of the peer)."""
    places = [(300, 300), (300, 1100), (900, 700), (1300, 200), (1400, 1300), (700, 1500)]
    zones = [box(k, ZoneKind.KEEP_OUT, *at, 250.0) for k, at in enumerate(places, 1)]
    zones.append(box(9, ZoneKind.KEEP_IN, -1000.0, -1000.0, 4000.0))
    roadmap = roadmaps(tuple(zones), 80.0)[0]
    fast = machine(routing.route_many)
    run(fast, roadmap, 2)
    slow_s, expected = run(routing.route_many, roadmap, FEW)
    if not np.array_equal(run(fast, roadmap, FEW)[1], expected):
        raise SystemExit("compiled routes differ from those of CPython")
    fast_s = min(run(fast, roadmap, MANY)[0] for _ in range(3))
    what = "route around six zones, every leg put to the kernels"
    found = [(what, fast_s / MANY * 1e9, "the same in CPython", slow_s / FEW * 1e9)]
    for name, bar_ms in BARS_MS.items():
        if (SHARED / name).is_dir():
            took = request_ns(SHARED / name)
            found.append((f"request to response, {name}", took, f"bar: {bar_ms} ms", bar_ms * 1e6))
    return found


def request_ns(folder: Path) -> float:
    """Least CPU time from request to response [ns], after a first run."""
    mission, best = load(folder), np.inf
    for k in range(4):
        begin = time.process_time()
        make_plan(mission)
        if k:
            best = min(best, time.process_time() - begin)
    return float(best) * 1e9


if __name__ == "__main__":
    raise SystemExit(alone(rows))
