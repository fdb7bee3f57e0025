"""Random and degenerate encounters for detect and avoid, and what must hold of every answer.

Run as a program: `python tests/programs/daa_scenes.py COUNT [SEED [SECONDS]]` (see `make daa-fuzz`).
"""

from __future__ import annotations

import dataclasses
import math
import random
import sys
import time
from collections.abc import Iterator

from cratous.core.daa.frame import project
from cratous.core.daa.session import Instant, Session
from cratous.core.daa.state import UNKNOWN, Aircraft, Sigma
from cratous.spec.daa.parameters import DCPA, FIXED
from cratous.spec.daa.presets import names, preset
from cratous.spec.errors import BadInput

POLES = (math.pi / 2, -math.pi / 2, 0.0, 1.55, -1.2)
LINES = (math.pi, -math.pi, 0.0, 3.1415, -3.1415)


def aircraft(rng: random.Random, name: str, scale: float, speed: float) -> Aircraft:
    """One aircraft, with one chance in four of something degenerate in each quantity."""

    def pick(usual: float, *odd: float) -> float:
        return rng.choice(odd) if rng.random() < 0.25 else usual

    x = pick(rng.gauss(0, scale), 0.0, 1e-9, 1e6)
    y = pick(rng.gauss(0, scale), 0.0, -1e-9, -1e6)
    z = pick(rng.uniform(0, 8000), 0.0, -400.0, 30.48, 1e5)
    u = pick(rng.gauss(0, speed), 0.0, 1e-12, 1e4)
    v = pick(rng.gauss(0, speed), 0.0, -1e-12, -1e4)
    w = pick(rng.gauss(0, 5), 0.0, 30.48, -200.0)
    sigma = Sigma()
    if rng.random() < 0.5:
        sizes = (50.0, 50.0, 30.0, 30.0, 3.0, 3.0, 2.0, 1.0)
        sigma = Sigma(*(abs(pick(rng.gauss(0, size), 0.0, 1e4)) for size in sizes))
    return Aircraft(name, x, y, z, u, v, w, rng.choice((0, 1, 1, 1, 2, 3, 7)), sigma)


def scene(rng: random.Random) -> tuple[Aircraft, list[Aircraft]]:
    """An ownship and up to four intruders; often one is in the same place or flies alike."""
    scale, speed = (50.0, 8.0) if rng.random() < 0.3 else (8000.0, 120.0)
    own = aircraft(rng, "own", scale, speed)._replace(east_m=0.0, north_m=0.0)
    others = []
    for k in range(rng.randrange(5)):
        other = aircraft(rng, f"i{k}", scale, speed)
        kind = rng.random()
        if kind < 0.1:
            other = own._replace(id=other.id)
        elif kind < 0.2:
            other = other._replace(ve_m_s=own.ve_m_s, vn_m_s=own.vn_m_s, vu_m_s=own.vu_m_s)
        elif kind < 0.3:
            lat, lon = rng.choice(POLES), rng.choice(LINES)
            there = project(lat, lon, rng.choice(POLES), rng.choice(LINES), 50.0, 50.0)
            other = other._replace(
                east_m=there.east_m, north_m=there.north_m, ve_m_s=there.ve_m_s, vn_m_s=there.vn_m_s
            )
        others.append(other)
    if others and rng.random() < 0.02:
        others[0] = others[0]._replace(id="own")
    return own, others


def head_on(distance_m: float = 15000.0) -> tuple[Aircraft, Aircraft]:
    own = Aircraft("own", 0, 0, 2000, 0, 100, 0)
    return own, Aircraft("i", 200, distance_m, 2000, 0, -100, 0)


def numbers(value: object) -> Iterator[float]:
    """All floats in nested tuples."""
    if isinstance(value, float):
        yield value
    elif isinstance(value, tuple):
        for part in value:
            yield from numbers(part)


def check(instant: Instant) -> None:
    """No number is NaN or infinite; bands tile their range in order, or say why there are none."""
    said = (instant.alerts, instant.guidance, instant.metrics)
    assert all(math.isfinite(x) for x in numbers(said)), instant
    for g in instant.guidance:
        assert g.bands, g
        assert bool(g.why) == any(b.region == UNKNOWN for b in g.bands), g
        for a, b in zip(g.bands, g.bands[1:], strict=False):
            assert abs(a.high - b.low) < 1e-6, g
        assert all(b.low < b.high for b in g.bands), g


def sessions_to_fuzz() -> list[Session]:
    """One of each preset as it is, and with each urgency strategy that can name somebody."""
    plain = [preset(name).parameters for name in names()]
    first = dataclasses.replace(
        plain[0], conflict_crit=True, urgency_strategy=FIXED, most_urgent_aircraft="i0"
    )
    nearest = [
        dataclasses.replace(p, conflict_crit=True, recovery_crit=True, urgency_strategy=DCPA)
        for p in plain
    ]
    return [Session(p) for p in (*plain, first, *nearest)]


def run(count: int, seed: int, seconds: float = math.inf) -> tuple[int, int]:
    """So many instants of sessions; returns (answered, refused)."""
    rng = random.Random(seed)
    sessions = sessions_to_fuzz()
    answered = refused = 0
    now, end = 0.0, time.monotonic() + seconds
    for _ in range(count):
        if time.monotonic() > end:
            break
        # sometimes time stands still or goes backwards
        now += rng.choice((1.0, 1.0, 1.0, 0.0, -2.0, 100.0))
        own, others = scene(rng)
        duplicate = any(o.id == "own" for o in others)
        try:
            instant = rng.choice(sessions).step(now, own, others)
        except BadInput:
            assert duplicate, (own, others)
            refused += 1
            continue
        assert not duplicate
        check(instant)
        answered += 1
    return answered, refused


if __name__ == "__main__":
    total = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    done = run(total, seed, float(sys.argv[3]) if len(sys.argv) > 3 else math.inf)
    print(f"{done[0]} answered, {done[1]} refused with a reason, no NaN, no crash")
