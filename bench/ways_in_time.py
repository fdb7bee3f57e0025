"""Ways in time (`services.ways_in_time`): time and memory with 20 intruders and 20 zones, and lengths on 50 maps.

    python bench/ways_in_time.py

The first table is CPU time of one search each second, as a share of a core, beside the time of the plain sampling of
the same flights that a checker would need (0.1 s, no kernel); the bars are 30 % of a core and the budget of 0.5 s.
Volumes are cylinders of the radius given. The second is the length of a way past zones alone, in units of the shortest
path around the corners of the same zones (shapely's visibility, Dijkstra), for turns of 2 m.
"""

from __future__ import annotations

import heapq
import itertools
import math
import random
import time
import tracemalloc

from shapely import LineString, Polygon
from table import on_one_core

from cratous.core.avoidance.manoeuvre import Ability, Motion
from cratous.core.avoidance.prediction import Intruder, after, later
from cratous.core.ways_in_time.scene import Scene
from cratous.services.ways_in_time.asking import Answer, Asked, Outcome, way_in_time
from cratous.spec.mission import Position, Velocity, WellClear, Zone, ZoneKind

NOW = Motion(Position(0.0, 0.0, 300.0), 0.0, 22.0, 0.0)
ABILITY = Ability(0.16, 15.0, 35.0, 5.0, 2.0, 50.0)
NIMBLE = Ability(11.0, 22.0, 22.0, 5.0, 2.0, 50.0)
GOAL = Position(6000.0, 0.0, 300.0)
SCENES, MAPS = 40, 50


def zones_of(draw: random.Random, side_m: float) -> tuple[Zone, ...]:
    """Twenty squares, none about start or goal."""
    zones = []
    for number in range(1, 21):
        s, w = draw.uniform(300, 5600 - side_m), draw.uniform(-1800, 1800 - side_m)
        corners = ((s, w), (s, w + side_m), (s + side_m, w + side_m), (s + side_m, w))
        zones.append(Zone(number, ZoneKind.KEEP_OUT, corners, 0.0, 5000.0))
    return tuple(zones)


def traffic_of(draw: random.Random) -> tuple[Intruder, ...]:
    """Twenty aircraft at the same altitude, none nearer than 900 m."""
    return tuple(
        Intruder(
            100 + k,
            Position(draw.uniform(900, 6500), draw.uniform(-2500, 2500), 300.0),
            Velocity(draw.uniform(-20, 20), draw.uniform(-20, 20), 0.0),
        )
        for k in range(20)
    )


def sampled(found: Answer, others: tuple[Intruder, ...]) -> float:
    """The least distance from any aircraft along a way, every 0.1 s [m]."""
    least = math.inf
    for piece in found.pieces:
        for k in range(math.ceil(10 * piece.duration_s)):
            p = after(piece, k / 10)
            for other in others:
                q = later(other, piece.start_s + k / 10).position
                if abs(p.alt_m - q.alt_m) <= 50:
                    least = min(least, math.hypot(p.north_m - q.north_m, p.east_m - q.east_m))
    return least


def load() -> list[str]:
    """A line for each radius of the volume."""
    lines = []
    for radius_m, layers in ((150.0, ()), (300.0, ()), (300.0, (420.0, 180.0))):
        took, checks, outcomes, plain = list[float](), 0, list[str](), 0.0
        for seed in range(SCENES):
            draw = random.Random(seed)
            zones, others = zones_of(draw, 250.0), traffic_of(draw)
            scene = Scene(zones, 20.0, others, WellClear(radius_m, 50.0, 0.0, 0.0))
            begin = time.process_time()
            found = way_in_time(Asked(NOW, GOAL, ABILITY, layers_m=layers), scene)
            took.append(time.process_time() - begin)
            checks += found.checks
            outcomes.append(str(found.outcome))
            begin = time.process_time()
            if sampled(found, others) <= radius_m:
                raise SystemExit(f"seed {seed}: the way is not clear")
            plain += time.process_time() - begin
        counted = ", ".join(f"{outcomes.count(one)} {one}" for one in map(str, Outcome))
        mean_ms, most_ms = 1000 * sum(took) / SCENES, 1000 * max(took)
        levels = f", {len(layers)} layers" if layers else ""
        lines.append(
            f"| {radius_m:.0f} m{levels} | {counted} | {mean_ms:.0f} | {most_ms:.0f} | "
            f"{mean_ms / 10:.0f} % | {1000 * plain / SCENES:.0f} | {checks / sum(took):,.0f} |"
        )
    return lines


def memory() -> str:
    """The peak of allocated memory of one search that spends its budget."""
    draw = random.Random(5)
    scene = Scene(zones_of(draw, 250.0), 20.0, traffic_of(draw), WellClear(800.0, 50.0, 0.0, 0.0))
    tracemalloc.start()
    found = way_in_time(Asked(NOW, GOAL, ABILITY), scene)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return f"memory of a search ({found.outcome}, {found.states} states): {peak / 1e6:.1f} MB"


def shortest_m(zones: tuple[Zone, ...]) -> float:
    """Length of the shortest path from start to goal around the zones' corners [m]; infinite if there is none."""
    shapes = [Polygon(zone.vertices).buffer(-1e-6) for zone in zones]
    places = [NOW.position[:2], GOAL[:2], *(v for zone in zones for v in zone.vertices)]
    best, heap, done = {0: 0.0}, [(0.0, 0)], set[int]()
    while heap:
        so_far, i = heapq.heappop(heap)
        if i == 1:
            return so_far
        if i in done:
            continue
        done.add(i)
        for j in range(len(places)):
            longer = so_far + math.dist(places[i], places[j])
            if j in done or longer >= best.get(j, math.inf):
                continue
            leg = LineString((places[i], places[j]))
            if not any(leg.intersects(shape) for shape in shapes):
                best[j] = longer
                heapq.heappush(heap, (longer, j))
    return math.inf


def lengths() -> str:
    """The ratios on the maps."""
    ratios, none, took = list[float](), 0, list[float]()
    for seed in range(MAPS):
        zones = zones_of(random.Random(1000 + seed), 400.0)
        begin = time.process_time()
        found = way_in_time(Asked(NOW, GOAL, NIMBLE, speeds_m_s=(22.0,)), Scene(zones))
        took.append(time.process_time() - begin)
        if found.outcome is not Outcome.PATH:
            none += shortest_m(zones) < math.inf
            continue
        points = [piece.position for piece in found.pieces] + [GOAL]
        flown_m = sum(math.dist(p, q) for p, q in itertools.pairwise(points))
        ratios.append(flown_m / shortest_m(zones))
    return (
        f"length on {len(ratios)} of {MAPS} maps: mean {sum(ratios) / len(ratios):.3f}, most {max(ratios):.3f} times "
        f"the shortest; {none} not found; at most {1000 * max(took):.0f} ms"
    )


if __name__ == "__main__":
    on_one_core()
    print(
        "| volume | answers | ms, mean | ms, most | of a core at 1 Hz | sampling, ms | checks/s |"
    )
    print("|---|---|--:|--:|--:|--:|--:|")
    print("\n".join(load()))
    print(memory())
    print(lengths())
