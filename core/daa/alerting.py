"""Alert levels: which volumes are violated soon enough.

A level's volume violated within its alerting time raises that level; the most severe one counts.
Definitions: `spec.daa.meaning`. The tables of levels are arrays, so that any number of encounters is
judged in one call.
"""

import math

import numpy as np

from cratous.core.daa.uncertainty import lost, lost_span
from cratous.core.kernel import Vec2, driver


@driver(checked_by=("in_conflict", "uncertain_conflict"))
def raw_levels(relative, errors, alerter, counts, kinds, volumes, alerting_s, lookahead_s, levels):
    """The alert level of each pair, without history, into `levels`.

    relative: (pairs, 6) ownship minus intruder; errors: (pairs, 6) uncertainties, as in `lost`; alerter: (pairs) index into the tables, below 0:
    none; counts: levels of each alerter; kinds, alerting_s: (alerters, levels); volumes:
    (alerters, levels, 5).
    """
    w = np.zeros(11)
    for j in range(alerter.size):
        a = alerter[j]
        w[5:] = errors[j]
        levels[j] = 0
        if a < 0:
            continue
        s = Vec2(relative[j, 0], relative[j, 1])
        v = Vec2(relative[j, 3], relative[j, 4])
        for level in range(counts[a] - 1, -1, -1):
            w[:5] = volumes[a, level]
            if lost(
                kinds[a, level], s, v, relative[j, 2], relative[j, 5], w, 0.0, 0.0,
                min(lookahead_s, alerting_s[a, level]),
            ):  # fmt: skip
                levels[j] = level + 1
                break


@driver(checked_by=("in_conflict", "conflict_span", "uncertain_conflict", "uncertain_span"))
def level_times(relative, errors, alerter, counts, kinds, volumes, lookahead_s, first_s, last_s):
    """First and last violation of every level within the look-ahead, into (pairs, levels) arrays.

    NaN where there is none. Arguments as for `raw_levels`.
    """
    w = np.zeros(11)
    for j in range(alerter.size):
        a = alerter[j]
        w[5:] = errors[j]
        for level in range(first_s.shape[1]):
            first_s[j, level] = math.nan
            last_s[j, level] = math.nan
            if a < 0 or level >= counts[a]:
                continue
            w[:5] = volumes[a, level]
            s = Vec2(relative[j, 0], relative[j, 1])
            v = Vec2(relative[j, 3], relative[j, 4])
            if lost(
                kinds[a, level], s, v, relative[j, 2], relative[j, 5], w, 0.0, 0.0, lookahead_s
            ):  # fmt: skip
                first, last = lost_span(
                    kinds[a, level], s, v, relative[j, 2], relative[j, 5], w, 0.0, 0.0, lookahead_s
                )  # fmt: skip
                if first > last:
                    # one instant of contact, lost by rounding: find it with the decision itself
                    early, late = 0.0, lookahead_s
                    for _ in range(60):
                        middle = (early + late) / 2
                        if lost(
                            kinds[a, level], s, v, relative[j, 2], relative[j, 5], w, 0.0, 0.0,
                            middle,
                        ):  # fmt: skip
                            late = middle
                        else:
                            early = middle
                    first, last = late, late
                first_s[j, level], last_s[j, level] = first, last
