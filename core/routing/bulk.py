"""Routes around zones in bulk: visibility graph, shortest chain, turns; loops over arrays.

A route is the direct Dubins path if the zones allow it. Otherwise the shortest chain of via points is searched (A*),
joined by Dubins segments, and every leg of the result is checked by the proved kernels; a segment that they refuse is
removed from the graph, or tried with other headings, or on a wider ring. All loops are bounded. A pose is north,
east, altitude, heading. CPython runs these functions directly; `core.readings.machine.compiled.machine` compiles the
same text.
"""

import math
from typing import NamedTuple

import numpy as np

from cratous.core.geofence.mission_leg_arrays import first_bad, leg_zone
from cratous.core.kernel import driver
from cratous.core.readings.tiered import within
from cratous.core.routing.dubins_words import WORDS_MOST, legs, legs_length, words

CHAINS_MOST = 12  # how many chains of via points are tried per ring before the next ring
LINKS_MOST = 60
GAINS_LITTLE = 1.2  # a word that is no longer than this, in shortest words and one radius, is taken
LEGS = 20  # as many legs against a zone take CPython a tenth of a millisecond
FOUND, BAD_START, BAD_END, NO_WAY, NOT_DIRECT = 0, 1, 2, 3, 4
UNKNOWN, FREE, BLOCKED = 0, 1, 2


class Turning(NamedTuple):
    """Turn performance of a vehicle: turn radius [m], steepest climb (metres per metre flown, > 0), and greatest
    distance of chords from their arc [m].
    """

    r: float
    slope: float
    chord_error: float


class Rings(NamedTuple):
    """Via points (g, m, 2) per ring, their numbers (g), and which of them are mutually visible at the altitude of all
    starts (g, m, m), 0 if not known yet.
    """

    points: np.ndarray
    sizes: np.ndarray
    seen: np.ndarray


class Sights(NamedTuple):
    """Cache of which nodes are mutually visible: two points of a ring (m, m); the start and a point or, at the last
    index, the end (m + 1); a point and the end (m).
    """

    between: np.ndarray
    from_start: np.ndarray
    to_end: np.ndarray


class Word(NamedTuple):
    """Scratch space for kinds and lengths [m] of words (WORDS_MOST, 3); row 0 holds the allowed word."""

    kinds: np.ndarray
    lengths: np.ndarray


class Routed(NamedTuple):
    """Routes in bulk: FOUND or a reason code, lengths [m], links or the zone, the poses between links."""

    codes: np.ndarray
    metres: np.ndarray
    links: np.ndarray
    poses: np.ndarray


def piece(
    start: np.ndarray,
    end: np.ndarray,
    turning: Turning,
    zones: tuple[np.ndarray, ...],
    word: Word,
) -> tuple[bool, float, int]:
    """The shortest allowed word from start to end: (allowed, length [m], zone of the shortest).

    Full turns are added at the beginning if the path is too short for the climb.
    """
    r, slope, chord_error = turning.r, turning.slope, turning.chord_error
    kinds, lengths = word.kinds, word.lengths
    count = words(end[0] - start[0], end[1] - start[1], start[3], end[3], r, kinds, lengths)
    totals = np.empty(count)
    for w in range(count):
        totals[w] = lengths[w, 0] + lengths[w, 1] + lengths[w, 2]
    if end[2] != start[2]:
        need, lap = abs(end[2] - start[2]) / slope, 2 * math.pi * r
        for w in range(count):
            laps = max(0, math.ceil((need - totals[w]) / lap))
            lengths[w, 0] += laps * lap
            totals[w] += laps * lap
    blocked = -1
    for _ in range(count):
        best = 0
        for w in range(1, count):
            if totals[w] < totals[best]:
                best = w
        totals[best] = math.inf
        zone = -1
        if len(zones[0]) > 0:
            points = legs(start, end, kinds[best], lengths[best], r, chord_error)
            zone = within(first_bad, 1 + len(points) * len(zones[0]) // LEGS)(points, zones)[1]
        if zone < 0:
            for j in range(3):
                kinds[0, j], lengths[0, j] = kinds[best, j], lengths[best, j]
            return True, legs_length(kinds[0], lengths[0], r, chord_error), blocked
        if blocked < 0:
            blocked = zone
    return False, 0.0, blocked


def gains_little(start: np.ndarray, end: np.ndarray, r: float, flown: float, word: Word) -> bool:
    """Whether a path of length `flown` is not much longer than the unobstructed word; `word` is scratch space."""
    words(end[0] - start[0], end[1] - start[1], start[3], end[3], r, word.kinds, word.lengths)
    least = word.lengths[0, 0] + word.lengths[0, 1] + word.lengths[0, 2]
    return bool(flown <= GAINS_LITTLE * least + r)


def free(
    an: float,
    ae: float,
    bn: float,
    be: float,
    alt: float,
    known: np.ndarray,
    k: int,
    zones: tuple[np.ndarray, ...],
) -> bool:
    """Whether the level leg from a to b obeys all zones; cached in `known[k]`."""
    if known[k] == UNKNOWN:
        known[k] = FREE if leg_zone(an, ae, alt, bn, be, alt, zones) < 0 else BLOCKED
    return bool(known[k] == FREE)


def chain(
    start: np.ndarray,
    end: np.ndarray,
    ring: np.ndarray,
    sights: Sights,
    struck: np.ndarray,
    zones: tuple[np.ndarray, ...],
    found: np.ndarray,
) -> int:
    """Shortest chain of mutually visible nodes from start to end (A*), without the excluded (struck) pairs.

    Nodes are the points of the ring, then start, then end; found: filled with the chain. Returns its number of nodes;
    0 if there is none.
    """
    m = len(ring)
    here, there = m, m + 1
    place = np.empty((m + 2, 2))
    for k in range(m):  # no slices: that two of them fit takes the compiler seconds
        place[k, 0], place[k, 1] = ring[k, 0], ring[k, 1]
    place[here, 0], place[here, 1] = start[0], start[1]
    place[there, 0], place[there, 1] = end[0], end[1]
    ahead = np.empty(m + 2)
    for k in range(m + 2):
        ahead[k] = math.sqrt((place[k, 0] - end[0]) ** 2 + (place[k, 1] - end[1]) ** 2)
    best, before = np.full(m + 2, math.inf), np.full(m + 2, -1)
    closed = np.zeros(m + 2, np.bool_)
    best[here] = 0.0
    for _ in range(m + 2):
        at = -1
        for k in range(m + 2):
            if closed[k] or best[k] == math.inf:
                continue
            if at < 0 or best[k] + ahead[k] < best[at] + ahead[at]:
                at = k
        if at < 0:
            return 0
        if at == there:
            count, k = 0, there
            while k >= 0:
                count, k = count + 1, before[k]
            if count > LINKS_MOST:
                return 0
            k = there
            for j in range(count - 1, -1, -1):
                found[j], k = k, before[k]
            return count
        closed[at] = True
        for to in range(m + 2):
            if closed[to] or to in (here, at):
                continue
            n, e = place[to, 0] - place[at, 0], place[to, 1] - place[at, 1]
            longer = best[at] + math.sqrt(n * n + e * e)
            if longer >= best[to]:
                continue
            gone = False
            for k in range(len(struck)):
                gone = gone or (struck[k, 0] == at and struck[k, 1] == to)
            if gone:
                continue
            if at == here:
                known, k = sights.from_start, (m if to == there else to)
            elif to == there:
                known, k = sights.to_end, at
            else:
                known, k = sights.between[min(at, to)], max(at, to)
            if free(
                place[at, 0], place[at, 1], place[to, 0], place[to, 1], start[2], known, k, zones
            ):
                best[to], before[to] = longer, at
    return 0


def fly_chain(
    start: np.ndarray,
    end: np.ndarray,
    turning: Turning,
    nodes: np.ndarray,
    ring: np.ndarray,
    zones: tuple[np.ndarray, ...],
    word: Word,
    poses: np.ndarray,
) -> tuple[int, float]:
    """The shortest allowed Dubins chain through the via points: (0, its length), poses filled.

    Or (index of the refused link, 0). At a via point three headings are tried: halfway between the legs, along the
    first, along the second.
    """
    count = len(nodes)
    place, run = np.empty((count, 2)), np.zeros(count)
    for k in range(count):
        if k == 0:
            place[k, 0], place[k, 1] = start[0], start[1]
        elif k == count - 1:
            place[k, 0], place[k, 1] = end[0], end[1]
        else:
            place[k, 0], place[k, 1] = ring[nodes[k], 0], ring[nodes[k], 1]
        if k > 0:
            n, e = place[k, 0] - place[k - 1, 0], place[k, 1] - place[k - 1, 1]
            run[k] = run[k - 1] + math.sqrt(n * n + e * e)
    whole = run[count - 1] if run[count - 1] > 0 else 1.0
    states = np.empty((count, 3, 4))
    cost, come = np.full((count, 3), math.inf), np.zeros((count, 3), np.int64)
    for j in range(4):
        states[0, 0, j] = start[j]
    cost[0, 0] = 0.0
    for k in range(1, count):
        targets = 1 if k == count - 1 else 3
        any_reached = False
        for t in range(targets):
            if targets == 1:
                for j in range(4):
                    states[k, 0, j] = end[j]
            else:
                first = math.atan2(place[k, 1] - place[k - 1, 1], place[k, 0] - place[k - 1, 0])
                second = math.atan2(place[k + 1, 1] - place[k, 1], place[k + 1, 0] - place[k, 0])
                turn = (second - first + math.pi) % (2 * math.pi) - math.pi
                states[k, t, 0], states[k, t, 1] = place[k, 0], place[k, 1]
                states[k, t, 2] = start[2] + (end[2] - start[2]) * run[k] / whole
                states[k, t, 3] = first + turn / 2 if t == 0 else (first if t == 1 else second)
            for s in range(3):
                if cost[k - 1, s] == math.inf:
                    continue
                allowed, length, _ = piece(states[k - 1, s], states[k, t], turning, zones, word)
                if allowed and cost[k - 1, s] + length < cost[k, t]:
                    cost[k, t], come[k, t] = cost[k - 1, s] + length, s
                    any_reached = True
        if not any_reached:
            return k, 0.0
    t = 0
    for k in range(count - 1, -1, -1):
        for j in range(4):
            poses[k, j] = states[k, t, j]
        t = come[k, t]
    return 0, cost[count - 1, 0]


def one_route(
    start: np.ndarray,
    end: np.ndarray,
    turning: Turning,
    zones: tuple[np.ndarray, ...],
    rings: Rings,
    poses: np.ndarray,
) -> tuple[int, float, int, int]:
    """One route: (FOUND, length, links, 0) with the poses between links; or a reason code, and the zone."""
    word = Word(np.empty((WORDS_MOST, 3), np.int64), np.empty((WORDS_MOST, 3)))
    allowed, flown, blocked = piece(start, end, turning, zones, word)
    for j in range(4):
        poses[0, j], poses[1, j] = start[j], end[j]
    if allowed and (blocked < 0 or gains_little(start, end, turning.r, flown, word)):
        return FOUND, flown, 1, 0
    for name, point in ((BAD_START, start), (BAD_END, end)):
        zone = leg_zone(point[0], point[1], point[2], point[0], point[1], point[2], zones)
        if zone >= 0:
            return name, 0.0, 0, zone
    best, links = (flown, 1) if allowed else (math.inf, 0)
    for g in range(len(rings.sizes)):
        ring = rings.points[g, : rings.sizes[g]]
        struck, nodes = np.empty((CHAINS_MOST, 2), np.int64), np.empty(LINKS_MOST + 2, np.int64)
        sights = Sights(
            rings.seen[g], np.zeros(len(ring) + 1, np.int8), np.zeros(len(ring), np.int8)
        )
        tried = np.empty((LINKS_MOST + 2, 4))
        for k in range(CHAINS_MOST):
            count = chain(start, end, ring, sights, struck[:k], zones, nodes)
            if count == 0:
                break
            bad, length = fly_chain(start, end, turning, nodes[:count], ring, zones, word, tried)
            if bad == 0:
                if length < best:
                    best, links = length, count - 1
                    for to in range(count):
                        for j in range(4):
                            poses[to, j] = tried[to, j]
                break
            struck[k, 0], struck[k, 1] = nodes[bad - 1], nodes[bad]
        if links > 0:
            return FOUND, best, links, 0
    return NO_WAY, 0.0, 0, blocked


@driver(checked_by=("keep_out_leg_ok", "keep_in_leg_ok", "location_step", "contact_step"))
def direct_many(
    starts: np.ndarray,
    ends: np.ndarray,
    turning: Turning,
    zones: tuple[np.ndarray, ...],
    found: Routed,
) -> None:
    """`route_many` for the pairs whose direct word is allowed, which is nearly all; code NOT_DIRECT for the others.

    So routing around zones is compiled only if many routes need it.
    """
    word = Word(np.empty((WORDS_MOST, 3), np.int64), np.empty((WORDS_MOST, 3)))
    for i in range(len(starts)):
        start, end = starts[i], ends[i]
        allowed, flown, blocked = piece(start, end, turning, zones, word)
        if allowed and blocked >= 0:
            allowed = gains_little(start, end, turning.r, flown, word)
        poses = found.poses[min(i, len(found.poses) - 1)]
        for j in range(4):
            poses[0, j], poses[1, j] = start[j], end[j]
        found.codes[i] = FOUND if allowed else NOT_DIRECT
        found.metres[i], found.links[i] = flown, 1


@driver(checked_by=("keep_out_leg_ok", "keep_in_leg_ok", "location_step", "contact_step"))
def route_many(
    starts: np.ndarray,
    ends: np.ndarray,
    turning: Turning,
    zones: tuple[np.ndarray, ...],
    rings: Rings,
    found: Routed,
) -> None:
    """A short flyable route for each pair of poses (n, 4), every leg of which obeys the zones.

    zones: `leg_arrays.table`; rings.seen: int8. Filled: codes (n) and links (n) int64, metres (n), poses (k,
    LINKS_MOST + 2, 4), k = n, or 1 if only lengths are needed. With a code other than FOUND, links holds the zone.
    The route is the shortest that was found, not the shortest that exists.
    """
    for i in range(len(starts)):
        at = found.poses[min(i, len(found.poses) - 1)]
        code, length, count, zone = one_route(starts[i], ends[i], turning, zones, rings, at)
        found.codes[i], found.metres[i] = code, length
        found.links[i] = count if code == FOUND else zone


def route_points(
    poses: np.ndarray,
    links: int,
    turning: Turning,
    zones: tuple[np.ndarray, ...],
) -> np.ndarray:
    """The polyline (n, 3) through the poses of a route that was found."""
    kinds, lengths = np.empty((WORDS_MOST, 3), np.int64), np.empty((WORDS_MOST, 3))
    parts = np.empty((0, 3))
    for k in range(links):
        piece(poses[k], poses[k + 1], turning, zones, Word(kinds, lengths))
        points = legs(poses[k], poses[k + 1], kinds[0], lengths[0], turning.r, turning.chord_error)
        parts = points if k == 0 else np.concatenate((parts, points[1:]))
    return parts
