"""Detect and avoid for one ownship at one instant: alerts and guidance from states and parameters.

Stateless; `core.daa.history` adds history. Violations, and which manoeuvres conflict, are decided by the kernels
behind `core.daa.alerting` and `core.daa.guidance`.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from cratous.core.daa.alerting import level_times, raw_levels
from cratous.core.daa.bands import Raw, Traffic, last_times, out_of_range, raw_bands
from cratous.core.daa.records import Tables
from cratous.core.daa.spread import spread_conflict
from cratous.core.daa.state import HDIR, Aircraft, Coordination, LevelTimes, Sigma
from cratous.core.daa.urgency import coordination, sides
from cratous.core.readings.tiered import swift
from cratous.spec.daa.parameters import (
    FAR,
    NEAR,
    TAUMOD,
    TCAS,
    Alerter,
    Level,
    Parameters,
    Volume,
    sensitivity,
)

EXACTLY = Sigma()
"""No uncertainty: a state known exactly."""


def thresholds(volume: Volume, alt_m: float) -> Volume:
    """A volume with its thresholds; those of TCAS are of the level at the own altitude [m].

    A resolution advisory by modified tau is the well-clear volume with these thresholds, including the time to
    co-altitude.
    """
    if volume.kind != TCAS:
        return volume
    level = sensitivity(alt_m)
    return Volume(TAUMOD, level.dmod_m, level.zthr_m, level.tau_s, level.tau_s)


@functools.lru_cache(maxsize=64)
def tables(alerters: tuple[Alerter, ...], alt_m: float) -> Tables:
    """The levels of all alerters as arrays; alt_m matters only to TCAS volumes."""
    most = max((len(a.levels) for a in alerters), default=0)
    shape = (len(alerters), most)
    made = Tables(
        np.array([len(a.levels) for a in alerters], dtype=np.int64),
        np.zeros(shape, dtype=np.int64),
        np.zeros((*shape, 5)),
        np.zeros(shape),
        np.zeros(shape),
    )
    for a, alerter in enumerate(alerters):
        for k, level in enumerate(alerter.levels):
            v = thresholds(level.volume, alt_m)
            made.kinds[a, k] = v.kind
            made.volumes[a, k] = (v.dthr_m, v.zthr_m, v.tthr_s, v.tcoa_s, v.vmod_s)
            made.alerting_s[a, k] = level.alerting_time_s
            made.early_s[a, k] = level.early_alerting_time_s
    return made


def tables_at(p: Parameters, alt_m: float) -> Tables:
    """The level tables of these parameters."""
    tcas = any(level.volume.kind == TCAS for a in p.alerters for level in a.levels)
    return tables(p.alerters, alt_m if tcas else 0.0)


def states(aircraft: Sequence[Aircraft]) -> np.ndarray:
    """(n, 6) positions and velocities."""
    return np.array([a[1:7] for a in aircraft], dtype=np.float64).reshape(-1, 6)


def alerter_index(p: Parameters, own: Aircraft, other: Aircraft) -> int:
    """The index of the alerter used for an intruder, or -1 for none."""
    number = own.alerter if p.ownship_centric_alerting else other.alerter
    return number - 1 if 1 <= number <= len(p.alerters) else -1


def region_level(alerter: Alerter, region: int) -> tuple[int, Level] | None:
    """The first level of an alerter that colours a region, and its index."""
    return next(((k, x) for k, x in enumerate(alerter.levels) if x.region == region), None)


def _regions_of(alerter: Alerter) -> list[tuple[int, int]]:
    """The regions coloured by levels of an alerter, each with the index of the first such level."""
    found = ((region, region_level(alerter, region)) for region in range(FAR, NEAR + 1))
    return [(region, one[0]) for region, one in found if one is not None]


def _root(east: float, north: float, both: float) -> float:
    """Standard deviation along the worst direction; both: root of the covariance, with its sign."""
    a, b, c = east * east, north * north, math.copysign(both * both, both)
    half = (a - b) / 2
    return math.sqrt((a + b) / 2 + math.sqrt(half * half + c * c))


def errors_of(p: Parameters, own: Aircraft, other: Aircraft) -> np.ndarray:
    """The uncertainties of a pair as `core.daa.uncertainty.lost` takes them: z-scores times the standard deviations
    of both.
    """
    if own.sigma == EXACTLY and other.sigma == EXACTLY:
        return np.array([0.0, 0.0, 0.0, 0.0, 0.0, p.h_vel_z_distance_m])
    pos = vel = 0.0
    for x in (own.sigma, other.sigma):
        pos += _root(x.s_ew_m, x.s_ns_m, x.s_en_m)
        vel += _root(x.v_ew_m_s, x.v_ns_m_s, x.v_en_m_s)
    return np.array(
        [
            p.h_pos_z_score * pos,
            p.v_pos_z_score * (own.sigma.sz_m + other.sigma.sz_m),
            p.v_vel_z_score * (own.sigma.vz_m_s + other.sigma.vz_m_s),
            p.h_vel_z_score_max * vel,
            p.h_vel_z_score_min * vel,
            p.h_vel_z_distance_m,
        ]
    )


class Seen(NamedTuple):
    """The evaluation of one instant: aircraft, alerter of each, raw levels, times, conflicts, and the intruder to
    coordinate with.
    """

    own: Aircraft
    others: tuple[Aircraft, ...]
    alerters: tuple[int, ...]
    levels: tuple[int, ...]
    times: tuple[tuple[LevelTimes, ...], ...]
    traffic: Traffic
    coordination: Coordination | None = None


def look(
    p: Parameters,
    own: Aircraft,
    others: Sequence[Aircraft],
    alerters: Sequence[int] | None = None,
    held: Mapping[tuple[str, int], int] = MappingProxyType({}),
) -> Seen:
    """Raw alert levels and conflicts.

    alerters: indices that override those of the parameters; held: levels that are already shown, by id and alerter
    index: an intruder that violates such a level within its early alerting time is in conflict with it.
    """
    t = tables_at(p, own.alt_m)
    index = tuple(alerters if alerters is not None else (alerter_index(p, own, o) for o in others))
    n = len(others)
    there = states(others)
    together = coordination(p, own, others)
    keep = sides(together, others)
    relative = states([own]) - there
    judged = np.array(index, dtype=np.int64).reshape(n)
    levels = np.zeros(n, dtype=np.int64)
    errors = np.array([errors_of(p, own, o) for o in others]).reshape(n, 6)
    width = t.kinds.shape[1] if len(t.counts) else 0
    first, last = np.full((n, width), math.nan), np.full((n, width), math.nan)
    if n and width:
        swift(raw_levels, n)(relative, errors, judged, t, p.lookahead_time_s, levels)
        swift(level_times, n)(relative, errors, judged, t, p.lookahead_time_s, first, last)
    for i, a in enumerate(index):
        for k in range(len(p.alerters[a].levels) if a >= 0 else 0, int(levels[i]), -1):
            level = p.alerters[a].levels[k - 1]
            if any(level.spread) and spread_conflict(
                p,
                own,
                there[i],
                int(t.kinds[a, k - 1]),
                np.concatenate([t.volumes[a, k - 1], errors[i]]),
                level,
                keep[i] * p.conflict_crit,
            ):
                levels[i] = k
                break
    times = tuple(
        tuple(
            LevelTimes(
                None if math.isnan(first[i, k]) else float(first[i, k]),
                None if math.isnan(last[i, k]) else float(last[i, k]),
            )
            for k in range(int(t.counts[a]) if a >= 0 else 0)
        )
        for i, a in enumerate(index)
    )
    traffic = Traffic(
        tuple(o.id for o in others),
        there,
        np.zeros((4, n), dtype=np.bool_),
        np.zeros((4, n), dtype=np.int64),
        np.zeros((4, n, 11)),
        np.zeros((4, n)),
        np.zeros((4, n), dtype=np.bool_),
        np.zeros((4, n), dtype=np.bool_),
        keep,
    )
    mapped = {a: _regions_of(p.alerters[a]) for a in set(index) if a >= 0}
    for i, a in enumerate(index):
        if a < 0:
            continue
        for region, k in mapped[a]:
            traffic.mapped[region, i] = True
            traffic.kinds[region, i] = t.kinds[a, k]
            traffic.volumes[region, i] = [*t.volumes[a, k], *errors[i]]
            traffic.alerting_s[region, i] = t.alerting_s[a, k]
            entry = times[i][k].first_s
            shown = held.get((others[i].id, a)) == k + 1
            limit_s = (t.early_s if shown else t.alerting_s)[a, k]
            traffic.violated[region, i] = entry == 0
            traffic.conflict[region, i] = entry is not None and entry < max(
                min(limit_s, p.lookahead_time_s), 1e-300
            )
    return Seen(own, tuple(others), index, tuple(int(x) for x in levels), times, traffic, together)


def bands_now(p: Parameters, seen: Seen, dimension: int, terminal: bool = False) -> Raw | None:
    """The bands of a dimension without history; None if the own value is out of range.

    terminal: a conflict in the terminal area: no downward guidance is given, and with dta_logic -1 no recovery of
    direction.
    """
    if out_of_range(p, seen.own, dimension):
        return None
    recover = (p.recovery_hdir, p.recovery_hs, p.recovery_vs, p.recovery_alt)[dimension]
    if terminal and dimension == HDIR and p.dta_logic < 0:
        recover = False
    return raw_bands(p, seen.own, seen.traffic, dimension, recover, terminal)


def corrective_entry(p: Parameters, seen: Seen, i: int) -> float | None:
    """When the corrective volume of intruder i is first violated within the look-ahead [s]."""
    a = seen.alerters[i]
    found = region_level(p.alerters[a], p.corrective_region) if a >= 0 else None
    return None if found is None else seen.times[i][found[0]].first_s


def last_times_of(p: Parameters, seen: Seen, i: int) -> tuple[float | None, ...] | None:
    """Last times to manoeuvre out of conflict with intruder i; None: there is no conflict."""
    entry = corrective_entry(p, seen, i)
    return None if entry is None else last_times(p, seen.own, seen.traffic, i, entry)
