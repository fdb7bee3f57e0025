"""Guidance in one dimension: safe values in every region, recovery, last times to manoeuvre.

Definitions: `spec.daa.meaning`. Everything here is search and bookkeeping over the kernels of
`core.daa.steps` and `core.daa.climb`; records: `core.daa.records`. Regions are 1 FAR, 2 MID, 3 NEAR.
"""

import numpy as np

from cratous.core.daa.climb import safe_altitudes
from cratous.core.daa.records import (
    Guided,
    Intruders,
    Looking,
    Manoeuvres,
    RecoverySizes,
    Regaining,
    Regions,
)
from cratous.core.daa.steps import safe_steps
from cratous.core.kernel import driver, kernel


@driver(checked_by=("in_conflict", "piece_counts", "straight_from"))
def evaluate(
    ways: Manoeuvres, intruders: Intruders, chosen: np.ndarray, regaining: Regaining,
    looking: Looking, safe_r: np.ndarray, safe_l: np.ndarray,
):  # fmt: skip
    """Safe steps to the right and left, or safe altitudes if there are targets, which have no sides.

    chosen: indices of the intruders that count. Returns whether there is a safe value: two neighbouring grid values,
    or any one if single.
    """
    if ways.targets.size > 0:
        return safe_altitudes(ways, intruders, chosen, regaining, looking, safe_r)
    a = safe_steps(ways.right, ways, intruders, chosen, regaining, looking, safe_r)
    if a and looking.early:
        return True
    b = safe_steps(ways.left, ways, intruders, chosen, regaining, looking, safe_l)
    return a or b


@kernel(implements="daa.meaning.shrunk")
def shrunk(size_m: float, least_m: float, factor: float) -> float:
    """A recovery distance [m] after one reduction, at least least_m; factor in (0, 1)."""
    return max(least_m, size_m * (1 - factor))


@driver(checked_by=("in_conflict", "piece_counts", "straight_from", "shrunk"))
def recover(
    ways: Manoeuvres, intruders: Intruders, chosen: np.ndarray, looking: Looking,
    size: RecoverySizes, safe_r: np.ndarray, safe_l: np.ndarray, result: np.ndarray,
):  # fmt: skip
    """The earliest manoeuvres that regain the volume, and the separation kept until then.

    result: [saturated, time s, times shrunk, radius m, half height m]. A cylinder is to be kept clear until the
    recovery time, the volumes after it; if that is not possible, and shrinking is on, the cylinder is reduced, down
    to the NMAC cylinder. The time is found by bisection to 0.5 s.
    """
    radius_m, half_m, lookahead_s = size.radius_m, size.half_m, looking.lookahead_s
    kinds = intruders.kinds.copy()
    sizes = intruders.volumes.copy()
    for i in range(kinds.size):
        kinds[i] = 3
        sizes[i, 0], sizes[i, 1] = size.nmac_m, size.nmac_half_m
        # a cylinder has no time thresholds
        sizes[i, 2], sizes[i, 3], sizes[i, 4] = 0.0, 0.0, 0.0
    cylinders = Intruders(intruders.states, kinds, sizes, intruders.horizons, intruders.sides)
    early = Looking(lookahead_s, looking.counted, 0.0, True, False)
    always = Regaining(0.0, 0.0, 0.0, False)
    result[0], result[1], result[2], result[3], result[4] = 1.0, 0.0, 0.0, radius_m, half_m
    if not evaluate(ways, cylinders, chosen, always, early, safe_r, safe_l):
        return
    shrinks = 0
    while True:
        for i in range(kinds.size):
            sizes[i, 0], sizes[i, 1] = radius_m, half_m
        if evaluate(ways, cylinders, chosen, always, early, safe_r, safe_l):
            red_s, green_s = 0.0, lookahead_s
            while green_s - red_s > 0.5:
                middle_s = (red_s + green_s) / 2
                then = Regaining(middle_s, radius_m, half_m, True)
                if evaluate(ways, intruders, chosen, then, early, safe_r, safe_l):
                    green_s = middle_s
                else:
                    red_s = middle_s
            if green_s < lookahead_s:
                time_s = min(lookahead_s, green_s + size.stability_s)
                then = Regaining(time_s, radius_m, half_m, True)
                if evaluate(ways, intruders, chosen, then, looking, safe_r, safe_l):
                    result[0], result[1], result[2] = 0.0, time_s, shrinks
                    result[3], result[4] = radius_m, half_m
                    return
        if not size.shrinking:
            return
        radius_m = shrunk(radius_m, size.nmac_m, size.factor)
        half_m = shrunk(half_m, size.nmac_half_m, size.factor)
        shrinks += 1
        result[2] = shrinks
        if radius_m <= size.nmac_m and half_m <= size.nmac_half_m:
            return


@driver(checked_by=("in_conflict", "piece_counts", "straight_from"))
def in_region(
    ways: Manoeuvres, regions: Regions, region: int, row: int, looking: Looking, found: Guided,
    chosen: np.ndarray, horizons: np.ndarray,
):  # fmt: skip
    """Safe values with respect to one region, into `row`: for each intruder by itself, then for all.

    An intruder in conflict counts with the whole look-ahead as horizon, any other one with its alerting time, and
    only if some manoeuvre conflicts with it: then it is peripheral. chosen: receives the intruders that count.
    Returns (how many, whether a value is safe).
    """
    mapped, conflict = regions.mapped[region], regions.conflict[region]
    alerting_s, peripheral = regions.alerting_s[region], found.peripheral[region]
    safe_r, safe_l, one_r, one_l = (
        found.safe_r[row],
        found.safe_l[row],
        found.safe_r[4],
        found.safe_l[4],
    )
    intruders = Intruders(
        regions.states, regions.kinds[region], regions.volumes[region], horizons, regions.sides
    )
    always, lookahead_s = Regaining(0.0, 0.0, 0.0, False), looking.lookahead_s
    safe_r[:] = True
    safe_l[:] = True
    count = 0
    one = chosen[:1].copy()
    for i in range(regions.states.shape[0]):
        if not mapped[i]:
            continue
        horizons[i] = lookahead_s
        if not conflict[i]:
            horizons[i] = min(lookahead_s, alerting_s[i])
        one[0] = i
        evaluate(ways, intruders, one, always, looking, one_r, one_l)
        use = conflict[i]
        for k in range(safe_r.size):
            if not one_r[k]:
                safe_r[k] = False
                use = True
        if ways.targets.size == 0:
            for k in range(safe_l.size):
                if not one_l[k]:
                    safe_l[k] = False
                    use = True
        peripheral[i] = use and not conflict[i]
        if use:
            chosen[count] = i
            count += 1
    any_safe = False
    for k in range(1, safe_r.size):
        any_safe = any_safe or (safe_r[k] and safe_r[k - 1])
    if ways.targets.size == 0:
        for k in range(1, safe_l.size):
            any_safe = any_safe or (safe_l[k] and safe_l[k - 1])
    return count, any_safe


@driver(checked_by=("in_conflict", "piece_counts", "straight_from", "shrunk"))
def guide(
    ways: Manoeuvres, regions: Regions, lookahead_s: float, counted: bool, corrective: int,
    recovery_on: bool, sizes: RecoverySizes, found: Guided,
):  # fmt: skip
    """Compute all guidance of one dimension, into `found`.

    counted: as in `Looking`; corrective: the region that is to be regained; recovery_on: whether recovery is
    requested.
    """
    horizons = regions.alerting_s[0].copy()
    chosen = regions.kinds[0].copy()
    looking = Looking(lookahead_s, counted, 0.0, False, False)
    worst = 0
    count = 0
    listed = 0
    for region in (3, 2, 1):
        if not regions.mapped[region].any():
            continue
        count, safe = in_region(ways, regions, region, region, looking, found, chosen, horizons)
        listed = region
        found.state[region] = 1
        if not safe:
            found.state[region] = 2
            worst = region
            break
    if worst == 0 or worst < corrective or not recovery_on:
        return
    if listed != corrective:
        count, safe = in_region(ways, regions, corrective, 0, looking, found, chosen, horizons)
    found.state[4] = 1
    intruders = Intruders(
        regions.states, regions.kinds[corrective], regions.volumes[corrective], horizons,
        regions.recovery_sides,
    )  # fmt: skip
    recover(
        ways, intruders, chosen[:count], looking, sizes, found.safe_r[4], found.safe_l[4],
        found.recovery,
    )  # fmt: skip


@driver(checked_by=("in_conflict", "piece_counts", "straight_from"))
def last_time(
    ways: Manoeuvres, intruders: Intruders, i: int, lookahead_s: float, counted: bool,
    entry_s: float, safe_r: np.ndarray, safe_l: np.ndarray,
):  # fmt: skip
    """The last time in [0, entry_s] at which a manoeuvre still avoids intruder i [s]; -1: none.

    Both fly straight until then. Found by bisection to 0.5 s, on the early side. The horizon of intruder i becomes
    the look-ahead.
    """
    one = intruders.kinds[:1].copy()
    one[0] = i
    intruders.horizons[i] = lookahead_s
    always = Regaining(0.0, 0.0, 0.0, False)
    green_s, red_s = -1.0, entry_s
    if entry_s <= 0:
        return green_s
    for turn in range(64):
        middle_s = 0.0
        if turn > 0:
            middle_s = (green_s + red_s) / 2
            if red_s - green_s <= 0.5:
                break
        looking = Looking(lookahead_s, counted, middle_s, True, True)
        if evaluate(ways, intruders, one, always, looking, safe_r, safe_l):
            green_s = middle_s
        elif turn == 0:
            break
        else:
            red_s = middle_s
    return green_s
