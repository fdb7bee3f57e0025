"""Alert levels: which volumes are predicted to be violated within their alerting times.

A level's volume violated within its alerting time raises that level; the most severe one counts. Definitions:
`spec.daa.meaning`. The tables of levels are arrays, so that any number of encounters is evaluated in one call.
"""

import math

import numpy as np

from cratous.core.daa.records import Relative, Tables
from cratous.core.daa.uncertainty import lost, lost_span
from cratous.core.kernel import Vec2, driver


def _relative(row: np.ndarray) -> Relative:
    return Relative(Vec2(row[0], row[1]), Vec2(row[3], row[4]), row[2], row[5])


@driver(checked_by=("in_conflict", "uncertain_conflict"))
def raw_levels(
    relative: np.ndarray, errors: np.ndarray, alerter: np.ndarray, tables: Tables,
    lookahead_s: float, levels: np.ndarray,
):  # fmt: skip
    """The alert level of each pair, without history, into `levels`.

    relative: (pairs, 6) ownship minus intruder; errors: (pairs, 6) uncertainties, as in `lost`;
    alerter: (pairs) index into the tables, below 0: none.
    """
    w = np.zeros(11)
    for j in range(alerter.size):
        a = alerter[j]
        w[5:] = errors[j]
        levels[j] = 0
        if a < 0:
            continue
        state = _relative(relative[j])
        for level in range(tables.counts[a] - 1, -1, -1):
            w[:5] = tables.volumes[a, level]
            horizon_s = min(lookahead_s, tables.alerting_s[a, level])
            if lost(tables.kinds[a, level], state, w, 0.0, 0.0, horizon_s):
                levels[j] = level + 1
                break


@driver(checked_by=("in_conflict", "conflict_span", "uncertain_conflict", "uncertain_span"))
def level_times(
    relative: np.ndarray, errors: np.ndarray, alerter: np.ndarray, tables: Tables,
    lookahead_s: float, first_s: np.ndarray, last_s: np.ndarray,
):  # fmt: skip
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
            if a < 0 or level >= tables.counts[a]:
                continue
            w[:5] = tables.volumes[a, level]
            kind, state = tables.kinds[a, level], _relative(relative[j])
            if lost(kind, state, w, 0.0, 0.0, lookahead_s):
                first, last = lost_span(kind, state, w, 0.0, 0.0, lookahead_s)
                if first > last:
                    # one instant of contact, lost by rounding: find it with the deciding kernel itself
                    early, late = 0.0, lookahead_s
                    for _ in range(60):
                        middle = (early + late) / 2
                        if lost(kind, state, w, 0.0, 0.0, middle):
                            late = middle
                        else:
                            early = middle
                    first, last = late, late
                first_s[j, level], last_s[j, level] = first, last
