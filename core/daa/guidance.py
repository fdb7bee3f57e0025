"""Guidance in one dimension: safe values in every region, recovery, last times to manoeuvre.

Definitions: `spec.daa.meaning`. Everything here is search and bookkeeping over the kernels of
`core.daa.steps` and `core.daa.climb`; arrays as described there. Regions are 1 FAR, 2 MID, 3 NEAR.
"""

import numpy as np

from cratous.core.daa.climb import safe_altitudes
from cratous.core.daa.steps import safe_steps
from cratous.core.kernel import driver, kernel


@driver(checked_by=("in_conflict", "piece_counts", "straight_from"))
def evaluate(
    right, left, step_s, piece_s, targets, rate_m_s, accel_m_s2, sample_s, others, chosen, kinds,
    volumes, horizons, sides, begin_s, radius_m, half_m, recovering, lookahead_s, counted, project_s, early,
    single, safe_r, safe_l,
):  # fmt: skip
    """Safe steps to the right and left, or safe altitudes if there are targets, which know no sides.

    Returns whether there is a safe value: two neighbouring grid values, or any one if single.
    """
    if targets.size > 0:
        return safe_altitudes(
            right[0], targets, rate_m_s, accel_m_s2, sample_s, others, chosen, kinds, volumes,
            horizons, begin_s, radius_m, half_m, recovering, lookahead_s, counted, project_s,
            early, single, safe_r,
        )  # fmt: skip
    a = safe_steps(
        right, step_s, piece_s, others, chosen, kinds, volumes, horizons, sides, begin_s, radius_m, half_m,
        recovering, lookahead_s, counted, project_s, early, single, safe_r,
    )  # fmt: skip
    if a and early:
        return True
    b = safe_steps(
        left, step_s, piece_s, others, chosen, kinds, volumes, horizons, sides, begin_s, radius_m, half_m,
        recovering, lookahead_s, counted, project_s, early, single, safe_l,
    )  # fmt: skip
    return a or b


@kernel(implements="daa.meaning.shrunk")
def shrunk(size_m: float, least_m: float, factor: float) -> float:
    """A recovery distance [m] one step smaller, never below least_m; factor in (0, 1)."""
    return max(least_m, size_m * (1 - factor))


@driver(checked_by=("in_conflict", "piece_counts", "straight_from", "shrunk"))
def recover(
    right, left, step_s, targets, rate_m_s, accel_m_s2, sample_s, others, chosen, kinds, volumes,
    horizons, sides, lookahead_s, counted, radius_m, half_m, nmac_m, nmac_half_m, shrinking, factor,
    stability_s, safe_r, safe_l, result,
):  # fmt: skip
    """The earliest manoeuvres that regain the volume, and how far the intruder stays away until.

    result: [saturated, time s, times shrunk, radius m, half height m]. A cylinder is to be kept
    clear until the recovery time, the volumes after it; if that cannot be, and shrinking, the
    cylinder is made smaller, down to the NMAC cylinder. The time is found by halving to 0.5 s.
    """
    cylinders = kinds.copy()
    sizes = volumes.copy()
    for i in range(kinds.size):
        cylinders[i] = 3
        sizes[i, 0], sizes[i, 1] = nmac_m, nmac_half_m
        # a cylinder has no times
        sizes[i, 2], sizes[i, 3], sizes[i, 4] = 0.0, 0.0, 0.0
    result[0], result[1], result[2], result[3], result[4] = 1.0, 0.0, 0.0, radius_m, half_m
    if not evaluate(
        right, left, step_s, step_s, targets, rate_m_s, accel_m_s2, sample_s, others, chosen, cylinders,
        sizes, horizons, sides, 0.0, 0.0, 0.0, False, lookahead_s, counted, 0.0, True, False, safe_r, safe_l,
    ):  # fmt: skip
        return
    shrinks = 0
    while True:
        for i in range(kinds.size):
            sizes[i, 0], sizes[i, 1] = radius_m, half_m
        if evaluate(
            right, left, step_s, step_s, targets, rate_m_s, accel_m_s2, sample_s, others, chosen,
            cylinders, sizes, horizons, sides, 0.0, 0.0, 0.0, False, lookahead_s, counted, 0.0, True,
            False, safe_r, safe_l,
        ):  # fmt: skip
            red_s, green_s = 0.0, lookahead_s
            while green_s - red_s > 0.5:
                middle_s = (red_s + green_s) / 2
                if evaluate(
                    right, left, step_s, step_s, targets, rate_m_s, accel_m_s2, sample_s, others, chosen,
                    kinds, volumes, horizons, sides, middle_s, radius_m, half_m, True, lookahead_s,
                    counted, 0.0, True, False, safe_r, safe_l,
                ):  # fmt: skip
                    green_s = middle_s
                else:
                    red_s = middle_s
            if green_s < lookahead_s:
                time_s = min(lookahead_s, green_s + stability_s)
                if evaluate(
                    right, left, step_s, step_s, targets, rate_m_s, accel_m_s2, sample_s, others, chosen,
                    kinds, volumes, horizons, sides, time_s, radius_m, half_m, True, lookahead_s,
                    counted, 0.0, False, False, safe_r, safe_l,
                ):  # fmt: skip
                    result[0], result[1], result[2] = 0.0, time_s, shrinks
                    result[3], result[4] = radius_m, half_m
                    return
        if not shrinking:
            return
        radius_m = shrunk(radius_m, nmac_m, factor)
        half_m = shrunk(half_m, nmac_half_m, factor)
        shrinks += 1
        result[2] = shrinks
        if radius_m <= nmac_m and half_m <= nmac_half_m:
            return


@driver(checked_by=("in_conflict", "piece_counts", "straight_from"))
def in_region(
    right, left, step_s, targets, rate_m_s, accel_m_s2, sample_s, others, mapped, conflict, kinds,
    volumes, alerting_s, sides, lookahead_s, counted, safe_r, safe_l, one_r, one_l, peripheral, chosen,
    horizons,
):  # fmt: skip
    """Safe values with respect to one region: of each intruder by itself, then of all.

    An intruder in conflict counts with the whole look-ahead as horizon, any other one with its
    alerting time, and only if some manoeuvre conflicts with it: then it is peripheral.
    chosen: the intruders that count are put there. Returns (how many, whether a value is safe).
    """
    safe_r[:] = True
    safe_l[:] = True
    count = 0
    one = chosen[:1].copy()
    for i in range(others.shape[0]):
        if not mapped[i]:
            continue
        horizons[i] = lookahead_s
        if not conflict[i]:
            horizons[i] = min(lookahead_s, alerting_s[i])
        one[0] = i
        evaluate(
            right, left, step_s, step_s, targets, rate_m_s, accel_m_s2, sample_s, others, one, kinds,
            volumes, horizons, sides, 0.0, 0.0, 0.0, False, lookahead_s, counted, 0.0, False, False,
            one_r, one_l,
        )  # fmt: skip
        use = conflict[i]
        for k in range(safe_r.size):
            if not one_r[k]:
                safe_r[k] = False
                use = True
        if targets.size == 0:
            for k in range(safe_l.size):
                if not one_l[k]:
                    safe_l[k] = False
                    use = True
        peripheral[i] = use and not conflict[i]
        if use:
            chosen[count] = i
            count += 1
    found = False
    for k in range(1, safe_r.size):
        found = found or (safe_r[k] and safe_r[k - 1])
    if targets.size == 0:
        for k in range(1, safe_l.size):
            found = found or (safe_l[k] and safe_l[k - 1])
    return count, found


@driver(checked_by=("in_conflict", "piece_counts", "straight_from", "shrunk"))
def guide(
    right, left, step_s, targets, rate_m_s, accel_m_s2, sample_s, others, mapped, conflict, kinds,
    volumes, alerting_s, sides, recovery_sides, lookahead_s, counted, corrective, recovery_on,
    radius_m, half_m, nmac_m, nmac_half_m, shrinking, factor, stability_s, safe_r, safe_l, peripheral, recovery, state,
):  # fmt: skip
    """Everything about one dimension.

    mapped, conflict, peripheral: (4, n) by region and intruder; kinds, alerting_s: (4, n);
    volumes: (4, n, 5); sides, recovery_sides: (n, 2) to keep to in conflict and recovery bands, 0:
    none. safe_r, safe_l: (5, K + 1) by region, row 4 for recovery.
    state: (5,) per region 0 not asked, 1 has safe values, 2 has none; [4] 1 if recovery was
    computed. recovery: as `recover`.
    """
    horizons = alerting_s[0].copy()
    chosen = kinds[0].copy()
    worst = 0
    count = 0
    listed = 0
    for region in (3, 2, 1):
        if not mapped[region].any():
            continue
        count, found = in_region(
            right, left, step_s, targets, rate_m_s, accel_m_s2, sample_s, others, mapped[region],
            conflict[region], kinds[region], volumes[region], alerting_s[region], sides, lookahead_s,
            counted, safe_r[region], safe_l[region], safe_r[4], safe_l[4], peripheral[region],
            chosen, horizons,
        )  # fmt: skip
        listed = region
        state[region] = 1
        if not found:
            state[region] = 2
            worst = region
            break
    if worst == 0 or worst < corrective or not recovery_on:
        return
    if listed != corrective:
        count, found = in_region(
            right, left, step_s, targets, rate_m_s, accel_m_s2, sample_s, others,
            mapped[corrective], conflict[corrective], kinds[corrective], volumes[corrective],
            alerting_s[corrective], sides, lookahead_s, counted, safe_r[0], safe_l[0], safe_r[4],
            safe_l[4], peripheral[corrective], chosen, horizons,
        )  # fmt: skip
    state[4] = 1
    recover(
        right, left, step_s, targets, rate_m_s, accel_m_s2, sample_s, others, chosen[:count],
        kinds[corrective], volumes[corrective], horizons, recovery_sides, lookahead_s, counted, radius_m, half_m,
        nmac_m, nmac_half_m, shrinking, factor, stability_s, safe_r[4], safe_l[4], recovery,
    )  # fmt: skip


@driver(checked_by=("in_conflict", "piece_counts", "straight_from"))
def last_time(
    right, left, step_s, piece_s, targets, rate_m_s, accel_m_s2, sample_s, others, i, kinds, volumes,
    lookahead_s, counted, entry_s, horizons, safe_r, safe_l,
):  # fmt: skip
    """The last time in [0, entry_s] at which a manoeuvre still avoids intruder i [s]; -1: none.

    piece_s: as in `safe_steps`. Both fly straight on until then. Found by halving to 0.5 s, on the early side.
    """
    one = kinds[:1].copy()
    one[0] = i
    sides = np.zeros((others.shape[0], 2), dtype=np.int64)
    horizons[i] = lookahead_s
    green_s, red_s = -1.0, entry_s
    if entry_s <= 0:
        return green_s
    for turn in range(64):
        middle_s = 0.0
        if turn > 0:
            middle_s = (green_s + red_s) / 2
            if red_s - green_s <= 0.5:
                break
        if evaluate(
            right, left, step_s, piece_s, targets, rate_m_s, accel_m_s2, sample_s, others, one, kinds,
            volumes, horizons, sides, 0.0, 0.0, 0.0, False, lookahead_s, counted, middle_s, True,
            True, safe_r, safe_l,
        ):  # fmt: skip
            green_s = middle_s
        elif turn == 0:
            break
        else:
            red_s = middle_s
    return green_s
