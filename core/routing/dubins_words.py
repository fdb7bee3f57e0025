"""The Dubins words between two poses, and their division into legs: plain loops over arrays.

A word has three segments: turn right (1), straight (0), turn left (-1). CPython runs these functions directly;
`core.readings.machine.compiled.machine` compiles the same text. The results are searched, never trusted: legs are
checked by the zone kernels.
"""

import math

import numpy as np

WORDS_MOST = 8
WHOLE_TURN = 2 * math.pi
CLOSED_RAD = 1e-9  # a turn this close to a full one is rounding noise
NOTHING_M = 1e-6  # a piece that is shorter is left out


def turned(angle: float) -> float:
    """The angle in [0, 2 pi), with rounding noise just below a full turn taken as none."""
    angle %= WHOLE_TURN
    return 0.0 if WHOLE_TURN - angle < CLOSED_RAD else angle


def put(
    kinds: np.ndarray,
    lengths: np.ndarray,
    count: int,
    kind: tuple[int, int, int],
    length: tuple[float, float, float],
) -> int:
    """Insert a word among `count` words sorted by length; returns the new count."""
    total, k = length[0] + length[1] + length[2], count
    while k > 0 and lengths[k - 1, 0] + lengths[k - 1, 1] + lengths[k - 1, 2] > total:
        for j in range(3):
            kinds[k, j] = kinds[k - 1, j]
            lengths[k, j] = lengths[k - 1, j]
        k -= 1
    for j in range(3):
        kinds[k, j], lengths[k, j] = kind[j], length[j]
    return count + 1


def words(
    north: float,
    east: float,
    a: float,
    b: float,
    r: float,
    kinds: np.ndarray,
    lengths: np.ndarray,
) -> int:
    """All words from heading a at the origin to heading b at (north, east), shortest first.

    a, b: clockwise from north [rad]; r: turn radius [m], > 0; kinds (int64), lengths (float64) [m]:
    filled, shape (WORDS_MOST, 3). How many there are: 2 or more. With the circles of the first and
    last piece given, the middle piece is a common tangent or a third circle touching both.
    """
    sin_a, cos_a, sin_b, cos_b = math.sin(a), math.cos(a), math.sin(b), math.cos(b)
    count = 0
    for one in (1, -1):
        for two in (1, -1):
            # from the first circle's centre to the last one's
            x = north - two * r * sin_b + one * r * sin_a
            y = east + two * r * cos_b - one * r * cos_a
            gap, bearing = math.sqrt(x * x + y * y), math.atan2(y, x)
            if one == two:
                if gap < 1e-9 * r:
                    bearing = a
                first, last = turned(one * (bearing - a)), turned(one * (b - bearing))
                count = put(kinds, lengths, count, (one, 0, two), (first * r, gap, last * r))
                if gap < 4 * r:
                    bend = math.acos(gap / (4 * r))
                    for side in (1, -1):
                        # the middle circle lies to one or the other side of the centre line
                        h1 = bearing + side * bend + one * math.pi / 2
                        h2 = bearing - side * bend + one * math.pi / 2 + math.pi
                        count = put(
                            kinds,
                            lengths,
                            count,
                            (one, -one, one),
                            (
                                turned(one * (h1 - a)) * r,
                                turned(one * (h1 - h2)) * r,
                                turned(one * (b - h2)) * r,
                            ),
                        )
            elif gap >= 2 * r:
                heading = bearing + one * math.asin(2 * r / gap)
                run = math.sqrt(gap * gap - 4 * r * r)
                first, last = turned(one * (heading - a)), turned(two * (b - heading))
                count = put(kinds, lengths, count, (one, 0, two), (first * r, run, last * r))
    return count


def chords(length: float, kind: int, r: float, step: float) -> int:
    """The number of legs into which a segment is divided; step: the longest arc of one leg [m]."""
    if length <= NOTHING_M:
        return 0
    return 1 if kind == 0 else max(1, math.ceil(length / step))


def arc_step(r: float, chord_error: float) -> float:
    """The longest arc whose chord deviates from it by at most chord_error [m]."""
    return 2 * math.acos(max(0.0, 1 - chord_error / r)) * r


def legs_length(kinds: np.ndarray, lengths: np.ndarray, r: float, chord_error: float) -> float:
    """Length of the polyline that `legs` makes of a word, without building it, accurate to
    NOTHING_M per segment [m].
    """
    step, total = arc_step(r, chord_error), 0.0
    for j in range(3):
        length = lengths[j]
        if kinds[j] == 0 or length <= NOTHING_M:
            total += length
        else:
            count = chords(length, kinds[j], r, step)
            total += count * 2 * r * math.sin(length / (2 * r * count))
    return total


def legs(
    start: np.ndarray,
    end: np.ndarray,
    kinds: np.ndarray,
    lengths: np.ndarray,
    r: float,
    chord_error: float,
) -> np.ndarray:
    """The polyline of a word, shape (n, 3): north, east, altitude; from start to end, both exactly.

    start, end: north, east, altitude, heading. An arc is cut into equal chords that leave it by
    at most chord_error [m]; altitude is linear in length.
    """
    step, count = arc_step(r, chord_error), 1
    for j in range(3):
        count += chords(lengths[j], kinds[j], r, step)
    points = np.empty((max(count, 2), 3))
    total = float(lengths[0] + lengths[1] + lengths[2])
    if total == 0.0:
        total = 1.0
    # CPython computes with its own numbers twice as fast as with those of arrays
    n, e, low, h = float(start[0]), float(start[1]), float(start[2]), float(start[3])
    climb, flown, at = float(end[2]) - low, 0.0, 1
    points[0, 0], points[0, 1], points[0, 2] = n, e, low
    for j in range(3):
        kind, length = int(kinds[j]), float(lengths[j])
        parts = chords(length, kind, r, step)
        if parts == 0:
            continue
        north, east, heading = n, e, h
        for k in range(1, parts + 1):
            run = length * k / parts
            if kind == 0:
                north, east = n + run * math.cos(h), e + run * math.sin(h)
            else:
                heading = h + kind * run / r
                north = n + kind * r * (math.sin(heading) - math.sin(h))
                east = e - kind * r * (math.cos(heading) - math.cos(h))
            points[at, 0], points[at, 1] = north, east
            points[at, 2] = low + climb * (flown + run) / total
            at += 1
        n, e, h, flown = north, east, heading, flown + length
    points[len(points) - 1, 0] = end[0]
    points[len(points) - 1, 1] = end[1]
    points[len(points) - 1, 2] = end[2]
    return points
