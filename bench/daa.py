"""Detect and avoid: full four-dimensional bands and batch alerting, CPU time on one core, warm.

The peer is a program given by $DAIDALUS_PEER: it reads encounters, one per line (the number of intruders, then for
ownship and intruders east, north, up [m], their rates [m/s] and the alerter), and answers each with the CPU time [ms]
that alerts, bands in four dimensions and resolutions took. So both get the same encounters in one run; fresh state,
no history. Without a peer a fixed bound is shown instead. `python bench/daa.py` prints a table.
"""

from __future__ import annotations

import os
import subprocess
import time

import numpy as np
from table import Rows, alone

from cratous.core.daa.alerting import raw_levels
from cratous.core.daa.engine import tables_at
from cratous.core.daa.session import Session
from cratous.core.daa.state import Aircraft
from cratous.core.readings.machine.compiled import machine
from cratous.spec.daa.presets import preset

BAR_MS = 300.0
"""The most that bands computed once a second may take if 70 % of a core is to stay free."""
SAMPLES = {1: 60, 5: 40, 20: 20, 100: 8}
BAR_ENCOUNTERS_S = 400_000


def encounter(rng: np.random.Generator, n: int) -> tuple[Aircraft, list[Aircraft]]:
    """An ownship and n intruders within 10 nmi, most of them near its altitude."""
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


def bands_ms(n: int) -> tuple[float, float | None]:
    """Mean CPU time of one instant with n intruders [ms], ours and the peer's."""
    parameters = preset("do_365b").parameters
    rng = np.random.default_rng(n)
    scenes = [encounter(rng, n) for _ in range(SAMPLES[n])]
    for own, others in scenes:
        Session(parameters).step(0.0, own, others)  # loads the compiled code
    times = []
    for own, others in scenes:
        begin = time.process_time()
        Session(parameters).step(0.0, own, others)
        times.append((time.process_time() - begin) * 1e3)
    return sum(times) / len(times), peer_ms(scenes)


def peer_ms(scenes: list[tuple[Aircraft, list[Aircraft]]]) -> float | None:
    """The peer's mean CPU time for the same encounters [ms]; None where there is no peer."""
    if not (program := os.environ.get("DAIDALUS_PEER")):
        return None
    lines = [
        " ".join([str(len(others)), *(repr(float(v)) for a in (own, *others) for v in a[1:8])])
        for own, others in scenes
    ]
    text = "\n".join(lines) + "\n"
    done = subprocess.run([program], input=text, capture_output=True, text=True, check=True)
    answers = [float(line.split()[0]) for line in done.stdout.splitlines()]
    assert len(answers) == len(scenes)
    return sum(answers) / len(answers)


def alerts_per_s(encounters: int = 200_000, intruders: int = 3) -> float:
    """Encounters with three intruders for which alert levels are computed per second of CPU time."""
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


def rows() -> Rows:
    """(what, ns each, peer, ns each of the peer) for the table of `run.py`."""
    found: Rows = []
    for n in SAMPLES:
        ours, theirs = bands_ms(n)
        peer = "bar: 300 ms" if theirs is None else "the program that $DAIDALUS_PEER names"
        ns = (BAR_MS if theirs is None else theirs) * 1e6
        found.append((f"bands in four dimensions, {n} intruders", ours * 1e6, peer, ns))
    bar = f"bar: {BAR_ENCOUNTERS_S:,} a second"
    found.append(
        ("alert levels of an encounter of 3", 1e9 / alerts_per_s(), bar, 1e9 / BAR_ENCOUNTERS_S)
    )
    return found


if __name__ == "__main__":
    raise SystemExit(alone(rows))
