"""Detect and avoid: full four-dimension bands and batch alerting, CPU time on one core, warm.

The peer figures are recorded ones, not run here: those measured once for DAIDALUS v2 (C++, -O) on
another machine, with the same configuration on the same kind of encounters: fresh state, no history.
`python bench/daa.py` prints a table.
"""

from __future__ import annotations

import time

import numpy as np
from table import on_one_core

from cratous.core.daa.alerting import raw_levels
from cratous.core.daa.engine import tables_at
from cratous.core.daa.session import Session
from cratous.core.daa.state import Aircraft
from cratous.core.readings.machine.compiled import machine
from cratous.spec.daa.presets import preset

PEER_MS = {1: 4.5, 5: 26.0, 20: 158.0, 100: 667.0}
SAMPLES = {1: 60, 5: 30, 20: 10, 100: 4}
PEER_ENCOUNTERS_S = 400_000


def encounter(rng: np.random.Generator, n: int) -> tuple[Aircraft, list[Aircraft]]:
    """An ownship and n intruders within 10 nmi, most of them at about its altitude."""
    alt = rng.uniform(1000, 8000)

    def one(name: str, spread_m: float, alerter: int) -> Aircraft:
        course, speed = rng.uniform(0, 2 * np.pi), rng.uniform(40, 230)
        x, y = rng.uniform(-spread_m, spread_m, 2) if spread_m else (0.0, 0.0)
        z = alt + (rng.normal() * 300 if spread_m else 0.0)
        climb = rng.choice([0.0, rng.normal() * 5])
        return Aircraft(
            name, x, y, z, speed * np.sin(course), speed * np.cos(course), climb, alerter
        )

    own = one("own", 0.0, 1)
    return own, [one(f"i{k}", 18520.0, int(rng.integers(1, 4))) for k in range(n)]


def bands_ms(n: int) -> tuple[float, float]:
    """Mean and greatest CPU time of one instant with n intruders [ms]."""
    parameters = preset("do_365b").parameters
    rng = np.random.default_rng(n)
    scenes = [encounter(rng, n) for _ in range(SAMPLES[n])]
    Session(parameters).step(0.0, *scenes[0])
    times = []
    for own, others in scenes:
        begin = time.process_time()
        Session(parameters).step(0.0, own, others)
        times.append((time.process_time() - begin) * 1e3)
    return sum(times) / len(times), max(times)


def alerts_per_s(encounters: int = 200_000, intruders: int = 3) -> float:
    """Encounters of three intruders whose alert levels are found in a second of CPU time."""
    parameters = preset("do_365b").parameters
    t = tables_at(parameters, 0.0)
    rng = np.random.default_rng(0)
    pairs = encounters * intruders
    relative = rng.normal(size=(pairs, 6)) * np.array([15000.0, 15000, 400, 150, 150, 5])
    alerter = rng.integers(0, 3, pairs)
    levels = np.zeros(pairs, dtype=np.int64)
    run = machine(raw_levels)
    errors = np.zeros((pairs, 6))
    arguments = (t, parameters.lookahead_time_s)
    run(relative[:10], errors[:10], alerter[:10], *arguments, levels[:10])
    best = float("inf")
    for _ in range(5):
        begin = time.process_time()
        run(relative, errors, alerter, *arguments, levels)
        best = min(best, time.process_time() - begin)
    return encounters / best


def rows() -> list[tuple[str, float, str, float]]:
    """(what, ns each, peer, ns each of the peer) for the table of `run.py`; the peer is recorded."""
    recorded = "recorded: DAIDALUS v2, C++ -O"
    found = [
        (f"bands in four dimensions, {n} intruders", bands_ms(n)[0] * 1e6, recorded, peer * 1e6)
        for n, peer in PEER_MS.items()
    ]
    bar = f"recorded bar: {PEER_ENCOUNTERS_S:,} a second"
    found.append(
        ("alert levels of an encounter of 3", 1e9 / alerts_per_s(), bar, 1e9 / PEER_ENCOUNTERS_S)
    )
    return found


def main() -> int:
    """Measure and print."""
    on_one_core()
    print("| bands in four dimensions, DO-365B | ms | greatest | DAIDALUS -O, ms | times faster |")
    print("|---|---|---|---|---|")
    for n, peer in PEER_MS.items():
        mean, most = bands_ms(n)
        print(f"| {n} intruders | {mean:.1f} | {most:.1f} | {peer:.1f} | {peer / mean:.1f} |")
    rate = alerts_per_s()
    print(
        f"| alert levels, encounters of 3 a second | {rate:,.0f} | | {PEER_ENCOUNTERS_S:,} | {rate / PEER_ENCOUNTERS_S:.1f} |"
    )
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
